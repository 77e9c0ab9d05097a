// SPDX-License-Identifier: MIT
#pragma once
/// @file Pictures of a fabric: cuts through the middle of every tow, and colours that tell warp from weft.

#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/observe/svg_slice.hpp>

#include <string>
#include <vector>

namespace fibrant::compositions::weave {

/// Warp in two blues, weft in two ochres, neighbouring tows in different ones.
inline observe::Palette fabric_palette(const FabricParameters& fabric) {
    observe::Palette palette;
    for (Index number = 0; number < fabric.fibres(); ++number) {
        const FibrePlace place = fabric.place(number);
        const bool even = place.tow % 2 == 0;
        palette.fibres.push_back(place.family == Family::warp
                                     ? (even ? observe::Colour{0.36, 0.60, 0.80} : observe::Colour{0.27, 0.49, 0.72})
                                     : (even ? observe::Colour{0.92, 0.68, 0.36} : observe::Colour{0.85, 0.55, 0.25}));
    }
    return palette;
}

/// A picture of a tow cut along its middle.
struct TowSlice {
    std::string name;  ///< "warp_0", "weft_3"
    std::string svg;
};

/// Cuts along every tow, by the plane across the fabric that holds the middle of the tow. The tows of the other family
/// show their cross-sections.
/// @param unit  of lengths, for the scale bar
inline std::vector<TowSlice> tow_slices(const observe::Snapshot& snapshot, const FabricParameters& fabric,
                                        const std::string& unit) {
    require_snapshot_of(snapshot, fabric);
    std::vector<TowSlice> slices;
    for (const Family family : {Family::warp, Family::weft}) {
        for (Index tow = 0; tow < fabric.tows(family); ++tow) {
            const Index axis = axis_of(other(family));
            double middle = 0.0;
            const std::vector<Vec3> nodes = tow_centreline(snapshot, fabric, family, tow);
            for (const Vec3& node : nodes) middle += node[axis];
            const std::string number = std::to_string(tow), name = name_of(family);
            observe::SliceParameters parameters;
            parameters.axis = axis;
            parameters.position = middle / static_cast<double>(nodes.size());
            parameters.title = "along " + name + " tow " + number;
            parameters.unit = unit;
            parameters.palette = fabric_palette(fabric);
            slices.push_back({name + "_" + number, observe::svg_slice(snapshot, parameters)});
        }
    }
    return slices;
}

}  // namespace fibrant::compositions::weave
