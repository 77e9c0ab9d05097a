// SPDX-License-Identifier: MIT
#pragma once
/// @file What contacts turned out to be over a step of Newton's method that went too far, for the step after.

#include <fibrant/contact/contact_element.hpp>
#include <fibrant/core/few_of.hpp>
#include <fibrant/core/parallel.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace fibrant::contact {

/// A contact that closes, or slides back, within a step has a tangent at its start that says nothing of its end: the step goes
/// too far there, and is cut for all. The next step takes the normal reaction of such a contact to be linear about the end of the
/// one that was cut, as if it were closed already, and gives friction its secant in the place of its tangent.
class LearnedContacts {
public:
    /// Part of secants that is left for the step after the next: without any, every other step goes too far again.
    static constexpr double kept = 0.25;
    /// Part of its stiffness by which a contact that is open, but near, holds a fibre to its neighbour, and how near that is. By
    /// trial on 608 fibres at rest: a tenth of the stiffness hides what is out of balance, a thousandth does as well.
    static constexpr double held = 1e-2, near = 0.1, least_held = 1e-2;  // [1], [radius], over the first [1]

    bool empty() const noexcept { return ends_.empty() && secants_.empty() && holding_ == 0.0; }
    void clear() noexcept { start_.clear(), ends_.clear(), secants_.clear(), holding_ = 0.0; }
    /// From the next step on, to be called after a step that had to be cut to a small part. Slack fibres, which hardly anything
    /// touches, send each step far away and are cut for all. In tangents alone they are held to those beside them: they go where
    /// these go, which springs to places would hinder.
    void hold_near(double radius) noexcept { holding_ = held, within_ = near * radius; }
    /// After any other step. As of secants, a part is left for the next one.
    void let_go() noexcept { holding_ = holding_ > least_held * held ? kept * holding_ : 0.0; }

    /// What comes to the tangent of element k, symmetric and positive semidefinite [force / length].
    template <class Contacts>
    Mat3 stiffness(const Contacts& contacts, Index k) const noexcept {
        const ContactResponse& now = contacts.responses()[core::at(k)];
        const auto& element = contacts.elements()[core::at(k)];
        Mat3 sum = secants_.empty() ? Mat3::Zero() : secants_[core::at(k)].friction;
        if (closes(k))
            sum += std::max(0.0, now.slope - ends_[core::at(k)].slope) * element.normal * element.normal.transpose();
        else if (now.slope == 0.0 && holding_ > 0.0 && now.gap < within_)
            sum += holding_ * contacts.stiffness(element) * Mat3::Identity();
        return sum;
    }
    /// What comes to the force of element k [force].
    template <class Contacts>
    Vec3 force(const Contacts& contacts, Index k) const noexcept {
        if (!closes(k)) return Vec3::Zero();
        const ContactResponse& now = contacts.responses()[core::at(k)];
        const End& end = ends_[core::at(k)];
        return (now.reaction - end.reaction - end.slope * (now.gap - end.gap)) * contacts.elements()[core::at(k)].normal;
    }

    /// To be called with contacts that balance, before their normals turn or their places move.
    template <class Contacts>
    void remember(const Contacts& contacts) {
        remembered_.fill(contacts.responses().size(), [&](Index k, ContactResponse& now) {
            now = contacts.responses()[core::at(k)];
            return now.slope != 0.0 || now.reaction != 0.0 || now.gap < 0.0;
        });
    }
    void forget() noexcept { remembered_.clear(); }
    /// To be called once they have, with contacts that have been evaluated. Fibres that slid over each other are a little further
    /// apart than before, and contacts that carried little are open: without them a tangent would let go what they hold. They are
    /// taken to be as they were, for one step; but not those that are further open than the deepest one was deep.
    template <class Contacts>
    void carry(const Contacts& contacts) {
        const auto& now = contacts.responses();
        if (remembered_.size() != now.size() || now.empty()) return forget();
        const double deepest = core::largest(core::count(now), 0.0, [&](Index k) { return -remembered_[core::at(k)].gap; });
        ends_.fill(now.size(), [&](Index k, End& end) {
            const ContactResponse& before = remembered_[core::at(k)];
            end = {before.gap, before.reaction, before.slope};
            return before.slope < now[core::at(k)].slope && now[core::at(k)].gap <= deepest;
        });
        forget();
    }

    /// To be called at the start of a step, with contacts that have been evaluated there.
    template <class Contacts>
    void begin_step(const Contacts& contacts) {
        ends_.clear();
        secants_.change([](Secant& one) { one.friction = one.before = kept * one.friction; });
        start_.fill(contacts.elements().size(), [&](Index k, Start& start) {
            start = {contacts.force(k), contacts.tangent(k)};
            return !start.force.isZero(0.0) || !start.tangent.isZero(0.0);
        });
    }

    /// To be called where that step, or a part of it, goes too far, with contacts that have been evaluated at its end: the
    /// shortest part says most about where it should have ended.
    /// @param step  of all unknowns
    template <class Contacts>
    void learn(const Contacts& contacts, const Vector& step) {
        struct Way {
            Vec3 along, slip, change;  // of the particles, and of the force
        };
        const auto way = [&](Index k) {
            const auto& element = contacts.elements()[core::at(k)];
            const Vec3 motion = element.motion(step), along = motion.dot(element.normal) * element.normal;
            return Way{along, motion - along, contacts.force(k) - start_[core::at(k)].force};
        };
        ends_.fill(start_.size(), [&](Index k, End& end) {
            const auto [along, slip, change] = way(k);
            const ContactResponse& now = contacts.responses()[core::at(k)];
            end = {now.gap, now.reaction, now.slope};
            return change.dot(along) > along.dot(start_[core::at(k)].tangent * along);
        });
        core::FewOf<Secant> secants;
        secants.fill(start_.size(), [&](Index k, Secant& one) {
            const auto [along, slip, change] = way(k);
            const double square = slip.squaredNorm(), excess = change.dot(slip) - slip.dot(start_[core::at(k)].tangent * slip);
            if (!secants_.empty()) one.friction = one.before = secants_[core::at(k)].before;
            if (square > 0.0 && excess > 0.0) one.friction += (excess / (square * square)) * slip * slip.transpose();
            return !one.friction.isZero(0.0);
        });
        secants_ = std::move(secants);
    }

private:
    struct Start {
        Vec3 force = Vec3::Zero();
        Mat3 tangent = Mat3::Zero();
    };
    struct Secant {  // of friction, and what was left of it when the step began
        Mat3 friction = Mat3::Zero(), before = Mat3::Zero();
    };
    static constexpr double none = std::numeric_limits<double>::infinity();  // slope of what is not taken as closed
    struct End {  // that a contact is taken as closed about: as ContactResponse
        double gap = 0.0, reaction = 0.0, slope = none;
    };

    bool closes(Index k) const noexcept { return !ends_.empty() && ends_[core::at(k)].slope < none; }

    core::FewOf<Start> start_;                 // of those that carried
    core::FewOf<End> ends_;                    // empty where there are none
    core::FewOf<Secant> secants_;              // empty where no step went too far
    core::FewOf<ContactResponse> remembered_;  // of contacts that balanced
    double holding_ = 0.0, within_ = 0.0;      // part of its stiffness by which a contact that is so near holds; gap [length]
};

}  // namespace fibrant::contact
