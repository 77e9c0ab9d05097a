// SPDX-License-Identifier: MIT
#pragma once
/// @file Vectors of random components, the same with every compiler.

#include <fibrant/core/types.hpp>

#include <random>

namespace fibrant::test {

/// Components drawn one after the other: as arguments of one call, the compiler would choose their order, and the scene.
template <class Distribution, class Generator>
Vec3 random_vector(Distribution& draw, Generator& generator) {
    const double x = draw(generator), y = draw(generator), z = draw(generator);
    return {x, y, z};
}

inline Vec3 uniform_vector(std::mt19937& generator) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return random_vector(uniform, generator);
}
inline Vec3 normal_vector(std::mt19937& generator) {
    std::normal_distribution<double> normal;
    return random_vector(normal, generator);
}

}  // namespace fibrant::test
