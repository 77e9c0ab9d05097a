// SPDX-License-Identifier: MIT
#pragma once
/// @file What a run takes for an observer: something that is told of snapshots, figures or failures, and of nothing by another
/// name.

#include <fibrant/observe/observer.hpp>
#include <fibrant/simulation/report.hpp>

#include <type_traits>

namespace fibrant::simulation {

/// What an observer may be told of besides snapshots, and how it chooses.
template <class O>
concept ToldOfIncrements = requires(O& observer, const IncrementReport& increment) {
    observer.reported(increment);
};
template <class O>
concept ToldOfFailures = requires(O& observer, const FailedAttempt& attempt) {
    observer.gave_up(attempt);
};
template <class O>
concept ChoosesIncrements = requires(O& observer, Index number) {
    { observer.due(number) } -> std::convertible_to<bool>;
};

namespace detail {
struct Names {
    int accepted, reported, gave_up, due;
};
template <class O>
struct AndNames : O, Names {};
template <class O>
concept Open = std::is_class_v<O> && !std::is_final_v<O>;
// A name that a type has beside one of Names is ambiguous.
template <class O>
concept HasAccepted = Open<O> && !requires {
    &AndNames<O>::accepted;
};
template <class O>
concept HasReported = Open<O> && !requires {
    &AndNames<O>::reported;
};
template <class O>
concept HasGaveUp = Open<O> && !requires {
    &AndNames<O>::gave_up;
};
template <class O>
concept HasDue = Open<O> && !requires {
    &AndNames<O>::due;
};
}  // namespace detail

/// A member that has the name of what an observer is told has to take what it is told.
template <class O>
concept TakesSnapshots = observe::Observer<O> || !detail::HasAccepted<std::remove_const_t<O>>;
template <class O>
concept TakesFigures = ToldOfIncrements<O> || !detail::HasReported<std::remove_const_t<O>>;
template <class O>
concept TakesFailures = ToldOfFailures<O> || !detail::HasGaveUp<std::remove_const_t<O>>;
template <class O>
concept TakesNumbers = ChoosesIncrements<O> || !detail::HasDue<std::remove_const_t<O>>;

/// Has at least one of accepted(const observe::Snapshot&), reported(const IncrementReport&), gave_up(const FailedAttempt&); with
/// due(number of the increment) it chooses.
template <class O>
concept Watching = TakesSnapshots<O> && TakesFigures<O> && TakesFailures<O> && TakesNumbers<O> &&(
    requires(O& observer, const observe::Snapshot& shot) { observer.accepted(shot); } ||
    requires(O & observer, const IncrementReport& increment) { observer.reported(increment); } ||
    requires(O & observer, const FailedAttempt& attempt) { observer.gave_up(attempt); });

/// Any observer, by reference: what it is not told of is null.
struct Watcher {
    const void* observer;
    void (*accepted)(const void*, const observe::Snapshot&) = nullptr;
    void (*reported)(const void*, const IncrementReport&) = nullptr;
    void (*gave_up)(const void*, const FailedAttempt&) = nullptr;
    bool (*due)(const void*, Index) = nullptr;

    template <Watching O>
    explicit Watcher(O& one) noexcept : observer{&one} {
        if constexpr (observe::Observer<O>)
            accepted = [](const void* of, const observe::Snapshot& shot) { self<O>(of).accepted(shot); };
        if constexpr (ToldOfIncrements<O>)
            reported = [](const void* of, const IncrementReport& increment) { self<O>(of).reported(increment); };
        if constexpr (ToldOfFailures<O>)
            gave_up = [](const void* of, const FailedAttempt& attempt) { self<O>(of).gave_up(attempt); };
        if constexpr (ChoosesIncrements<O>) due = [](const void* of, Index number) -> bool { return self<O>(of).due(number); };
    }

private:
    template <class O>
    static O& self(const void* of) noexcept {
        return *static_cast<O*>(const_cast<void*>(of));
    }  // as it was given
};

}  // namespace fibrant::simulation
