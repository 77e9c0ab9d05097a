// SPDX-License-Identifier: MIT
// A term that does not say what it lacks has it: a verb that is misspelt is missing.
// expect: static assertion failed|static_assert failed
// expect: Remembering
// expect: Forgetful
// expect: accept
#include <fibrant/term/term.hpp>

using namespace fibrant;

struct Forgetful : term::NoDrive, term::NoSearch, term::NoStiffness, term::NoEnergy, term::NoPicture {
    static constexpr auto role = term::Role::external;
    struct Parameters {};
    struct Slot {
        Parameters forgetful{};
    };
    void add_forces(const Vector&, Vector&) const {}
    void acept(const Vector&) {}
    void restore() {}
    void each(const auto&) {}
};
static_assert(term::Term<Forgetful>);
