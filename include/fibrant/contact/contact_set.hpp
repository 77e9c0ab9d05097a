// SPDX-License-Identifier: MIT
#pragma once
/// @file All contact elements of a mesh, through the three loops.

#include <fibrant/contact/acting_state.hpp>
#include <fibrant/contact/contact_detection.hpp>
#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/contact_figures.hpp>
#include <fibrant/contact/contact_parameters.hpp>
#include <fibrant/contact/contact_record.hpp>
#include <fibrant/contact/element_placing.hpp>
#include <fibrant/contact/followed_places.hpp>
#include <fibrant/contact/pair_rules.hpp>
#include <fibrant/contact/seen_touch.hpp>
#include <fibrant/contact/side_index.hpp>
#include <fibrant/contact/station_pairs.hpp>
#include <fibrant/contact/watched_places.hpp>
#include <fibrant/core/blocks.hpp>
#include <fibrant/core/few_of.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace fibrant::contact {

/// The contacts of a mesh. Orders are by fibres and abscissae: threads change no bit.
template <beam::BeamElement B, proximity::ProximitySearch Search, law::NormalLaw Normal, law::FrictionLaw Friction>
class ContactSet {
public:
    using Element = ContactElement<B, Normal, Friction>;
    using Memory = ContactMemory<Normal, Friction>;

    ContactSet(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const ContactParameters& parameters, Search search,
               Normal normal, Friction friction)
        : mesh_{&mesh},
          parameters_{core::validated(parameters)},
          orders_{assembly, mesh},
          rules_{assembly},
          search_{std::move(search)},
          normal_{normal},
          friction_{friction},
          accepted_{mesh.periods()},
          places_{parameters.places},
          bores_{mesh} {}

    Normal& normal_law() noexcept { return normal_; }
    const Normal& normal_law() const noexcept { return normal_; }
    Friction& friction_law() noexcept { return friction_; }
    ContactParameters& parameters() noexcept { return parameters_; }
    const core::Blocks<Element>& elements() const noexcept { return elements_; }
    const std::vector<ContactResponse>& responses() const noexcept { return responses_; }
    const core::FewOf<law::FrictionAnswer<Friction>>& frictions() const noexcept { return frictions_; }
    const std::vector<Zone>& zones() const noexcept { return zones_; }
    std::vector<Zone>& zones() noexcept { return zones_; }
    const Memory& accepted_memory() const noexcept { return accepted_; }
    const ForcedOrders& orders() const noexcept { return orders_; }
    /// The element's normal is prescribed by a forced order.
    bool forced(const Element& element) const noexcept { return zones_[core::at(element.zone)].forced; }
    double stiffness(const Element& element) const noexcept { return zones_[core::at(element.zone)].stiffness; }

    /// Outer loop: zones, stations, particles anew, with what contacts remember.
    /// @param state     current
    /// @param accepted  last accepted state: gap shifts and slips count from there
    /// @param reach     beyond touching [length]
    /// @param forced    keep forced orders
    void detect(const Vector& state, const Vector& accepted, double reach, bool forced) {
        std::vector<Zone> all = find_zones(*mesh_, state, search_, parameters_.detection, orders_, reach, forced);
        const ZonesOfFibres of(all);
        core::parallel_for(
            core::count(all), [&](Index z) { inherit(all[core::at(z)], state, of); }, core::light_items);
        zones_ = std::move(all);
        regenerate(state, accepted);
    }

    /// Contact elements anew in zones that stand.
    void regenerate(const Vector& state, const Vector& accepted) {
        const Memory last(accepted_.periods(), records(state));
        const Memory& memory = last.records().empty() ? accepted_ : last;
        bores_.keep(acting(state, accepted));
        ValleyStations<B>::join(*mesh_, acting(state, accepted), parameters_.spacing, memory, zones_);
        generate(state, accepted, memory, acting(state, accepted));
        places_.number(elements_, zones_, accepted);
        for_elements([&](Index k) {
            if (slides(k)) follow(k, state);
        });
        sides_.build(mesh_->line_count(), elements_);
    }

