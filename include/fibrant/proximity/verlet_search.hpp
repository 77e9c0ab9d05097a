// SPDX-License-Identifier: MIT
#pragma once
/// @file A list of pairs that serves several calls while the fibres move little.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/zones.hpp>

namespace fibrant::proximity {

/// Keeps the pairs that `Base` finds at reach + skin and filters them at each call, until the vertices have moved so far
/// (twice the largest displacement, and the growth of inflations, above the skin) that a pair could be missing.
///
/// Same pairs and zones as `Base`, whatever it was asked before. Worth it where a step moves vertices by less than about a
/// tenth of the skin.
template <ProximitySearch Base>
class VerletSearch {
public:
    struct Parameters {
        typename Base::Parameters base{};
        double skin = core::unset;  ///< [length], > 0: about the radius
        void validate() const { core::require_positive("VerletSearch.skin", skin); }
    };
    explicit VerletSearch(const Parameters& parameters)
        : skin_{core::validated(parameters).skin}, base_{parameters.base} {}

    std::vector<SegmentPair> pairs(std::span<const Centreline> fibres, double reach) {
        const detail::SegmentTable table(fibres, reach);
        if (!serves(fibres, reach)) rebuild(fibres, reach);
        const std::vector<detail::SegmentRecord> records = table.records();
        constexpr Index block = 8192;
        const Index listed = core::count(list_);
        std::vector<std::vector<SegmentPair>> close(core::at((listed + block - 1) / block));
        core::parallel_for(core::count(close), [&](Index b) {
            std::vector<detail::Candidate> candidates;
            for (Index k = b * block; k < std::min(listed, (b + 1) * block); ++k)
                candidates.push_back({list_[core::at(k)].i, list_[core::at(k)].j});
            detail::keep_close(table, records.data(), candidates, close[core::at(b)]);
        });
        std::vector<SegmentPair> all;
        for (const auto& some : close) all.insert(all.end(), some.begin(), some.end());
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

    bool serves(std::span<const Centreline> fibres, double reach) const {
        if (builds_ == 0 || fibres.size() != kept_.size() || reach > reach_) return false;
        double moved = 0.0, grown = 0.0;
        for (std::size_t f = 0; f < fibres.size(); ++f) {
            const Kept& kept = kept_[f];
            const Centreline& line = fibres[f];
            if (line.radius != kept.radius || line.family != kept.family || std::isfinite(line.self_skip) != kept.selfish ||
                line.points.size() != kept.vertices)
                return false;
            for (std::size_t k = 0; k < kept.vertices; ++k)
                moved = std::max(moved, (line.points[k] - position_[kept.first + k]).squaredNorm());
            for (std::size_t k = 0; k < line.inflation.size(); ++k)
                grown = std::max(grown, line.inflation[k] - inflation_[kept.first + k]);
        }
        return 2.0 * (std::sqrt(moved) + grown) * (1.0 + 1.0e-9) < skin_ + reach_ - reach;
    }

    void rebuild(std::span<const Centreline> fibres, double reach) {
        std::vector<Centreline> listed(fibres.begin(), fibres.end());
        kept_.clear();
        position_.clear();
        inflation_.clear();
        for (Centreline& line : listed) {
            const bool selfish = std::isfinite(line.self_skip);
            kept_.push_back({line.radius, line.family, selfish, position_.size(), line.points.size()});
            if (selfish) line.self_skip = 0.0;  // arcs stretch while the list lives: the filter applies the rule
            position_.insert(position_.end(), line.points.begin(), line.points.end());
            inflation_.insert(inflation_.end(), line.inflation.begin(), line.inflation.end());
            inflation_.resize(position_.size(), 0.0);
        }
        list_ = base_.pairs(listed, reach + skin_);
        reach_ = reach;
        ++builds_;
    }

    double skin_;
    Base base_;
    Index builds_ = 0;
    double reach_ = 0.0;
    std::vector<SegmentPair> list_;
    std::vector<Kept> kept_;
    std::vector<Vec3> position_;
    std::vector<double> inflation_;  // one a vertex, the last of a fibre unused
};

}  // namespace fibrant::proximity
