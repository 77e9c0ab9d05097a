// SPDX-License-Identifier: MIT
#pragma once
/// @file What is remembered of contacts when contact elements are made anew: normals, and friction on material abscissae.

#include <fibrant/contact/contact_element.hpp>
#include <fibrant/proximity/proximity_search.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace fibrant::contact {

/// Reversible displacement by components along a direction between the tangents of the fibres and across it, so that it turns by the
/// mean of both turns, whichever of them comes first.
template <law::FrictionLaw Friction>
struct RecordedFriction {};
template <law::FrictionLaw Friction>
    requires core::Active<Friction>
struct RecordedFriction<Friction> {
    double along = 0.0, across = 0.0;  ///< [length]
    double sign = 1.0;                 ///< of the second tangent in the direction between both, 1 or -1
};

/// Multiplier, for laws that have one; nothing otherwise.
template <law::NormalLaw Normal>
struct RecordedMultiplier {};
template <law::Augmenting Normal>
struct RecordedMultiplier<Normal> {
    double force = 0.0;  ///< reaction of the last evaluation [force]
};

/// One contact element of the past. Records are sorted by pair of fibres, then by abscissa on fibre i.
template <law::NormalLaw Normal, law::FrictionLaw Friction>
struct ContactRecord {
    std::int32_t fibre_i = -1, fibre_j = -1;
    double u_i = 0.0, u_j = 0.0;
    Vec3 normal = Vec3::Zero();
    [[no_unique_address]] RecordedMultiplier<Normal> multiplier;
    [[no_unique_address]] RecordedFriction<Friction> friction;

    /// Calls see(number) with each number of the record, in a fixed order: for files.
    template <class See>
    void each(const See& see) {
        visit_numbers(*this, see);
    }
    template <class See>
    void each(const See& see) const {
        visit_numbers(*this, see);
    }

    friend bool operator<(const ContactRecord& a, const ContactRecord& b) noexcept {
        return std::tie(a.fibre_i, a.fibre_j, a.u_i, a.u_j) < std::tie(b.fibre_i, b.fibre_j, b.u_i, b.u_j);
    }

private:
    template <class Self, class See>
    static void visit_numbers(Self& self, const See& see) {
        see(self.fibre_i), see(self.fibre_j), see(self.u_i), see(self.u_j);
        see(self.normal.x()), see(self.normal.y()), see(self.normal.z());
        if constexpr (law::Augmenting<Normal>) see(self.multiplier.force);
        if constexpr (core::Active<Friction>) see(self.friction.along), see(self.friction.across), see(self.friction.sign);
    }
};

/// Unit vectors of the tangent plane: along a direction, and across it.
struct TangentPlane {
    Vec3 along, across;
    TangentPlane(const Vec3& tangent, const Vec3& normal) {
        along = tangent - tangent.dot(normal) * normal;
        const double size = along.norm();
        if (size > 1e-6) {
            along /= size;
        } else {  // the contact is with the end of the fibre: any fixed direction of the plane
            along = normal.unitOrthogonal();
        }
        across = normal.cross(along);
    }
};

/// Reads the memory of contacts at a new pair of stations.
template <law::NormalLaw Normal, law::FrictionLaw Friction>
class ContactMemory {
public:
    using Record = ContactRecord<Normal, Friction>;

    const std::vector<Record>& records() const noexcept { return records_; }
    void assign(std::vector<Record> records) {
        records_ = std::move(records);
        if (!std::is_sorted(records_.begin(), records_.end())) std::stable_sort(records_.begin(), records_.end());
    }

    /// Nearest record of the pair within `range` on both fibres [elements], or null.
    const Record* nearest(Index i, Index j, double u_i, double u_j, double range) const noexcept {
        const Record* best = nullptr;
        double least = range;
        visit(i, j, u_i, range, [&](const Record& record) {
            const double distance = std::max(std::abs(record.u_i - u_i), std::abs(record.u_j - u_j));
            if (distance <= least && (!best || distance < least)) least = distance, best = &record;
        });
        return best;
    }

    /// Friction interpolated on the abscissae between the nearest record on either side; a single neighbour within
    /// `range` [elements] gives its own value, and none gives zero. The abscissa is the mean of both fibres', so the
    /// result does not depend on which fibre comes first.
    RecordedFriction<Friction> friction(Index i, Index j, double u_i, double u_j, double range) const noexcept
        requires core::Active<Friction>
    {
        const Record *before = nullptr, *after = nullptr;
        double left = range, right = range;
        visit(i, j, u_i, 2.0 * range, [&](const Record& record) {
            const double d_i = record.u_i - u_i, d_j = record.u_j - u_j;
            if (std::max(std::abs(d_i), std::abs(d_j)) > 2.0 * range) return;
            const double signed_mean = std::copysign(0.5 * (std::abs(d_i) + std::abs(d_j)), d_i != 0.0 ? d_i : d_j);
            if (signed_mean <= 0.0 && -signed_mean < left) left = -signed_mean, before = &record;
            if (signed_mean > 0.0 && signed_mean < right) right = signed_mean, after = &record;
        });
        if (before && after && before->friction.sign != after->friction.sign) {  // not of one line of contact
            (left <= right ? after : before) = nullptr;
        }
        if (before && after) {
            const double t = left + right > 0.0 ? left / (left + right) : 0.0;
            return {(1.0 - t) * before->friction.along + t * after->friction.along,
                    (1.0 - t) * before->friction.across + t * after->friction.across, before->friction.sign};
        }
        if (before) return before->friction;
        if (after) return after->friction;
        return {};
    }

    /// Calls see(record) with the records between the two fibres of a zone, inside its interval of the first one.
    template <class See>
    void visit(const proximity::ProximityZone& zone, const See& see) const noexcept {
        visit(zone.fibre_i, zone.fibre_j, 0.5 * (zone.a_i + zone.b_i), 0.5 * (zone.b_i - zone.a_i), see);
    }

private:
    template <class Visit>
    void visit(Index i, Index j, double u_i, double range, const Visit& see) const noexcept {
        Record first;
        first.fibre_i = static_cast<std::int32_t>(i), first.fibre_j = static_cast<std::int32_t>(j);
        first.u_i = u_i - range, first.u_j = -1.0;
        for (auto it = std::lower_bound(records_.begin(), records_.end(), first);
             it != records_.end() && it->fibre_i == i && it->fibre_j == j && it->u_i <= u_i + range; ++it)
            see(*it);
    }
    std::vector<Record> records_;
};

/// Hands each record's multiplier to the nearest of the new elements of its zone: their sum is kept, whatever their spacing.
/// @param elements  of the zone, sorted by u_i
template <class Memory, class Element>
void hand_multipliers(const Memory& memory, const proximity::ProximityZone& zone, std::span<Element> elements) {
    const double range = 1.5;  // elements of the mesh
    memory.visit(zone, [&](const auto& record) {
        const auto distance = [&](const Element& e) { return std::max(std::abs(e.u_i - record.u_i), std::abs(e.u_j - record.u_j)); };
        auto element = std::lower_bound(elements.begin(), elements.end(), record.u_i - range,
                                        [](const Element& e, double u) { return e.u_i < u; });
        auto nearest = element;
        for (; element != elements.end() && element->u_i <= record.u_i + range; ++element)
            if (distance(*element) < distance(*nearest)) nearest = element;
        if (nearest != elements.end() && distance(*nearest) <= range) nearest->shift.multiplier += record.multiplier.force;
    });
}

}  // namespace fibrant::contact
