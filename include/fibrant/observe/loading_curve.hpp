// SPDX-License-Identifier: MIT
#pragma once
/// @file One quantity as a function of the loading's progress.

#include <fibrant/observe/observer.hpp>

#include <concepts>
#include <type_traits>
#include <utility>
#include <vector>

namespace fibrant::observe {

/// Sum of the normal reactions of all contact elements [force].
struct TotalReaction {
    double operator()(const Snapshot& snapshot) const noexcept {
        double sum = 0.0;
        for (const ContactSnapshot& contact : snapshot.contacts) sum += contact.reaction;
        return sum;
    }
};

/// Collects (progress, quantity(snapshot)) after each increment.
template <class Quantity = TotalReaction>
    requires std::is_invocable_r_v<double, const Quantity&, const Snapshot&>
class LoadingCurve {
public:
    struct Point {
        double progress = 0;  ///< of the whole loading, in [0, 1]
        double value = 0;
    };

    LoadingCurve() requires std::default_initializable<Quantity> : quantity_{} {}
    explicit LoadingCurve(Quantity quantity) : quantity_{std::move(quantity)} {}

    void accepted(const Snapshot& snapshot) { points_.push_back({snapshot.progress, quantity_(snapshot)}); }
    const std::vector<Point>& points() const noexcept { return points_; }

private:
    Quantity quantity_;
    std::vector<Point> points_;
};
static_assert(Observer<LoadingCurve<>>);

}  // namespace fibrant::observe
