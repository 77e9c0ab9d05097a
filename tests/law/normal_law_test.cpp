// SPDX-License-Identifier: MIT
#include <fibrant/inertia/time_integrator.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/law/impact.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/linear_penalty.hpp>
#include <fibrant/law/regularised_penalty.hpp>

#include <law/normal_law_contract.hpp>
#include <near.hpp>
#include <refusal.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

using namespace fibrant;

namespace normal_law_test {

using law::LimitedGap;
using law::LinearPenalty;
using law::RegularisedPenalty;

TEST_CASE("a normal law pushes fibres apart and never pulls them together") {
    for (const double depth : {1e-6, 1e-3, 0.3})
        for (const double stiffness : {0.02, 50.0, 1e7}) {
            CAPTURE(depth);
            CAPTURE(stiffness);
            test::check_normal_law(RegularisedPenalty{{.regularisation_depth = depth}}, stiffness, depth);
            test::check_normal_law(LinearPenalty{}, stiffness, depth, true);
            // The wrapper moves the gap before the law sees it; the law itself is unchanged.
            test::check_normal_law(LimitedGap<RegularisedPenalty>{{.law = {.regularisation_depth = depth}, .limit = 2.0 * depth}},
                                   stiffness, depth);
            test::check_normal_law(LimitedGap<LinearPenalty>{{.law = {}, .limit = depth}}, stiffness, depth, true);
        }
}

TEST_CASE("the regularised penalty follows the three branches of the chapter's equation 10") {
    // Powers of two, so that every figure below is exact: k_N = 8, p_reg = 1/4.
    const RegularisedPenalty law{{.regularisation_depth = 0.25}};
    CHECK(law.regularisation_depth() == 0.25);
    CHECK(law.response(0.5, 8.0).reaction == 0.0);
    CHECK(law.response(-0.125, 8.0).reaction == 0.25);  // k_N p^2 / (2 p_reg)
    CHECK(law.response(-0.125, 8.0).slope == -4.0);     // -k_N p / p_reg
    CHECK(law.response(-1.0, 8.0).reaction == 7.0);     // k_N (p - p_reg / 2)
    CHECK(law.response(-1.0, 8.0).slope == -8.0);
}

TEST_CASE("the regularised penalty is continuous with its slope at the threshold, which the misprint would break") {
    const double depth = 1e-3, stiffness = 50.0;
    const RegularisedPenalty law{{.regularisation_depth = depth}};
    const law::NormalResponse at = law.response(-depth, stiffness);
    const law::NormalResponse before = law.response(std::nextafter(-depth, 0.0), stiffness);
    // Neighbouring numbers: only round-off may part them.
    CHECK(at.reaction == test::near(before.reaction, 1e-14));
    CHECK(at.slope == test::near(before.slope, 1e-14));
    CHECK(at.reaction == test::near(0.5 * stiffness * depth, 1e-14));
    CHECK(law.energy(-depth, stiffness) == test::near(law.energy(std::nextafter(-depth, 0.0), stiffness), 1e-14));
}

TEST_CASE("a law tells the depth that its quadratic start loses, and the linear one loses none") {
    CHECK(law::regularisation_depth(RegularisedPenalty{{.regularisation_depth = 0.25}}) == 0.25);
    CHECK(law::regularisation_depth(LinearPenalty{}) == 0.0);
    CHECK(law::regularisation_depth(LimitedGap<RegularisedPenalty>{{.law = {.regularisation_depth = 0.25}, .limit = 1.0}}) ==
          0.25);
    static_assert(!law::Regularised<LimitedGap<LinearPenalty>>);
    static_assert(law::GapShifting<LimitedGap<LinearPenalty>>);
    static_assert(!law::GapShifting<RegularisedPenalty>);
}

TEST_CASE("a limited gap is an offset: a deep overlap is shown at the limit and keeps its full stiffness") {
    const double limit = 0.25, stiffness = 8.0;
    const LimitedGap<LinearPenalty> law{{.law = {}, .limit = limit}};
    const double overlap = -3.0;  // at the start of the increment, 12 limits deep
    const double offset = law.gap_shift(overlap);
    CHECK(offset == 2.75);
    CHECK(law.response(overlap + offset, stiffness).reaction == stiffness * limit);
    // During the increment the offset stays, so the reaction follows the motion with the law's own slope: it falls to
    // zero after the limit, and rises when the overlap deepens. A clamp of the gap would do neither.
    CHECK(law.response(overlap + 0.125 + offset, stiffness).reaction == stiffness * 0.125);
    CHECK(law.response(overlap + limit + offset, stiffness).reaction == 0.0);
    CHECK(law.response(overlap - 0.125 + offset, stiffness).reaction == stiffness * 0.375);
    for (const double motion : {0.125, 0.0, -0.125})
        CHECK(law.response(overlap + motion + offset, stiffness).slope == -stiffness);
}

TEST_CASE("a gap within the limit, or open, is not moved") {
    const LimitedGap<RegularisedPenalty> law{{.law = {.regularisation_depth = 0.125}, .limit = 0.25}};
    for (const double gap : {1.0, 0.0, -0.125, -0.25}) CHECK(law.gap_shift(gap) == 0.0);
    CHECK(law.gap_shift(-0.5) == 0.25);
    CHECK(law.with_limit(0.5).gap_shift(-0.5) == 0.0);
    CHECK(law.with_limit(0.125).limit() == 0.125);
    const LimitedGap<RegularisedPenalty> off = law.with_limit(std::numeric_limits<double>::infinity());
    CHECK(off.gap_shift(-1e6) == 0.0);
}

TEST_CASE("parameters that cannot hold are refused with field, value and bound") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    CHECK(test::refusal([] { RegularisedPenalty{{.regularisation_depth = -0.001}}; }) ==
          "RegularisedPenalty.regularisation_depth = -0.001, but it must be finite and > 0");
    for (const double depth : {0.0, nan, infinity, core::unset})
        CHECK(test::refusal([&] {
                  RegularisedPenalty{{.regularisation_depth = depth}};
              }).starts_with("RegularisedPenalty.regularisation_depth = "));
    CHECK(test::refusal([] { RegularisedPenalty{{}}; }) ==
          "RegularisedPenalty.regularisation_depth = nan, but it must be finite and > 0");
    CHECK(test::refusal([] { LimitedGap<LinearPenalty>{{.law = {}, .limit = -2.0}}; }) ==
          "LimitedGap.limit = -2, but it must be > 0");
    CHECK(test::refusal([] { LimitedGap<LinearPenalty>{{}}; }) == "LimitedGap.limit = nan, but it must be > 0");
    CHECK(test::refusal([] { LimitedGap<LinearPenalty>{{.law = {}, .limit = 1.0}}.with_limit(0.0); }) ==
          "LimitedGap.limit = 0, but it must be > 0");
    CHECK(test::refusal([] { LimitedGap<RegularisedPenalty>{{.law = {}, .limit = 1.0}}; }) ==
          "RegularisedPenalty.regularisation_depth = nan, but it must be finite and > 0");
    CHECK(test::refusal([] { LimitedGap<LinearPenalty>{{.law = {}, .limit = 1.0}}; }).empty());
}

