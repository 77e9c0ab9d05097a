// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres that tests of loads push on.

#include <fibrant/scene/assembly.hpp>

namespace fibrant::test {

inline scene::FibreSpecification fibre(const Vec3& from, const Vec3& to, Index elements) {
    scene::FibreSpecification one;
    one.from = from, one.to = to, one.section = scene::circular(0.01), one.material = {1000.0, 0.3}, one.elements = elements;
    return one;
}

}  // namespace fibrant::test
