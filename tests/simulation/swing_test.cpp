// SPDX-License-Identifier: MIT
#include "near.hpp"

#include <fibrant/simulation/swing.hpp>

#include <doctest/doctest.h>

#include <type_traits>

namespace {
using namespace fibrant;
using simulation::Swing;

struct Plain {
    static double product(const Vector& a, const Vector& b) { return a.dot(b); }
    void reset_stresses(const Vector&) { ++reset; }
    int reset = 0;
};

/// Increments that each multiply by m what is left of the way to an end. @returns where the one after `count` of them begins
Vector after(Swing& swing, Plain& plain, double m, int count, const Vector& end, Vector& state) {
    for (int k = 0; k < count; ++k) {
        const Vector next = end + m * (state - end);
        swing.learn(plain, state, next, true);
        state = next;
    }
    return swing.begin(plain, state, true, 0);
}

const Vector end{{1.0, -2.0, 0.5, 3.0}}, start{{1.3, -1.0, 0.4, 3.0}};
}  // namespace

TEST_CASE("loose increments that carry fibres to and fro about their end begin the next one there") {
    for (const double m : {-0.6, -1.0, -1.5}) {
        CAPTURE(m);
        Swing swing;
        Plain plain;
        Vector state = start;
        CHECK(after(swing, plain, m, 1, end, state) == state);  // one motion tells nothing
        CHECK(plain.reset == 0);
        const Vector begin = after(swing, plain, m, 1, end, state);
        CHECK((begin - end).norm() < 1e-14);
        CHECK(plain.reset == 1);
        CHECK(swing.begin(plain, state, true, 1) == state);   // an attempt has failed
        CHECK(swing.begin(plain, state, false, 0) == state);  // one that is exact finds its end itself
        swing.learn(plain, state, begin, false);
        CHECK(swing.begin(plain, begin, true, 0) == begin);
    }
}

TEST_CASE("increments that creep, come to rest or turn aside begin where the last one ended") {
    for (const double m : {0.9, 0.1, 0.0, -0.3}) {
        CAPTURE(m);
        Swing swing;
        Plain plain;
        Vector state = start;
        CHECK(after(swing, plain, m, 4, end, state) == state);
    }
    Swing swing;
    Plain plain;
    const Vector from = start, to = start + Vector{{0.1, 0.0, 0.0, 0.0}}, aside = to + Vector{{-0.1, 0.0, 0.3, 0.0}};
    swing.learn(plain, from, to, true), swing.learn(plain, to, aside, true);
    CHECK(swing.begin(plain, aside, true, 0) == aside);
}

TEST_CASE("what a run keeps of a swing is enough to go on from") {
    Swing swing, again;
    Plain plain;
    Vector state = start;
    const Vector begin = after(swing, plain, -1.2, 2, end, state);
    Vector travel;
    double factor = 0.0;
    const auto get = [&](const auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Vector>)
            travel = value;
        else
            factor = value;
    };
    const Swing& kept = swing;
    kept.each(get);
    again.each([&]<class Value>(Value& value) {
        if constexpr (std::is_same_v<Value, Vector>)
            value = travel;
        else
            value = factor;
    });
    CHECK(again.begin(plain, state, true, 0) == begin);
}
