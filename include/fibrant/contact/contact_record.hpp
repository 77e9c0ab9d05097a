// SPDX-License-Identifier: MIT
#pragma once
/// @file What is remembered of contacts when contact elements are made anew: normals, and friction on material abscissae.

#include <fibrant/contact/contact_element.hpp>
#include <fibrant/core/ordering.hpp>
#include <fibrant/proximity/proximity_search.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <tuple>
#include <vector>

namespace fibrant::contact {

/// Reversible displacement by components along a direction between the tangents of the fibres and across it, so that it turns by
/// the mean of both turns, whichever of them comes first.
template <law::FrictionLaw Friction>
struct RecordedFriction {};
/// Numbers of a law's history, for laws that have some; nothing otherwise.
template <class History>
struct RecordedNumbers {
    static RecordedNumbers of(const History&) noexcept { return {}; }
    static RecordedNumbers between(const RecordedNumbers&, const RecordedNumbers&, double) noexcept { return {}; }
    void give(History&) const noexcept {}
    static void each(auto&, const auto&) noexcept {}
};
template <class History>
    requires(law::history_numbers<History> > 0)
struct RecordedNumbers<History> {
    std::array<double, law::history_numbers<History>> value{};
    static RecordedNumbers of(const History& history) noexcept { return {history.numbers}; }
    static RecordedNumbers between(const RecordedNumbers& a, const RecordedNumbers& b, double t) noexcept {
        RecordedNumbers mean;
        for (std::size_t k = 0; k < mean.value.size(); ++k) mean.value[k] = (1.0 - t) * a.value[k] + t * b.value[k];
        return mean;
    }
    void give(History& history) const noexcept { history.numbers = value; }
    static void each(auto& self, const auto& see) {
        for (auto& number : self.value) see(number);
    }
};
template <law::FrictionLaw Friction>
    requires core::Active<Friction>
struct RecordedFriction<Friction> {
    double along = 0.0, across = 0.0;  ///< [length]
    double sign = 1.0;                 ///< of the second tangent in the direction between both, 1 or -1
    [[no_unique_address]] RecordedNumbers<typename Friction::History> numbers{};

    /// Of a history. @param plane  that `along` and `across` are of
    template <class Plane>
    static RecordedFriction of(const typename Friction::History& history, const Plane& plane, double sign = 1.0) noexcept {
        return {history.reversible.dot(plane.along), history.reversible.dot(plane.across), sign,
                RecordedNumbers<typename Friction::History>::of(history)};
    }
    template <class Plane>
    void give(const Plane& plane, typename Friction::History& history) const noexcept {
        history.reversible = along * plane.along + across * plane.across;
        numbers.give(history);
    }
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
        if constexpr (core::Active<Friction>) {
            see(self.friction.along), see(self.friction.across), see(self.friction.sign);
            RecordedNumbers<typename Friction::History>::each(self.friction.numbers, see);
        }
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

    ContactMemory() = default;
    /// @param periods  of closed fibres, around which contacts may slip: as beam::Mesh::periods; empty if there are none
    explicit ContactMemory(std::vector<double> periods, std::vector<Record> records = {}) : periods_{std::move(periods)} {
        assign(std::move(records));
    }

    const std::vector<Record>& records() const noexcept { return records_; }
    const std::vector<double>& periods() const noexcept { return periods_; }
    void assign(std::vector<Record> records) {
        records_ = std::move(records);
        if (!std::is_sorted(records_.begin(), records_.end())) core::stable_sort(records_, std::less<>());
        if (!periods_.empty()) mirror();
    }

    /// Nearest record of the pair within `range` on both fibres [elements], or null.
    /// @param aside  what the shorter one of both ways counts, over the longer one [1]
    const Record* nearest(Index i, Index j, double u_i, double u_j, double range, double aside = 0.0) const noexcept {
        const Record* best = nullptr;
        double least = range;
        visit(i, j, u_i, u_j, range, [&](const Record& record, double d_i, double d_j) {
            const double distance = std::max(std::abs(d_i), std::abs(d_j));
            if (distance > range) return;
            const double counted = distance + aside * std::min(std::abs(d_i), std::abs(d_j));
            if (!best || counted < least) least = counted, best = &record;
        });
        return best;
    }