    /// Middle loop: normals and particles at the same stations.
    /// @returns the largest turn of a normal that carries force [radian]
    double refresh(const Vector& state, const Vector& accepted) {
        std::vector<double> turned(elements_.size(), 0.0);
        const Vector& acting = this->acting(state, accepted);
        for_elements([&](Index k) {
            Element& element = elements_[core::at(k)];
            const Vec3 before = element.in_bore() ? plane(k) : element.normal;
            if (!slides(k)) placing().place(element, zones_[core::at(element.zone)], acting, state, accepted, before);
            const double turn = slides(k) ? follow(k, state) : turn_between(before, element.normal);
            if (k < core::count(responses_) && responses_[core::at(k)].reaction != 0.0) turned[core::at(k)] = turn;
        });
        bores_.keep(acting);
        hold_reactions();
        return turned.empty() ? 0.0 : *std::max_element(turned.begin(), turned.end());
    }

    /// Middle loop: the last reactions bound friction from now on. Its bound held, friction has a convex potential and Newton
    /// does not cycle between stick and slip.
    void hold_reactions() {
        if constexpr (core::Active<Friction>)
            if (!follows())
                for (std::size_t k = 0; k < std::min(elements_.size(), responses_.size()); ++k)
                    elements_[k].friction.bound = friction_bound(normal_, *mesh_, elements_[k], responses_[k]);
    }

    /// Inner loop: gaps, reactions and friction of a state.
    /// @param start  the last accepted one: nothing has slipped, however pairs have turned; twice as deep as its zone was, none
    /// touched, unless contact acts within an increment: what it gives then counts from there
    void evaluate(const Vector& state, bool start = false) {
        core::resize_anew(responses_, elements_.size());
        const Vector& acting = acting_.of(normal_, state);
        frictions_.fill(elements_.size(), [&](Index k, [[maybe_unused]] auto& friction) {
            Element& element = elements_[core::at(k)];
            const Zone& zone = zones_[core::at(element.zone)];
            if (slides(k) && !start) places_.follow(*mesh_, state, zone, element);
            if (element.in_bore()) bores_.turn(*mesh_, acting, element);
            if (slides(k))
                places_.take(*mesh_, state, zone, element);
            else
                follow_particles(*mesh_, state, element);
            const double apart = element.gap(state) - zone.unseen;
            const bool none = start && apart < -2.0 * zone.deepest && !acting_.within(normal_);
            const double gap = (none ? 0.0 : apart) + element.shift.value();
            const law::NormalResponse response = normal_answer(normal_, *mesh_, element, gap, zone.stiffness);
            responses_[core::at(k)] = {gap, response.reaction, response.slope};
            act_within(*mesh_, normal_, state, acting, element);
            if constexpr (core::Active<Friction>) {
                if (!carries(k)) return false;
                Vec3 slip = Vec3::Zero();
                if (!start) slip = element.friction_offset(state) - element.friction.accepted_offset;
                slip -= slip.dot(plane(k)) * plane(k);
                const double bound = none ? 0.0 : standing_bound(normal_, *mesh_, element, responses_[core::at(k)]);
                friction = friction_answer(friction_, *mesh_, element, slip, zone.friction_factor, bound);
            }
            return core::Active<Friction>;
        });
    }

    /// Fibres along each other as they stood in another state; `turn_forth` takes it back.
    auto turn_back(const Vector& start) {
        std::vector<std::pair<Vec3, MeetingPoint<B>>> present;
        present.reserve(elements_.size());
        for (const Element& element : elements_) present.emplace_back(element.normal, element.meeting);
        for_elements([&](Index k) {
            Element& element = elements_[core::at(k)];
            if (element.crossing || acting_.within(normal_)) return;
            placing().place_back(element, start);
        });
        return present;
    }
    void turn_forth(const auto& present) {
        for (std::size_t k = 0; k < elements_.size(); ++k) std::tie(elements_[k].normal, elements_[k].meeting) = present[k];
    }

    /// Force of element k on the particle of fibre j, against the internal forces [force].
    Vec3 force(Index k) const noexcept {
        Vec3 sum = -responses_[core::at(k)].reaction * elements_[core::at(k)].normal;
        if constexpr (core::Active<Friction>) sum += frictions_[core::at(k)].force;
        return sum;
    }
    /// Element k exerts a force or may do so at once.
    bool carries(Index k) const noexcept {
        if (responses_[core::at(k)].slope != 0.0 || responses_[core::at(k)].reaction != 0.0) return true;
        if constexpr (core::Active<Friction>) return elements_[core::at(k)].friction.bound > 0.0;
        return false;
    }
    /// Stiffness of element k between particles, symmetric, positive semidefinite, at its friction bound [force / length].
    Mat3 tangent(Index k) const noexcept {
        const Vec3& normal = elements_[core::at(k)].normal;
        return friction_tangent(k) - responses_[core::at(k)].slope * normal * normal.transpose();
    }

