// SPDX-License-Identifier: MIT
#pragma once
/// @file Springs on those fibres whose steps hold all others back, while they do.

#include <fibrant/core/parallel.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace fibrant::solver {

namespace newton_numbers {
// Springs to where a step begins, on fibres that made it be cut to less than `cut_hard` (Levenberg 1944, Marquardt 1963): as
// stiff as their part of the step was along itself, and as many times stiffer as it was cut, at most `stiffest`. They grow while
// such fibres make steps be cut, and go once they do not. By trial.
inline constexpr double cut_hard = 0.25, stiffest = 100.0, harder = 4.0, softer = 0.25, as_none = 0.1;
}  // namespace newton_numbers

/// What hardly anything holds goes far in a step of Newton's method, and meets others on its way: a step that is cut for it is
/// cut for all. The fewest fibres without which it would not have been cut are held by springs in the next one.
class HeldSteps {
public:
    void clear() noexcept { springs_.clear(), softest_.clear(); }
    bool any() const noexcept { return !springs_.empty(); }
    /// On the places of each chain [force / length]; empty: on none.
    std::span<const double> springs() const noexcept { return springs_; }

    /// To be called with the residual where a step begins.
    void begin(const scene::DofLayout& layout, const Vector& residual, const Vector& step) {
        slopes_.resize(layout.chains.size());
        core::parallel_for(core::count(slopes_), [&](Index f) {
            Slopes& one = slopes_[core::at(f)] = {};
            scene::for_own_vectors(layout, f, [&](Index v, double length) {
                one.start += residual.segment<3>(3 * v).dot(step.segment<3>(3 * v));
                one.square += length * length * step.segment<3>(3 * v).squaredNorm();
            });
        });
    }
    /// To be called with the residual at the end of that step, before it is cut.
    void arrive(const scene::DofLayout& layout, const Vector& residual, const Vector& step) {
        core::parallel_for(core::count(slopes_), [&](Index f) {
            double& end = slopes_[core::at(f)].end = 0.0;
            scene::for_own_vectors(layout, f,
                                   [&](Index v, double) { end += residual.segment<3>(3 * v).dot(step.segment<3>(3 * v)); });
        });
    }
    /// @param part       of the step that is left
    /// @param overshoot  slope of the energy at the end over that at the start, beyond which a step is cut [1]
    void learn(double part, double overshoot) {
        namespace with = newton_numbers;
        std::vector<Index> held;
        if (part < with::cut_hard) held = hold_back(overshoot);
        if (held.empty() && !any()) return;
        springs_.resize(slopes_.size(), 0.0), softest_.resize(slopes_.size(), 0.0);
        std::vector<double> before = springs_;
        for (Index f = 0; f < core::count(slopes_); ++f)
            if (part == 1.0 || slopes_[core::at(f)].end <= 0.0) soften(f);
        double along = 0.0, square = 0.0;
        for (const Slopes& one : slopes_) along -= one.start, square += one.square;
        for (const Index f : held) {
            const Slopes& one = slopes_[core::at(f)];
            const double own = one.start < 0.0 && one.square > 0.0 ? -one.start / one.square : along / square;
            double &spring = springs_[core::at(f)], &softest = softest_[core::at(f)];
            softest = softest > 0.0 ? std::min(softest, own) : own;
            spring = std::max(with::harder * before[core::at(f)], std::min(1.0 / part - 1.0, with::stiffest) * own);
        }
        if (std::all_of(springs_.begin(), springs_.end(), [](double one) { return one == 0.0; })) clear();
    }

private:
    /// Of a chain's part of a step: slopes of the energy along it [force * length], and its square [length^2].
    struct Slopes {
        double start = 0.0, end = 0.0, square = 0.0;
    };
    std::vector<Index> hold_back(double overshoot) const {
        std::vector<Index> held;
        double start = 0.0, end = 0.0;
        for (Index f = 0; f < core::count(slopes_); ++f) {
            start += slopes_[core::at(f)].start, end += slopes_[core::at(f)].end;
            if (slopes_[core::at(f)].end > 0.0) held.push_back(f);
        }
        std::stable_sort(held.begin(), held.end(),
                         [&](Index a, Index b) { return slopes_[core::at(a)].end > slopes_[core::at(b)].end; });
        std::size_t fewest = 0;
        for (; fewest < held.size() && end > -overshoot * start; ++fewest) end -= slopes_[core::at(held[fewest])].end;
        held.resize(fewest);
        return held;
    }
    void soften(Index f) {
        namespace with = newton_numbers;
        double& spring = springs_[core::at(f)];
        spring = with::softer * spring > with::as_none * softest_[core::at(f)] ? with::softer * spring : 0.0;
    }

    std::vector<double> springs_, softest_;  // softest: that a chain was along its steps [force / length]
    std::vector<Slopes> slopes_;
};

}  // namespace fibrant::solver
