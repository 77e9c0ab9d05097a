// SPDX-License-Identifier: MIT
#pragma once
/// @file Contact points of a proximity zone: planes across the mean of its two lines, closest points, fibre ends.

#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/proximity/proximity_search.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace fibrant::contact {

/// A pair of stations whose sections may touch; abscissae are counted in elements.
struct StationPair {
    double u_i = 0.0, u_j = 0.0;
    bool crossing = false;               ///< the only pair of its zone
    bool end_i = false, end_j = false;   ///< the station is a fibre's end and the contact is with its cap
    double length = 0.0;                 ///< of the zone that it stands for [length]; for a crossing the touching length, for a last section 0
};

/// The pair of closest points near a start, both inside their fibres.
///
/// Newton on (x_j - x_i) . t_i = 0 and (x_j - x_i) . t_j = 0 with the positive part of its matrix, so it also settles
/// where the lines pass through each other; unique if the angle exceeds arccos(1 - 2 r kappa). With the tangents of
/// contact_tangent: closest but for the kinks between elements, in which there would be two closest points.
template <class B>
StationPair closest_points(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double u_i, double u_j) {
    const double end_i = static_cast<double>(mesh.fibre(i).elements), end_j = static_cast<double>(mesh.fibre(j).elements);
    for (int iteration = 0; iteration < 30; ++iteration) {
        const Vec3 centres = mesh.position(state, j, u_j) - mesh.position(state, i, u_i);
        const Vec3 d_i = contact_tangent(mesh, state, i, u_i), d_j = contact_tangent(mesh, state, j, u_j);
        const double a = d_i.squaredNorm(), b = -d_i.dot(d_j), c = d_j.squaredNorm();
        const double p = centres.dot(d_i), q = -centres.dot(d_j);  // minus the gradient of |centres|^2 / 2
        // Gauss-Newton step with a bound on each variable: at a bound the other one alone
        const double determinant = std::max(a * c - b * b, 1e-12 * a * c);
        double step_i = (c * p - b * q) / determinant, step_j = (a * q - b * p) / determinant;
        if ((u_i + step_i < 0.0 || u_i + step_i > end_i)) {
            step_i = std::clamp(u_i + step_i, 0.0, end_i) - u_i;
            step_j = (q - b * step_i) / c;
        }
        if ((u_j + step_j < 0.0 || u_j + step_j > end_j)) {
            step_j = std::clamp(u_j + step_j, 0.0, end_j) - u_j;
            step_i = std::clamp(u_i + (p - b * step_j) / a, 0.0, end_i) - u_i;
        }
        const double largest = std::max(std::abs(step_i), std::abs(step_j));
        const double shorten = largest > 1.0 ? 1.0 / largest : 1.0;
        u_i = std::clamp(u_i + shorten * step_i, 0.0, end_i);
        u_j = std::clamp(u_j + shorten * step_j, 0.0, end_j);
        if (largest < 1e-11) break;
    }
    return {u_i, u_j, true, false, false, 0.0};
}

/// Abscissa where the plane through `origin` across `normal` cuts a fibre, near `u`; clamped to the fibre.
template <class B>
double plane_section(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, const Vec3& origin,
                     const Vec3& normal) {
    const double end = static_cast<double>(mesh.fibre(fibre).elements);
    for (int iteration = 0; iteration < 12; ++iteration) {
        const double speed = mesh.derivative(state, fibre, u).dot(normal);
        if (speed == 0.0) break;
        const double step = std::clamp((origin - mesh.position(state, fibre, u)).dot(normal) / speed, -1.0, 1.0);
        const double next = std::clamp(u + step, 0.0, end);
        const bool still = std::abs(next - u) < 1e-11;
        u = next;
        if (still) break;
    }
    return u;
}

/// Arc within which a fibre does not touch itself: pi r is the shortest one that can come back to do so, and elements of one
/// contact have no node in common [length].
inline double self_contact_arc(double radius, double element_length) noexcept {
    return std::max(std::numbers::pi * radius, 2.0 * element_length);
}

