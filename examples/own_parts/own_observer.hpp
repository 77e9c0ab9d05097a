// SPDX-License-Identifier: MIT
#pragma once
/// @file An observer of one's own: what friction carries, over what it may.

#include <fibrant/observe/observer.hpp>

/// Sums of the last increment that it was shown.
struct FrictionCarried {
    double reaction = 0.0, friction = 0.0;  // [force]
    void accepted(const fibrant::observe::Snapshot& shot) {
        reaction = friction = 0.0;
        for (const fibrant::observe::ContactSnapshot& contact : shot.contacts)
            reaction += contact.reaction, friction += contact.friction.norm();
    }
};
static_assert(fibrant::observe::Observer<FrictionCarried>);
