// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres that are in each other: where deepest, and by which sides they can part.

#include <fibrant/contact/contact_detection.hpp>
#include <fibrant/contact/deepest_overlap.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/contact/station_pairs.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace fibrant::contact {

/// The deepest overlap that two fibres would have if their sections were as at rest: what is held in each other may squeeze its
/// sections flat, and has parted from nothing. Fibres that meet with an end count not.
/// @param deep  gets the fibres of which that is more than `part` of the thinner one's radius
template <class Contacts, class B>
Overlap deepest_squeeze(const Contacts& contacts, const beam::Mesh<B>& mesh, const Vector& state, double part,
                        std::vector<Index>& deep) {
    Overlap deepest;
    for (const auto& element : contacts.elements()) {
        if (element.end_i || element.end_j) continue;
        const Vec3 x_i = mesh.position(state, element.fibre_i, element.u_i),
                   x_j = mesh.position(state, element.fibre_j, element.u_j);
        const auto half = [&](Index f, double u) {
            const auto [g_1, g_2] = mesh.directors(state, f, u);
            return mesh.fibre(f).section.extent(g_1.normalized(), g_2.normalized(), element.normal);
        };
        const double depth =
            half(element.fibre_i, element.u_i) + half(element.fibre_j, element.u_j) - (x_j - x_i).dot(element.normal);
        const double radius =
            std::min(mesh.fibre(element.fibre_i).section.radius(), mesh.fibre(element.fibre_j).section.radius());
        if (!(depth > part * radius)) continue;
        deep.push_back(element.fibre_i), deep.push_back(element.fibre_j);
        if (depth > deepest.depth)
            deepest = {element.fibre_i, element.fibre_j, element.u_i, element.u_j,
                       depth,           radius,          radius,      Vec3(0.5 * (x_i + x_j))};
    }
    return deepest;
}

/// Sides by which fibres that are deep in each other part, all along each place where they are, so that none leaves by one side
/// here and by the other there, threaded through the other one.
///
/// Stations whose centres are less than `shallow` of touching apart are deep, and each run of them has one direction, carried
/// along the fibres without twist: the sum of the offsets of their centres, by which the least motion parts them. Where the run
/// ends in offsets to opposite sides, fibres cross at a small angle and part across both. Where offsets cancel or vanish, as for
/// fibres on one line, nothing says where to: it is the binormal of the line, along which it keeps its length, or if it is
/// straight the mean of both directors g_1, from the thinner, softer, shorter fibre to the other one, and between equals by their
/// number. None of it depends on the axes of space, but a director that a scene leaves open.
template <class B>
class OverlapSides {
public:
    static constexpr double shallow = 0.75;    ///< of the distance at which sections touch
    static constexpr double vanishing = 1e-6;  ///< of it: offsets that are rounding
    static constexpr double opposite = -0.3;   ///< cosine of directions that run apart

    struct Side {
        Index fibre_i, fibre_j;
        double u_i, u_j;
        Vec3 normal;
    };

    OverlapSides(const beam::Mesh<B>& mesh, const Vector& state) : mesh_{mesh}, state_{state} {}

    /// Sides at all stations of the zones of a state.
    std::vector<Side> of(const std::vector<Zone>& zones, const ContactSpacing& spacing) {
        std::vector<Side> sides;
        for (const Zone& zone : zones) {
            pairs_.clear();
            const bool crossing = crossing_angle_deg(mesh_, state_, zone.span) > spacing.crossing_angle_deg;
            station_pairs(mesh_, state_, zone.span, crossing, spacing, pairs_);
            i_ = zone.span.fibre_i, j_ = zone.span.fibre_j;
            touching_ = mesh_.fibre(i_).section.radius() + mesh_.fibre(j_).section.radius();
            stations_.clear();
            for (const StationPair& pair : pairs_)
                if (!pair.end_i && !pair.end_j) add_station(pair);
            if (stations_.empty()) continue;
            if (crossing) {
                turn_crossing();
            } else {
                for (std::size_t from = 0; from < stations_.size();) {
                    std::size_t to = from;
                    while (to < stations_.size() && stations_[to].offset.norm() < shallow) ++to;
                    if (to > from) turn_run(from, to);
                    from = std::max(to, from + 1);
                }
            }
            for (const Station& station : stations_) sides.push_back({i_, j_, station.u_i, station.u_j, station.normal});
        }
        return sides;
    }

private:
    using Vec2 = Eigen::Vector2d;
    struct Station {
        double u_i, u_j;
        Vec3 t_i, t_j, tangent, first, second;  // tangents; axes across, that do not twist from one station to the next
        Vec2 offset;                            // of the centres across, over the touching distance
        Vec3 normal;
    };

