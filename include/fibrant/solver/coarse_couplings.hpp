// SPDX-License-Identifier: MIT
#pragma once
/// @file What the terms of a system couple in a coarse space of rigid motions, beyond the bands of its chains.

#include <fibrant/assembly/linear_system.hpp>
#include <fibrant/core/parallel.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace fibrant::solver {

/// The rows of P, vector by vector: how a vector moves with the stations that its node stands between.
struct CoarseModes {
    using Block = Eigen::Matrix<double, 6, 6>;
    using Mode = Eigen::Matrix<double, 3, 6>;

    /// Two stations of the cluster and the share of each in a node's motion; the second may lie beyond the last if its share is
    /// 0.
    struct Hat {
        int station = 0;
        double second = 0.0;
        double weight(int k) const noexcept { return k == 0 ? 1.0 - second : second; }
    };
    struct Place {
        int chain = 0, node = 0;
        Hat hat;  // station counted over all clusters
    };

    /// The columns of a rotation: what it does to the end of a lever.
    static void add_rotation(const Vec3& lever, Mode& rows) {
        rows(0, 4) += lever.z(), rows(0, 5) -= lever.y();
        rows(1, 3) -= lever.z(), rows(1, 5) += lever.x();
        rows(2, 3) += lever.y(), rows(2, 4) -= lever.x();
    }
    /// Rows of F P of one vector for a station of weight 1.
    Mode mode(const scene::DofLayout& layout, const assembly::HeldProjector& held, Index v) const {
        Mode rows = Mode::Zero();
        if (turns(layout, v))
            rows.rightCols<3>() = turn[core::at(v)];
        else
            add_rotation(arm[core::at(v)], rows);
        if (layout.kind[core::at(v)] == scene::VectorKind::position) rows.leftCols<3>().setIdentity();
        if (const Mat3* free = held.free(v)) rows = (*free * rows).eval();
        return rows;
    }

    /// v is a rotation vector: a spin changes it by turn, whatever its arm.
    bool turns(const scene::DofLayout& layout, Index v) const {
        return !turn.empty() && layout.kind[core::at(v)] == scene::VectorKind::rotation;
    }

    std::vector<Place> places;  ///< of each vector
    std::vector<Vec3> arm;      ///< of each vector: a direction, or a position from the middle of its cluster
    std::vector<Mat3> turn;     ///< of each rotation vector by a spin; none where no chain has any
};

/// Takes the terms of a system and calls body(station i, station j, block) for each coupling beyond the bands; both orders are
/// meant. With `Values` false the blocks are not computed.
///
/// A term is taken apart into parts that lie within the reach of one chain; what couples a part with itself is in the band.
template <bool Values, class Body>
class CoarseCouplings {
    using Block = CoarseModes::Block;
    using Mode = CoarseModes::Mode;
    using Place = CoarseModes::Place;

public:
    CoarseCouplings(const CoarseModes& modes, const scene::DofLayout& layout, const assembly::HeldProjector& held,
                    const Body& body)
        : modes_{&modes}, layout_{&layout}, held_{&held}, body_{&body} {}

    void point(const assembly::PointTerm& term) {
        if constexpr (!Values) {  // the contacts of two elements couple the same stations
            if (std::equal(last_.begin(), last_.end(), term.vectors.begin(), term.vectors.end())) return;
            last_.assign(term.vectors.begin(), term.vectors.end());
        }
        used_ = 0;
        for (std::size_t k = 0; k < term.vectors.size(); ++k) {
            const Place& place = modes_->places[core::at(term.vectors[k])];
            take(term.vectors[k], term.weights[k], layout_->chains[core::at(place.chain)].reach);
        }
        if (overlap()) {  // some pairs of nodes of two parts are in a band, others not
            used_ = 0;
            for (std::size_t k = 0; k < term.vectors.size(); ++k) take(term.vectors[k], term.weights[k], 0);
        }
        for (std::size_t q = 0; q < used_; ++q) {
            if constexpr (Values) parts_[q].gather();
            for (std::size_t p = 0; p < q; ++p) {
                if (!in_band(parts_[p], parts_[q])) emit(parts_[p], parts_[q], term.stiffness);
            }
        }
    }
    void dense(const assembly::DenseTerm& term) {
        const Place& first = modes_->places[core::at(term.vectors.front())];
        int low = first.node, high = first.node;
        bool one = true;
        for (const Index v : term.vectors) {
            const Place& place = modes_->places[core::at(v)];
            one = one && place.chain == first.chain;
            low = std::min(low, place.node), high = std::max(high, place.node);
        }
        if (one && high - low <= layout_->chains[core::at(first.chain)].reach) return;
        for (std::size_t i = 0; i < term.vectors.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                used_ = 0;
                take(term.vectors[i], 1.0, -1), take(term.vectors[j], 1.0, -1);
                if (in_band(parts_[0], parts_[1])) continue;
                parts_[0].gather(), parts_[1].gather();
                emit(parts_[0], parts_[1], term.stiffness.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j)));
            }
    }

private:
    struct StationShare {
        int station = 0;
        double translation = 0.0;  // sum of w and of w arm over vectors that are free,
        Vec3 arm = Vec3::Zero();
        Mode rows = Mode::Zero();  // and of w times the rows of those that are held
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
                stations[k].rows.template leftCols<3>().diagonal().array() += stations[k].translation;
                CoarseModes::add_rotation(stations[k].arm, stations[k].rows);
            }
        }
    };

    void take(Index v, double weight, Index window) {
        const Place& place = modes_->places[core::at(v)];
        std::size_t p = 0;
        for (; p < used_; ++p) {
            const Part& part = parts_[p];
            if (part.chain == place.chain && std::max(part.high, place.node) - std::min(part.low, place.node) <= window) break;
        }
        if (p == used_) {
            if (++used_ > parts_.size()) parts_.emplace_back();
            parts_[p].chain = place.chain, parts_[p].low = parts_[p].high = place.node;
            parts_[p].used = 0;
        }
        Part& part = parts_[p];
        part.low = std::min(part.low, place.node), part.high = std::max(part.high, place.node);
        const bool free = held_->free(v) == nullptr && !modes_->turns(*layout_, v),
                   position = layout_->kind[core::at(v)] == scene::VectorKind::position;
        for (int i = 0; i < 2; ++i) {
            const double share = weight * place.hat.weight(i);
            if (place.hat.weight(i) == 0.0) continue;
            StationShare& station = part.at(place.hat.station + i);
            if (!free) {
                station.rows += share * modes_->mode(*layout_, *held_, v);
                continue;
            }
            if (position) station.translation += share;
            station.arm += share * modes_->arm[core::at(v)];
        }
    }
    bool in_band(const Part& a, const Part& b) const {
        return a.chain == b.chain &&
               std::max(a.low, b.low) - std::min(a.high, b.high) <= layout_->chains[core::at(a.chain)].reach;
    }
    bool overlap() const {
        for (std::size_t p = 0; p < used_; ++p)
            for (std::size_t q = p + 1; q < used_; ++q) {
                if (in_band(parts_[p], parts_[q])) return true;
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
                (*body_)(row.station, column.station, block);
            }
        }
    }

    const CoarseModes* modes_;
    const scene::DofLayout* layout_;
    const assembly::HeldProjector* held_;
    const Body* body_;
    std::vector<Part> parts_;
    std::size_t used_ = 0;
    std::vector<Index> last_;
};

}  // namespace fibrant::solver
