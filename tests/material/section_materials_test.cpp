// SPDX-License-Identifier: MIT
#include "section_material_contract.hpp"

#include "../beam/beam_element_contract.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/material/brittle.hpp>
#include <fibrant/material/composed.hpp>
#include <fibrant/material/eigenstrain.hpp>
#include <fibrant/material/viscoelastic.hpp>
#include <fibrant/material/wire.hpp>

using namespace fibrant;
using beam::Drive;
using beam::SectionStrains;
namespace strain = beam::strain;

namespace {

const scene::ElasticMaterial isotropic{1000.0, 0.3};
const scene::ElasticMaterial carbon{230.0, 0.2, {15.0, 0.3, 15.0}};
const beam::SectionConstants round_section = beam::section_constants(scene::circular(0.1)), flat_section = beam::section_constants(scene::elliptical(0.15, 0.08));

template <class M>
typename M::Section section_of(const M& law, const scene::ElasticMaterial& material = isotropic, const beam::SectionConstants& shape = round_section) {
    return law.section(shape, material, 1.0);
}

TEST_CASE("every law's tangent is its derivative, its stress that of a potential, and it dissipates nothing negative") {
    const material::Elastic elastic;
    SUBCASE("isotropic") { test::check_section_material(elastic, section_of(elastic, isotropic, flat_section), 0.01, 0.1); }
    SUBCASE("carbon") { test::check_section_material(elastic, section_of(elastic, carbon, flat_section), 0.01, 0.1); }
    SUBCASE("eigenstrain") {
        const material::Eigenstrain<material::Elastic> law({.base = {}, .along = 0.02, .across = -0.01, .curvature_1 = 0.3, .curvature_2 = -0.2, .twist = 0.5});
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
        const material::Composed<material::LinearStretch, material::SofteningBending> soft({.axial = {}, .bending = {.left_over = 0.1, .curvature = 0.05}});
        test::check_section_material(soft, section_of(soft, isotropic, flat_section), 0.01, 0.1);
    }
}

}  // namespace
