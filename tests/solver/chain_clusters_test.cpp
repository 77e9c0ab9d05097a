// SPDX-License-Identifier: MIT
#include "support/synthetic_system.hpp"

#include <fibrant/solver/chain_clusters.hpp>

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <numbers>
#include <set>

using namespace fibrant;

namespace chain_clusters_test {

using test::SyntheticSystem;

// Straight chains of bars from one point to another.
Index add_line(SyntheticSystem& system, const Vec3& from, const Vec3& to, Index group, Index nodes = 9) {
    const Index c = system.add_chain(nodes, 1, 1, group, 1.0);
    const Index first = system.description.chains.back().first_vector;
    for (Index a = 0; a < nodes; ++a) {
        const double t = nodes > 1 ? static_cast<double>(a) / static_cast<double>(nodes - 1) : 0.0;
        system.description.value[core::at(first + a)] = (1.0 - t) * from + t * to;
    }
    return c;
}

void touch(SyntheticSystem& system, Index c, Index d, Index times) {
    for (Index a = 0; a < times; ++a) {
        system.points.push_back(
            {{system.description.chains[core::at(c)].first_vector + a, system.description.chains[core::at(d)].first_vector + a},
             {1.0, -1.0},
             Mat3::Identity()});
    }
}

// Every chain is in one cluster.
void check_partition(const std::vector<solver::ChainCluster>& clusters, Index chains) {
    std::set<Index> seen;
    for (const auto& cluster : clusters) {
        REQUIRE(cluster.chains.size() == cluster.reversed.size());
        CHECK(std::is_sorted(cluster.chains.begin(), cluster.chains.end()));
        for (const Index c : cluster.chains) CHECK(seen.insert(c).second);
    }
    CHECK(core::count(seen) == chains);
}

TEST_CASE("a group is cut into compact parts of nearly equal number") {
    SyntheticSystem system;
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 15; ++column)
            add_line(system, {0, 1.0 * column, 1.0 * row}, {30, 1.0 * column, 1.0 * row}, 3);
    const auto clusters = solver::cluster_chains(system, 19);
    check_partition(clusters, 75);
    CHECK(clusters.size() == 4);
    for (const auto& cluster : clusters) {
        CHECK(core::count(cluster.chains) >= 18);
        CHECK(core::count(cluster.chains) <= 19);
        double low = 1e9, high = -1e9;
        for (const Index c : cluster.chains) {
            const double y = system.description.value[core::at(9 * c)].y();
            low = std::min(low, y), high = std::max(high, y);
        }
        CHECK(high - low <= 4.0);  // cut across the long side, 15 columns in four
    }
}

TEST_CASE("chains that run backwards are reversed, chains that run across form clusters of their own") {
    SyntheticSystem system;
    for (int k = 0; k < 6; ++k) {
        const Vec3 a(0, k, 0), b(10, k, 0);
        add_line(system, k % 2 == 0 ? a : b, k % 2 == 0 ? b : a, 0);
    }
    for (int k = 0; k < 3; ++k) add_line(system, Vec3(k, 0, 5), Vec3(k, 10, 5), 0);
    add_line(system, {0, 0, 0}, {0, 0, 0}, 0, 1);  // a rigid body in the group
    const auto clusters = solver::cluster_chains(system, 19);
    check_partition(clusters, 10);
    REQUIRE(clusters.size() == 3);
    for (const auto& cluster : clusters) {
        for (std::size_t k = 0; k < cluster.chains.size(); ++k)
            CHECK(cluster.reversed[k] == (cluster.chains[k] < 6 && cluster.chains[k] % 2 == 1));
    }
}

TEST_CASE("without groups those who touch along their length are together, and those who only cross are not") {
    SyntheticSystem system;
    for (int k = 0; k < 8; ++k) add_line(system, {0, 1.0 * k, 0}, {10, 1.0 * k, 0}, -1);
    for (int k = 0; k + 1 < 8; ++k) {
        if (k != 3) touch(system, k, k + 1, 5);
    }
    const Index across = add_line(system, {5, 0, 1}, {5, 10, 1}, -1);
    for (int k = 0; k < 8; ++k) touch(system, k, across, 1);
    const auto clusters = solver::cluster_chains(system, 19);
    check_partition(clusters, 9);
    REQUIRE(clusters.size() == 3);
    CHECK(clusters[0].chains == std::vector<Index>{0, 1, 2, 3});
    CHECK(clusters[1].chains == std::vector<Index>{4, 5, 6, 7});
    CHECK(clusters[2].chains == std::vector<Index>{across});
}

TEST_CASE("clusters do not depend on where the assembly is or how it is turned") {
    std::vector<std::vector<solver::ChainCluster>> found;
    for (int turn = 0; turn < 3; ++turn) {
        SyntheticSystem system;
        const Mat3 rotation = Eigen::AngleAxisd(0.7 * turn, Vec3(1, 2, 3).normalized()).toRotationMatrix();
        const Vec3 shift(3.0 * turn, -turn, 0.1 * turn);
        for (int k = 0; k < 60; ++k) {  // a spiral: no two sites alike
            const double angle = 2.4 * k, radius = std::sqrt(k + 0.5);
            const Vec3 site(0, 2.0 * radius * std::cos(angle), radius * std::sin(angle));
            add_line(system, rotation * site + shift, rotation * (site + Vec3(40, 0, 0)) + shift, 0);
        }
        found.push_back(solver::cluster_chains(system, 15));
        CHECK(found.back().size() == 4);
    }
    for (const auto& other : found) {
        std::set<std::vector<Index>> a, b;
        for (const auto& cluster : found.front()) a.insert(cluster.chains);
        for (const auto& cluster : other) b.insert(cluster.chains);
        CHECK(a == b);
    }
}

}  // namespace chain_clusters_test
