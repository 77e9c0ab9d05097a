// SPDX-License-Identifier: MIT
#pragma once
/// @file Contact points of a proximity zone: planes across the mean of its two lines, closest points, fibre ends.

#include <fibrant/contact/element_normal.hpp>
#include <fibrant/contact/intermediate_geometry.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/contact/section_extents.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace fibrant::contact {

namespace detail {

/// The stations of one zone while they are placed, appended to the caller's pairs.
///
/// `u` of one of the two fibres goes with a `bool of_i` that says of which.
template <class B>
class ZoneStations {
public:
    ZoneStations(const beam::Mesh<B>& mesh, const Vector& state, const proximity::ProximityZone& zone,
                 const ContactSpacing& spacing, std::vector<StationPair>& pairs)
        : mesh_{mesh},
          state_{state},
          zone_{zone},
          spacing_{spacing},
          pairs_{pairs},
          before_{pairs.size()},
          i_{zone.fibre_i},
          j_{zone.fibre_j},
          h_i_{mesh.fibre(i_).element_length},
          h_j_{mesh.fibre(j_).element_length},
          low_i_{mesh.bounds(i_).first},
          end_i_{mesh.bounds(i_).second},
          low_j_{mesh.bounds(j_).first},
          end_j_{mesh.bounds(j_).second},
          r_{0.5 * (mesh.fibre(i_).section.radius() + mesh.fibre(j_).section.radius())},
          h_{0.5 * (h_i_ + h_j_)},
          thin_{0.5 * (thinnest(mesh.fibre(i_).section) + thinnest(mesh.fibre(j_).section))},
          step_{1.0 / spacing.points_per_element},
          from_{mean_abscissa(zone.a_i, zone.a_j)},
          to_{mean_abscissa(zone.b_i, zone.b_j)} {}

    /// The mutual closest points; with an end beyond which the other fibre goes on, its cap.
    void place_crossing() {
        StationPair pair = closest_points(mesh_, state_, i_, j_, zone_.closest_i, zone_.closest_j);
        if (is_one(pair))
            pair.u_i = zone_.closest_i, pair.u_j = zone_.closest_j, pair.crossing = false;  // nor across both tangents
        pair.length = r_;
        const Vec3 centres = mesh_.position(state_, j_, pair.u_j) - mesh_.position(state_, i_, pair.u_i);
        const double off_i = std::abs(centres.dot(mesh_.derivative(state_, i_, pair.u_i).normalized()));
        const double off_j = std::abs(centres.dot(mesh_.derivative(state_, j_, pair.u_j).normalized()));
        // A fibre's line goes on beyond its end, its end does not: the gap across both tangents is less than that of a cap, by
        // 0.1 r where lines part by a quarter of r. Then an end that slides to where the one kind begins would be sent back by
        // the other for ever.
        pair.end_i = (pair.u_i <= low_i_ || pair.u_i >= end_i_) && off_i > cap_from * r_;
        pair.end_j = (pair.u_j <= low_j_ || pair.u_j >= end_j_) && off_j > cap_from * r_;
        if (is_beyond(i_, pair.u_i, off_i) || is_beyond(j_, pair.u_j, off_j)) return;
        pairs_.push_back(pair);
    }

