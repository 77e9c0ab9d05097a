// SPDX-License-Identifier: MIT
#pragma once
/// @file Coarse space of clusters of chains: rigid motions of their cross-sections, linear between stations along them.

#include <fibrant/core/rotation.hpp>
#include <fibrant/solver/block_cholesky.hpp>
#include <fibrant/solver/chain_clusters.hpp>
#include <fibrant/solver/coarse_couplings.hpp>
#include <fibrant/solver/coarse_ties.hpp>
#include <fibrant/solver/linear_solver.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cassert>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// Coarse space spanned by P: three translations and three rotations at each station of a cluster.
///
/// A node between two stations moves with their motions, weighted linearly; a rotation moves positions about the middle of
/// the cluster and turns directions. This is the bending of many fibres at once, which factors of single chains do not
/// see. P^T A P is summed from the bands of the chains, which are at hand when chains are factored, and from
/// what the terms couple beyond them; A itself is never formed. The sum is in double.
///
/// @tparam Real  float or double, of the factor of P^T A P: as a preconditioner float is as good, and half the bytes
template <class Real = float>
class RigidCoarseSpace {
public:
    /// Clusters of about `cluster_size` chains, and a station every `elements_per_station` elements; both > 0.
    template <assembly::LinearSystem System>
    void analyse(const System& system, Index cluster_size, Index elements_per_station) {
        const scene::DofLayout& layout = system.layout();
        clusters_ = cluster_chains(system, cluster_size);
        chains_.assign(layout.chains.size(), {});
        stations_ = 0;
        for (const ChainCluster& cluster : clusters_) {
            Index intervals = 0;
            for (const Index c : cluster.chains) {
                const scene::Chain& chain = layout.chains[core::at(c)];
                const Index step = std::max<Index>(chain.reach, 1) * elements_per_station;
                intervals = std::max(intervals, (chain.nodes - 1 + step - 1) / step);
            }
            for (std::size_t l = 0; l < cluster.chains.size(); ++l) {
                const Index nodes = layout.chains[core::at(cluster.chains[l])].nodes;
                Chain& chain = chains_[core::at(cluster.chains[l])];
                chain.first_station = stations_;
                chain.intervals = nodes > 1 ? intervals : 0;
                chain.nodes = nodes;
                chain.reversed = cluster.reversed[l];
            }
            stations_ += static_cast<int>(intervals) + 1;
        }
        modes_.places.resize(layout.kind.size());
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            for (Index k = 0; k < chain.nodes * chain.vectors_per_node; ++k) {
                const Index node = k / chain.vectors_per_node;
                modes_.places[core::at(chain.first_vector + k)] = {static_cast<int>(c), static_cast<int>(node),
                                                                   hat(chains_[core::at(c)], node)};
            }
        }
        find_pattern(system);
    }

    Index clusters() const noexcept { return core::count(clusters_); }
    Index stations() const noexcept { return stations_; }
    const BlockCholesky<Real>& matrix() const noexcept { return matrix_; }

    /// To be called before the chains are added: takes over the values of the layout.
    void begin(const scene::DofLayout& layout) {
        modes_.arm = layout.value;
        modes_.turn.clear();
        if (std::ranges::find(layout.kind, scene::VectorKind::rotation) != layout.kind.end()) {
            modes_.turn.resize(layout.kind.size());
            for (std::size_t v = 0; v < modes_.turn.size(); ++v)
                if (layout.kind[v] == scene::VectorKind::rotation) modes_.turn[v] = core::spin_matrix(layout.value[v]).inverse();
        }
        core::parallel_for(
            clusters(),
            [&](Index k) {
                Vec3 sum = Vec3::Zero();
                Index positions = 0;
                for_positions(layout, k, [&](Index v) { sum += layout.value[core::at(v)], ++positions; });
                const Vec3 middle = sum / static_cast<double>(std::max<Index>(positions, 1));
                for_positions(layout, k, [&](Index v) { modes_.arm[core::at(v)] -= middle; });
            },
            grain(layout, clusters()));
    }

    /// Adds the band of chain c, as LinearSystem::chain_band gives it. For different chains from several threads at once.
    void add_chain(const scene::DofLayout& layout, const assembly::HeldProjector& held, Index c, const Matrix& band) {
        const scene::Chain& chain = layout.chains[core::at(c)];
        Chain& own = chains_[core::at(c)];
        const Index m = 3 * chain.vectors_per_node;
        own.blocks.assign(core::at((own.intervals + 1) * (own.reach(chain.reach) + 1)), Block::Zero());
        std::vector<Modes> modes(core::at(chain.nodes), Modes(m, 6));
        for (Index a = 0; a < chain.nodes; ++a) {
            for (Index v = 0; v < chain.vectors_per_node; ++v) {
                modes[core::at(a)].middleRows<3>(3 * v) =
                    modes_.mode(layout, held, chain.first_vector + a * chain.vectors_per_node + v);
            }
        }
        // Products of a few numbers, without the packing of those of large matrices.
        Modes product(m, 6);
        for (Index a = 0; a < chain.nodes; ++a) {
            for (Index d = 0; d <= std::min(a, chain.reach); ++d) {
                // I - F, which the band has on held vectors, gives nothing with F times the modes.
                product.noalias() = band.block(a * m, d * m, m, m).lazyProduct(modes[core::at(a - d)]);
                const Block block = modes[core::at(a)].transpose().lazyProduct(product);
                add_to_chain(own, chain.reach, hat(own, a), hat(own, a - d), block, d == 0);
            }
        }
    }

    /// Adds what the terms couple beyond the bands of chains, and factors.
    /// @return indefinite if P^T A P is not positive semidefinite; the correction is positive semidefinite all the same
    template <assembly::LinearSystem System>
    SolveStatus finish(const System& system) {
        if (!sum(system)) {  // terms between stations that had none in the analysis
            find_pattern(system);
            [[maybe_unused]] const bool complete = sum(system);
            assert(complete);
        }
        for (Chain& chain : chains_) core::release(chain.blocks);
        const auto pivots = matrix_.factor();
        if (!pivots.finite) return SolveStatus::not_finite;
        return pivots.negative > 0 ? SolveStatus::indefinite : SolveStatus::converged;
    }

    /// z += P (P^T A P)^-1 P^T r
    ///
    /// @param r, z  zero outside the free directions of held vectors
    void add_correction(const scene::DofLayout& layout, const Vector& r, Vector& z) {
        restrict_to_stations(layout, r);
        matrix_.solve(station_values_);
        prolong(layout, z);
        // The P that the matrix was made with: what others make of z would not be symmetric otherwise.
        for (const scene::HeldVector& held : layout.held)
            z.segment<3>(3 * held.vector) = held.free * z.segment<3>(3 * held.vector).eval();
    }

    // In parts, for those who share the work of a correction among themselves:

    using Motion = Eigen::Matrix<double, 6, 1>;
    /// Calls add(station, its share of P^T r) for nodes [first, last) of a chain, in the order of the chain; a station may come
    /// several times.
    template <class Add>
    void restrict_nodes(const scene::DofLayout& layout, const Vector& r, Index c, Index begin, Index end, const Add& add) const {
        const scene::Chain& chain = layout.chains[core::at(c)];
        Motion near = Motion::Zero(), far = Motion::Zero();  // of the two stations that nodes are between
        int station = modes_.places[core::at(chain.first_vector + begin * chain.vectors_per_node)].hat.station;
        const auto store = [&] {
            add(station, near);
            if (!far.isZero(0.0)) add(station + 1, far);
        };
        for (Index a = begin; a < end; ++a) {
            Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
            const Index first = chain.first_vector + a * chain.vectors_per_node;
            for (Index v = first; v < first + chain.vectors_per_node; ++v) {
                const Vec3 f = r.segment<3>(3 * v);
                if (layout.kind[core::at(v)] == scene::VectorKind::position) force += f;
                if (modes_.turns(layout, v))
                    moment += modes_.turn[core::at(v)].transpose() * f;
                else
                    moment += modes_.arm[core::at(v)].cross(f);
            }
            const Hat& hat = modes_.places[core::at(first)].hat;
            if (hat.station != station) {
                store();
                near.setZero(), far.setZero();
                station = hat.station;
            }
            Motion both;
            both << force, moment;
            near += hat.weight(0) * both;
            far += hat.second * both;
        }
        store();
    }
    /// (P^T A P)^-1 of forces and moments at all stations, in their place.
    void solve_stations(Vector& values) { matrix_.solve(values); }
    /// z += P times the values of all stations, of nodes [begin, end) of a chain; held vectors as if they were free.
    void prolong_to_nodes(const scene::DofLayout& layout, const Vector& values, Index c, Index begin, Index end,
                          Vector& z) const {
        const scene::Chain& chain = layout.chains[core::at(c)];
        for (Index a = begin; a < end; ++a) {
            const Index first = chain.first_vector + a * chain.vectors_per_node;
            const Hat& hat = modes_.places[core::at(first)].hat;
            Motion motion = hat.weight(0) * values.segment<6>(6 * hat.station);
            if (hat.second > 0.0) motion += hat.second * values.segment<6>(6 * hat.station + 6);
            const Vec3 translation = motion.head<3>(), rotation = motion.tail<3>();
            for (Index v = first; v < first + chain.vectors_per_node; ++v) {
                Vec3 move = modes_.turns(layout, v) ? Vec3(modes_.turn[core::at(v)] * rotation)
                                                    : Vec3(rotation.cross(modes_.arm[core::at(v)]));
                if (layout.kind[core::at(v)] == scene::VectorKind::position) move += translation;
                z.segment<3>(3 * v) += move;
            }
        }
    }
    /// What `add_chain` has made of a chain, 36 numbers a block, to be sent to others.
    std::span<double> chain_values(Index c) noexcept {
        std::vector<Block>& blocks = chains_[core::at(c)].blocks;
        return blocks.empty() ? std::span<double>() : std::span<double>(blocks.front().data(), 36 * blocks.size());
    }
    /// Makes room for what another has made of a chain.
    void expect_chain(const scene::DofLayout& layout, Index c) {
        Chain& own = chains_[core::at(c)];
        own.blocks.assign(core::at((own.intervals + 1) * (own.reach(layout.chains[core::at(c)].reach) + 1)), Block::Zero());
    }