    /// Friction interpolated on the abscissae between the nearest record on either side; a single neighbour within
    /// `range` [elements] gives its own value, and none gives zero. The abscissa is the mean of both fibres', so the
    /// result does not depend on which fibre comes first.
    RecordedFriction<Friction> friction(Index i, Index j, double u_i, double u_j,
                                        double range) const noexcept requires core::Active<Friction> {
        const Record *before = nullptr, *after = nullptr;
        double left = range, right = range;
        visit(i, j, u_i, u_j, 2.0 * range, [&](const Record& record, double d_i, double d_j) {
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
                    (1.0 - t) * before->friction.across + t * after->friction.across, before->friction.sign,
                    RecordedNumbers<typename Friction::History>::between(before->friction.numbers, after->friction.numbers, t)};
        }
        if (before) return before->friction;
        if (after) return after->friction;
        return {};
    }

    /// The same of a contact element. A station of a valley is one that was there, or new.
    template <class Element>
    RecordedFriction<Friction> friction(const Element& element, double range) const noexcept requires core::Active<Friction> {
        const double same = 0.25;  // elements
        if (element.place >= 0) {
            // Beside the middle of two lines that cross, the middle is as near as the first station of the other line.
            const Record* here = nearest(element.fibre_i, element.fibre_j, element.u_i, element.u_j, same, 1.0);
            if (here) return here->friction;
            if (element.slide != 0) return {};
        }
        return friction(element.fibre_i, element.fibre_j, element.u_i, element.u_j, range);
    }