    /// Stations at whole multiples of the spacing in the mean abscissa of both fibres, so that they stay at the same
    /// material when the ends of a zone move, and meet the nodes of aligned fibres, where a centreline has its kinks.
    /// More of them where the fibres would come closer unseen, and the last sections of fibres.
    /// @param earlier  as of `station_pairs`
    template <class Earlier>
    void place_along(const Earlier& earlier) {
        std::vector<double> between;
        earlier([&](double u_i, double u_j) {
            const double k = mean_abscissa(u_i, u_j) / step_;
            if (std::abs(k - std::round(k)) > off_multiple) between.push_back(k);
        });
        const auto first = static_cast<Index>(std::ceil(from_ / step_ - at_multiple)),
                   last = static_cast<Index>(std::floor(to_ / step_ + at_multiple));
        if (first > last) add_station(0.5, step_ * h_);
        Station station{};
        for (Index k = first; k <= last; ++k) {
            const Station here = add_station(share(static_cast<double>(k)), step_ * h_);
            add_between(k - 1, k == first ? beside(here, -1.0) : station, here, between);
            station = here;
        }
        if (first <= last) add_between(last, station, beside(station, 1.0), between);
        // Ends that the zone reaches and no station has met.
        for (const double s : {0.0, 1.0})
            for (const bool of_i : {true, false}) {
                const auto [u_i, u_j] = zone_point(s);
                const double u = of_i ? u_i : u_j, end = nearest_end(of_i, u);
                if (std::isinf(of_i ? end_i_ : end_j_) || mesh_.fibre(of_i ? i_ : j_).goes_on) continue;
                if (std::abs(u - end) < 0.5 * step_) add_last_section(of_i, end, of_i ? u_j : u_i);
            }
        const auto begin = pairs_.begin() + static_cast<std::ptrdiff_t>(before_);
        const auto out = [&](const StationPair& pair) { return is_one(pair) || is_again(pair); };
        pairs_.erase(std::remove_if(begin, pairs_.end(), out), pairs_.end());
        sort_along(pairs_, before_);
    }

private:
    /// How far beside an end the other fibre's closest point may be, along the end's fibre, before contact is with its cap: but
    /// for rounding not at all [radius].
    static constexpr double cap_from = 0.01;
    /// The same where a fibre goes on: but for rounding a crossing is on one side of the seam [radius].
    static constexpr double joint = 1e-9;
    /// Distance from an end's plane from which the other fibre does not come by it any more, and from which an end is beyond
    /// the other one's; splayed ends make the first, blunt ones the second [radius].
    static constexpr double left = 0.05, end_to_end = 0.25;
    /// What is less aside is at a multiple of the spacing: rounding, and what a station moves along between two detections.
    /// Spacings are halved three times, so that stations between are an eighth or more aside [spacing].
    static constexpr double at_multiple = 1e-6, off_multiple = 0.1;
    static constexpr int most_parts = 8;  ///< of a spacing that is halved three times
    /// Looks along the other fibre for where Newton's method starts, its iterations and the step at which it has ended [element]:
    /// it converges by the square, so that what is left is rounding.
    static constexpr int looks = 8, most_iterations = 12;
    static constexpr double settled = 1e-11;
    static constexpr double parallel =
        1e-3;  ///< sine below which lines count as parallel, so that nothing is divided by zero [1]
    /// Least length over which facing sections part, of the thinner half axis: those that are deep in each other have no
    /// direction that is furthest [1].
    static constexpr double sharpest = 0.1;

    struct Station {
        double u_i, u_j, sine;
    };  // sine of the angle between the fibres
    struct Turn {
        double at, angle;
    };  // of a fibre towards the other one where two of its elements meet, at a part of the way

