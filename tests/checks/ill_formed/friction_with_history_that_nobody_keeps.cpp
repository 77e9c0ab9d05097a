// SPDX-License-Identifier: MIT
// Contacts keep the reversible displacement of a history: a law that remembers more would find it empty.
// expect: static assertion failed|static_assert failed
// expect: HistoryIsKept
// expect: Wearing
#include <fibrant/law/friction_law.hpp>

using namespace fibrant;

struct Wearing {
    using Parameters = core::NoParameters;
    struct History {
        Vec3 reversible = Vec3::Zero();
        double worn = 0.0;
    };
    explicit Wearing(const Parameters& = {}) {}
    law::FrictionResponse<History> response(const Vec3&, double, const History&) const { return {}; }
};
static_assert(law::FrictionLaw<Wearing>);
static_assert(law::HistoryIsKept<Wearing>);
