// SPDX-License-Identifier: MIT
#pragma once
/// @file The contract of an observer: what looks at a run without taking part in it.

#include <fibrant/observe/snapshot.hpp>

namespace fibrant::observe {

/// Is shown the state after each accepted increment, in order. A run that is resumed shows the increments that follow
/// the last accepted one; an observer that writes files keeps what they hold of the earlier ones. One that has a member
/// due(number of the increment) is shown only those for which it is true; the others cost no snapshot.
template <class O>
concept Observer = requires(O observer, const Snapshot& snapshot) {
    observer.accepted(snapshot);
};

/// Does a file begin anew, or go on from an interrupted run?
enum class Start { anew, resumed };

}  // namespace fibrant::observe