    static double thinnest(const scene::CrossSection& section) noexcept {
        return std::min(section.semi_axis_1, section.semi_axis_2);
    }
    // Direction between two sections, and the length over which lines that slant past each other part: the distance of the
    // centres of round ones. Of others, what their contours are curved by where they face each other: little where flat, more
    // where they stand on edge.
    std::pair<Vec3, double> facing(double u_i, double u_j) const noexcept {
        const Vec3 centres = mesh_.position(state_, j_, u_j) - mesh_.position(state_, i_, u_i);
        const auto round = [&](Index f) { return mesh_.fibre(f).section.semi_axis_1 == mesh_.fibre(f).section.semi_axis_2; };
        if (bore_between(mesh_, i_, j_) != no_bore)  // the wall is on the other side, and parts from no line that slants
            return {-centres.normalized(), std::numeric_limits<double>::infinity()};
        if ((round(i_) && round(j_)) || beam::CentreTouched<B>) return {centres.normalized(), 2.0 * r_};
        const Vec3 tangent =
            mean_tangent(mesh_.derivative(state_, i_, u_i).normalized(), mesh_.derivative(state_, j_, u_j).normalized());
        const SectionAxes axes_i = section_axes(mesh_, state_, i_, u_i), axes_j = section_axes(mesh_, state_, j_, u_j);
        const Vec3 across = centres - centres.dot(tangent) * tangent;
        const Vec3 normal = furthest_direction(across, axes_i, axes_j, tangent, unit_or(across, tangent.unitOrthogonal()));
        return {normal, std::max(sharpest * thin_, normal_turn(across, axes_i, axes_j, tangent, normal).length)};
    }
    // In a bend the points of a fibre that are closest to each other are next to each other, or one.
    bool is_one(const StationPair& pair) const noexcept {
        return i_ == j_ && mesh_.apart(i_, pair.u_i, pair.u_j) * h_i_ < self_contact_arc(r_, h_i_);
    }
    // A fibre goes on beyond its end: what is beyond is another zone's.
    bool is_beyond(Index f, double u, double off) const noexcept {
        return mesh_.fibre(f).goes_on && (u <= 0.0 || u >= static_cast<double>(mesh_.fibre(f).elements)) && off > joint * r_;
    }
    // A station at the last section of a fibre that goes on is one at its first section, too.
    bool is_again(const StationPair& pair) const noexcept {
        const auto last = [&](Index f, double u) {
            return mesh_.fibre(f).goes_on && u > static_cast<double>(mesh_.fibre(f).elements) - at_multiple;
        };
        return last(i_, pair.u_i) || (!mesh_.fibre(i_).goes_on && last(j_, pair.u_j));
    }
    double mean_abscissa(double u_i, double u_j) const noexcept {
        return 0.5 * (h_i_ * u_i + h_j_ * (zone_.b_j < zone_.a_j ? static_cast<double>(mesh_.fibre(j_).elements) - u_j : u_j)) /
               h_;
    }
    // Of the zone at a multiple k of the spacing.
    double share(double k) const noexcept {
        return to_ > from_ ? std::clamp((k * step_ - from_) / (to_ - from_), 0.0, 1.0) : 0.5;
    }
    // Abscissae of both fibres at a share of the zone.
    std::pair<double, double> zone_point(double s) const noexcept {
        return {zone_.a_i + s * (zone_.b_i - zone_.a_i), zone_.a_j + s * (zone_.b_j - zone_.a_j)};
    }
    double nearest_end(bool of_i, double u) const noexcept {
        const double end = of_i ? end_i_ : end_j_;
        return u > 0.5 * end ? end : 0.0;
    }
    // Where a station lies that would be so many steps from one, as the zone's ends say.
    Station beside(const Station& station, double steps) const noexcept {
        const double per_step = to_ > from_ ? step_ / (to_ - from_) : 0.0;
        return {std::clamp(station.u_i + steps * per_step * (zone_.b_i - zone_.a_i), low_i_, end_i_),
                std::clamp(station.u_j + steps * per_step * (zone_.b_j - zone_.a_j), low_j_, end_j_), station.sine};
    }