private:
    using Block = CoarseModes::Block;
    using Hat = CoarseModes::Hat;
    using Modes = Eigen::Matrix<double, Eigen::Dynamic, 6>;

    struct Chain {
        int first_station = 0;
        Index intervals = 0, nodes = 1;
        bool reversed = false;
        std::vector<Block> blocks;  // between the stations k and k - d, at k (reach + 1) + d
        /// Stations that coupled nodes may lie apart.
        Index reach(Index nodes_apart) const noexcept {
            return intervals == 0 ? 0 : std::min(intervals, nodes_apart * intervals / (nodes - 1) + 2);
        }
    };
    static Hat hat(const Chain& chain, Index node) noexcept {
        if (chain.intervals == 0) return {chain.first_station, 0.0};
        const Index share = (chain.reversed ? chain.nodes - 1 - node : node) * chain.intervals;  // over nodes - 1
        const Index station = std::min(share / (chain.nodes - 1), chain.intervals - 1);
        return {chain.first_station + static_cast<int>(station),
                static_cast<double>(share - station * (chain.nodes - 1)) / static_cast<double>(chain.nodes - 1)};
    }

    template <class Body>
    void for_positions(const scene::DofLayout& layout, Index cluster, const Body& body) const {
        for (const Index c : clusters_[core::at(cluster)].chains) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            for (Index v = chain.first_vector; v < chain.first_vector + chain.nodes * chain.vectors_per_node; ++v) {
                if (layout.kind[core::at(v)] == scene::VectorKind::position) body(v);
            }
        }
    }

    static void add_to_chain(Chain& own, Index nodes_apart, const Hat& row, const Hat& column, const Block& block,
                             bool diagonal) {
        const Index width = own.reach(nodes_apart) + 1;
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) {
                const double weight = row.weight(i) * column.weight(j);
                if (weight == 0.0) continue;
                const Index k = row.station + i - own.first_station, l = column.station + j - own.first_station;
                if (k > l || (k == l && diagonal)) {
                    own.blocks[core::at(k * width + (k - l))] += weight * block;
                } else if (k == l) {
                    own.blocks[core::at(k * width)] += weight * (block + block.transpose());
                } else if (!diagonal) {
                    own.blocks[core::at(l * width + (l - k))] += weight * block.transpose();
                }
            }
    }

    template <class System>
    void find_pattern(const System& system) {
        const scene::DofLayout& layout = system.layout();
        if (modes_.arm.size() != layout.kind.size()) modes_.arm = layout.value;
        using Columns = std::vector<std::vector<int>>;  // of each row, left of the diagonal, rising
        const auto insert = [](Columns& columns, int i, int j) {
            if (i == j) return;
            std::vector<int>& row = columns[core::at(std::max(i, j))];
            const auto place = std::lower_bound(row.begin(), row.end(), std::min(i, j));
            if (place == row.end() || *place != std::min(i, j)) row.insert(place, std::min(i, j));
        };
        std::vector<Columns> lane(core::at(lanes(system)), Columns(core::at(stations_)));
        Columns& columns = lane[0];
        for (Index c = 0; c < core::count(chains_); ++c) {
            const Chain& own = chains_[core::at(c)];
            for (int k = 0; k <= static_cast<int>(own.intervals); ++k) {
                const int reach = static_cast<int>(own.reach(layout.chains[core::at(c)].reach));
                for (int d = 1; d <= std::min(k, reach); ++d) insert(columns, own.first_station + k, own.first_station + k - d);
            }
        }
        couple<false>(system, [&](Index l, int i, int j, const Block&) { insert(lane[core::at(l)], i, j); });
        for (std::size_t l = 1; l < lane.size(); ++l)
            for (int k = 0; k < stations_; ++k)
                for (const int column : lane[l][core::at(k)]) insert(columns, k, column);
        std::vector<Supernodes::Pair> pairs;
        for (int k = 0; k < stations_; ++k)
            for (const int column : columns[core::at(k)]) pairs.emplace_back(k, column);
        matrix_.analyse(std::vector<int>(core::at(stations_), 6), pairs);
    }

    /// Parts that the couplings are taken in at once, each with a sum of its own: their number depends on the system alone, and
    /// so do the bits.
    template <class System>
    static Index lanes(const System& system) {
        if constexpr (assembly::DivisibleCouplings<System>)
            return system.couplings() < 4096 ? 1 : 4;
        else
            return 1;
    }
    /// Calls body(lane, station i, station j, block) for each coupling beyond the bands, from several threads for different
    /// lanes.
    template <bool Values, class System, class Body>
    void couple(const System& system, const Body& body) const {
        const assembly::HeldProjector held(system.layout());
        const Index all = lanes(system);
        core::parallel_for(all, [&](Index lane) {
            const auto add = [&](int i, int j, const Block& block) { body(lane, i, j, block); };
            CoarseCouplings<Values, decltype(add)> visitor(modes_, system.layout(), held, add);
            if constexpr (assembly::DivisibleCouplings<System>) {
                const Index count = system.couplings();
                system.visit_couplings(visitor, count * lane / all, count * (lane + 1) / all);
            } else {
                assembly::visit_couplings(system, visitor);
            }
            if (lane == 0) couple_ties<Values>(modes_, system.layout(), held, add);
        });
    }

    /// Sums the matrix; false if the pattern lacks a block.
    template <class System>
    bool sum(const System& system) {
        const Index all = lanes(system);
        std::vector<char> complete(core::at(all), 1);
        matrix_.clear(all);
        core::parallel_for(all, [&](Index lane) {
            const Index count = core::count(chains_);
            for (Index c = count * lane / all; c < count * (lane + 1) / all; ++c) {
                const Chain& own = chains_[core::at(c)];
                const Index width = own.reach(system.layout().chains[core::at(c)].reach) + 1;
                for (Index k = 0; k <= own.intervals; ++k)
                    for (Index d = 0; d <= std::min(k, width - 1); ++d) {
                        const int row = own.first_station + static_cast<int>(k);
                        if (!matrix_.add(row, row - static_cast<int>(d), own.blocks[core::at(k * width + d)], lane))
                            complete[core::at(lane)] = 0;
                    }
            }
        });
        couple<true>(system, [&](Index lane, int i, int j, const Block& block) {
            if (!matrix_.add(i, j, i == j ? Block(block + block.transpose()) : block, lane)) complete[core::at(lane)] = 0;
        });
        matrix_.join_lanes();
        return std::ranges::find(complete, 0) == complete.end();
    }

    /// station values = P^T r
    void restrict_to_stations(const scene::DofLayout& layout, const Vector& r) {
        station_values_.setZero(6 * stations_);
        core::parallel_for(
            clusters(),
            [&](Index cluster) {
                for (const Index c : clusters_[core::at(cluster)].chains)
                    restrict_nodes(layout, r, c, 0, layout.chains[core::at(c)].nodes,
                                   [&](int station, const Motion& sum) { station_values_.segment<6>(6 * station) += sum; });
            },
            grain(layout, clusters()));
    }

    /// z += P times the station values
    void prolong(const scene::DofLayout& layout, Vector& z) const {
        core::parallel_for(
            core::count(layout.chains),
            [&](Index c) { prolong_to_nodes(layout, station_values_, c, 0, layout.chains[core::at(c)].nodes, z); },
            grain(layout, core::count(layout.chains)));
    }

    std::vector<ChainCluster> clusters_;
    std::vector<Chain> chains_;
    CoarseModes modes_;
    int stations_ = 0;
    BlockCholesky<Real> matrix_;
    Vector station_values_;  // forces and moments, then motions
};

}  // namespace fibrant::solver
