// SPDX-License-Identifier: MIT
#pragma once
/// @file What every linear system can offer through `visit`: products, node blocks and chain bands.

#include <fibrant/assembly/linear_system.hpp>

#include <utility>
#include <vector>

namespace fibrant::assembly {

/// What the functions below need of a system: its terms.
template <class T>
concept VisitedSystem = requires(const T system, IgnoredTerms& terms) {
    { system.layout() } -> std::same_as<const scene::DofLayout&>;
    system.visit(terms);
};

/// Where each vector stands: its chain, and its number in the chain.
class VectorPlaces {
public:
    explicit VectorPlaces(const scene::DofLayout& layout)
        : chain_(core::at(layout.vectors()), -1), number_(core::at(layout.vectors()), 0) {
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            for (Index k = 0; k < chain.nodes * chain.vectors_per_node; ++k) {
                chain_[core::at(chain.first_vector + k)] = static_cast<int>(c);
                number_[core::at(chain.first_vector + k)] = static_cast<int>(k);
            }
        }
    }
    Index chain(Index vector) const noexcept { return chain_[core::at(vector)]; }
    Index number(Index vector) const noexcept { return number_[core::at(vector)]; }

private:
    std::vector<int> chain_, number_;
};

/// Calls body(i, j, block) for the 3 x 3 blocks of each term of K, i and j being 3-vectors. All ordered pairs.
template <VisitedSystem System, class Body>
void visit_blocks(const System& system, const Body& body) {
    struct Blocks {
        const Body& body;
        void point(const PointTerm& term) const {
            for (std::size_t i = 0; i < term.vectors.size(); ++i) {
                for (std::size_t j = 0; j < term.vectors.size(); ++j) {
                    body(term.vectors[i], term.vectors[j], Mat3(term.weights[i] * term.weights[j] * term.stiffness));
                }
            }
        }
        void dense(const DenseTerm& term) const {
            for (std::size_t i = 0; i < term.vectors.size(); ++i) {
                for (std::size_t j = 0; j < term.vectors.size(); ++j) {
                    body(term.vectors[i], term.vectors[j],
                         Mat3(term.stiffness.template block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j))));
                }
            }
        }
    } blocks{body};
    system.visit(blocks);
}

/// y = A x, term by term. Serial: for tests and small systems.
template <VisitedSystem System>
void apply_terms(const System& system, const Vector& x, Vector& y) {
    struct Product {
        const Vector& x;
        Vector& y;
        void point(const PointTerm& term) const {
            Vec3 sum = Vec3::Zero();
            for (std::size_t i = 0; i < term.vectors.size(); ++i) {
                sum += term.weights[i] * x.segment<3>(3 * term.vectors[i]);
            }
            const Vec3 force = term.stiffness * sum;
            for (std::size_t i = 0; i < term.vectors.size(); ++i) {
                y.segment<3>(3 * term.vectors[i]) += term.weights[i] * force;
            }
        }
        void dense(const DenseTerm& term) const {
            for (std::size_t i = 0; i < term.vectors.size(); ++i) {
                Vec3 force = Vec3::Zero();
                for (std::size_t j = 0; j < term.vectors.size(); ++j) {
                    force += term.stiffness.template block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j)) *
                             x.segment<3>(3 * term.vectors[j]);
                }
                y.segment<3>(3 * term.vectors[i]) += force;
            }
        }
    };
    const HeldProjector held(system.layout());
    Vector free = x;
    held.project(free);
    y.setZero();
    Product product{free, y};
    system.visit(product);
    held.complete(x, y);
}

/// Lower block bands of all chains, as LinearSystem::chain_band gives them. One sweep over the terms.
template <VisitedSystem System>
void chain_bands_from_terms(const System& system, std::vector<Matrix>& bands) {
    const scene::DofLayout& layout = system.layout();
    const VectorPlaces places(layout);
    const HeldProjector held(layout);
    bands.resize(layout.chains.size());
    for (std::size_t c = 0; c < bands.size(); ++c) {
        const scene::Chain& chain = layout.chains[c];
        const Index m = 3 * chain.vectors_per_node;
        bands[c].setZero(chain.nodes * m, (chain.reach + 1) * m);
    }
    visit_blocks(system, [&](Index i, Index j, Mat3 block) {
        const Index c = places.chain(i);
        if (c != places.chain(j)) return;
        const Index per_node = layout.chains[core::at(c)].vectors_per_node;
        const Index a = places.number(i) / per_node, b = places.number(j) / per_node;
        if (a < b || a - b > layout.chains[core::at(c)].reach) return;
        held.project(i, j, block);
        bands[core::at(c)].block<3, 3>(3 * places.number(i), 3 * ((a - b) * per_node + places.number(j) % per_node)) += block;
    });
    for (const scene::HeldVector& vector : layout.held) {
        const Index c = places.chain(vector.vector), k = places.number(vector.vector);
        const Index per_node = layout.chains[core::at(c)].vectors_per_node;
        bands[core::at(c)].block<3, 3>(3 * k, 3 * (k % per_node)) += held.held_part(vector);
    }
}

/// The band of one chain. Visits all terms: for tests and small systems; use chain_bands_from_terms for all chains.
template <VisitedSystem System>
void chain_band_from_terms(const System& system, Index chain, Matrix& blocks) {
    std::vector<Matrix> bands;
    chain_bands_from_terms(system, bands);
    blocks = std::move(bands[core::at(chain)]);
}

/// The diagonal node blocks of one chain. Visits all terms: for tests and small systems.
template <VisitedSystem System>
void node_blocks_from_terms(const System& system, Index chain, Matrix& blocks) {
    Matrix band;
    chain_band_from_terms(system, chain, band);
    blocks = band.leftCols(3 * system.layout().chains[core::at(chain)].vectors_per_node);
}

}  // namespace fibrant::assembly