    // A fibre's end against the other fibre's side; the same end is paired once in a zone.
    void add_end(bool of_i, double u) {
        bool& done = met_[(of_i ? 0U : 2U) + (u > 0.5 * (of_i ? end_i_ : end_j_) ? 1U : 0U)];
        if (done) return;
        done = true;
        const Index self = of_i ? i_ : j_, other = of_i ? j_ : i_;
        const Vec3 centre = mesh_.position(state_, self, u);
        const double low = of_i ? std::min(zone_.a_j, zone_.b_j) : zone_.a_i,
                     high = of_i ? std::max(zone_.a_j, zone_.b_j) : zone_.b_i;
        double v = 0.5 * (low + high);
        const double other_low = of_i ? low_j_ : low_i_, other_end = of_i ? end_j_ : end_i_;
        double best = (mesh_.position(state_, other, v) - centre).squaredNorm();
        for (int k = 0; k <= looks; ++k) {  // a start close enough for the tangent planes to converge
            const double w = low + (high - low) * k / looks;
            const double square = (mesh_.position(state_, other, w) - centre).squaredNorm();
            if (square < best) best = square, v = w;
        }
        for (int iteration = 0; iteration < most_iterations; ++iteration) {
            const Vec3 d = mesh_.derivative(state_, other, v);
            const double step = std::clamp((centre - mesh_.position(state_, other, v)).dot(d) / d.squaredNorm(), -1.0, 1.0);
            v = std::clamp(v + step, other_low, other_end);
            if (std::abs(step) < settled) break;
        }
        const Vec3 d = mesh_.derivative(state_, other, v);
        const double beyond = std::abs((centre - mesh_.position(state_, other, v)).dot(d.normalized()));
        StationPair pair{of_i ? u : v, of_i ? v : u, false, of_i, !of_i, 0.5 * r_};
        if (beyond > end_to_end * r_) pair.end_i = pair.end_j = true;  // end to end
        pairs_.push_back(pair);
    }

    // The last section of a fibre against the other one: there splayed fibres are closest, and no cap sticks out. False if
    // the other fibre ends before.
    bool add_last_section(bool of_i, double u, double v) {
        const Index self = of_i ? i_ : j_, other = of_i ? j_ : i_;
        const double other_low = of_i ? low_j_ : low_i_, other_end = of_i ? end_j_ : end_i_;
        const Vec3 origin = mesh_.position(state_, self, u);
        const Vec3 t = contact_tangent(mesh_, state_, self, u).normalized(),
                   t_other = contact_tangent(mesh_, state_, other, v).normalized();
        const Vec3 tangent = mean_tangent(t, t_other);
        // A station next to it will do, unless the fibres come closer by more than may go unseen between the two.
        const double near =
            std::min(off_multiple * step_, spacing_.largest_unseen * thin_ / (h_ * std::max(sine_between(t, t_other), parallel)));
        for (std::size_t k = before_; k < pairs_.size(); ++k)
            if (std::abs((of_i ? pairs_[k].u_i : pairs_[k].u_j) - u) < near) return true;
        v = plane_section(mesh_, state_, other, v, origin, tangent);
        if ((v <= other_low || v >= other_end) && std::abs((mesh_.position(state_, other, v) - origin).dot(tangent)) > left * r_)
            return false;
        pairs_.push_back({of_i ? u : v, of_i ? v : u, false, false, false, 0.0});
        return true;
    }

    // The pair of the plane at the share s of the zone.
    Station add_station(double s, double length) {
        auto [u_i, u_j] = zone_point(s);
        const Vec3 middle = 0.5 * (mesh_.position(state_, i_, u_i) + mesh_.position(state_, j_, u_j));
        const Vec3 t_i = contact_tangent(mesh_, state_, i_, u_i).normalized(),
                   t_j = contact_tangent(mesh_, state_, j_, u_j).normalized();
        const Vec3 tangent = mean_tangent(t_i, t_j);
        u_i = plane_section(mesh_, state_, i_, u_i, middle, tangent);
        u_j = plane_section(mesh_, state_, j_, u_j, middle, tangent);
        const double off_i = std::abs((mesh_.position(state_, i_, u_i) - middle).dot(tangent));
        const double off_j = std::abs((mesh_.position(state_, j_, u_j) - middle).dot(tangent));
        const bool left_i = off_i > left * r_ && (u_i <= low_i_ || u_i >= end_i_);
        const bool left_j = off_j > left * r_ && (u_j <= low_j_ || u_j >= end_j_);
        if (left_i || left_j) {
            const bool of_i = left_i;
            const double u = of_i ? u_i : u_j;
            if (mesh_.fibre(of_i ? i_ : j_).goes_on) return {u_i, u_j, sine_between(t_i, t_j)};
            if (!add_last_section(of_i, nearest_end(of_i, u), of_i ? u_j : u_i)) add_end(of_i, u);
        } else {
            pairs_.push_back({u_i, u_j, false, false, false, length});
        }
        return {u_i, u_j, sine_between(t_i, t_j)};
    }

