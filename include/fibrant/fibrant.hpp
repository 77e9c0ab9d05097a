// SPDX-License-Identifier: MIT
#pragma once
/// @file What a first simulator needs: a scene, a beam, a search, laws, a solver, a loading. All of a folder is in the header of
/// its name, such as <fibrant/law.hpp>; a program compiles in the least time with the headers of its own parts alone.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/observe/loading_curve.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
