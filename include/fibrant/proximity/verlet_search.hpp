// SPDX-License-Identifier: MIT
#pragma once
/// @file A list of pairs that serves several calls while the fibres move little.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/zones.hpp>

#include <limits>

namespace fibrant::proximity {

/// Keeps the pairs that `Base` finds at reach + skin and filters them at each call, until the vertices have moved so far
/// (twice the largest displacement, and the growth of inflations, above the skin) that a pair could be missing.
///
/// Same pairs and zones as `Base`, whatever it was asked before. Worth it where a step moves vertices by less than about a
/// tenth of the skin. Without a skin of its own it takes one from the motion between the last calls, so that a list lives some 15
/// calls, and asks `Base` alone where none would live 3.
template <ProximitySearch Base>
class VerletSearch {
public:
    struct Parameters {
        typename Base::Parameters base{};
        double skin = 0.0;  ///< [length], >= 0; 0: from the motion
        void validate() const { core::require_not_negative("VerletSearch.skin", skin); }
    };
    explicit VerletSearch(const Parameters& parameters)
        : adaptive_{core::validated(parameters).skin == 0.0}, skin_{parameters.skin}, base_{parameters.base} {}

    std::vector<SegmentPair> pairs(std::span<const Centreline> fibres, double reach) {
        const detail::SegmentTable table(fibres, reach);
        const double moved = moved_since(fibres);
        ++calls_;
        if (!listed_ || reach > reach_ || !(moved * (1.0 + 1.0e-9) < skin_ + reach_ - reach)) {
            if (adaptive_) skin_ = skin_for(moved, fibres);
            remember(fibres);
            listed_ = skin_ > 0.0;
            ++builds_;
            if (!listed_) return base_.pairs(fibres, reach);
            make_list(fibres, reach);
        }
        constexpr Index block = 8192;
        records_.resize(core::at(table.size()));
        const Index segments = table.size(), listed = core::count(list_);
        core::parallel_for((segments + block - 1) / block, [&](Index b) {
            for (Index k = b * block; k < std::min(segments, (b + 1) * block); ++k)
                records_[core::at(k)] = table.record(static_cast<std::int32_t>(k));
        });
        close_.resize(core::at((listed + block - 1) / block));
        core::parallel_for(core::count(close_), [&](Index b) {
            const auto first = list_.begin() + b * block, last = list_.begin() + std::min(listed, (b + 1) * block);
            std::vector<detail::Candidate> candidates;
            candidates.reserve(core::at(block));
            for (auto pair = first; pair != last; ++pair) candidates.push_back({pair->i, pair->j});
            close_[core::at(b)].clear();
            detail::keep_close(table, records_.data(), candidates, close_[core::at(b)]);
        });
        std::vector<SegmentPair> all;
        core::join(close_, all);
        return all;
    }

    std::vector<ProximityZone> find(std::span<const Centreline> fibres, double reach) {
        return zones_from_pairs(fibres, reach, pairs(fibres, reach));
    }

    Index builds() const noexcept { return builds_; }  ///< how often `Base` was asked

private:
    /// What of a fibre may not change while a list lives.
    struct Kept {
        double radius;
        Index family;
        bool selfish;
        std::size_t first, vertices;
    };

    /// By how much a pair may have come closer since `remember`; infinite if the fibres are others [length].
    double moved_since(std::span<const Centreline> fibres) const {
        constexpr double other = std::numeric_limits<double>::infinity();
        if (builds_ == 0 || fibres.size() != kept_.size()) return other;
        double moved = 0.0, grown = 0.0;
        for (std::size_t f = 0; f < fibres.size(); ++f) {
            const Kept& kept = kept_[f];
            const Centreline& line = fibres[f];
            if (line.radius != kept.radius || line.family != kept.family || std::isfinite(line.self_skip) != kept.selfish ||
                line.points.size() != kept.vertices)
                return other;
            for (std::size_t k = 0; k < kept.vertices; ++k)
                moved = std::max(moved, (line.points[k] - position_[kept.first + k]).squaredNorm());
            for (std::size_t k = 0; k < line.inflation.size(); ++k)
                grown = std::max(grown, line.inflation[k] - inflation_[kept.first + k]);
        }
        return 2.0 * (std::sqrt(moved) + grown);
    }

    /// Skin of the next list; 0 for none. Beyond 1.5 radii a list costs more than it saves.
    double skin_for(double moved, std::span<const Centreline> fibres) const {
        if (!std::isfinite(moved)) return 0.0;
        double radius = std::numeric_limits<double>::infinity();
        for (const Centreline& line : fibres) radius = std::min(radius, line.radius);
        const double a_call = moved / static_cast<double>(calls_);
        const double skin = a_call > 0.0 ? std::min(15.0 * a_call, 1.5 * radius) : 0.5 * radius;
        return skin < 3.0 * a_call ? 0.0 : skin;
    }

    void remember(std::span<const Centreline> fibres) {
        kept_.clear();
        position_.clear();
        inflation_.clear();
        calls_ = 0;
        for (const Centreline& line : fibres) {
            kept_.push_back({line.radius, line.family, std::isfinite(line.self_skip), position_.size(), line.points.size()});
            position_.insert(position_.end(), line.points.begin(), line.points.end());
            inflation_.insert(inflation_.end(), line.inflation.begin(), line.inflation.end());
            inflation_.resize(position_.size(), 0.0);
        }
    }

    void make_list(std::span<const Centreline> fibres, double reach) {
        std::vector<Centreline> listed(fibres.begin(), fibres.end());
        for (Centreline& line : listed)
            if (std::isfinite(line.self_skip))
                line.self_skip = 0.0;  // arcs stretch while the list lives: the filter applies the rule
        list_ = base_.pairs(listed, reach + skin_);
        reach_ = reach;
    }

    bool adaptive_;
    double skin_;
    Base base_;
    Index builds_ = 0, calls_ = 0;  // calls since `remember`
    bool listed_ = false;
    double reach_ = 0.0;
    std::vector<SegmentPair> list_;
    std::vector<Kept> kept_;
    std::vector<Vec3> position_;
    std::vector<double> inflation_;  // one a vertex, the last of a fibre unused
    std::vector<detail::SegmentRecord> records_;
    std::vector<std::vector<SegmentPair>> close_;
};

}  // namespace fibrant::proximity
