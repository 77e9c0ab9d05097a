// SPDX-License-Identifier: MIT
// A member with the name of what an observer is told takes what it is told, be there others or not.
// expect: static assertion failed|static_assert failed
// expect: Watching
// expect: Mistaken
// expect: TakesFigures
// expect: reported|ToldOfIncrements
#include <fibrant/simulation/watching.hpp>

struct Mistaken {
    void accepted(const fibrant::observe::Snapshot&) {}
    void reported(const fibrant::simulation::FailedAttempt&) {}
};
static_assert(fibrant::simulation::Watching<Mistaken>);
