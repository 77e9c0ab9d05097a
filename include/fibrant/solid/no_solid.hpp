// SPDX-License-Identifier: MIT
#pragma once
/// @file No solid: what models without one are made with.

#include <fibrant/core/parameters.hpp>

namespace fibrant::solid {

/// Fibres alone: compiled away.
struct NoSolid : core::Inactive {
    using Parameters = core::NoParameters;
    NoSolid() = default;
    explicit NoSolid(const Parameters&) {}
};

}  // namespace fibrant::solid