    /// Calls see(record) with the records between the two fibres of a zone, inside its interval of the first one.
    template <class See>
    void visit(const proximity::ProximityZone& zone, const See& see) const noexcept {
        visit(records_, zone.fibre_i, zone.fibre_j, 0.5 * (zone.a_i + zone.b_i), 0.5 * (zone.b_i - zone.a_i), see);
    }
    /// Calls see(u_i, u_j) with where they lie; around closed fibres these are abscissae of the zone.
    template <class See>
    void visit_places(const proximity::ProximityZone& zone, const See& see) const noexcept {
        if (periods_.empty()) return visit(zone, [&](const Record& record) { see(record.u_i, record.u_j); });
        const double middle = 0.5 * (zone.a_i + zone.b_i), period = periods_[core::at(zone.fibre_j)];
        visit(zone.fibre_i, zone.fibre_j, middle, 0.0, 0.5 * (zone.b_i - zone.a_i),
              [&](const Record& record, double d_i, double) {
                  const double u_i = middle + d_i, share = zone.b_i > zone.a_i ? (u_i - zone.a_i) / (zone.b_i - zone.a_i) : 0.5;
                  const double beside = zone.a_j + share * (zone.b_j - zone.a_j);
                  see(u_i, period > 0.0 ? beside + std::remainder(record.u_j - beside, period) : record.u_j);
              });
    }
    /// Calls see(record, d_i, d_j) with the records of two fibres within `range` on the first, in order, and how far they lie
    /// from a pair of abscissae. On one closed fibre a record is also seen with its two particles the other way around, if that
    /// is where it lies near.
    template <class Visit>
    void visit(Index i, Index j, double u_i, double u_j, double range, const Visit& see) const noexcept {
        const double period_i = periods_.empty() ? 0.0 : periods_[core::at(i)],
                     period_j = periods_.empty() ? 0.0 : periods_[core::at(j)];
        if (period_i == 0.0 && period_j == 0.0)
            return visit(records_, i, j, u_i, range,
                         [&](const Record& record) { see(record, record.u_i - u_i, record.u_j - u_j); });
        const double within = period_i > 0.0 ? std::min(range, 0.5 * period_i) : range;
        for (const std::vector<Record>* records : {&records_, &mirrored_}) {
            const auto take = [&](double by) {
                visit(*records, i, j, u_i - by, within, [&](const Record& record) {
                    const double d_j = record.u_j - u_j;
                    see(record, record.u_i + by - u_i, period_j > 0.0 ? std::remainder(d_j, period_j) : d_j);
                });
            };
            if (period_i == 0.0) {
                take(0.0);
                continue;
            }
            // Turns that bring [0, period) within reach; no record twice, but half-way around.
            for (double turn = std::floor((u_i - within) / period_i); turn * period_i <= u_i + within; turn += 1.0)
                take(turn * period_i);
        }
    }

private:
    template <class Visit>
    static void visit(const std::vector<Record>& records, Index i, Index j, double u_i, double range, const Visit& see) noexcept {
        Record first;
        first.fibre_i = static_cast<std::int32_t>(i), first.fibre_j = static_cast<std::int32_t>(j);
        first.u_i = u_i - range, first.u_j = -1.0;
        for (auto it = std::lower_bound(records.begin(), records.end(), first);
             it != records.end() && it->fibre_i == i && it->fibre_j == j && it->u_i <= u_i + range; ++it)
            see(*it);
    }
    /// Records of closed fibres with themselves, the other way around.
    void mirror() {
        mirrored_.clear();
        for (const Record& record : records_) {
            if (record.fibre_i != record.fibre_j || periods_[core::at(Index{record.fibre_i})] == 0.0) continue;
            Record other = record;
            std::swap(other.u_i, other.u_j);
            other.normal = -record.normal;
            if constexpr (core::Active<Friction>) {  // the direction between both tangents is that of the second one
                other.friction.along = -record.friction.sign * record.friction.along;
                other.friction.across = record.friction.sign * record.friction.across;
            }
            mirrored_.push_back(other);
        }
        core::stable_sort(mirrored_, std::less<>());
    }
    std::vector<double> periods_;
    std::vector<Record> records_, mirrored_;
};

/// The same where fibres are closed: of each element the records near it, and of each record the nearest of these elements.
template <class Memory, class Element>
void hand_multipliers_around(const Memory& memory, const proximity::ProximityZone& zone, std::span<Element> elements,
                             double range) {
    struct Near {
        double u_i, u_j, distance, force;  // of the record, as it is kept
        std::size_t element;
    };
    std::vector<Near> all;
    for (std::size_t k = 0; k < elements.size(); ++k)
        memory.visit(zone.fibre_i, zone.fibre_j, elements[k].u_i, elements[k].u_j, range,
                     [&](const auto& record, double d_i, double d_j) {
                         const double distance = std::max(std::abs(d_i), std::abs(d_j));
                         const bool turned = zone.fibre_i == zone.fibre_j && record.u_i > record.u_j;
                         if (distance <= range)
                             all.push_back({turned ? record.u_j : record.u_i, turned ? record.u_i : record.u_j, distance,
                                            record.multiplier.force, k});
                     });
    std::sort(all.begin(), all.end(), [](const Near& a, const Near& b) {
        return std::tie(a.u_i, a.u_j, a.distance, a.element) < std::tie(b.u_i, b.u_j, b.distance, b.element);
    });
    for (std::size_t k = 0; k < all.size(); ++k)
        if (k == 0 || all[k].u_i != all[k - 1].u_i || all[k].u_j != all[k - 1].u_j)
            elements[all[k].element].shift.multiplier += all[k].force;
}

/// Hands each record's multiplier to the nearest of the new elements of its zone: their sum is kept, whatever their spacing.
/// @param elements  of the zone, sorted by u_i
template <class Memory, class Element>
void hand_multipliers(const Memory& memory, const proximity::ProximityZone& zone, std::span<Element> elements) {
    const double range = 1.5;  // elements of the mesh
    if (!memory.periods().empty()) return hand_multipliers_around(memory, zone, elements, range);
    memory.visit(zone, [&](const auto& record) {
        const auto distance = [&](const Element& e) {
            return std::max(std::abs(e.u_i - record.u_i), std::abs(e.u_j - record.u_j));
        };
        auto element = std::lower_bound(elements.begin(), elements.end(), record.u_i - range,
                                        [](const Element& e, double u) { return e.u_i < u; });
        auto nearest = element;
        for (; element != elements.end() && element->u_i <= record.u_i + range; ++element)
            if (distance(*element) < distance(*nearest)) nearest = element;
        if (nearest != elements.end() && distance(*nearest) <= range) nearest->shift.multiplier += record.multiplier.force;
    });
}

}  // namespace fibrant::contact
