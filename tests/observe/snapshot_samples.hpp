// SPDX-License-Identifier: MIT
#pragma once
/// @file Small snapshots whose figures are known by hand.

#include <fibrant/observe/snapshot.hpp>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

namespace fibrant::observe {

/// Straight fibre from one point to another, directors across it.
inline FibreSnapshot straight_fibre(const Vec3& from, const Vec3& to, Index nodes, double radius, Index group) {
    FibreSnapshot fibre;
    fibre.section = scene::circular(radius);
    fibre.group = group;
    const Vec3 ahead = (to - from).normalized();
    const Vec3 helper = std::abs(ahead.z()) < 0.9 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3::UnitX());
    const Vec3 g_1 = (helper - helper.dot(ahead) * ahead).normalized();
    const Vec3 g_2{ahead.y() * g_1.z() - ahead.z() * g_1.y(), ahead.z() * g_1.x() - ahead.x() * g_1.z(),
                   ahead.x() * g_1.y() - ahead.y() * g_1.x()};
    for (Index node = 0; node < nodes; ++node) {
        const double s = static_cast<double>(node) / static_cast<double>(nodes - 1);
        fibre.position.push_back((1.0 - s) * from + s * to);
        fibre.displacement.emplace_back(0.25, 0.5, -1.0);
        fibre.director_1.push_back(g_1);
        fibre.director_2.push_back(g_2);
        fibre.curvature.push_back(static_cast<double>(node));
    }
    return fibre;
}

/// Two crossing fibres of radius 0.1 and 0.2, the second above, in contact by one active element of two.
inline Snapshot crossing_pair(Index increment = 7) {
    Snapshot snapshot;
    snapshot.increment = increment;
    snapshot.stage = "press";
    snapshot.progress = 0.5;
    snapshot.fibres.push_back(straight_fibre({-1, 0, 0}, {1, 0, 0}, 3, 0.1, 0));
    snapshot.fibres.push_back(straight_fibre({0, -1, 0.3}, {0, 1, 0.3}, 5, 0.2, 1));
    ContactSnapshot closed;
    closed.fibre_i = 0;
    closed.fibre_j = 1;
    closed.position = {0, 0, 0.1};
    closed.normal = Vec3::UnitZ();
    closed.gap = -0.005;
    closed.reaction = 2.0;
    closed.friction = {0.3, 0.4, 0.0};
    closed.stiffness = 400.0;
    closed.crossing = true;
    ContactSnapshot open = closed;
    open.position = {0.5, 0, 0.1};
    open.normal = Vec3::UnitX();
    open.gap = 0.25;
    open.reaction = 0.0;
    open.friction = Vec3::Zero();
    open.crossing = false;
    snapshot.contacts = {closed, open};
    return snapshot;
}

/// A folder of the test's own, emptied.
inline std::filesystem::path empty_folder(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("fibrant_" + name);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

}  // namespace fibrant::observe
