// SPDX-License-Identifier: MIT
#pragma once
/// @file The least linear system: terms that are stored and visited, and nothing faster.

#include "random_vector.hpp"

#include <fibrant/assembly/visited_system.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace fibrant::test {

/// A system whose terms are given one by one. Call finish() once they are complete.
class SyntheticSystem {
public:
    struct Point {
        std::vector<Index> vectors;
        std::vector<double> weights;
        Mat3 stiffness;
    };
    struct Dense {
        std::vector<Index> vectors;
        Matrix stiffness;
    };
    scene::DofLayout description;
    std::vector<Point> points;
    std::vector<Dense> dense;

    /// Adds the vectors of a chain; the first of each node is a position, the others are directions of length `radius`.
    Index add_chain(Index nodes, Index vectors_per_node, Index reach, Index group, double radius) {
        description.chains.push_back({description.vectors(), nodes, vectors_per_node, reach, group});
        for (Index k = 0; k < nodes * vectors_per_node; ++k) {
            const bool position = k % vectors_per_node == 0;
            description.kind.push_back(position ? scene::VectorKind::position : scene::VectorKind::direction);
            description.value.push_back(position ? Vec3(static_cast<double>(k), 0, 0) : Vec3(0, 1, 0));
            description.length.push_back(position ? 1.0 : radius);
        }
        return core::count(description.chains) - 1;
    }
    void hold(Index vector, const Mat3& free) {
        description.held.push_back({vector, free});
        std::ranges::sort(description.held, {}, &scene::HeldVector::vector);
    }
    void finish() { assembly::chain_bands_from_terms(*this, bands_); }

    const scene::DofLayout& layout() const { return description; }
    void apply(const Vector& x, Vector& y) const { assembly::apply_terms(*this, x, y); }
    void chain_band(Index chain, Matrix& blocks) const { blocks = bands_[core::at(chain)]; }
    void node_blocks(Index chain, Matrix& blocks) const {
        blocks = bands_[core::at(chain)].leftCols(3 * description.chains[core::at(chain)].vectors_per_node);
    }
    template <class Visitor>
    void visit(Visitor& visitor) const {
        for (const Dense& term : dense) visitor.dense(assembly::DenseTerm{term.vectors, term.stiffness});
        for (const Point& term : points) visitor.point(assembly::PointTerm{term.vectors, term.weights, term.stiffness});
    }

private:
    std::vector<Matrix> bands_;
};
static_assert(assembly::LinearSystem<SyntheticSystem>);

/// A, dense, from products with unit vectors.
template <assembly::LinearSystem System>
Matrix dense_matrix(const System& system) {
    const Index n = system.layout().unknowns();
    Matrix a(n, n);
    Vector y(n);
    for (Index k = 0; k < n; ++k) {
        system.apply(Vector::Unit(n, k), y);
        a.col(k) = y;
    }
    return a;
}

struct RandomSystem {
    std::vector<scene::Chain> chains;  ///< first_vector is set here
    int points = 0;                    ///< contact elements, each between two nodes of any two chains
    int held = 0;                      ///< vectors held in none, one, two or three directions
    int ties = 0;                      ///< of five vectors each, in one, two or three directions; the first two may move together
    double radius = 0.01;              ///< of directions
    double curvature = 1.0;            ///< of the dense terms; negative makes the system indefinite
    unsigned seed = 1;
};

