// SPDX-License-Identifier: MIT
#pragma once
/// @file A force of one's own: fibres lie in a soft bed, each particle tied to where it was at rest (Winkler's foundation).

#include <fibrant/term/term.hpp>

#include <vector>

/// k times the displacement, a length. An internal force with a potential; its stiffness lies within elements.
class SoftBed : public fibrant::term::NoDrive,
                public fibrant::term::NoSearch,
                public fibrant::term::NoSpring,
                public fibrant::term::NoCouplings,
                public fibrant::term::NoMemory,
                public fibrant::term::NoPicture {
public:
    static constexpr auto role = fibrant::term::Role::structure;
    struct Parameters {
        double stiffness = fibrant::core::unset;  ///< k [force / length^2], >= 0
        void validate() const { fibrant::core::require_not_negative("SoftBed.stiffness", stiffness); }
    };
    struct Slot {
        Parameters bed{};  // parameters.acts.bed.stiffness
    };

    SoftBed(const fibrant::term::Site& site, const Parameters& parameters)
        : stiffness_{fibrant::core::validated(parameters).stiffness} {
        for (fibrant::Index f = 0; f < fibrant::core::count(site.fibres()); ++f)
            site.each_point(f, 0.0, 1.0, [&](const fibrant::term::CentrePoint& at, double length) {
                points_.push_back({at, length, at.place(site.rest_state())});
            });
    }
    void add_forces(const fibrant::Vector& state, fibrant::Vector& sum) const {
        for (const Point& one : points_) one.at.push(stiffness_ * one.length * (one.at.place(state) - one.rest), sum);
    }
    void add_bands(const fibrant::Vector&, fibrant::term::Bands& bands) const {
        for (const Point& one : points_) {
            fibrant::Matrix all(3 * one.at.vectors, 3 * one.at.vectors);
            for (fibrant::Index a = 0; a < one.at.vectors; ++a)
                for (fibrant::Index b = 0; b < one.at.vectors; ++b)
                    all.block<3, 3>(3 * a, 3 * b) = stiffness_ * one.length * one.at.weights.place[fibrant::core::at(a)] *
                                                    one.at.weights.place[fibrant::core::at(b)] * fibrant::Mat3::Identity();
            bands.element(one.at.fibre, one.at.element, all);
        }
    }
    double stored(const fibrant::Vector& state) const {
        double sum = 0.0;
        for (const Point& one : points_) sum += 0.5 * stiffness_ * one.length * (one.at.place(state) - one.rest).squaredNorm();
        return sum;
    }
    double dissipated(const fibrant::Vector&) const noexcept { return 0.0; }

private:
    struct Point {
        fibrant::term::CentrePoint at;
        double length;       // of the fibre that it stands for
        fibrant::Vec3 rest;  // where it was
    };
    double stiffness_;
    std::vector<Point> points_;
};
static_assert(fibrant::term::Term<SoftBed>);