    /// Crossings that are followed.
    FollowedPlaces<B>& places() noexcept { return places_; }
    const FollowedPlaces<B>& places() const noexcept { return places_; }
    const BorePass& bores() const noexcept { return bores_; }
    /// Element k is one: its normal force acts on patches, and has a stiffness of its own.
    bool slides(Index k) const noexcept { return elements_[core::at(k)].place >= 0; }
    SlidingStiffness sliding(Index k, bool positive) const {
        const ContactResponse& response = responses_[core::at(k)];
        return places_.stiffness(elements_[core::at(k)], response.reaction, response.slope, positive);
    }
    /// Its normal force acts on centres (bore.hpp).
    bool pushes_centres(Index k) const noexcept { return pushed_at_centres<B> && elements_[core::at(k)].in_bore(); }
    /// Of `force` and `tangent`, what acts on particles.
    Vec3 point_force(Index k) const noexcept {
        const bool all = !slides(k) && !pushes_centres(k);
        return all ? force(k) : Vec3(force(k) + responses_[core::at(k)].reaction * elements_[core::at(k)].normal);
    }
    Mat3 point_tangent(Index k) const noexcept { return slides(k) || pushes_centres(k) ? friction_tangent(k) : tangent(k); }

    /// Present reactions bound friction.
    bool follows() const noexcept { return core::Active<Friction> && parameters_.friction_bound == FrictionBound::following; }
    /// What `tangent` leaves out if the bound follows: slope of friction by the gap [force / length].
    Vec3 friction_by_gap(Index k) const noexcept {
        const ContactResponse& response = responses_[core::at(k)];
        if constexpr (core::Active<Friction>)
            if (follows() && response.reaction > 0.0) return friction_slope<Friction>(response, frictions_[core::at(k)]);
        return Vec3::Zero();
    }

    /// Stiffness of a fibre's sections under their contacts: add(first unknown, weights, stiffness) of rank-one terms.
    template <class Add>
    void section_stiffness_terms(Index fibre, const Vector& state, const Add& add) const {
        for (const std::int32_t side : sides(fibre)) {
            const Index k = side / 2;
            if (slides(k)) continue;
            side_stiffness_term(*mesh_, state, elements_[core::at(k)], side % 2 == 1, responses_[core::at(k)].reaction, add);
        }
    }

    /// Adds contact forces to a residual (internal minus external forces).
    void add_forces(Vector& residual) const {
        core::parallel_for(
            mesh_->line_count(),
            [&](Index f) {
                for (const std::int32_t side : sides(f)) {
                    const Index k = side / 2;
                    if (!carries(k)) continue;
                    const Element& element = elements_[core::at(k)];
                    const bool of_j = side % 2 == 1;
                    const Vec3 value = of_j ? point_force(k) : Vec3(-point_force(k));
                    if (slides(k))
                        spread(places_.of(element), element.normal, of_j ? 1.0 : -1.0, responses_[core::at(k)].reaction,
                               residual);
                    if (pushes_centres(k)) push_centre(*mesh_, element, of_j, responses_[core::at(k)].reaction, residual);
                    beam::spread(of_j ? element.weights_j : element.weights_i, value, of_j ? element.first_j : element.first_i,
                                 residual);
                }
            },
            mesh_->grain());
    }

    const Vector& acting(const auto&... states) { return acting_.of(normal_, states...); }

    /// Of elements, in order.
    std::span<const std::int32_t> sides(Index fibre) const noexcept { return sides_.of(fibre); }

    /// Greatest gap or depth of what carries force [length].
    double misfit() const {
        double most = 0.0;
        for (std::size_t k = 0; k < elements_.size(); ++k)
            if (responses_[k].reaction > 0.0) most = std::max(most, std::abs(responses_[k].gap - elements_[k].shift.value()));
        return most;
    }

    ContactFigures figures(const Vector& state) const { return contact::figures(*this, *mesh_, state); }

