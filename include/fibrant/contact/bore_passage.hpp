// SPDX-License-Identifier: MIT
#pragma once
/// @file Whether a motion takes a fibre out of a tube through its wall.

#include <fibrant/contact/bore.hpp>
#include <fibrant/contact/passed_pair.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace fibrant::contact {

/// Fibres whose axis was in the bore of their tube and comes into its wall in a motion, each particle on a straight line. By an
/// end of the tube they may leave it, and what has left is looked at no more until it comes back by an end.
template <class B>
std::vector<PassedPair> through_walls(const beam::Mesh<B>& mesh, const Vector& from, const Vector& to) {
    constexpr Index points = 2;  // an element
    constexpr double most_steps = 64.0;
    std::vector<PassedPair> passed;
    const auto greatest_motion = [&](Index fibre) {
        double most = 0.0;
        for (Index k = 0; k <= points * mesh.fibre(fibre).elements; ++k) {
            const double u = static_cast<double>(k) / points;
            most = std::max(most, (mesh.position(to, fibre, u) - mesh.position(from, fibre, u)).norm());
        }
        return most;
    };
    for (Index rod = 0; rod < mesh.fibre_count(); ++rod)
        for (const Index tube : mesh.fibre(rod).inside) {
            const double bore = mesh.fibre(tube).section.bore, clear = bore - mesh.fibre(rod).section.radius(),
                         motion = greatest_motion(rod) + greatest_motion(tube);
            std::vector<BorePlace> places;
            std::vector<char> inside;
            const auto in = [&](const BorePlace& place) { return !place.beyond && place.from.norm() < bore; };
            along_bore(mesh, from, tube, rod, points,
                       [&](double, const BorePlace& place) { places.push_back(place), inside.push_back(in(place) ? 1 : 0); });
            // Steps of half a bore: nothing gets out by an end and beside the tube in one of them.
            const double steps = std::clamp(std::ceil(2.0 * motion / bore), 1.0, most_steps);
            PassedPair pair;
            pair.fibre = rod, pair.other = tube, pair.bore = true, pair.motion = motion, pair.touch = 1.0;
            bool out = false;
            Vector state;
            for (double step = 1.0; step <= steps && !out; ++step) {
                const double before = (step - 1.0) / steps;
                state = from + step / steps * (to - from);
                for (std::size_t k = 0; k < places.size(); ++k) {
                    const double u = static_cast<double>(k) / points;
                    const BorePlace now = place_in_bore(mesh, state, tube, mesh.position(state, rod, u), places[k].u);
                    const double distance = now.from.norm();
                    if (inside[k] != 0 && !now.beyond && distance > clear) pair.touch = std::min(pair.touch, before);
                    if (inside[k] != 0 && !now.beyond && distance >= bore && !out) {
                        out = true, pair.time = step / steps, pair.place = mesh.position(state, rod, u);
                        pair.along = u / static_cast<double>(mesh.fibre(rod).elements);
                        pair.along_other = now.u / static_cast<double>(mesh.fibre(tube).elements);
                        pair.left = distance / bore;
                    }
                    places[k] = now, inside[k] = in(now) ? 1 : 0;
                }
            }
            if (out) passed.push_back(pair);
        }
    return passed;
}

}  // namespace fibrant::contact
