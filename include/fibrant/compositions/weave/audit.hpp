// SPDX-License-Identifier: MIT
#pragma once
/// @file Audit of a settled fabric: every crossing of every two fibres against the pattern, and the true least gap.

#include <fibrant/compositions/weave/tow_geometry.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/observe/least_gap.hpp>
#include <fibrant/observe/swelling.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace fibrant::compositions::weave {

/// A crossing in plan of a warp fibre with a weft fibre.
struct AuditedCrossing {
    Index warp_fibre = -1, weft_fibre = -1;  ///< numbers in the fabric
    Index warp_tow = -1, weft_tow = -1;
    Vec3 position = Vec3::Zero();  ///< half way between the two axes [length]
    double height = 0;             ///< of the axis that should be above over the other, < 0 where the order is wrong [length]
};

/// What a settled weave is judged by: crossings against the pattern.
struct Audit {
    Index crossings = 0;          ///< found
    Index wrong_crossings = 0;    ///< against the pattern
    Index missing_crossings = 0;  ///< pairs of a warp and a weft fibre that do not cross in plan: one slipped out
    double least_height = std::numeric_limits<double>::infinity();  ///< over all crossings [length]
    std::vector<AuditedCrossing> worst;                             ///< the lowest, lowest first
    observe::LeastGap least_gap;
    observe::Swelling swelling;  ///< of sections in turn from node to node

    /// All crossings as the pattern says, and no fibres deeper in each other than allowed [length].
    bool clean(double allowed_penetration) const noexcept {
        return wrong_crossings == 0 && missing_crossings == 0 && least_gap.gap >= -allowed_penetration;
    }
};

/// Checks the crossings alone. Time: pairs of warp and weft fibres times nodes of a fibre.
/// @param keep  how many of the lowest crossings to name
inline Audit audit_crossings(const observe::Snapshot& snapshot, const FabricParameters& fabric, Index keep = 8) {
    require_snapshot_of(snapshot, fabric);
    const Index warps = fabric.warp_tows * fabric.warp.fibres, wefts = fabric.weft_tows * fabric.weft.fibres;
    const auto lower = [](const AuditedCrossing& a, const AuditedCrossing& b) {
        if (a.height != b.height) return a.height < b.height;
        return a.warp_fibre != b.warp_fibre ? a.warp_fibre < b.warp_fibre : a.weft_fibre < b.weft_fibre;
    };
    const auto keep_lowest = [&](std::vector<AuditedCrossing>& crossings) {
        std::sort(crossings.begin(), crossings.end(), lower);
        if (core::count(crossings) > keep) crossings.resize(core::at(keep));
    };
    std::vector<Audit> parts(core::at(warps));  // one a warp fibre, joined in order
    core::parallel_for(warps, [&](Index i) {
        Audit& part = parts[core::at(i)];
        const observe::NodalCurve warp{snapshot.fibres[core::at(i)].position};
        for (Index j = 0; j < wefts; ++j) {
            const observe::NodalCurve weft{snapshot.fibres[core::at(warps + j)].position};
            const Index warp_tow = i / fabric.warp.fibres, weft_tow = j / fabric.weft.fibres;
            const bool over = fabric.pattern.over(warp_tow, weft_tow);
            const Index found = for_each_plan_crossing(warp, weft, [&](const PlanCrossing& crossing) {
                const Vec3 a = warp.position(crossing.warp), b = weft.position(crossing.weft);
                const double height = over ? a.z() - b.z() : b.z() - a.z();
                if (!(height > 0.0)) ++part.wrong_crossings;
                part.worst.push_back({i, warps + j, warp_tow, weft_tow, 0.5 * (a + b), height});
            });
            part.crossings += found;
            if (found == 0) ++part.missing_crossings;
        }
        keep_lowest(part.worst);
    });
    Audit audit;
    for (const Audit& part : parts) {
        audit.crossings += part.crossings;
        audit.wrong_crossings += part.wrong_crossings;
        audit.missing_crossings += part.missing_crossings;
        audit.worst.insert(audit.worst.end(), part.worst.begin(), part.worst.end());
    }
    keep_lowest(audit.worst);
    if (!audit.worst.empty()) audit.least_height = audit.worst.front().height;
    return audit;
}

/// The whole audit.
template <proximity::ProximitySearch Search>
Audit audit(const observe::Snapshot& snapshot, const FabricParameters& fabric, const Search& search, Index keep = 8) {
    Audit answer = audit_crossings(snapshot, fabric, std::max(keep, Index{1}));
    answer.least_gap = least_gap(snapshot, search);
    answer.swelling = observe::greatest_swelling(snapshot);
    return answer;
}

}  // namespace fibrant::compositions::weave