    // Stations between two that are a step apart, the first at the multiple k of it. Fibres come closer there than at either
    // where they slant past each other, the distance of their centres being a hyperbola, where they bend towards each other, and
    // where sections are thicker: the spacing is halved then.
    void add_between(Index k, const Station& low, const Station& high, const std::vector<double>& earlier) {
        const double u_i = 0.5 * (low.u_i + high.u_i), u_j = 0.5 * (low.u_j + high.u_j), sine = std::max(low.sine, high.sine);
        const auto [across, parting] = facing(u_i, u_j);
        const Vec3 bend =
            mesh_.second_derivative(state_, j_, u_j) / (h_j_ * h_j_) - mesh_.second_derivative(state_, i_, u_i) / (h_i_ * h_i_);
        const auto bulge = [&, &normal = across](Index fibre, double u, double length) {
            return extents_along(mesh_, state_, fibre, mesh_.locate(fibre, u).first, normal).second() / (length * length);
        };
        const double bending = std::max(0.0, bend.dot(across) - bulge(i_, u_i, h_i_) - bulge(j_, u_j, h_j_));
        const double smooth = 0.125 * step_ * h_ * step_ * h_ * (sine * sine / parting + bending);
        find_turns(low, high, across);
        const auto unseen = [&](int parts) {
            double depth = smooth / (parts * parts);
            for (const Turn& turn : turns_) {
                const double at = turn.at * parts - std::floor(turn.at * parts);
                depth += turn.angle * at * (1.0 - at) * step_ * h_ / parts;
            }
            return depth;
        };
        const auto was_halved = [&](int parts) {
            return std::any_of(earlier.begin(), earlier.end(), [&](double station) {
                const double place = (station - static_cast<double>(k)) * 2.0 * parts;  // odd at the stations of this halving
                return place > 0.0 && place < 2.0 * parts && std::abs(std::remainder(place - 1.0, 2.0)) < 2.0 * off_multiple;
            });
        };
        int parts = 1;
        while (parts < most_parts && (unseen(parts) > spacing_.largest_unseen * thin_ || was_halved(parts))) parts *= 2;
        for (int m = 1; m < parts; ++m) {
            const double at = static_cast<double>(k) + static_cast<double>(m) / parts;
            if (at * step_ > from_ && at * step_ < to_) add_station(share(at), step_ * h_ / parts);
        }
    }

    // Where elements of either fibre meet between two stations, and its surface turns towards the other one.
    void find_turns(const Station& low, const Station& high, const Vec3& across) {
        turns_.clear();
        for (const bool of_i : {true, false}) {
            const double from_u = of_i ? low.u_i : low.u_j, to_u = of_i ? high.u_i : high.u_j;
            const double least = std::max(std::min(from_u, to_u), (of_i ? low_i_ : low_j_) + 0.5);
            double node = std::min(std::floor(std::max(from_u, to_u) - 1e-6), (of_i ? end_i_ : end_j_) - 1.0);
            for (; node > least; node -= 1.0) {
                const Index fibre = of_i ? i_ : j_, next = static_cast<Index>(mesh_.wrapped(fibre, node));
                const double jump = (of_i ? -1.0 : 1.0) * kink(mesh_, state_, fibre, next).dot(across) -
                                    extent_kink(mesh_, state_, fibre, next, across);
                turns_.push_back({(node - from_u) / (to_u - from_u), std::max(0.0, jump) / (of_i ? h_i_ : h_j_)});
            }
        }
    }

