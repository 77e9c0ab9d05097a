// SPDX-License-Identifier: MIT
#include "section_material_contract.hpp"
#include <near.hpp>

#include <refusal.hpp>

#include <fibrant/material/brittle.hpp>
#include <fibrant/material/composed.hpp>
#include <fibrant/material/damped.hpp>
#include <fibrant/material/eigenstrain.hpp>
#include <fibrant/material/viscoelastic.hpp>
#include <fibrant/material/wire.hpp>

#include <limits>
#include <numbers>
#include <tuple>
#include <vector>

using namespace fibrant;

namespace section_materials_test {

using beam::Drive;
using beam::SectionStrains;
namespace strain = beam::strain;
using test::refusal;
const scene::ElasticMaterial isotropic{1000.0, 0.3};
const scene::ElasticMaterial carbon{230.0, 0.2, {15.0, 0.3, 15.0}};
const beam::SectionConstants round_section = beam::section_constants(scene::circular(0.1)),
                             flat_section = beam::section_constants(scene::elliptical(0.15, 0.08));

template <class M>
typename M::Section section_of(const M& law, const scene::ElasticMaterial& material = isotropic,
                               const beam::SectionConstants& shape = round_section) {
    return law.section(shape, material, 1.0);
}

TEST_CASE("every law's tangent is its derivative, its stress that of a potential, and it dissipates nothing negative") {
    const material::Elastic elastic;
    SUBCASE("isotropic") { test::check_section_material(elastic, section_of(elastic, isotropic, flat_section), 0.01, 0.1); }
    SUBCASE("carbon") { test::check_section_material(elastic, section_of(elastic, carbon, flat_section), 0.01, 0.1); }
    SUBCASE("eigenstrain") {
        const material::Eigenstrain<material::Elastic> law(
            {.base = {}, .along = 0.02, .across = -0.01, .curvature_1 = 0.3, .curvature_2 = -0.2, .twist = 0.5});
        auto section = section_of(law, carbon, flat_section);
        test::check_section_material(law, section, 0.01, 0.1);
        const Drive warm{0.0, 0.7};
        const SectionStrains free = law.free(section, 0.7);
        const auto at_free = law.response(section, free, law.fresh(section, {}), warm);
        CHECK(at_free.stored == 0.0);
    }
    SUBCASE("viscoelastic") {
        const material::Viscoelastic<2> law({.share = {0.3, 0.2}, .time = {1.0, 10.0}});
        test::check_section_material(law, section_of(law, carbon), 0.01, 0.1, 0.7);
    }
    SUBCASE("damped") {
        const material::Damped<material::Elastic> law({.stretch = 0.3, .bending = 0.2, .turning = 0.5, .section = 0.1});
        test::check_section_material(law, section_of(law, carbon, flat_section), 0.01, 0.1, 0.7);
        // Bent at a constant rate: M = E I (kappa + beta kappa'), and the power is beta E I kappa'^2.
        const auto section = section_of(law);
        SectionStrains bent{};
        bent[strain::b1] = 0.02;
        const auto now = law.response(section, bent, law.fresh(section, {}), Drive{0.5, 0.0});
        CHECK(now.stress[strain::b1] / section.diagonal[strain::b1] == test::near(0.02 + 0.2 * 0.02 / 0.5));
        CHECK(now.dissipated / section.diagonal[strain::b1] == test::near(0.2 * 0.02 * 0.02 / 0.5));
        // In a motion that takes the mean of both ends the work of that mean is what is lost, whatever was before.
        SectionStrains further = bent;
        further[strain::b1] = 0.05;
        const Drive half{0.5, 0.0, 0.5};
        const auto first = law.response(section, bent, law.fresh(section, {}), half),
                   then = law.response(section, further, first.history, half);
        const double elastic = 0.5 * (0.02 + 0.05) * section.diagonal[strain::b1];
        CHECK((0.5 * (first.stress[strain::b1] + then.stress[strain::b1]) - elastic) * 0.03 == test::near(then.dissipated));
        CHECK(refusal([] { material::Damped<material::Elastic>({.bending = -1.0}); }).find("Damped.bending = -1") !=
              std::string::npos);
    }
    SUBCASE("wire") {
        const material::Wire law({.yield_stress = 5.0, .hardening = 100.0});
        test::check_section_material(law, section_of(law), 0.01, 0.1);
    }
    SUBCASE("broken") {
        const material::Brittle law({.strength = 10.0, .modulus = 5.0, .reference_length = 1.0});
        test::check_section_material(law, section_of(law), 0.01, 0.1);
    }
    SUBCASE("composed") {
        const material::Composed<material::NoCompression, material::BendingStops<4>> law(
            {.axial = {}, .bending = {.share = {0.3, 0.2, 0.2, 0.1}, .curvature = {0.02, 0.05, 0.08, 0.2}}});
        test::check_section_material(law, section_of(law, isotropic, flat_section), 0.01, 0.1);
        const material::Composed<material::LinearStretch, material::SofteningBending> soft(
            {.axial = {}, .bending = {.left_over = 0.1, .curvature = 0.05}});
        test::check_section_material(soft, section_of(soft, isotropic, flat_section), 0.01, 0.1);
    }
}

/// The stress of a strain that is alone.
template <class M>
auto alone(const M& law, const typename M::Section& section, int c, double e, const typename M::History& memory,
           double duration = 0.0) {
    SectionStrains strains{};
    strains[core::at(c)] = e;
    return law.response(section, strains, memory, {duration, 0.0});
}

TEST_CASE("a transversely isotropic section has the constants of Hashin and Rosen, and flattens by E*") {
    struct Row {
        scene::ElasticMaterial material;
        double bulk, shear, E33, flat;
    };
    const double A = round_section.area;
    for (const Row& row : {Row{carbon, 10.794743, 5.769231, 231.727159, 15.039233},
                           Row{{112.0, 0.36, {2.5, 0.3, 2.0}}, 1.800597, 0.961538, 112.933429, 2.507253},
                           Row{{72.0, 0.22, {72.0, 0.22, 72.0 / 2.44}}, 52.693208, 29.508197, 82.201405, 75.662043}}) {
        const material::ElasticSection s(round_section, row.material, 1.0);
        const double C00 = s.diagonal[strain::e11], C01 = s.lateral, nu = row.material.poisson_ratio;
        CHECK(0.5 * (C00 + C01) / A == test::near(row.bulk, 1e-6));
        CHECK(0.5 * (C00 - C01) / A == test::near(row.shear, 1e-6));
        CHECK((s.diagonal[strain::e33] + 2.0 * nu * nu * (C00 + C01)) / A == test::near(row.E33, 1e-8));
        CHECK((C00 - C01 * C01 / C00) / A == test::near(row.flat, 1e-7));  // at held length, free sideways
        CHECK(row.material.section_modulus() == test::near(row.flat, 1e-7));
    }
    const auto refused = [](double nu, scene::TransverseConstants t) {
        return refusal([&] { scene::ElasticMaterial{230.0, nu, t}.validate(); });
    };
    CHECK(refused(2.4, {15.0, 0.3, 15.0}).find("ElasticMaterial.poisson_ratio = 2.4") != std::string::npos);
    CHECK(refused(2.3, {15.0, 0.3, 15.0}).empty());
    CHECK(refused(0.2, {15.0, 1.0, 15.0}).find("transverse.poisson_ratio = 1") != std::string::npos);
    CHECK(refused(0.2, {15.0, 0.3, core::unset}).find("transverse.shear_modulus") != std::string::npos);
}

TEST_CASE("a Prony series relaxes, is ramped, creeps and damps as its closed forms say") {
    const material::Viscoelastic<2> law({.share = {0.3, 0.2}, .time = {1.0, 10.0}});
    const auto section = section_of(law);
    const double EA = section.diagonal[strain::e33], e = 0.01;
    const double relaxed[][3] = {
        {0.1, 0.969461, 0.984491}, {1.0, 0.791331, 0.879961}, {10.0, 0.573590, 0.656423}, {100.0, 0.500009, 0.522999}};
    for (const auto& [time, after, ramp] : relaxed) {
        const auto stepped = alone(law, section, strain::e33, e, {});
        CHECK(stepped.stress[strain::e33] == test::near(EA * e));
        CHECK(alone(law, section, strain::e33, e, stepped.history, time).stress[strain::e33] == test::near(after * EA * e, 1e-6));
        const auto ramped = alone(law, section, strain::e33, e, {}, time);
        CHECK(ramped.stress[strain::e33] == test::near(ramp * EA * e, 1e-6));
        // Ten uneven steps of a constant rate are one, and its work is what is stored and lost.
        material::Viscoelastic<2>::History memory;
        double at = 0.0, lost = 0.0, stored = 0.0, stress = 0.0;
        for (int k = 1; k <= 10; ++k) {
            const double next = k * k / 100.0;
            const auto part = alone(law, section, strain::e33, next * e, memory, (next - at) * time);
            memory = part.history, lost += part.dissipated, stored = part.stored, stress = part.stress[strain::e33], at = next;
        }
        CHECK(stress == test::near(ramped.stress[strain::e33], 1e-14));
        CHECK(lost / ramped.dissipated == test::near(1.0, 1e-12));
        CHECK(stored / ramped.stored == test::near(1.0, 1e-14));
    }
    // Work of a path in many steps, by Simpson's rule within each: what is stored and lost.
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(alone(law, section, strain::e33, e, {}, infinity).stress[strain::e33] == test::near(0.5 * EA * e));
    const material::Viscoelastic<1> one({.share = {0.5}, .time = {1.0}});
    material::Viscoelastic<1>::History memory;
    double work = 0.0, lost = 0.0, stored = 0.0, before = 0.0;
    for (int k = 1; k <= 400; ++k) {
        const double old = 0.01 * std::sin(0.05 * (k - 1)), now = 0.01 * std::sin(0.05 * k);
        const double half = alone(one, section, strain::e33, 0.5 * (old + now), memory, 0.025).stress[strain::e33];
        const auto end = alone(one, section, strain::e33, now, memory, 0.05);
        work += (before + 4.0 * half + end.stress[strain::e33]) / 6.0 * (now - old);
        lost += end.dissipated, stored = end.stored, before = end.stress[strain::e33], memory = end.history;
    }
    CHECK(work / (stored + lost) == test::near(1.0, 1e-6));  // Simpson: (0.05/2)^4
    // tan delta of omega tau = 1 is 1/3: loss of a steady cycle over pi amplitude^2 is the loss modulus g/2, the storage one is 1
    // - g/2.
    memory = {}, lost = 0.0;
    const int steps = 400;
    for (int k = 1; k <= 4 * steps; ++k) {
        const auto end = alone(one, section, strain::e33, 0.01 * std::sin(2.0 * std::numbers::pi * k / steps), memory,
                               2.0 * std::numbers::pi / steps);
        if (k > 3 * steps) lost += end.dissipated;
        memory = end.history;
    }
    CHECK(lost / (std::numbers::pi * 1e-4 * EA) / 0.75 == test::near(1.0 / 3.0, 1e-3));
    // Creep: the strain that keeps the stress, each step solved with the tangent.
    memory = {};
    const double held = EA * e;
    double strain_now = alone(one, section, strain::e33, 0.0, memory).tangent[strain::e33] > 0.0 ? e : 0.0;
    memory = alone(one, section, strain::e33, strain_now, memory).history;
    for (int k = 0; k < 1000; ++k) {
        const auto same = alone(one, section, strain::e33, strain_now, memory, 1e-3);
        strain_now += (held - same.stress[strain::e33]) / same.tangent[strain::e33];
        memory = alone(one, section, strain::e33, strain_now, memory, 1e-3).history;
    }
    CHECK(strain_now / e == test::near(1.393469, 1e-4));
    CHECK(refusal([] {
              material::Viscoelastic<2>({.share = {0.6, 0.4}, .time = {1.0, 2.0}});
          }).find("share: sum = 1") != std::string::npos);
}

TEST_CASE("a wire bends, twists and springs back beyond yield as its section says") {
    const double E = 1000.0, r = 0.1, sy = 1.0;
    const material::Wire law({.yield_stress = sy});
    const auto section = section_of(law);
    const double first = sy / (E * r), yield_moment = std::numbers::pi * r * r * r * sy / 4.0;  // curvature and moment
    const double bent[][3] = {{1.5, 1.347091, 0.101939},
                              {2, 1.493660, 0.253170},
                              {3, 1.604932, 0.465023},
                              {5, 1.663904, 0.667219},
                              {10, 1.689177, 0.831082}};
    double worst = 0.0;
    for (const auto& [times, moment, left] : bent) {
        const auto now = alone(law, section, strain::b1, times * first, {});
        worst = std::max(worst, std::abs(now.stress[strain::b1] / yield_moment / moment - 1.0));
        // Springback: what is left of the curvature without a moment.
        const double back = times * first - now.stress[strain::b1] / section.diagonal[strain::b1];
        CHECK(std::abs(alone(law, section, strain::b1, back, now.history).stress[strain::b1]) < 1e-12 * yield_moment);
        CHECK(back / (times * first) == test::near(left, 0.05));
        // Kinematic hardening in bending alone is uniaxial: M = (E_t/E) E I kappa + (1 - E_t/E) of that without it.
        const double h = 250.0, tangent_share = h / (E + h);
        const material::Wire hard({.yield_stress = sy, .hardening = h});
        const double with = alone(hard, section, strain::b1, times * first, {}).stress[strain::b1];
        // The same yield stress is reached at the same strain; beyond it the slope is E_t instead of 0.
        CHECK(with / (tangent_share * section.diagonal[strain::b1] * times * first +
                      (1.0 - tangent_share) * now.stress[strain::b1]) ==
              test::near(1.0, 1e-12));
    }
    CHECK(worst < 0.014);  // 48 points, any direction
    const double G = E / 2.6, first_twist = sy / std::sqrt(3.0) / (G * r);
    for (const auto& [times, torque] : {std::pair{1.5, 1.234568}, {2.0, 1.291667}, {3.0, 1.320988}, {5.0, 1.330667}}) {
        SectionStrains e{};
        e[strain::c21] = times * first_twist, e[strain::c12] = -times * first_twist;
        const auto now = law.response(section, e, {}, {});
        const double T = now.stress[strain::c21] - now.stress[strain::c12],
                     Ty = std::numbers::pi * r * r * r * sy / std::sqrt(3.0) / 2.0;
        CHECK(T / Ty == test::near(torque, 0.02));  // three rings
        // In torsion and in shear hardening is a third of that, beside G.
        const double h = 250.0, share = h / 3.0 / (G + h / 3.0);
        const material::Wire hard({.yield_stress = sy, .hardening = h}), elastic({.yield_stress = 1e9 * sy});
        const auto twisted = [&](const material::Wire& one) {
            const auto stress = one.response(section, e, {}, {}).stress;
            return stress[strain::c21] - stress[strain::c12];
        };
        CHECK(twisted(hard) == test::near(share * twisted(elastic) + (1.0 - share) * T, 1e-12));
        const double slide = times * first_twist * r;
        for (const int c : {strain::e13, strain::e23}) {
            const auto sheared = [&](const material::Wire& one) { return alone(one, section, c, slide, {}).stress[core::at(c)]; };
            CHECK(sheared(hard) == test::near(share * sheared(elastic) + (1.0 - share) * sheared(law), 1e-12));
        }
    }
    // A closed cycle in stretch and bending: work of a fine path is what is stored and lost; return mapping is of first order.
    double error[2];
    for (int fine = 0; fine < 2; ++fine) {
        material::Wire::History memory;
        SectionStrains before{}, stress{};
        double work = 0.0, lost = 0.0, stored = 0.0;
        const int steps = fine == 0 ? 200 : 400;
        for (int k = 1; k <= steps; ++k) {
            const double t = 2.0 * std::numbers::pi * k / steps;
            SectionStrains e{};
            e[strain::e33] = 0.002 * std::sin(t), e[strain::b1] = 0.03 * (1.0 - std::cos(t)),
            e[strain::c21] = 0.02 * std::sin(2.0 * t);
            auto free = section;
            free.keep_shape();
            const auto now = law.response(free, e, memory, {});
            for (std::size_t c = 0; c < 12; ++c) work += 0.5 * (stress[c] + now.stress[c]) * (e[c] - before[c]);
            before = e, stress = now.stress, memory = now.history, lost += now.dissipated, stored = now.stored;
        }
        error[fine] = std::abs(work - stored - lost) / lost;
    }
    CHECK(error[1] < 5e-3);
    CHECK(error[1] < 0.7 * error[0]);
}

TEST_CASE("strengths are Weibull's, bending is weighed by flaws, and a bundle holds what Daniels says") {
    const double infinite = material::Brittle::left_over;
    CHECK(infinite < 1e-3);
    for (const auto& [m, surface, volume] : {std::tuple{5.0, 0.701406, 0.545954}, {10.0, 0.810974, 0.677941}}) {
        for (const bool on_surface : {true, false}) {
            const material::Brittle law({.strength = 1.0,
                                         .modulus = m,
                                         .reference_length = 1.0,
                                         .flaws = on_surface ? material::Flaws::surface : material::Flaws::volume});
            const auto section = section_of(law);
            SectionStrains e{};
            e[strain::b1] = 0.006, e[strain::b2] = 0.008;
            // Over the volume by the points of the section: 2.2e-3 of m = 10.
            CHECK(law.acting_stress(section, e) / (1000.0 * 0.1 * 0.01) ==
                  test::near(on_surface ? surface : volume, on_surface ? 1e-6 : 2.5e-3));
        }
    }
    const double m = 5.0;
    const material::Brittle law({.strength = 1.0, .modulus = m, .reference_length = 1.0, .seed = 11});
    const auto section = section_of(law);
    // Fibres of four points each: the weakest of a fibre has the distribution of its whole length.
    double mean = 0.0, square = 0.0, peaks = 0.0;
    const int bundles = 20, n = 1000;
    for (int bundle = 0; bundle < bundles; ++bundle) {
        std::vector<double> strengths;
        for (int k = 0; k < n; ++k) {
            double least = std::numeric_limits<double>::infinity();
            for (int p = 0; p < 4; ++p) least = std::min(least, law.fresh(section, {bundle * n + k, p, 0.25}).strength);
            strengths.push_back(least), mean += least, square += least * least;
        }
        std::sort(strengths.begin(), strengths.end());
        double peak = 0.0;
        for (int k = 0; k < n; ++k) peak = std::max(peak, strengths[core::at(k)] * (n - k) / n);
        peaks += peak / bundles;
    }
    mean /= bundles * n, square /= bundles * n;
    CHECK(mean == test::near(0.918169, 0.005));  // 20000 fibres: 0.0016 is one standard deviation
    CHECK(std::sqrt(square - mean * mean) / mean == test::near(0.229053, 0.02));
    CHECK(peaks == test::near(0.5976, 0.01));  // 0.593399 for infinitely many; 20 bundles: 0.002
    // The least stress that breaks it, and what is left then.
    auto memory = law.fresh(section, {0, 0, 1.0});
    SectionStrains e{};
    e[strain::e33] = 0.999 * memory.strength / 1000.0;
    CHECK(law.utilisation(section, e, memory) == test::near(0.999));
    law.break_now(memory);
    CHECK(law.utilisation(section, e, memory) == 0.0);
    CHECK(law.response(section, e, memory, {}).stress[strain::e33] / (1e-6 * section.diagonal[strain::e33] * e[strain::e33]) ==
          test::near(1.0));
}

TEST_CASE(
    "a free fibre has the strains of its shape, what drives a held one does the work that it stores, and it breaks by "
    "what it is strained beyond") {
    using Law = material::Eigenstrain<material::Brittle>;
    const Law law({.base = {.strength = 1.0, .modulus = 5.0, .reference_length = 1.0},
                   .along = 0.02,
                   .across = -0.01,
                   .curvature_1 = 0.3,
                   .curvature_2 = -0.2,
                   .twist = 0.5});
    const auto section = section_of(law, isotropic, flat_section);
    const double a = 0.7, l = 1.0 + 0.02 * a, m = 1.0 - 0.01 * a;
    const SectionStrains free = law.free(section, a);
    CHECK(free[strain::e33] == test::near(0.5 * (l * l - 1.0), 1e-12));
    // Widths count from those of a fibre that contracts as it is drawn.
    for (const int c : {strain::e11, strain::e22})
        CHECK(free[core::at(c)] - 0.3 * free[strain::e33] == test::near(0.5 * (m * m - 1.0), 1e-12));
    CHECK(free[strain::b1] == test::near(-l * m * a * 0.3, 1e-12));
    CHECK(free[strain::b2] == test::near(l * m * a * 0.2, 1e-12));
    CHECK(free[strain::c21] == test::near(m * m * a * 0.5, 1e-12));
    CHECK(free[strain::c12] == -free[strain::c21]);
    const auto held = law.response(section, {}, law.fresh(section, {0, 0, 1.0}), {0.0, a});
    CHECK(held.stored > 0.0);
    CHECK(held.driven == test::near(held.stored, 1e-12));
    // What strains it is counted from the free shape.
    SectionStrains drawn = free;
    drawn[strain::e33] += 0.999 * held.history.base.strength / 1000.0;
    CHECK(law.utilisation(section, drawn, held.history) == test::near(0.999, 1e-9));
    // Memories go over to other points in proportion.
    const auto mean = Law::History::between(held.history, {}, 0.25);
    for (std::size_t c = 0; c < free.size(); ++c) CHECK(mean.stress[c] == test::near(0.75 * held.history.stress[c], 1e-12));
    material::Viscoelastic<2>::History slow;
    slow.branch[1][strain::e33] = 0.4;
    CHECK(material::Viscoelastic<2>::History::between(slow, {}, 0.25).branch[1][strain::e33] == test::near(0.3, 1e-12));
    // A flat fibre is weighed by how far it reaches from the axis that it is bent about.
    const material::Brittle brittle({.strength = 1.0, .modulus = 5.0, .reference_length = 1.0});
    const auto flat = section_of(brittle, isotropic, flat_section);
    SectionStrains wide{}, thin{};
    wide[strain::b1] = thin[strain::b2] = 0.01;
    CHECK(brittle.acting_stress(flat, thin) / brittle.acting_stress(flat, wide) == test::near(0.08 / 0.15, 1e-12));
}

TEST_CASE("stops meet the curve that they are made of, and their loops are Masing's") {
    // M / Mc = 1 - exp(-x), loop at amplitude 2: with stops equally spaced to x = 6, chords inside the curve.
    const auto area = [](auto stops) {
        constexpr int count = decltype(stops)::value;
        using Law = material::BendingStops<count>;
        const auto curve = [](double x) { return 1.0 - std::exp(-x); };
        const double first = curve(6.0 / count) / (6.0 / count);
        const Law law(Law::Parameters::of_curve(curve, first, 6.0 / count));
        CHECK(law.response(first, {6.0, 0.0}, {}).moment[0] == test::near(curve(6.0)));
        typename Law::History memory = law.response(first, {0.0, 2.0}, {}).history;
        double sum = 0.0, lost = 0.0, before = law.response(first, {0.0, 2.0}, {}).moment[1];
        const int steps = 2000;
        for (int k = 1; k <= 2 * steps; ++k) {
            const double x = k <= steps ? 2.0 - 4.0 * k / steps : -2.0 + 4.0 * (k - steps) / steps;
            const auto now = law.response(first, {0.0, x}, memory);
            sum += 0.5 * (before + now.moment[1]) * (k <= steps ? -4.0 : 4.0) / steps;
            before = now.moment[1], memory = now.history, lost += now.dissipated;
        }
        CHECK(sum == test::near(lost, 1e-5));  // kinks within a step
        return sum;
    };
    CHECK(area(std::integral_constant<int, 4>{}) == test::near(1.2071, 1e-3));
    CHECK(area(std::integral_constant<int, 8>{}) == test::near(1.9180, 1e-3));
    CHECK(area(std::integral_constant<int, 16>{}) == test::near(2.1012, 1e-3));
    CHECK(area(std::integral_constant<int, 32>{}) == test::near(2.1494, 1e-3));
    const material::Composed<material::NoCompression, material::LinearBending> string({.axial = {}, .bending = {}});
    auto section = section_of(string);
    section.keep_shape();
    CHECK(alone(string, section, strain::e33, -0.01, {}).stress[strain::e33] / (-1e-5 * section.diagonal[strain::e33]) ==
          test::near(1.0));
    CHECK(alone(string, section, strain::e33, 0.01, {}).stress[strain::e33] /
              ((0.01 - 0.5 * 0.999e-3) * section.diagonal[strain::e33]) ==
          test::near(1.0));
}

}  // namespace section_materials_test
