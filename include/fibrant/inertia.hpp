// SPDX-License-Identifier: MIT
#pragma once
/// @file Inertia: a term of models whose fibres move in time.

#include <fibrant/inertia/bodies.hpp>
#include <fibrant/inertia/inertia.hpp>
#include <fibrant/inertia/mass.hpp>
#include <fibrant/inertia/time_integrator.hpp>