    const beam::Mesh<B>& mesh_;
    const Vector& state_;
    const proximity::ProximityZone& zone_;
    const ContactSpacing& spacing_;
    std::vector<StationPair>& pairs_;
    std::size_t before_;  // pairs of other zones
    Index i_, j_;
    double h_i_, h_j_;                      // lengths of an element
    double low_i_, end_i_, low_j_, end_j_;  // abscissae of the ends; infinite of closed fibres
    double r_, h_, thin_;                   // means of the two fibres; of their least half axes
    double step_, from_, to_;               // of the mean abscissa
    std::array<bool, 4> met_{};             // first and last ends of i and of j that have their cap already
    std::vector<Turn> turns_;               // between the stations that are looked at
};

/// Puts stations on closed fibres into the form that is remembered: abscissae in [0, elements), on one fibre the lesser first; a
/// zone that goes all around meets itself, and has its first stations once.
/// @param first  pair of the zone
template <class B>
void wrap_stations(const beam::Mesh<B>& mesh, Index i, Index j, double points_per_element, std::size_t first,
                   std::vector<StationPair>& pairs) {
    if (!mesh.fibre(i).closed && !mesh.fibre(j).closed) return;
    for (std::size_t k = first; k < pairs.size(); ++k) {
        StationPair& pair = pairs[k];
        pair.u_i = mesh.wrapped(i, pair.u_i), pair.u_j = mesh.wrapped(j, pair.u_j);
        if (i != j || pair.u_i <= pair.u_j) continue;
        std::swap(pair.u_i, pair.u_j), std::swap(pair.end_i, pair.end_j);
    }
    sort_along(pairs, first);
    const double same = 0.02 / points_per_element;  // a sixth of the least spacing, which is halved three times [elements]
    const auto one = [&](const StationPair& a, const StationPair& b) {
        return mesh.apart(i, a.u_i, b.u_i) < same && mesh.apart(j, a.u_j, b.u_j) < same;
    };
    pairs.erase(std::unique(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(), one), pairs.end());
    if (pairs.size() > first + 1 && one(pairs[first], pairs.back())) pairs.pop_back();
}

}  // namespace detail

/// Stations of a zone (Durville, eq. 6 to 8). The intermediate geometry is the mean of the zone's two lines, points stand
/// at equal distances on it, and the plane across it cuts the two centrelines.
///
/// Departures: a crossing is one element at the mutual closest points, because every plane near a crossing yields the
/// same gap along the cross product of the tangents; where a zone reaches the end of a fibre, its last section has a
/// point; and fibres that meet end to end are paired by their rounded ends.
/// @param zone        abscissae in elements
/// @param crossing    the zone is a crossing
/// @param pairs       appended to, in the order of the zone
/// @param earlier     earlier(see) calls see(u_i, u_j) with the stations that the two fibres had before: a spacing that was
///                    halved stays so, or the contact that it found would come and go for ever
template <class B, class Earlier>
void station_pairs(const beam::Mesh<B>& mesh, const Vector& state, const proximity::ProximityZone& zone, bool crossing,
                   const ContactSpacing& spacing, std::vector<StationPair>& pairs, const Earlier& earlier) {
    const std::size_t first = pairs.size();
    detail::ZoneStations<B> stations{mesh, state, zone, spacing, pairs};
    if (crossing)
        stations.place_crossing();
    else
        stations.place_along(earlier);
    if (bore_between(mesh, zone.fibre_i, zone.fibre_j) != no_bore)  // ends have no caps there: what is beyond an end is free
        pairs.erase(std::remove_if(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(),
                                   [](const StationPair& pair) { return pair.end_i || pair.end_j; }),
                    pairs.end());
    detail::wrap_stations(mesh, zone.fibre_i, zone.fibre_j, spacing.points_per_element, first, pairs);
}

/// Stations of a zone that had none before.
template <class B>
void station_pairs(const beam::Mesh<B>& mesh, const Vector& state, const proximity::ProximityZone& zone, bool crossing,
                   const ContactSpacing& spacing, std::vector<StationPair>& pairs) {
    station_pairs(mesh, state, zone, crossing, spacing, pairs, [](const auto&) {});
}

}  // namespace fibrant::contact
