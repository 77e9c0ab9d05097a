// SPDX-License-Identifier: MIT
#pragma once
/// @file What contacts turned out to be over a step of Newton's method that went too far, for the step after.

#include <fibrant/contact/contact_element.hpp>
#include <fibrant/core/parallel.hpp>

#include <algorithm>
#include <limits>
#include <vector>

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
    void clear() noexcept { ends_.clear(), secants_.clear(), holding_ = 0.0; }
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
        const ContactResponse &now = contacts.responses()[core::at(k)], &end = ends_[core::at(k)];
        return (now.reaction - end.reaction - end.slope * (now.gap - end.gap)) * contacts.elements()[core::at(k)].normal;
    }

    /// To be called with contacts that balance, before their normals turn or their places move.
    template <class Contacts>
    void remember(const Contacts& contacts) {
        remembered_.assign(contacts.responses().begin(), contacts.responses().end());
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
        ends_.swap(remembered_);
        core::parallel_for(
            core::count(now),
            [&](Index k) {
                ContactResponse& end = ends_[core::at(k)];
                if (!(end.slope < now[core::at(k)].slope && now[core::at(k)].gap <= deepest)) end.slope = none;
            },
            core::light_items);
        forget();
    }

    /// To be called at the start of a step, with contacts that have been evaluated there.
    template <class Contacts>
    void begin_step(const Contacts& contacts) {
        ends_.clear();
        for (Secant& one : secants_) one.friction = one.before = kept * one.friction;
        start_.resize(contacts.elements().size());
        core::parallel_for(
            core::count(start_),
            [&](Index k) {
                start_[core::at(k)] = {contacts.force(k), contacts.tangent(k)};
            },
            core::light_items);
    }

    /// To be called where that step, or a part of it, goes too far, with contacts that have been evaluated at its end: the
    /// shortest part says most about where it should have ended.
    /// @param step  of all unknowns
    template <class Contacts>
    void learn(const Contacts& contacts, const Vector& step) {
        ends_.resize(start_.size()), secants_.resize(start_.size());
        core::parallel_for(
            core::count(start_),
            [&](Index k) {
                const auto& element = contacts.elements()[core::at(k)];
                const Start& start = start_[core::at(k)];
                const Vec3 motion = element.motion(step), change = contacts.force(k) - start.force;
                const Vec3 along = motion.dot(element.normal) * element.normal, slip = motion - along;
                Secant& one = secants_[core::at(k)];
                ContactResponse& end = ends_[core::at(k)];
                end = contacts.responses()[core::at(k)];
                if (!(change.dot(along) > along.dot(start.tangent * along))) end.slope = none;
                const double square = slip.squaredNorm(), excess = change.dot(slip) - slip.dot(start.tangent * slip);
                one.friction = one.before;
                if (square > 0.0 && excess > 0.0) one.friction += (excess / (square * square)) * slip * slip.transpose();
            },
            core::light_items);
    }

private:
    struct Start {
        Vec3 force;
        Mat3 tangent;
    };
    struct Secant {  // of friction, and what was left of it when the step began
        Mat3 friction = Mat3::Zero(), before = Mat3::Zero();
    };
    static constexpr double none = std::numeric_limits<double>::infinity();  // slope of what is not taken as closed

    bool closes(Index k) const noexcept { return !ends_.empty() && ends_[core::at(k)].slope < none; }

    std::vector<Start> start_;
    std::vector<ContactResponse> ends_;        // that contacts are taken as closed about; empty where there are none
    std::vector<Secant> secants_;              // empty where no step went too far
    std::vector<ContactResponse> remembered_;  // of contacts that balanced
    double holding_ = 0.0, within_ = 0.0;      // part of its stiffness by which a contact that is so near holds; gap [length]
};

}  // namespace fibrant::contact
