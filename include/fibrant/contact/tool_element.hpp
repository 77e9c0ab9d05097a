// SPDX-License-Identifier: MIT
#pragma once
/// @file A contact element between a fibre and a rigid tool, and what is remembered of it.

#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/contact_record.hpp>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

namespace fibrant::contact {

/// What fibres exert on a tool.
struct ToolReaction {
    Vec3 force = Vec3::Zero();   ///< [force]
    Vec3 moment = Vec3::Zero();  ///< about the tool's origin as it stands [force * length]
};

/// A particle of a fibre that may touch a tool. Normals and the plane that stands for the tool's surface are kept while Newton
/// iterates, as those between fibres are.
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
struct ToolElement {
    double u = 0.0;                                 ///< abscissa, in elements
    beam::Particle<B> weights{};                    ///< of the nodal vectors of the fibre's element
    Vec3 normal = Vec3::Zero();                     ///< away from the tool
    Vec3 foot = Vec3::Zero();                       ///< point of the tool that the particle is above [length]
    double cap = 0.0;                               ///< radius of a fibre's end, taken off the gap [length]
    std::int32_t fibre = -1, tool = -1, first = 0;  ///< first unknown of the fibre's element
    std::int32_t station = 0;                       ///< of the fibre: stations stand at the same material for ever
    bool end = false;                               ///< the rounded end of the fibre touches, not its side
    [[no_unique_address]] GapShift<Normal> shift;
    [[no_unique_address]] FrictionState<B, Friction> friction;

    Vec3 offset(const Vector& state) const noexcept { return beam::Mesh<B>::point(state, first, weights) - foot; }
    /// True gap, < 0 in penetration [length].
    double gap(const Vector& state) const noexcept { return normal.dot(offset(state)) - cap; }
};

/// What is remembered of a ToolElement.
template <law::NormalLaw Normal, law::FrictionLaw Friction>
struct ToolRecord {
    std::int32_t fibre = -1, tool = -1, station = 0;
    double multiplier = 0.0;  ///< its reaction, which an augmented law starts from and friction is bounded by [force]
    [[no_unique_address]] RecordedFriction<Friction> friction;

    /// Calls see(number) with each number of the record, in a fixed order: for files.
    template <class Self, class See>
    static void each(Self& self, const See& see) {
        see(self.fibre), see(self.tool), see(self.station), see(self.multiplier);
        if constexpr (core::Active<Friction>) {
            see(self.friction.along), see(self.friction.across);
            RecordedNumbers<typename Friction::History>::each(self.friction.numbers, see);
        }
    }
    /// Of an element, with nothing remembered yet.
    static ToolRecord key_of(const auto& element) {
        ToolRecord key;
        key.fibre = element.fibre, key.tool = element.tool, key.station = element.station;
        return key;
    }
    /// The record of a key among ordered ones; null if there is none.
    static const ToolRecord* find(const std::vector<ToolRecord>& records, const ToolRecord& key) {
        const auto found = std::lower_bound(records.begin(), records.end(), key);
        return found != records.end() && !(key < *found) ? &*found : nullptr;
    }
    friend bool operator<(const ToolRecord& a, const ToolRecord& b) noexcept {
        return std::tie(a.fibre, a.tool, a.station) < std::tie(b.fibre, b.tool, b.station);
    }
};

}  // namespace fibrant::contact