TEST_CASE("a law that can be inverted tells the penetration of every reaction") {
    const auto check = [](const auto& law) {
        for (const double gap : test::gaps_around(1e-3)) {
            if (gap >= 0.0) continue;
            CHECK(law.penetration(law.response(gap, 50.0).reaction, 50.0) == test::near(-gap, 1e-12));
        }
        CHECK(law.penetration(0.0, 50.0) == 0.0);
    };
    check(LinearPenalty{});
    check(RegularisedPenalty{{.regularisation_depth = 1e-3}});
    check(law::Augmented<RegularisedPenalty>{{.law = {.regularisation_depth = 1e-3}, .largest_penetration = 1e-6}});
}

TEST_CASE("multipliers leave a law as it is, and a law without them is not one that has") {
    test::check_normal_law(
        law::Augmented<RegularisedPenalty>{{.law = {.regularisation_depth = 1e-3}, .largest_penetration = 1e-6}}, 50.0, 1e-3);
    static_assert(law::Augmenting<law::Augmented<LinearPenalty>> && !law::Augmenting<RegularisedPenalty>);
    CHECK(test::refusal([] { law::Augmented<LinearPenalty>{{}}; }) ==
          "Augmented.largest_penetration = nan, but it must be finite and > 0");
}

/// Part of its speed with which a mass leaves a law, `steps` of them in pi sqrt(m/K). @param phase  of the first one, in [0, 1)
double restitution(law::Impact<law::PowerNormal> law, int steps, double phase, double& balance) {
    const inertia::GeneralisedAlpha scheme({});
    const double dt = std::numbers::pi / static_cast<double>(steps);
    const inertia::TimeStep step = scheme.step(dt);
    law.last(dt, step.share);
    law::Approach at{.gap = dt * (1.0 + phase)};
    double v = -1.0, a = 0.0, dissipated = 0.0;
    for (int k = 0; k < 8 * steps; ++k) {
        at.before = at.gap;
        const double place = at.gap + step.by_velocity * v + step.by_acceleration * a;
        double low = -10.0, high = 10.0 * std::max(1.0, place);  // the law falls with the gap: one place balances it
        for (int half = 0; half < 80; ++half) {
            at.gap = 0.5 * (low + high);
            ((at.gap - place) / step.c2 > law.response(at).reaction ? high : low) = at.gap;
        }
        const double next = (at.gap - place) / step.c2;
        CHECK(law.dissipated(at) >= 0.0);
        dissipated += law.dissipated(at);
        v += step.old_acceleration * a + step.new_acceleration * next, a = next;
    }
    CHECK(law.energy(at) == 0.0);
    balance = 1.0 - (0.5 * v * v + dissipated) / 0.5;
    return v;
}