/// Chains of positive definite elements with entries of order 1 (per displacement), tied by random points.
inline SyntheticSystem random_system(const RandomSystem& options) {
    SyntheticSystem system;
    std::mt19937 generator(options.seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto below = [&](Index n) { return static_cast<Index>(generator() % static_cast<unsigned>(n)); };
    for (const scene::Chain& chain : options.chains) {
        const Index c = system.add_chain(chain.nodes, chain.vectors_per_node, chain.reach, chain.group, options.radius);
        const Index first = system.description.chains[core::at(c)].first_vector;
        const Index span = std::min(chain.reach, chain.nodes - 1);
        for (Index a = 0; a + span < chain.nodes; a += std::max<Index>(span, 1)) {
            SyntheticSystem::Dense term;
            for (Index k = 0; k < (span + 1) * chain.vectors_per_node; ++k) {
                term.vectors.push_back(first + a * chain.vectors_per_node + k);
            }
            const Index size = 3 * core::count(term.vectors);
            Matrix root(2 * size, size);  // twice as many strains as unknowns: well-conditioned
            for (Index k = 0; k < root.size(); ++k) root.data()[k] = uniform(generator);
            for (Index k = 0; k < core::count(term.vectors); ++k) {
                root.middleCols<3>(3 * k) *= system.description.length[core::at(term.vectors[core::at(k)])];
            }
            term.stiffness = options.curvature * (root.transpose() * root);
            system.dense.push_back(std::move(term));
        }
        for (Index rest = (chain.nodes - 1) % std::max<Index>(span, 1); rest > 0; --rest) {  // nodes that no element reached
            SyntheticSystem::Dense term;
            for (Index k = 0; k < chain.vectors_per_node; ++k) {
                term.vectors.push_back(first + (chain.nodes - rest) * chain.vectors_per_node + k);
            }
            term.stiffness.setIdentity(3 * chain.vectors_per_node, 3 * chain.vectors_per_node);
            term.stiffness *= options.curvature * options.radius * options.radius;
            system.dense.push_back(std::move(term));
        }
    }
    for (int p = 0; p < options.points; ++p) {
        SyntheticSystem::Point term;
        for (const double sign : {1.0, -1.0}) {
            const scene::Chain& chain = system.description.chains[core::at(below(core::count(system.description.chains)))];
            const Index node = below(chain.nodes);
            for (Index k = 0; k < chain.vectors_per_node; ++k) {
                const Index vector = chain.first_vector + node * chain.vectors_per_node + k;
                if (std::ranges::find(term.vectors, vector) != term.vectors.end()) continue;
                term.vectors.push_back(vector);
                term.weights.push_back(sign * system.description.length[core::at(vector)] * (k == 0 ? 1.0 : uniform(generator)));
            }
        }
        const Vec3 normal = random_vector(uniform, generator).normalized();
        term.stiffness = 5.0 * normal * normal.transpose() + 0.5 * Mat3::Identity();
        system.points.push_back(std::move(term));
    }
    for (int k = 0; k < options.held; ++k) {
        const Index vector = k * (system.description.vectors() / std::max(options.held, 1));
        const Vec3 u = random_vector(uniform, generator).normalized();
        const Mat3 line = u * u.transpose();
        system.hold(vector, k % 3 == 0 ? Mat3::Zero() : k % 3 == 1 ? line : Mat3(Mat3::Identity() - line));
    }
    for (int t = 0; t < options.ties; ++t) {
        scene::Tie tie;
        tie.count = 1 + t % 3;
        tie.first = t == 0 ? 0 : system.description.ties.back().first + system.description.ties.back().count;
        const auto taken = [&](Index vector) {
            const auto in = [&](const scene::Tie& other) {
                return std::ranges::find(other.vectors, vector) != other.vectors.end();
            };
            return in(tie) || std::ranges::any_of(system.description.ties, in) ||
                   system.description.kind[core::at(vector)] != scene::VectorKind::position ||
                   std::ranges::find(system.description.held, vector, &scene::HeldVector::vector) !=
                       system.description.held.end();
        };
        while (tie.vectors.size() < 5) {
            const Index vector = below(system.description.vectors());
            if (taken(vector)) continue;
            tie.vectors.push_back(vector), tie.weights.push_back(1.0 / std::sqrt(5.0));
        }
        const Vec3 first = random_vector(uniform, generator).normalized(), second = first.unitOrthogonal();
        tie.axes.col(0) = first, tie.axes.col(1) = second, tie.axes.col(2) = first.cross(second);
        system.description.ties.push_back(tie);
    }
    if (options.ties > 1) system.description.motions.push_back({{0, 1, 2}, Vec3(2.0, -1.0, 2.0) / 3.0, {}});
    system.finish();
    return system;
}

/// Right-hand side with forces of order 1 (on directions: of order `length`).
inline Vector random_load(const scene::DofLayout& layout, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Vector b(layout.unknowns());
    for (Index k = 0; k < b.size(); ++k) b[k] = uniform(generator) * layout.length[core::at(k / 3)];
    return b;
}

}  // namespace fibrant::test
