// SPDX-License-Identifier: MIT
#pragma once
/// @file Coarse space of clusters of chains: rigid motions of their cross-sections, linear between stations along them.

#include <fibrant/core/rotation.hpp>
#include <fibrant/solver/block_cholesky.hpp>
#include <fibrant/solver/chain_clusters.hpp>
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
/// what the terms couple beyond them; A itself is never formed.
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
        places_.resize(layout.kind.size());
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            for (Index k = 0; k < chain.nodes * chain.vectors_per_node; ++k) {
                const Index node = k / chain.vectors_per_node;
                places_[core::at(chain.first_vector + k)] = {static_cast<int>(c), static_cast<int>(node), hat(chains_[core::at(c)], node)};
            }
        }
        find_pattern(system);
    }

    Index clusters() const noexcept { return core::count(clusters_); }
    Index stations() const noexcept { return stations_; }
    const BlockCholesky<double>& matrix() const noexcept { return matrix_; }

    /// To be called before the chains are added: takes over the values of the layout.
    void begin(const scene::DofLayout& layout) {
        arm_ = layout.value;
        turn_.clear();
        if (std::ranges::find(layout.kind, scene::VectorKind::rotation) != layout.kind.end()) {
            turn_.resize(layout.kind.size());
            for (std::size_t v = 0; v < turn_.size(); ++v)
                if (layout.kind[v] == scene::VectorKind::rotation) turn_[v] = core::spin_matrix(layout.value[v]).inverse();
        }
        core::parallel_for(clusters(), [&](Index k) {
            Vec3 sum = Vec3::Zero();
            Index positions = 0;
            for_positions(layout, k, [&](Index v) { sum += layout.value[core::at(v)], ++positions; });
            const Vec3 middle = sum / static_cast<double>(std::max<Index>(positions, 1));
            for_positions(layout, k, [&](Index v) { arm_[core::at(v)] -= middle; });
        }, grain(layout, clusters()));
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
                modes[core::at(a)].middleRows<3>(3 * v) = mode(layout, held, chain.first_vector + a * chain.vectors_per_node + v);
            }
        }
        Modes product(m, 6);
        for (Index a = 0; a < chain.nodes; ++a) {
            for (Index d = 0; d <= std::min(a, chain.reach); ++d) {
                // I - F, which the band has on held vectors, gives nothing with F times the modes.
                product.noalias() = band.block(a * m, d * m, m, m) * modes[core::at(a - d)];
                const Block block = modes[core::at(a)].transpose() * product;
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
        const BlockCholesky<double>::Pivots pivots = matrix_.factor();
        if (!pivots.finite) return SolveStatus::not_finite;
        return pivots.negative > 0 ? SolveStatus::indefinite : SolveStatus::converged;
    }

    /// z += P (P^T A P)^-1 P^T r
    ///
    /// @param r, z  zero and not used outside the free directions of held vectors
    void add_correction(const scene::DofLayout& layout, const Vector& r, Vector& z) {
        restrict_to_stations(layout, r);
        matrix_.solve(station_values_);
        prolong(layout, z);
    }

private:
    using Block = Eigen::Matrix<double, 6, 6>;
    using Mode = Eigen::Matrix<double, 3, 6>;
    using Modes = Eigen::Matrix<double, Eigen::Dynamic, 6>;
    using Motion = Eigen::Matrix<double, 6, 1>;

    /// Two stations of the cluster and the share of each in a node's motion; the second may lie beyond the last if its share is 0.
    struct Hat {
        int station = 0;
        double second = 0.0;
        double weight(int k) const noexcept { return k == 0 ? 1.0 - second : second; }
    };
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
    struct Place {
        int chain = 0, node = 0;
        Hat hat;  // station counted over all clusters
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

    /// The columns of a rotation: what it does to `arm`.
    static void add_rotation(const Vec3& arm, Mode& rows) {
        rows(0, 4) += arm.z(), rows(0, 5) -= arm.y();
        rows(1, 3) -= arm.z(), rows(1, 5) += arm.x();
        rows(2, 3) += arm.y(), rows(2, 4) -= arm.x();
    }
    /// Rows of F P of one vector for a station of weight 1.
    Mode mode(const scene::DofLayout& layout, const assembly::HeldProjector& held, Index v) const {
        Mode rows = Mode::Zero();
        if (turns(layout, v)) rows.rightCols<3>() = turn_[core::at(v)];
        else add_rotation(arm_[core::at(v)], rows);
        if (layout.kind[core::at(v)] == scene::VectorKind::position) rows.leftCols<3>().setIdentity();
        if (const Mat3* free = held.free(v)) rows = (*free * rows).eval();
        return rows;
    }

    /// v is a rotation vector: a spin changes it by turn_, whatever its arm.
    bool turns(const scene::DofLayout& layout, Index v) const { return !turn_.empty() && layout.kind[core::at(v)] == scene::VectorKind::rotation; }

    static void add_to_chain(Chain& own, Index nodes_apart, const Hat& row, const Hat& column, const Block& block, bool diagonal) {
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

    // What the terms couple beyond the bands. A term is taken apart into parts that lie within the reach of one chain;
    // what couples a part with itself is in the band.
    struct StationShare {
        int station = 0;
        double translation = 0.0;       // sum of w and of w arm over vectors that are free,
        Vec3 arm = Vec3::Zero();
        Mode rows = Mode::Zero();       // and of w times the rows of those that are held
    };
    struct Part {
        int chain = 0, low = 0, high = 0;
        std::size_t used = 0;
        std::vector<StationShare> stations;
        std::span<const StationShare> shares() const { return {stations.data(), used}; }
        StationShare& at(int station) {
            for (std::size_t k = 0; k < used; ++k) {
                if (stations[k].station == station) return stations[k];
            }
            if (++used > stations.size()) stations.emplace_back();
            stations[used - 1] = {};
            stations[used - 1].station = station;
            return stations[used - 1];
        }
        /// Completes the rows.
        void gather() {
            for (std::size_t k = 0; k < used; ++k) {
                stations[k].rows.leftCols<3>().diagonal().array() += stations[k].translation;
                add_rotation(stations[k].arm, stations[k].rows);
            }
        }
    };

    /// Calls body(station i, station j, block) for each coupling beyond the bands; both orders are meant. With `Values` false the
    /// blocks are not computed.
    template <bool Values, class System, class Body>
    void couple(const System& system, const Body& body) const {
        struct Visitor {
            const RigidCoarseSpace& space;
            const scene::DofLayout& layout;
            const assembly::HeldProjector& held;
            const Body& body;
            std::vector<Part> parts;
            std::size_t used;
            std::vector<Index> last{};

            void take(Index v, double weight, Index window) {
                const Place& place = space.places_[core::at(v)];
                std::size_t p = 0;
                for (; p < used; ++p) {
                    const Part& part = parts[p];
                    if (part.chain == place.chain && std::max(part.high, place.node) - std::min(part.low, place.node) <= window) break;
                }
                if (p == used) {
                    if (++used > parts.size()) parts.emplace_back();
                    parts[p].chain = place.chain, parts[p].low = parts[p].high = place.node;
                    parts[p].used = 0;
                }
                Part& part = parts[p];
                part.low = std::min(part.low, place.node), part.high = std::max(part.high, place.node);
                const bool free = held.free(v) == nullptr && !space.turns(layout, v), position = layout.kind[core::at(v)] == scene::VectorKind::position;
                for (int i = 0; i < 2; ++i) {
                    const double share = weight * place.hat.weight(i);
                    if (place.hat.weight(i) == 0.0) continue;
                    StationShare& station = part.at(place.hat.station + i);
                    if (!free) {
                        station.rows += share * space.mode(layout, held, v);
                        continue;
                    }
                    if (position) station.translation += share;
                    station.arm += share * space.arm_[core::at(v)];
                }
            }
            bool in_band(const Part& a, const Part& b) const {
                return a.chain == b.chain && std::max(a.low, b.low) - std::min(a.high, b.high) <= layout.chains[core::at(a.chain)].reach;
            }
            bool overlap() const {
                for (std::size_t p = 0; p < used; ++p)
                    for (std::size_t q = p + 1; q < used; ++q) {
                        if (in_band(parts[p], parts[q])) return true;
                    }
                return false;
            }
            void emit(const Part& a, const Part& b, const Mat3& stiffness) const {
                for (const StationShare& column : b.shares()) {
                    Mode product = Mode::Zero();
                    if constexpr (Values) product = stiffness * column.rows;
                    for (const StationShare& row : a.shares()) {
                        Block block = Block::Zero();
                        if constexpr (Values) block = row.rows.transpose() * product;
                        body(row.station, column.station, block);
                    }
                }
            }
            void point(const assembly::PointTerm& term) {
                if constexpr (!Values) {  // the contacts of two elements couple the same stations
                    if (std::equal(last.begin(), last.end(), term.vectors.begin(), term.vectors.end())) return;
                    last.assign(term.vectors.begin(), term.vectors.end());
                }
                used = 0;
                for (std::size_t k = 0; k < term.vectors.size(); ++k) {
                    const Place& place = space.places_[core::at(term.vectors[k])];
                    take(term.vectors[k], term.weights[k], layout.chains[core::at(place.chain)].reach);
                }
                if (overlap()) {  // some pairs of nodes of two parts are in a band, others not
                    used = 0;
                    for (std::size_t k = 0; k < term.vectors.size(); ++k) take(term.vectors[k], term.weights[k], 0);
                }
                for (std::size_t q = 0; q < used; ++q) {
                    if constexpr (Values) parts[q].gather();
                    for (std::size_t p = 0; p < q; ++p) {
                        if (!in_band(parts[p], parts[q])) emit(parts[p], parts[q], term.stiffness);
                    }
                }
            }
            void dense(const assembly::DenseTerm& term) {
                const Place& first = space.places_[core::at(term.vectors.front())];
                int low = first.node, high = first.node;
                bool one = true;
                for (const Index v : term.vectors) {
                    const Place& place = space.places_[core::at(v)];
                    one = one && place.chain == first.chain;
                    low = std::min(low, place.node), high = std::max(high, place.node);
                }
                if (one && high - low <= layout.chains[core::at(first.chain)].reach) return;
                for (std::size_t i = 0; i < term.vectors.size(); ++i)
                    for (std::size_t j = 0; j < i; ++j) {
                        used = 0;
                        take(term.vectors[i], 1.0, -1), take(term.vectors[j], 1.0, -1);
                        if (in_band(parts[0], parts[1])) continue;
                        parts[0].gather(), parts[1].gather();
                        emit(parts[0], parts[1], term.stiffness.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j)));
                    }
            }
        };
        const assembly::HeldProjector held(system.layout());
        Visitor visitor{*this, system.layout(), held, body, {}, 0};
        assembly::visit_couplings(system, visitor);
    }

    template <class System>
    void find_pattern(const System& system) {
        const scene::DofLayout& layout = system.layout();
        if (arm_.size() != layout.kind.size()) arm_ = layout.value;
        std::vector<std::vector<int>> columns(core::at(stations_));  // of each row, left of the diagonal, rising
        const auto insert = [&](int i, int j, const Block&) {
            if (i == j) return;
            std::vector<int>& row = columns[core::at(std::max(i, j))];
            const auto place = std::lower_bound(row.begin(), row.end(), std::min(i, j));
            if (place == row.end() || *place != std::min(i, j)) row.insert(place, std::min(i, j));
        };
        for (Index c = 0; c < core::count(chains_); ++c) {
            const Chain& own = chains_[core::at(c)];
            for (int k = 0; k <= static_cast<int>(own.intervals); ++k) {
                const int reach = static_cast<int>(own.reach(layout.chains[core::at(c)].reach));
                for (int d = 1; d <= std::min(k, reach); ++d) insert(own.first_station + k, own.first_station + k - d, Block::Zero());
            }
        }
        couple<false>(system, insert);
        std::vector<Supernodes::Pair> pairs;
        for (int k = 0; k < stations_; ++k)
            for (const int column : columns[core::at(k)]) pairs.emplace_back(k, column);
        matrix_.analyse(std::vector<int>(core::at(stations_), 6), pairs);
    }

    /// Sums the matrix; false if the pattern lacks a block.
    template <class System>
    bool sum(const System& system) {
        bool complete = true;
        matrix_.clear();
        for (Index c = 0; c < core::count(chains_); ++c) {
            const Chain& own = chains_[core::at(c)];
            const Index width = own.reach(system.layout().chains[core::at(c)].reach) + 1;
            for (Index k = 0; k <= own.intervals; ++k)
                for (Index d = 0; d <= std::min(k, width - 1); ++d) {
                    const int row = own.first_station + static_cast<int>(k);
                    complete = matrix_.add(row, row - static_cast<int>(d), own.blocks[core::at(k * width + d)]) && complete;
                }
        }
        couple<true>(system, [&](int i, int j, const Block& block) {
            complete = matrix_.add(i, j, i == j ? Block(block + block.transpose()) : block) && complete;
        });
        return complete;
    }

    /// station values = P^T r
    void restrict_to_stations(const scene::DofLayout& layout, const Vector& r) {
        station_values_.setZero(6 * stations_);
        core::parallel_for(clusters(), [&](Index cluster) {
            for (const Index c : clusters_[core::at(cluster)].chains) {
                const scene::Chain& chain = layout.chains[core::at(c)];
                Motion near = Motion::Zero(), far = Motion::Zero();  // of the two stations that nodes are between
                int station = places_[core::at(chain.first_vector)].hat.station;
                const auto store = [&] {
                    station_values_.segment<6>(6 * station) += near;
                    if (!far.isZero(0.0)) station_values_.segment<6>(6 * station + 6) += far;
                };
                for (Index a = 0; a < chain.nodes; ++a) {
                    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
                    const Index first = chain.first_vector + a * chain.vectors_per_node;
                    for (Index v = first; v < first + chain.vectors_per_node; ++v) {
                        const Vec3 f = r.segment<3>(3 * v);
                        if (layout.kind[core::at(v)] == scene::VectorKind::position) force += f;
                        if (turns(layout, v)) moment += turn_[core::at(v)].transpose() * f;
                        else moment += arm_[core::at(v)].cross(f);
                    }
                    const Hat& hat = places_[core::at(first)].hat;
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
        }, grain(layout, clusters()));
    }

    /// z += P times the station values
    void prolong(const scene::DofLayout& layout, Vector& z) const {
        core::parallel_for(core::count(layout.chains), [&](Index c) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            for (Index a = 0; a < chain.nodes; ++a) {
                const Index first = chain.first_vector + a * chain.vectors_per_node;
                const Hat& hat = places_[core::at(first)].hat;
                Motion motion = hat.weight(0) * station_values_.segment<6>(6 * hat.station);
                if (hat.second > 0.0) motion += hat.second * station_values_.segment<6>(6 * hat.station + 6);
                const Vec3 translation = motion.head<3>(), rotation = motion.tail<3>();
                for (Index v = first; v < first + chain.vectors_per_node; ++v) {
                    Vec3 move = turns(layout, v) ? Vec3(turn_[core::at(v)] * rotation) : Vec3(rotation.cross(arm_[core::at(v)]));
                    if (layout.kind[core::at(v)] == scene::VectorKind::position) move += translation;
                    z.segment<3>(3 * v) += move;
                }
            }
        }, grain(layout, core::count(layout.chains)));
    }

    std::vector<ChainCluster> clusters_;
    std::vector<Chain> chains_;
    std::vector<Place> places_;  // of each vector
    std::vector<Vec3> arm_;      // of each vector: a direction, or a position from the middle of its cluster
    std::vector<Mat3> turn_;     // of each rotation vector by a spin; none where no chain has any
    int stations_ = 0;
    BlockCholesky<double> matrix_;
    Vector station_values_;  // forces and moments, then motions
};

}  // namespace fibrant::solver