    /// That zones adapt to from now on [length], > 0.
    void allow_penetration(double length) {
        parameters_.stiffness.allowed_penetration = length;
        parameters_.stiffness.validate();
    }
    /// Keeps what there is in an accepted state, and adapts stiffness.
    void accept(const Vector& state) {
        accepted_.assign(records(state));
        for (Zone& zone : zones_) {
            double penetration = zone.deepest = 0.0;
            for (Index k = zone.first; k < zone.last; ++k) {
                const Element& element = elements_[core::at(k)];
                penetration = std::max(penetration, adapting_penetration(element, responses_[core::at(k)]));
                zone.deepest = std::max(zone.deepest, element.shift.value() - responses_[core::at(k)].gap);
            }
            zone.stiffness = adapted_stiffness(parameters_.stiffness, normal_, zone.stiffness, zone.reference, penetration,
                                               zone.penetration_factor);
            if (zone.deepest == 0.0) zone.unseen = 0.0;
        }
        accepted_zones_ = zones_;
    }

    /// To what was accepted.
    void restore() {
        zones_ = accepted_zones_;
        elements_.clear(), responses_.clear(), frictions_.clear();
        sides_.clear(mesh_->line_count());
    }

    const std::vector<Zone>& accepted_zones() const noexcept { return accepted_zones_; }
    /// From a checkpoint: what was accepted last.
    void resume(std::vector<typename Memory::Record> records, std::vector<Zone> zones) {
        accepted_.assign(std::move(records));
        accepted_zones_ = std::move(zones);
        restore();
    }

private:
    void for_elements(const auto& body) const { core::parallel_for(core::count(elements_), body, core::light_items); }

    void inherit(Zone& zone, const Vector& state, const ZonesOfFibres& all) const {
        rules_.apply(zone);
        const Zone* before = predecessor(zones_, zone.span, 1.0, accepted_.periods());
        keep_watch(zone, before);
        zone.stiffness = before ? before->stiffness : parameters_.stiffness.initial_fraction * zone.reference;
        if (!accepted_zones_.empty()) zone.deepest = before ? before->deepest : 0.0;
        if (zone.forced || bore_between(*mesh_, zone.span.fibre_i, zone.span.fibre_j) != no_bore) return;
        places_.mark(*mesh_, state, zone, before, all);
        const double angle = crossing_angle_deg(*mesh_, state, zone.span, !zone.followed);
        const double shift = !before ? 0.0 : parameters_.spacing.angle_hysteresis_deg * (before->crossing ? -1.0 : 1.0);
        zone.crossing = angle > places_.angle_share(zone) * (parameters_.spacing.crossing_angle_deg + shift);
    }

    void generate(const Vector& end, const Vector& accepted, const Memory& memory, const Vector& state) {
        elements_.clear();
        // Some zones at a time: what they make is not twice in memory.
        const Index some = std::max<Index>(512, core::count(zones_) / 64);
        for (Index first = 0; first < core::count(zones_); first += some)
            generate(first, std::min(core::count(zones_), first + some), end, accepted, memory, state);
        elements_.trim();
    }
    /// Of zones [from, to).
    void generate(Index from, Index to, const Vector& end, const Vector& accepted, const Memory& memory, const Vector& state) {
        constexpr Index block = 8;  // zones
        const Index blocks = (to - from + block - 1) / block;
        std::vector<std::vector<Element>> made(core::at(blocks));
        const double forced_keep = 0.5;  // radii apart, from which a forced pair needs no element
        core::parallel_for<core::Share::turns>(
            blocks,
            [&](Index b) {
                std::vector<StationPair> pairs;
                for (Index z = from + b * block; z < std::min(to, from + (b + 1) * block); ++z) {
                    Zone& zone = zones_[core::at(z)];
                    pairs.clear();
                    station_pairs(*mesh_, state, zone.span, zone.crossing, parameters_.spacing, pairs,
                                  [&](const auto& see) { memory.visit_places(zone.span, see); });
                    zone.first = core::count(made[core::at(b)]);
                    if (!pairs.empty() && is_followed(pairs.back(), zone))
                        ValleyStations<B>::settle(*mesh_, state, zone, memory, pairs);
                    add_watched(zone, pairs);
                    for (const StationPair& pair : pairs) {
                        Element element = make(zone, z, pair);
                        const auto* record = memory.nearest(zone.span.fibre_i, zone.span.fibre_j, pair.u_i, pair.u_j, 1.5);
                        Vec3 remembered = record ? record->normal : Vec3(Vec3::Zero());
                        if (zone.order >= 0 && (zone.forced || !record))
                            remembered = orders_.direction(zone.order, zone.span.fibre_i);
                        const PairTangents tangents = placing().place(element, zone, state, end, accepted, remembered);
                        if (zone.forced && element.gap(state) > forced_keep * mesh_->fibre(zone.span.fibre_i).section.radius())
                            continue;
                        if constexpr (core::Active<Friction>) recall_friction(element, tangents);
                        made[core::at(b)].push_back(element);
                    }
                    zone.last = core::count(made[core::at(b)]);
                    see_lengths(*mesh_, std::span<Element>(made[core::at(b)]).subspan(core::at(zone.first)));
                    if constexpr (law::Augmenting<Normal>) {
                        const auto first = made[core::at(b)].begin() + zone.first;
                        hand_multipliers(memory, zone.span, std::span<Element>(first, made[core::at(b)].end()));
                        for (auto element = first; element != made[core::at(b)].end(); ++element)
                            element->shift.shift = -normal_.penetration(element->shift.multiplier, zone.stiffness);
                    }
                }
            },
            core::light_items / block);
        for (Index b = 0, offset = core::count(elements_); b < blocks; offset += core::count(made[core::at(b++)])) {
            for (Index z = from + b * block; z < std::min(to, from + (b + 1) * block); ++z)
                zones_[core::at(z)].first += offset, zones_[core::at(z)].last += offset;
        }
        elements_.append(made);
    }