TEST_CASE("what meets in motion parts as the closed form says, however few steps it takes, and all of its energy is told") {
    const auto impact = [](double exponent, double damping) {
        return law::Impact<law::PowerNormal>(
            {.law = {.line_stiffness = 1.0, .crossing_stiffness = 1.0, .crossing_exponent = exponent}, .damping = damping});
    };
    // Undamped: of second order, and hardly any energy is put in where steps are too long.
    double most = 0.0, least[3] = {1.0, 1.0, 1.0}, balance = 0.0;
    for (int fine = 0; fine < 3; ++fine)
        for (double phase = 0.0; phase < 1.0; phase += 0.1) {
            const double e = restitution(impact(1.0, 0.0), 8 << fine, phase, balance);
            most = std::max(most, e), least[fine] = std::min(least[fine], e);
        }
    std::printf("impact: 8, 16, 32 steps: %.5f %.5f %.5f, most %.5f\n", least[0], least[1], least[2], most);
    CHECK(least[0] > 0.99);
    CHECK(1.0 - least[2] < 0.1 * (1.0 - least[0]));  // a sixteenth
    CHECK(most < 1.001);
    // Damped: ln((1 + y)/(1 - e y)) = y (1 + e), whatever the power. 40 steps.
    const double y[] = {0.1, 0.3, 1.0, 3.0}, e[] = {0.937476, 0.832870, 0.593624, 0.306897};
    for (const double exponent : {1.0, 1.5})
        for (int k = 0; k < 4; ++k) {
            const double here = restitution(impact(exponent, y[k]), 100, 0.3, balance);
            CAPTURE(exponent);
            CAPTURE(y[k]);
            CHECK(here == test::near(e[k], 1e-3));
            CHECK(std::abs(balance) < 6e-3);  // of first order where damping makes it jump
        }
}

TEST_CASE("laws that pull and laws of a step have the slope and the energy that they owe, whatever the element's length") {
    using Sticky = law::Adhesive<law::PowerNormal>;
    const law::PowerNormal::Parameters power{.line_stiffness = 3.0, .crossing_stiffness = 2.0, .crossing_exponent = 2.0};
    const Sticky sticky({.law = power, .line_pull = 0.4, .crossing_pull = 0.3, .range = 0.5});
    law::Impact<Sticky> moving({.law = {.law = power, .line_pull = 0.4, .crossing_pull = 0.3, .range = 0.5}, .damping = 0.6});
    moving.last(0.7, 2.0 / 3.0);
    double lost = 0.0;
    for (const double length : {0.0, 2.0})
        for (const double gap : {-0.7, -0.2, -0.01, 0.01, 0.2, 0.49, 0.51, 2.0})
            for (const double before : {-0.5, 0.1, 0.9}) {
                CAPTURE(length);
                CAPTURE(gap);
                CAPTURE(before);
                const double by = 1e-6;
                const law::Approach at{gap, length, 1.0, before}, less{gap - by, length, 1.0, before},
                    more{gap + by, length, 1.0, before}, half{gap, 0.5 * length, 1.0, before};
                const auto slope_of = [&](const auto& law) {
                    return (law.response(more).reaction - law.response(less).reaction) / (2.0 * by);
                };
                CHECK(std::abs(slope_of(sticky) - sticky.response(at).slope) < 1e-8);
                CHECK(std::abs(slope_of(moving) - moving.response(at).slope) < 1e-8);
                CHECK(std::abs((sticky.energy(more) - sticky.energy(less)) / (2.0 * by) + sticky.response(at).reaction) < 1e-8);
                CHECK(sticky.push(at) >= 0.0);
                CHECK(moving.dissipated(at) >= 0.0);
                lost += moving.dissipated(at);
                if (length > 0.0) CHECK(2.0 * moving.response(half).reaction == test::near(moving.response(at).reaction, 1e-13));
                if (gap > 0.5) CHECK(sticky.response(at).reaction == 0.0);
            }
    CHECK(lost > 0.0);
    // Depth without a load, K p^2 = F, and work of coming off, F d/2 and what it had sunk by.
    const double rests = std::sqrt(0.3 / 2.0);
    CHECK(std::abs(sticky.response({-rests}).reaction) < 1e-12);
    CHECK(-sticky.energy({-rests}) == test::near(0.5 * 0.3 * 0.5 + 2.0 / 3.0 * 0.3 * rests, 1e-12));
}

}  // namespace normal_law_test