/// How contact points are placed.
struct ContactSpacing {
    double points_per_element = 2.0;    ///< along near-parallel fibres [1], > 0
    double crossing_angle_deg = 30.0;   ///< of `contact::crossing_angle_deg`, above: one contact element for the zone [degree]
    double angle_hysteresis_deg = 5.0;  ///< a zone keeps its kind within this of the bound [degree]
    /// Depth that may go unseen between two contact points, where fibres slant or bend towards each other; beyond it the
    /// spacing is halved, up to three times [radius], > 0.
    double largest_unseen = 0.005;
    void validate() const {
        core::require_positive("ContactSpacing.points_per_element", points_per_element);
        core::require_positive("ContactSpacing.largest_unseen", largest_unseen);
        core::require_between("ContactSpacing.crossing_angle_deg", crossing_angle_deg, 1.0, 90.0);
        core::require_between("ContactSpacing.angle_hysteresis_deg", angle_hysteresis_deg, 0.0, 20.0);
    }
};

/// Angle between two fibres at the closest points of their zone, less what bending towards each other takes of it; at most that of two
/// lines which part as fast as the two halves of the zone do [degree].
///
/// The distance of their centres is least there and nowhere beside if its second variation is positive: straight fibres at any
/// angle a; bent ones, c from centre to centre and k their curvature vectors, if sin^2 a > c.(k_i - k_j) + (c.k_i)(c.k_j). That is what is
/// taken off sin^2 a: as it goes to zero a second closest place comes up beside the first, and one contact element would hop to and fro.
/// Fibres that run side by side and splay where they end are closest there and at an angle, yet touch all along: their zone is long, and hardly
/// parts. Straight lines part by s sin a or more, and arcs around a line as the second variation says.
template <class B>
double crossing_angle_deg(const beam::Mesh<B>& mesh, const Vector& state, const proximity::ProximityZone& zone) {
    const Vec3 d_i = mesh.derivative(state, zone.fibre_i, zone.closest_i), d_j = mesh.derivative(state, zone.fibre_j, zone.closest_j);
    const Vec3 t_i = d_i.normalized(), t_j = d_j.normalized();
    const Vec3 x_i = mesh.position(state, zone.fibre_i, zone.closest_i), x_j = mesh.position(state, zone.fibre_j, zone.closest_j);
    const Vec3 centres = x_j - x_i;
    const auto bend = [&](Index fibre, double u, const Vec3& derivative, const Vec3& tangent) {
        const Vec3 second = mesh.mean_second_derivative(state, fibre, u);
        return centres.dot(second - second.dot(tangent) * tangent) / derivative.squaredNorm();
    };
    const double bend_i = bend(zone.fibre_i, zone.closest_i, d_i, t_i), bend_j = bend(zone.fibre_j, zone.closest_j, d_j, t_j);
    const double taken = std::max(0.0, bend_i - bend_j + bend_i * bend_j);
    double sine = std::sqrt(std::max(0.0, t_i.cross(t_j).squaredNorm() - taken));
    const double touching = mesh.fibre(zone.fibre_i).section.radius() + mesh.fibre(zone.fibre_j).section.radius();
    for (const bool first : {true, false}) {
        const Vec3 end_i = mesh.position(state, zone.fibre_i, first ? zone.a_i : zone.b_i);
        const Vec3 end_j = mesh.position(state, zone.fibre_j, first ? zone.a_j : zone.b_j);
        const double length = std::max((end_i - x_i).norm(), (end_j - x_j).norm());
        if (length <= 2.0 * touching) continue;  // no room for another contact
        sine = std::min(sine, std::sqrt(std::max(0.0, (end_j - end_i).squaredNorm() - centres.squaredNorm())) / length);
    }
    return std::asin(std::min(1.0, sine)) * 180.0 / std::numbers::pi;
}

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
    const Index i = zone.fibre_i, j = zone.fibre_j;
    const double h_i = mesh.fibre(i).element_length, h_j = mesh.fibre(j).element_length;
    const double end_i = static_cast<double>(mesh.fibre(i).elements), end_j = static_cast<double>(mesh.fibre(j).elements);
    const double r = 0.5 * (mesh.fibre(i).section.radius() + mesh.fibre(j).section.radius());
    bool first_i = false, last_i = false, first_j = false, last_j = false;  // ends that already have their element
    const std::size_t before = pairs.size();
    // In a bend the points of a fibre that are closest to each other are next to each other, or one.
    const auto is_one = [&](const StationPair& pair) {
        return i == j && std::abs(pair.u_j - pair.u_i) * h_i < self_contact_arc(r, h_i);
    };

    // A fibre's end against the other fibre's side; the same end is paired once in a zone.
    const auto add_end = [&](bool of_i, double u) {
        const bool last = u > 0.5 * (of_i ? end_i : end_j);
        bool& done = of_i ? (last ? last_i : first_i) : (last ? last_j : first_j);
        if (done) return;
        done = true;
        const Index self = of_i ? i : j, other = of_i ? j : i;
        const Vec3 centre = mesh.position(state, self, u);
        const double low = of_i ? std::min(zone.a_j, zone.b_j) : zone.a_i, high = of_i ? std::max(zone.a_j, zone.b_j) : zone.b_i;
        double v = 0.5 * (low + high);
        const double other_end = of_i ? end_j : end_i;
        double best = (mesh.position(state, other, v) - centre).squaredNorm();
        for (int k = 0; k <= 8; ++k) {  // a start close enough for the tangent planes to converge
            const double w = low + (high - low) * k / 8.0;
            const double square = (mesh.position(state, other, w) - centre).squaredNorm();
            if (square < best) best = square, v = w;
        }
        for (int iteration = 0; iteration < 12; ++iteration) {
            const Vec3 d = mesh.derivative(state, other, v);
            const double step = std::clamp((centre - mesh.position(state, other, v)).dot(d) / d.squaredNorm(), -1.0, 1.0);
            v = std::clamp(v + step, 0.0, other_end);
            if (std::abs(step) < 1e-11) break;
        }
        const Vec3 d = mesh.derivative(state, other, v);
        const double beyond = std::abs((centre - mesh.position(state, other, v)).dot(d.normalized()));
        StationPair pair{of_i ? u : v, of_i ? v : u, false, of_i, !of_i, 0.5 * r};
        if (beyond > 0.25 * r) pair.end_i = pair.end_j = true;  // end to end
        pairs.push_back(pair);
    };

    if (crossing) {
        StationPair pair = closest_points(mesh, state, i, j, zone.closest_i, zone.closest_j);
        if (is_one(pair)) pair.u_i = zone.closest_i, pair.u_j = zone.closest_j, pair.crossing = false;  // nor across both tangents
        pair.length = r;
        const Vec3 centres = mesh.position(state, j, pair.u_j) - mesh.position(state, i, pair.u_i);
        const double off_i = std::abs(centres.dot(mesh.derivative(state, i, pair.u_i).normalized()));
        const double off_j = std::abs(centres.dot(mesh.derivative(state, j, pair.u_j).normalized()));
        // A fibre's line goes on beyond its end, its end does not: the gap across both tangents is less than that of a cap, by 0.1 r where lines part by a quarter
        // of r. Then an end that slides to where the one kind begins would be sent back by the other for ever.
        const double nearly_none = 0.01 * r;
        pair.end_i = (pair.u_i <= 0.0 || pair.u_i >= end_i) && off_i > nearly_none;
        pair.end_j = (pair.u_j <= 0.0 || pair.u_j >= end_j) && off_j > nearly_none;
        pairs.push_back(pair);
        return;
    }
    // Stations stand at whole multiples of the spacing in the mean abscissa of both fibres, so that they stay at the same
    // material when the ends of a zone move, and meet the nodes of aligned fibres, where a centreline has its kinks.
    const bool backward = zone.b_j < zone.a_j;
    const double h = 0.5 * (h_i + h_j), step = 1.0 / spacing.points_per_element;
    const auto mean_abscissa = [&](double u_i, double u_j) {
        return 0.5 * (h_i * u_i + h_j * (backward ? end_j - u_j : u_j)) / h;
    };
    const double from = mean_abscissa(zone.a_i, zone.a_j), to = mean_abscissa(zone.b_i, zone.b_j);
    const auto first = static_cast<Index>(std::ceil(from / step - 1e-6)), last = static_cast<Index>(std::floor(to / step + 1e-6));
    const auto share = [&](double k) { return to > from ? std::clamp((k * step - from) / (to - from), 0.0, 1.0) : 0.5; };
    // The last section of a fibre against the other one: there splayed fibres are closest, and no cap sticks out. False if
    // the other fibre ends before.
    const auto add_last_section = [&](bool of_i, double u, double v) {
        const Index self = of_i ? i : j, other = of_i ? j : i;
        const double other_end = of_i ? end_j : end_i;
        const Vec3 origin = mesh.position(state, self, u);
        const Vec3 t = contact_tangent(mesh, state, self, u).normalized(), t_other = contact_tangent(mesh, state, other, v).normalized();
        const Vec3 tangent = mean_tangent(t, t_other);
        // A station next to it will do, unless the fibres come closer by more than may go unseen between the two.
        const double near = std::min(0.1 * step, spacing.largest_unseen * r / (h * std::max(sine_between(t, t_other), 1e-3)));
        for (std::size_t k = before; k < pairs.size(); ++k)
            if (std::abs((of_i ? pairs[k].u_i : pairs[k].u_j) - u) < near) return true;
        v = plane_section(mesh, state, other, v, origin, tangent);
        if ((v <= 0.0 || v >= other_end) && std::abs((mesh.position(state, other, v) - origin).dot(tangent)) > 0.05 * r) return false;
        pairs.push_back({of_i ? u : v, of_i ? v : u, false, false, false, 0.0});
        return true;
    };
    const auto nearest_end = [&](bool of_i, double u) { return u > 0.5 * (of_i ? end_i : end_j) ? (of_i ? end_i : end_j) : 0.0; };
    struct Station { double u_i, u_j, sine; };  // sine of the angle between the fibres
    // The pair of the plane at the share s of the zone.
    const auto add_station = [&](double s, double length) {
        double u_i = zone.a_i + s * (zone.b_i - zone.a_i), u_j = zone.a_j + s * (zone.b_j - zone.a_j);
        const Vec3 middle = 0.5 * (mesh.position(state, i, u_i) + mesh.position(state, j, u_j));
        const Vec3 t_i = contact_tangent(mesh, state, i, u_i).normalized(), t_j = contact_tangent(mesh, state, j, u_j).normalized();
        const Vec3 tangent = mean_tangent(t_i, t_j);
        u_i = plane_section(mesh, state, i, u_i, middle, tangent);
        u_j = plane_section(mesh, state, j, u_j, middle, tangent);
        const double off_i = std::abs((mesh.position(state, i, u_i) - middle).dot(tangent));
        const double off_j = std::abs((mesh.position(state, j, u_j) - middle).dot(tangent));
        const bool left_i = off_i > 0.05 * r && (u_i <= 0.0 || u_i >= end_i);
        const bool left_j = off_j > 0.05 * r && (u_j <= 0.0 || u_j >= end_j);
        if (left_i || left_j) {
            const bool of_i = left_i;
            const double u = of_i ? u_i : u_j;
            if (!add_last_section(of_i, nearest_end(of_i, u), of_i ? u_j : u_i)) add_end(of_i, u);
        } else {
            pairs.push_back({u_i, u_j, false, false, false, length});
        }
        return Station{u_i, u_j, sine_between(t_i, t_j)};
    };
    if (first > last) add_station(0.5, step * h);
    // Between two stations fibres come closer than at either where they slant past each other, the distance of their centres
    // being a hyperbola, and where they bend towards each other: the spacing is halved there.
    std::vector<double> between;  // earlier stations at parts of the spacing
    earlier([&](double u_i, double u_j) {
        const double k = mean_abscissa(u_i, u_j) / step;
        if (std::abs(k - std::round(k)) > 0.1) between.push_back(k);
    });
    const auto was_halved = [&](Index k, int parts) {
        return std::any_of(between.begin(), between.end(), [&](double station) {
            const double place = (station - static_cast<double>(k)) * 2.0 * parts;  // odd at the stations of this halving
            return place > 0.0 && place < 2.0 * parts && std::abs(std::remainder(place - 1.0, 2.0)) < 0.2;
        });
    };
    const auto add_between = [&](Index k, const Station& low, const Station& high) {
        const double u_i = 0.5 * (low.u_i + high.u_i), u_j = 0.5 * (low.u_j + high.u_j), sine = std::max(low.sine, high.sine);
        const Vec3 across = (mesh.position(state, j, u_j) - mesh.position(state, i, u_i)).normalized();
        const Vec3 bend = mesh.second_derivative(state, j, u_j) / (h_j * h_j) - mesh.second_derivative(state, i, u_i) / (h_i * h_i);
        const double bending = std::max(0.0, bend.dot(across));
        const double smooth = 0.125 * step * h * step * h * (sine * sine / (2.0 * r) + bending);
        // Where two elements of a fibre meet between the stations, at a part of the way, it turns towards the other one by an angle.
        struct Turn { double at, angle; };
        std::array<Turn, 2> turns{};
        for (const bool of_i : {true, false}) {
            const double from_u = of_i ? low.u_i : low.u_j, to_u = of_i ? high.u_i : high.u_j;
            const double node = std::floor(std::max(from_u, to_u) - 1e-6), elements = of_i ? end_i : end_j;
            if (node <= std::min(from_u, to_u) || node < 1.0 || node >= elements) continue;
            const Vec3 jump = kink(mesh, state, of_i ? i : j, static_cast<Index>(node)) / (of_i ? -h_i : h_j);
            turns[of_i ? 0 : 1] = {(node - from_u) / (to_u - from_u), std::max(0.0, jump.dot(across))};
        }
        const auto unseen = [&](int parts) {
            double depth = smooth / (parts * parts);
            for (const Turn& turn : turns) {
                const double at = turn.at * parts - std::floor(turn.at * parts);
                depth += turn.angle * at * (1.0 - at) * step * h / parts;
            }
            return depth;
        };
        int parts = 1;
        while (parts < 8 && (unseen(parts) > spacing.largest_unseen * r || was_halved(k, parts))) parts *= 2;
        for (int m = 1; m < parts; ++m) {
            const double at = static_cast<double>(k) + static_cast<double>(m) / parts;
            if (at * step > from && at * step < to) add_station(share(at), step * h / parts);
        }
    };
    const double per_step = to > from ? step / (to - from) : 0.0;
    const auto next = [&](const Station& station, double steps) {
        return Station{std::clamp(station.u_i + steps * per_step * (zone.b_i - zone.a_i), 0.0, end_i),
                       std::clamp(station.u_j + steps * per_step * (zone.b_j - zone.a_j), 0.0, end_j), station.sine};
    };
    Station station{};
    for (Index k = first; k <= last; ++k) {
        const Station here = add_station(share(static_cast<double>(k)), step * h);
        add_between(k - 1, k == first ? next(here, -1.0) : station, here);
        station = here;
    }
    if (first <= last) add_between(last, station, next(station, 1.0));
    // Ends that the zone reaches and no station has met.
    for (const double s : {0.0, 1.0})
        for (const bool of_i : {true, false}) {
            const double u_i = zone.a_i + s * (zone.b_i - zone.a_i), u_j = zone.a_j + s * (zone.b_j - zone.a_j);
            const double u = of_i ? u_i : u_j, end = nearest_end(of_i, u);
            if (std::abs(u - end) < 0.5 * step) add_last_section(of_i, end, of_i ? u_j : u_i);
        }
    pairs.erase(std::remove_if(pairs.begin() + static_cast<std::ptrdiff_t>(before), pairs.end(), is_one), pairs.end());
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(before), pairs.end(), [](const StationPair& a, const StationPair& b) {
        return a.u_i != b.u_i ? a.u_i < b.u_i : a.u_j < b.u_j;
    });
}

/// Stations of a zone that had none before.
template <class B>
void station_pairs(const beam::Mesh<B>& mesh, const Vector& state, const proximity::ProximityZone& zone, bool crossing,
                   const ContactSpacing& spacing, std::vector<StationPair>& pairs) {
    station_pairs(mesh, state, zone, crossing, spacing, pairs, [](const auto&) {});
}

}  // namespace fibrant::contact