    /// The closest patches, and where friction acts until normals are renewed. @returns its turn [radian]
    double follow(Index k, const Vector& state) {
        Element& element = elements_[core::at(k)];
        const Zone& zone = zones_[core::at(element.zone)];
        places_.follow(*mesh_, state, zone, element);
        places_.host(*mesh_, element);
        const PairTangents tangents = pair_tangents(*mesh_, state, element);
        Vec3 before;
        if constexpr (core::Active<Friction> || law::SteppedNormal<Normal>)
            before = places_.normal_in(*mesh_, places_.accepted(), zone, element);
        placing().meet(element, zone, state, tangents, state, places_.accepted(), &before);
        if constexpr (core::Active<Friction>) recall_friction(element, tangents);
        return places_.renew(*mesh_, state, element, core::Active<Friction>);
    }
    /// Normal to an element's friction, and its stiffness.
    Vec3 plane(Index k) const {
        const Element& element = elements_[core::at(k)];
        return slides(k) ? places_.plane(element) : element.in_bore() ? bores_.normal(*mesh_, element) : element.normal;
    }
    Mat3 friction_tangent([[maybe_unused]] Index k) const noexcept {
        if constexpr (core::Active<Friction>) {
            const Mat3 flat = Mat3::Identity() - plane(k) * plane(k).transpose();
            return flat * frictions_[core::at(k)].tangent * flat;
        } else
            return Mat3::Zero();
    }

    Element make(const Zone& zone, Index z, const StationPair& pair) const {
        Element element;
        element.fibre_i = static_cast<std::int32_t>(zone.span.fibre_i);
        element.fibre_j = static_cast<std::int32_t>(zone.span.fibre_j);
        element.zone = static_cast<std::int32_t>(z);
        element.u_i = pair.u_i, element.u_j = pair.u_j;
        element.crossing = pair.crossing, element.slide = pair.slide, element.end_i = pair.end_i, element.end_j = pair.end_j;
        element.place = bore_between(*mesh_, zone.span.fibre_i, zone.span.fibre_j);
        places_.host(*mesh_, element);
        see_length(element, pair);
        return element;
    }

    ElementPlacing<B, Normal, Friction> placing() const noexcept { return {*mesh_, parameters_.normal, normal_}; }

    void recall_friction(Element& element, const PairTangents& tangents) const requires core::Active<Friction> {
        give_friction<Friction>(tangents, element, accepted_.friction(element, 1.5 / parameters_.spacing.points_per_element));
    }

    std::vector<typename Memory::Record> records(const Vector& state) const {
        return records_of<Normal, Friction>(*mesh_, state, elements_, responses_, frictions_);
    }

    const beam::Mesh<B>* mesh_;
    ContactParameters parameters_;
    ForcedOrders orders_;
    PairRules rules_;
    Search search_;
    Normal normal_;
    [[no_unique_address]] Friction friction_;
    std::vector<Zone> zones_, accepted_zones_;
    core::Blocks<Element> elements_;
    std::vector<ContactResponse> responses_;
    core::FewOf<law::FrictionAnswer<Friction>> frictions_;
    SideIndex sides_;
    Memory accepted_;
    FollowedPlaces<B> places_;
    BorePass bores_;
    [[no_unique_address]] ActingState<Normal> acting_;
};

}  // namespace fibrant::contact