    void add_station(const StationPair& pair) {
        Station station;
        station.u_i = pair.u_i, station.u_j = pair.u_j;
        station.t_i = contact_tangent(mesh_, state_, i_, pair.u_i).normalized(),
        station.t_j = contact_tangent(mesh_, state_, j_, pair.u_j).normalized();
        station.tangent = mean_tangent(station.t_i, station.t_j);
        station.first = stations_.empty() ? Vec3(station.tangent.unitOrthogonal())
                                          : turned(stations_.back().first, stations_.back().tangent, station.tangent);
        station.first = (station.first - station.first.dot(station.tangent) * station.tangent).normalized();
        station.second = station.tangent.cross(station.first);
        const Vec3 centres = mesh_.position(state_, j_, pair.u_j) - mesh_.position(state_, i_, pair.u_i);
        station.offset = across(station, centres) / touching_;
        station.normal = unit_or(centres - centres.dot(station.tangent) * station.tangent, station.first);
        stations_.push_back(station);
    }
    static Vec2 across(const Station& station, const Vec3& vector) {
        return {vector.dot(station.first), vector.dot(station.second)};
    }

    void turn_crossing() {
        Station& station = stations_.front();
        const Vec3 normal = station.t_i.cross(station.t_j).normalized();
        const Vec3 centres = mesh_.position(state_, j_, station.u_j) - mesh_.position(state_, i_, station.u_i);
        station.normal = centres.dot(normal) < -vanishing * touching_ ? Vec3(-normal) : normal;
    }

    /// One direction for the stations [from, to), which are deep.
    void turn_run(std::size_t from, std::size_t to) {
        const double n = static_cast<double>(to - from);
        Vec2 sum = Vec2::Zero();
        for (std::size_t k = from; k < to; ++k) sum += stations_[k].offset;
        Vec2 direction = sum;
        const bool open = from > 0 && to < stations_.size();
        if (open) {
            const Vec2 before = stations_[from - 1].offset.normalized(), after = stations_[to].offset.normalized();
            if (before.dot(after) < opposite) {
                const Vec2 way = (after - before).normalized();
                direction -= direction.dot(way) * way;
                if (direction.norm() < vanishing * n) {
                    const Station& middle = stations_[(from + to) / 2];
                    direction = Vec2(-way.y(), way.x());
                    const double turn = across(middle, middle.t_i.cross(middle.t_j)).dot(direction);
                    if (turn < 0.0 || (turn == 0.0 && later())) direction = -direction;
                }
            } else {
                direction += stations_[from - 1].offset + stations_[to].offset;
            }
        }
        if (direction.norm() < vanishing * n) direction = unsaid(from, to);
        direction.normalize();
        for (std::size_t k = from; k < to; ++k)
            stations_[k].normal = direction.x() * stations_[k].first + direction.y() * stations_[k].second;
    }

    /// Where offsets say nothing.
    Vec2 unsaid(std::size_t from, std::size_t to) const {
        Vec2 bend = Vec2::Zero(), both = Vec2::Zero(), own = Vec2::Zero();
        const bool swap = later();
        const Index a = swap ? j_ : i_, b = swap ? i_ : j_;
        const double h = mesh_.fibre(a).element_length;
        for (std::size_t k = from; k < to; ++k) {
            const Station& station = stations_[k];
            const double u_a = swap ? station.u_j : station.u_i, u_b = swap ? station.u_i : station.u_j;
            const Vec3 tangent = swap ? station.t_j : station.t_i;
            bend += across(station, tangent.cross(mesh_.mean_second_derivative(state_, a, u_a))) * touching_ / (h * h);
            const Vec2 first = across(station, mesh_.directors(state_, a, u_a).first);
            own += first, both += first + across(station, mesh_.directors(state_, b, u_b).first);
        }
        constexpr double clear = 1e-3;  // of a station: what is more than rounding of curves and directors
        const double least = clear * static_cast<double>(to - from);
        Vec2 direction = bend.norm() > least ? bend : both.norm() > least ? both : own;
        if (direction.norm() <= least) direction = Vec2::UnitX();
        return swap ? Vec2(-direction) : direction;
    }
    /// Fibre i comes after fibre j, whichever their numbers are unless all else is the same.
    bool later() const {
        const auto rank = [&](Index f) {
            const beam::MeshFibre& fibre = mesh_.fibre(f);
            return std::tuple{fibre.section.radius(), fibre.material.young_modulus, fibre.length()};
        };
        return i_ != j_ && rank(j_) < rank(i_);
    }

    const beam::Mesh<B>& mesh_;
    const Vector& state_;
    std::vector<StationPair> pairs_;
    std::vector<Station> stations_;
    Index i_ = -1, j_ = -1;
    double touching_ = 0.0;
};

}  // namespace fibrant::contact
