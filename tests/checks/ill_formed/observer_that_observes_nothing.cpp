// SPDX-License-Identifier: MIT
// What is told of nothing is no observer.
// expect: static assertion failed|static_assert failed
// expect: Watching
// expect: Silent
// expect: accepted
#include <fibrant/simulation/watching.hpp>

struct Silent {
    void acepted(const fibrant::observe::Snapshot&) {}
};
static_assert(fibrant::simulation::Watching<Silent>);
