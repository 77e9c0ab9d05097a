// SPDX-License-Identifier: MIT
#pragma once
/// @file What loading does to fibres and tows: stretch and curvature of elements, widths and gaps of tows.

#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/compositions/weave/tow_section.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace fibrant::compositions::weave {

/// One number for each element of each fibre, in order.
struct ElementFigures {
    std::vector<double> strain;     ///< arc length over that at rest, less 1 [1]
    std::vector<double> curvature;  ///< mean over the element [1 / length]
};

/// Strain and curvature of each element of the fibres of a snapshot.
inline ElementFigures element_figures(const observe::Snapshot& snapshot) {
    ElementFigures figures;
    for (const observe::FibreSnapshot& fibre : snapshot.fibres) {
        std::vector<Vec3> rest(fibre.position.size());
        for (std::size_t k = 0; k < rest.size(); ++k) rest[k] = fibre.position[k] - fibre.displacement[k];
        const observe::NodalCurve now{fibre.position}, before{rest};
        for (Index e = 0; e < now.elements(); ++e) {
            const double from = 2.0 * static_cast<double>(e), length = now.length(from, from + 2.0);
            double bend = 0.0;
            now.integrate(from, from + 2.0, [&](double t, double weight) { bend += weight * now.curvature(t); });
            figures.strain.push_back(length / before.length(from, from + 2.0) - 1.0);
            figures.curvature.push_back(bend / length);
        }
    }
    return figures;
}

/// Means over the tows of a family, at their crossings [length, 1].
struct TowFigures {
    double width = 0.0, thickness = 0.0, fibre_volume_fraction = 0.0;
    double gap =
        std::numeric_limits<double>::quiet_NaN();  ///< least free distance in plan between neighbouring tows; < 0: they overlap
};

/// Sections lie across the tow's centre line, so widths of a sheared fabric are those of its tows. The gap is taken half way
/// between crossings, where neighbours are side by side, from all fibres of the two.
inline TowFigures tow_figures(const observe::Snapshot& snapshot, const FabricParameters& fabric, Family family) {
    TowFigures figures;
    double count = 0.0;
    for (Index tow = 0; tow < fabric.tows(family); ++tow)
        for (const double t : crossing_parameters(snapshot, fabric, family, tow)) {
            if (!std::isfinite(t)) continue;
            const TowSection section = tow_section(snapshot, fabric, family, tow, t);
            figures.width += section.width, figures.thickness += section.thickness,
                figures.fibre_volume_fraction += section.fibre_volume_fraction;
            count += 1.0;
        }
    if (count > 0.0) figures.width /= count, figures.thickness /= count, figures.fibre_volume_fraction /= count;
    for (Index tow = 0; tow + 1 < fabric.tows(family); ++tow) {
        const std::vector<double> places = crossing_parameters(snapshot, fabric, family, tow);
        const std::vector<Vec3> centre = tow_centreline(snapshot, fabric, family, tow);
        const observe::NodalCurve line{centre};
        for (std::size_t k = 0; k + 1 < places.size(); ++k) {
            const double t = 0.5 * (places[k] + places[k + 1]);
            if (!std::isfinite(t)) continue;
            const Vec3 origin = line.position(t), along = line.tangent(t).normalized();
            Vec3 across = Vec3::UnitZ().cross(along).normalized();
            if (across[axis_of(other(family))] < 0.0) across = -across;
            double most = -std::numeric_limits<double>::infinity(), least = std::numeric_limits<double>::infinity();
            for (const Index which : {tow, tow + 1})
                for (Index f = 0; f < fabric.tow(family).fibres; ++f) {
                    const observe::FibreSnapshot& fibre = snapshot.fibres[core::at(fabric.fibre(family, which, f))];
                    const observe::NodalCurve curve{fibre.position};
                    const auto at = curve.meets(along, along.dot(origin));
                    if (!at) continue;
                    const double place = across.dot(curve.position(*at) - origin),
                                 extent = section_extent(fibre, curve, *at, across);
                    if (which == tow)
                        most = std::max(most, place + extent);
                    else
                        least = std::min(least, place - extent);
                }
            const double gap = least - most;
            if (std::isfinite(gap) && !(figures.gap <= gap)) figures.gap = gap;
        }
    }
    return figures;
}

}  // namespace fibrant::compositions::weave
