// SPDX-License-Identifier: MIT
#include "fibres.hpp"

#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/contact/contact_set.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/linear_penalty.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/observe/vtk_writer.hpp>
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/proximity/kd_tree_search.hpp>
#include <fibrant/proximity/test_point_search.hpp>
#include <fibrant/simulation/snapshot_of.hpp>

#include <near.hpp>
#include <observe/vtk_arrays.hpp>
#include <support/threads.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

using namespace fibrant;

namespace contact_set_test {

using law::Frictionless;
using law::RegularisedCoulomb;
using law::RegularisedPenalty;
using test::Beam;
using test::Mesh;
using test::straight_fibre;

template <class Normal, class Friction>
using Element = contact::ContactElement<Beam, Normal, Friction>;

/// What a contact element holds without any law's state.
struct BareElement {
    double u_i, u_j;
    beam::ElementWeights<Beam> weights_i, weights_j;
    Vec3 normal;
    double cap;
    std::int32_t fibre_i, fibre_j, first_i, first_j, zone, place;
    bool crossing, end_i, end_j;
    Vec3 from_i, from_j;
    double depth;
};
static_assert(sizeof(Element<RegularisedPenalty, Frictionless>) == sizeof(BareElement), "null policies take no byte");
static_assert(sizeof(Element<law::LinearPenalty, Frictionless>) == sizeof(BareElement));
static_assert(sizeof(Element<RegularisedPenalty, Frictionless>) < sizeof(Element<RegularisedPenalty, RegularisedCoulomb>));
static_assert(sizeof(Element<RegularisedPenalty, Frictionless>) <
              sizeof(Element<law::LimitedGap<RegularisedPenalty>, Frictionless>));

const double r = 0.02;
const RegularisedPenalty penalty({.regularisation_depth = 0.005 * r});
const RegularisedCoulomb coulomb({.friction_coefficient = 0.3, .reversible_displacement = 0.02 * r});

contact::ContactParameters contact_parameters() {
    contact::ContactParameters parameters;
    parameters.stiffness.allowed_penetration = 0.05 * r;
    return parameters;
}

template <class Friction = Frictionless, class Search = proximity::GridSearch>
using Contacts = contact::ContactSet<Beam, Search, RegularisedPenalty, Friction>;

template <class Friction = Frictionless, class Search = proximity::GridSearch>
Contacts<Friction, Search> contacts_of(const scene::Assembly& assembly, const Mesh& mesh, const Friction& friction = Friction{},
                                       const Search& search = Search{typename Search::Parameters{}}) {
    return {assembly, mesh, contact_parameters(), search, penalty, friction};
}

/// A state with a whole fibre moved.
Vector moved(const Mesh& mesh, Vector state, Index fibre, const Vec3& way) {
    for (Index node = 0; node < mesh.node_count(fibre); ++node) state.segment<3>(3 * mesh.node_vector(fibre, node)) += way;
    return state;
}
/// Sum of the forces on a fibre.
Vec3 on_fibre(const Mesh& mesh, const Vector& forces, Index fibre) {
    Vec3 sum = Vec3::Zero();
    for (Index node = 0; node < mesh.node_count(fibre); ++node) sum += forces.segment<3>(3 * mesh.node_vector(fibre, node));
    return sum;
}

double random_value(std::mt19937& generator) {
    static std::uniform_real_distribution<double> value(-1.0, 1.0);
    return value(generator);
}
Vector random_vector(std::mt19937& generator, Index size) {
    Vector vector(size);
    for (Index k = 0; k < size; ++k) vector[k] = random_value(generator);
    return vector;
}

/// Pairs side by side, at a slant, crossing, and end against side, all slightly pressed together.
std::vector<scene::FibreSpecification> some_fibres() {
    std::vector<scene::FibreSpecification> fibres{
        straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 8),
        straight_fibre({-0.45, 0.01, 1.9 * r}, {0.5, 0.02, 1.9 * r}, r, 8),      // side by side
        straight_fibre({0.4, -0.03, -1.95 * r}, {-0.5, 0.12, -1.95 * r}, r, 7),  // at 9 degrees, the other way
        straight_fibre({0.1, -0.4, 3.8 * r}, {-0.1, 0.5, 3.85 * r}, r, 6),       // across
        straight_fibre({-0.2, 0.3, -3.85 * r}, {0.2, -0.3, -3.85 * r}, r, 6),    // across, below
        straight_fibre({0.3, 0.9, 0.0}, {0.3, 0.039, 0.0}, r, 8),                // its end against the first
    };
    fibres[3].section = scene::elliptical(1.2 * r, 0.9 * r);
    fibres[3].director = Vec3(1, 0, 0.3);
    return fibres;
}

struct Scene {
    scene::Assembly assembly;
    Mesh mesh;
    static scene::Assembly gather(const std::vector<scene::FibreSpecification>& fibres) {
        scene::Assembly assembly;
        for (const scene::FibreSpecification& fibre : fibres) assembly.add(fibre);
        return assembly;
    }
    explicit Scene(const std::vector<scene::FibreSpecification>& fibres) : assembly{gather(fibres)}, mesh{assembly, Beam{}} {}
    /// The rest state with every vector moved a little: positions by part of a radius, directors by some per cent.
    Vector shaken(unsigned seed, double amount = 1.0) const {
        std::mt19937 generator(seed);
        Vector state = mesh.rest_state();
        for (Index v = 0; v < mesh.layout().vectors(); ++v) {
            const double size = amount * (mesh.layout().kind[core::at(v)] == scene::VectorKind::position ? 0.02 * r : 0.05);
            for (int k = 0; k < 3; ++k) state[3 * v + k] += size * random_value(generator);
        }
        return state;
    }
};

template <class Contact>
double energy(Contact& contacts, const Vector& state) {
    contacts.evaluate(state);
    return contacts.figures(state).work;
}
template <class Contact>
Vector forces(Contact& contacts, const Vector& state) {
    contacts.evaluate(state);
    Vector sum = Vector::Zero(state.size());
    contacts.add_forces(sum);
    return sum;
}
/// Tangent times a direction, of the state that was evaluated last.
template <class Contact>
Vector tangent_times(const Contact& contacts, const Mesh& mesh, const Vector& state, const Vector& x) {
    Vector y = Vector::Zero(x.size());
    const auto add = [&](Index first, const beam::ElementWeights<Beam>& weights, const Vec3& force) {
        for (std::size_t a = 0; a < weights.size(); ++a) y.segment<3>(first + 3 * static_cast<Index>(a)) += weights[a] * force;
    };
    for (Index k = 0; k < core::count(contacts.elements()); ++k) {
        const auto& element = contacts.elements()[core::at(k)];
        const Vec3 force = contacts.tangent(k) * (Mesh::point(x, element.first_j, element.weights_j) -
                                                  Mesh::point(x, element.first_i, element.weights_i));
        add(element.first_j, element.weights_j, force);
        add(element.first_i, element.weights_i, -force);
    }
    for (Index f = 0; f < mesh.fibre_count(); ++f)
        contacts.section_stiffness_terms(f, state,
                                         [&](Index first, const beam::ElementWeights<Beam>& weights, const Mat3& stiffness) {
                                             add(first, weights, stiffness * Mesh::point(x, first, weights));
                                         });
    return y;
}

TEST_CASE("contact forces are the slope of the contact energy while the normals stand") {
    const Scene scene(some_fibres());
    for (const unsigned seed : {1U, 2U, 3U}) {
        const Vector state = scene.shaken(seed);
        auto contacts = contacts_of(scene.assembly, scene.mesh);
        contacts.detect(state, state, 0.5 * r, false);
        const Vector force = forces(contacts, state);
        CHECK(contacts.figures(state).active > 5);  // of every kind of pair
        std::mt19937 generator(seed + 10);
        for (int n = 0; n < 20; ++n) {
            const Vector direction = random_vector(generator, state.size());
            const double step = 1e-3 * r;  // the energy is cubic and parabolic by pieces, joined smoothly
            const double e = 1e-3 * step;
            const double slope = (energy(contacts, state + e * direction) - energy(contacts, state - e * direction)) / (2.0 * e);
            CHECK(std::abs(slope - force.dot(direction)) < 1e-6 * force.norm());
        }
    }
}

TEST_CASE("the tangent of contact is the slope of its forces, symmetric and never negative") {
    const Scene scene(some_fibres());
    const Vector state = scene.shaken(4);
    auto contacts = contacts_of(scene.assembly, scene.mesh);
    contacts.detect(state, state, 0.5 * r, false);
    std::mt19937 generator(5);
    for (int n = 0; n < 20; ++n) {
        const Vector x = random_vector(generator, state.size()), y = random_vector(generator, state.size());
        const double e = 1e-7 * r;
        const Vector difference = (forces(contacts, state + e * x) - forces(contacts, state - e * x)) / (2.0 * e);
        contacts.evaluate(state);
        const Vector product = tangent_times(contacts, scene.mesh, state, x);
        CHECK((difference - product).norm() < 1e-5 * product.norm());  // differences lose digits where a contact is about to open
        CHECK(x.dot(product) >= 0.0);
        CHECK(std::abs(y.dot(product) - x.dot(tangent_times(contacts, scene.mesh, state, y))) <
              1e-10 * product.norm() * y.norm());
    }
}

/// Equal and opposite forces without a moment, on sections that are strained and lean, of pairs that slide; the moment over the
/// radius and the forces.
template <class B, class Friction>
void check_balance(const std::vector<scene::FibreSpecification>& fibres, const Friction& friction) {
    const scene::Assembly assembly = Scene::gather(fibres);
    const beam::Mesh<B> mesh{assembly, B{}};
    contact::ContactSet<B, proximity::GridSearch, RegularisedPenalty, Friction> contacts{
        assembly, mesh, contact_parameters(), proximity::GridSearch{}, penalty, friction};
    std::mt19937 generator(6);
    const Vector rest = mesh.rest_state();
    Vector state = rest;
    const auto& kind = mesh.layout().kind;
    for (Index v = 0; v < mesh.layout().vectors(); ++v)
        for (int k = 0; k < 3; ++k)
            state[3 * v + k] += (kind[core::at(v)] == scene::VectorKind::position ? 0.02 * r : 0.05) * random_value(generator);
    contacts.detect(state, rest, 0.5 * r, false);
    const Vector force = forces(contacts, state);
    CHECK(contacts.figures(state).active > 5);
    if constexpr (core::Active<Friction>) CHECK(contacts.figures(state).dissipated > 0.0);
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();  // work of small rigid motions
    double size = 0.0;
    for (Index v = 0; v < mesh.layout().vectors(); ++v) {
        const Vec3 f = force.segment<3>(3 * v), y = state.segment<3>(3 * v);
        const bool position = kind[core::at(v)] == scene::VectorKind::position;
        if (position) sum += f, size += f.norm();
        if (position || !beam::TurningSections<B>)
            moment += y.cross(f);
        else
            moment += core::spin_matrix(y).inverse().transpose() * f;
    }
    CHECK(size > 0.0);
    CHECK(sum.norm() < 1e-13 * size);
    CHECK(moment.norm() < 1e-12 * r * size);  // rounding: fibres reach 25 radii from the origin
    // A look back to where it came from leaves no trace.
    const auto pairs = contacts.turn_back(rest);
    contacts.evaluate(rest, true);
    contacts.turn_forth(pairs);
    CHECK(forces(contacts, state) == force);
}

TEST_CASE("contact forces are equal and opposite and without a moment, whatever sections have suffered") {
    check_balance<Beam>(some_fibres(), Frictionless{});
    std::vector<scene::FibreSpecification> fibres = some_fibres();
    fibres.pop_back();  // friction at the centre of a round end has no lever
    check_balance<Beam>(fibres, coulomb);
    check_balance<beam::RigidSectionRod>(fibres, Frictionless{});
    check_balance<beam::RigidSectionRod>(fibres, coulomb);
}

TEST_CASE("friction answers a slide at a standing reaction by its own slope, stuck or sliding") {
    const Scene scene({straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 8),
                       straight_fibre({-0.5, 0, 1.9 * r}, {0.5, 0, 1.9 * r}, r, 8),
                       straight_fibre({0.1, -0.4, -1.9 * r}, {0.1, 0.5, -1.9 * r}, r, 6)});
    const Vector rest = scene.mesh.rest_state();
    auto contacts = contacts_of(scene.assembly, scene.mesh, coulomb);
    contacts.detect(rest, rest, 0.5 * r, false);
    for (const double slide : {0.3, 3.0}) {                       // in reversible displacements
        Vector aside = Vector::Zero(rest.size()), other = aside;  // the first fibre along itself, and across
        for (Index node = 0; node < scene.mesh.node_count(0); ++node) {
            aside[3 * scene.mesh.node_vector(0, node)] = 1.0;
            other.segment<3>(3 * scene.mesh.node_vector(0, node)) = Vec3(0.4, 0.7, 0.0);
        }
        const Vector state = rest + slide * 0.02 * r * aside;
        const double e = 1e-8;
        const Vector difference = (forces(contacts, state + e * other) - forces(contacts, state - e * other)) / (2.0 * e);
        const Vector force = forces(contacts, state);
        const Vector product = tangent_times(contacts, scene.mesh, state, other);
        CHECK((difference - product).norm() < 1e-6 * product.norm());
        const Vec3 sum = on_fibre(scene.mesh, force, 0);
        double reaction = 0.0;
        for (const contact::ContactResponse& response : contacts.responses()) reaction += response.reaction;
        // against the slide, as an internal force: up to mu R_N
        CHECK(std::abs(sum.x() - 0.3 * reaction * std::min(slide, 1.0)) < 1e-12 * reaction);
        CHECK((contacts.figures(state).dissipated > 0.0) == (slide > 1.0));
    }
}

TEST_CASE("what stuck friction remembers turns with the fibres, and files show what contacts exert and where fibres are") {
    const Scene scene(
        {straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 8), straight_fibre({-0.5, 0, 1.9 * r}, {0.5, 0, 1.9 * r}, r, 8),
         straight_fibre({0.1, -0.4, -1.9 * r}, {0.1, 0.5, -1.9 * r}, r, 6), straight_fibre({-0.4, 1, 0}, {0.4, 1, 0}, r, 6)});
    const Vector rest = scene.mesh.rest_state();
    auto contacts = contacts_of(scene.assembly, scene.mesh, coulomb);
    contacts.detect(rest, rest, 0.5 * r, false);
    Vector state = moved(scene.mesh, rest, 0, 0.02 * r * Vec3(0.5, 0.3, 0.0));  // within the reversible displacement
    const double bend = 0.2;                                                    // the last one, to z = bend x^2
    for (Index node = 0; node < scene.mesh.node_count(3); ++node) {
        const Index v = 3 * scene.mesh.node_vector(3, node);
        state[v + 2] = bend * state[v] * state[v];
    }
    contacts.evaluate(state);
    contacts.accept(state);
    contacts.detect(state, state, 0.5 * r, false);
    const Vector before = forces(contacts, state);
    const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    const Vector turned = (turn * Eigen::Map<const Eigen::Matrix3Xd>(state.data(), 3, state.size() / 3)).reshaped();
    contacts.detect(turned, turned, 0.5 * r, false);
    const Vector after = forces(contacts, turned);
    CHECK((after - (turn * Eigen::Map<const Eigen::Matrix3Xd>(before.data(), 3, before.size() / 3)).reshaped()).norm() <
          1e-9 * before.norm());
    // Of friction there is something: 0.3 of the reactions, for 0.58 of the reversible displacement.
    CHECK(on_fibre(scene.mesh, before, 0).head<2>().norm() > 0.05 * std::abs(on_fibre(scene.mesh, before, 1).z()));

    const observe::Snapshot shot = simulation::snapshot_of(scene.mesh, contacts, turned);
    const std::string touching = observe::contact_data(shot).text(), fibres = observe::fibre_data(shot).text();
    const auto friction = test::array_of<float>(touching, "friction"), pushed = test::array_of<float>(touching, "normal_force");
    const auto first = test::array_of<float>(touching, "fibre_i"), second = test::array_of<float>(touching, "fibre_j");
    for (Index fibre = 0; fibre < 3; ++fibre) {
        Vec3 sum = Vec3::Zero();
        for (std::size_t k = 0; k < first.size(); ++k) {
            const Vec3 on_i = Vec3(friction[3 * k], friction[3 * k + 1], friction[3 * k + 2]) -
                              Vec3(pushed[3 * k], pushed[3 * k + 1], pushed[3 * k + 2]);
            if (static_cast<Index>(first[k]) == fibre) sum += on_i;
            if (static_cast<Index>(second[k]) == fibre) sum -= on_i;
        }
        CHECK((sum + on_fibre(scene.mesh, after, fibre)).norm() <
              1e-6 * on_fibre(scene.mesh, after, 1).norm());  // floats; forces are internal ones
    }
    const auto displacement = test::array_of<float>(fibres, "displacement"),
               curvature = test::array_of<float>(fibres, "curvature");
    std::size_t point = 0;
    for (Index fibre = 0; fibre < 4; ++fibre)
        for (Index node = 0; node < scene.mesh.node_count(fibre); ++node, ++point) {
            const Index v = 3 * scene.mesh.node_vector(fibre, node);
            const Vec3 way = turned.segment<3>(v) - rest.segment<3>(v);
            CHECK((Vec3(displacement[3 * point], displacement[3 * point + 1], displacement[3 * point + 2]) - way).norm() <
                  1e-6 * way.norm());
            if (fibre == 3)
                CHECK(curvature[point] == test::near(2.0 * bend / std::pow(1.0 + std::pow(2.0 * bend * state[v], 2), 1.5), 1e-6));
        }
}

TEST_CASE("where an increment started, pairs far deeper than their zone was exert and store nothing, friction included") {
    const Scene scene({straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 8),
                       straight_fibre({-0.5, 0, 1.9 * r}, {0.5, 0, 1.9 * r}, r, 8),
                       straight_fibre({0.1, -0.4, -1.98 * r}, {0.1, 0.5, -1.98 * r}, r, 6)});
    const Vector rest = scene.mesh.rest_state(),
                 slid = moved(scene.mesh, rest, 0, {0.01 * r, 0, 0});  // by half of a reversible displacement
    struct Seen {
        std::array<Vec3, 3> on;  // each fibre
        contact::ContactFigures figures;
    };
    const auto settled = [&](const Vector& accepted) {
        auto contacts = contacts_of(scene.assembly, scene.mesh, coulomb);
        contacts.detect(rest, rest, 0.5 * r, false);
        contacts.evaluate(rest);
        contacts.hold_reactions();
        contacts.detect(accepted, rest, 0.5 * r, false);
        contacts.evaluate(accepted);
        contacts.accept(accepted);
        contacts.detect(slid, accepted, 0.5 * r, false);
        contacts.evaluate(slid);
        contacts.hold_reactions();
        return contacts;
    };
    const auto seen = [&](auto contacts, const Vector& state) {
        contacts.evaluate(state, true);
        Vector sum = Vector::Zero(state.size());
        contacts.add_forces(sum);
        Seen all{{}, contacts.figures(state)};
        for (Index fibre = 0; fibre < 3; ++fibre) all.on[core::at(fibre)] = on_fibre(scene.mesh, sum, fibre);
        return all;
    };
    // The upper pair was 0.1 r deep: it carries at 0.15 r, and is of no place where it stood at 0.25 r.
    const auto contacts = settled(slid);
    const Seen whole = seen(contacts, slid), deeper = seen(contacts, moved(scene.mesh, slid, 1, {0, 0, -0.05 * r})),
               part = seen(contacts, moved(scene.mesh, slid, 1, {0, 0, -0.15 * r}));
    CHECK(std::abs(whole.on[1].x()) > 0.05 * whole.on[1].norm());        // friction: half of 0.3
    CHECK(deeper.on[1].z() / whole.on[1].z() == test::near(1.5, 0.05));  // the penalty's regularised foot
    CHECK(part.on[1] == Vec3(Vec3::Zero()));
    CHECK(whole.on[2].norm() > 0.0);
    CHECK(part.on[2] == whole.on[2]);
    CHECK((part.on[0] + part.on[2]).norm() < 1e-12 * part.on[2].norm());
    CHECK((0.0 < part.figures.work && part.figures.work < 0.1 * whole.figures.work));
    // A pair that had no zone carried nothing, however little it seems to have been in contact.
    const Seen alone = seen(settled(moved(scene.mesh, slid, 2, {0, 0, -3.0 * r})), slid);
    CHECK(alone.on[2] == Vec3(Vec3::Zero()));
    CHECK(alone.on[1] == whole.on[1]);
}

TEST_CASE("fibres that cross and slid along themselves since are pushed where they cross now, which spins neither") {
    const Scene scene(
        {straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 8), straight_fibre({0, -0.5, 1.98 * r}, {0, 0.5, 1.98 * r}, r, 8)});
    const Vector rest = scene.mesh.rest_state();
    const Vector slid = moved(scene.mesh, moved(scene.mesh, rest, 0, {0.3 * r, 0, 0}), 1, {0, 0.3 * r, 0});
    auto contacts = contacts_of(scene.assembly, scene.mesh);
    contacts.detect(rest, rest, 0.5 * r, false);
    contacts.evaluate(rest);
    contacts.refresh(slid, rest);  // at the stations of before
    const Vector force = forces(contacts, slid);
    for (const Index fibre : {0, 1}) {
        const Vec3 push = on_fibre(scene.mesh, force, fibre), crossing(0, 0, static_cast<double>(fibre) * 1.98 * r);
        Vec3 moment = -crossing.cross(push);  // about the crossing, at the height of the fibre's axis
        for (Index v = scene.mesh.node_vector(fibre, 0); v < scene.mesh.node_vector(fibre, 0) + 3 * scene.mesh.node_count(fibre);
             ++v)
            moment += slid.segment<3>(3 * v).cross(force.segment<3>(3 * v));
        REQUIRE(std::abs(push.z()) > 0.0);
        CHECK(moment.norm() < 1e-12 * r * std::abs(push.z()));  // half-way between stations it were 0.2 r
    }
}

TEST_CASE("a fibre that slid around another stores and exerts the same where it came from, as it stood there") {
    const double apart = 1.98 * r, angle = 0.4;
    const Scene scene({straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 8), straight_fibre({-0.5, 0, apart}, {0.5, 0, apart}, r, 8)});
    const Vector start = scene.mesh.rest_state(),
                 end = moved(scene.mesh, start, 1, apart * Vec3(0.0, std::sin(angle), std::cos(angle) - 1.0));
    auto contacts = contacts_of(scene.assembly, scene.mesh);
    contacts.detect(end, end, 0.5 * r, false);
    const auto pressed = [&](const Vector& state, bool start) {
        contacts.evaluate(state, start);
        Vector forces = Vector::Zero(state.size());
        contacts.add_forces(forces);
        return std::pair<Vec3, double>(on_fibre(scene.mesh, forces, 1), contacts.figures(state).work);
    };
    const auto [force, work] = pressed(end, false);
    REQUIRE(work > 0.0);
    // As the pairs stand at the end, the start seems 1.98 r (1 - cos 0.4) = 0.16 r deep.
    CHECK(pressed(start, true).second > 10.0 * work);
    const auto pairs = contacts.turn_back(start);
    const auto [force_before, work_before] = pressed(start, true);
    CHECK(std::abs(work_before - work) < 1e-9 * work);
    const Mat3 turn = Eigen::AngleAxisd(-angle, Vec3::UnitX()).toRotationMatrix();
    CHECK((turn * force_before - force).norm() < 1e-9 * force.norm());
    contacts.turn_forth(pairs);
    CHECK(pressed(end, false) == std::pair<Vec3, double>(force, work));
}

TEST_CASE("a rule for a pair of groups changes the friction and the penetration of that pair alone") {
    // One fibre on two others, in the groups of a hierarchy: the rule is given for the outer group of one of them.
    for (const bool ruled : {false, true}) {
        scene::Assembly assembly;
        const Index upper = assembly.add_group("upper"), outer = assembly.add_group("outer"),
                    inner = assembly.add_group("inner", outer);
        const Index other = assembly.add_group("other");
        auto fibres = std::array{straight_fibre({-0.5, 0, 1.9 * r}, {0.5, 0, 1.9 * r}, r, 8),
                                 straight_fibre({-0.2, -0.4, 0}, {-0.2, 0.4, 0}, r, 6),
                                 straight_fibre({0.2, -0.4, 0}, {0.2, 0.4, 0}, r, 6)};
        fibres[0].group = upper, fibres[1].group = inner, fibres[2].group = other;
        for (const scene::FibreSpecification& fibre : fibres) assembly.add(fibre);
        if (ruled) {
            scene::PairRule rule;
            rule.first = outer, rule.second = upper, rule.friction_factor = 0.5, rule.penetration_factor = 4.0;
            assembly.add(rule);
        }
        const Mesh mesh(assembly, Beam{});
        auto contacts = contacts_of(assembly, mesh, coulomb);
        const Vector rest = mesh.rest_state();
        contacts.detect(rest, rest, 0.5 * r, false);
        const Vector slid = moved(mesh, rest, 0, {0.1 * r, 0, 0});
        contacts.evaluate(slid);
        REQUIRE(contacts.elements().size() == 2);
        const auto ratio = [&](Index k) {
            return contacts.frictions()[core::at(k)].force.norm() / contacts.responses()[core::at(k)].reaction;
        };
        CHECK(ratio(0) == test::near(ruled ? 0.15 : 0.3, 1e-12));
        CHECK(ratio(1) == test::near(0.3, 1e-12));
        const double before = contacts.zones()[0].stiffness;
        CHECK(before == contacts.zones()[1].stiffness);
        // 0.1 r deep where 0.05 r is allowed: the stiffness rises, and for 0.2 r it falls, as the adaptation says.
        contacts.accept(slid);
        const contact::StiffnessAdaptation all = contact_parameters().stiffness;
        contact::StiffnessAdaptation own = all;
        own.allowed_penetration *= ruled ? 4.0 : 1.0;
        for (const Index k : {0, 1}) {
            const double depth = -contacts.responses()[core::at(k)].gap;
            CHECK(contacts.zones()[core::at(k)].stiffness ==
                  test::near((k == 0 ? own : all).adapted(before, contacts.zones()[core::at(k)].reference, depth, 0.005 * r),
                             1e-12));
        }
        CHECK((contacts.zones()[0].stiffness == contacts.zones()[1].stiffness) == !ruled);
    }
    scene::Assembly assembly;
    assembly.add_group("only");
    CHECK_THROWS_WITH(assembly.add(scene::PairRule{0, 1}), "PairRule.group = 1, but it must be a group of this assembly");
    CHECK_THROWS_WITH(assembly.add(scene::PairRule{0, 0, -0.5}),
                      "PairRule.friction_factor = -0.5, but it must be finite and >= 0 (group 0 'only' and group 0 'only')");
}

/// Two families of four waving fibres that interlace, and an order between them.
scene::Assembly interlaced() {
    scene::Assembly assembly;
    Index groups[2][2];
    for (auto& family : groups)
        for (Index& group : family) group = assembly.add_group("group");
    for (int family = 0; family < 2; ++family)
        for (int k = 0; k < 4; ++k) {
            scene::FibreSpecification fibre = test::curved_fibre(
                [=](double t) {
                    const double along = 0.6 * (t - 0.5), across = 0.05 * (k - 1.5) + (k > 1 ? 0.04 : -0.04),
                                 height = 0.01 * std::sin(9.0 * t + k);
                    return family == 0 ? Vec3(along, across, height) : Vec3(across, along, height);
                },
                r, 8);
            fibre.group = groups[family][k / 2];
            assembly.add(fibre);
        }
    for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
            const bool over = (a + b) % 2 == 0;
            assembly.force_order({over ? groups[0][a] : groups[1][b], over ? groups[1][b] : groups[0][a], Vec3::UnitZ()});
        }
    return assembly;
}

template <class Search>
auto elements_by(const scene::Assembly& assembly, const Mesh& mesh, const Search& search, bool forced) {
    auto contacts = contacts_of<Frictionless, Search>(assembly, mesh, Frictionless{}, search);
    contacts.detect(mesh.rest_state(), mesh.rest_state(), 0.5 * r, forced);
    contacts.evaluate(mesh.rest_state());
    return std::pair(contacts.elements(), contacts.zones());
}

template <class Result>
void check_same(const Result& a, const Result& b) {
    REQUIRE(a.first.size() == b.first.size());
    REQUIRE(a.second.size() == b.second.size());
    for (std::size_t k = 0; k < a.second.size(); ++k) {
        CHECK(a.second[k].span == b.second[k].span);
        CHECK(a.second[k].forced == b.second[k].forced);
        CHECK(a.second[k].crossing == b.second[k].crossing);
        CHECK(a.second[k].order == b.second[k].order);
        CHECK(a.second[k].first == b.second[k].first);
        CHECK(a.second[k].last == b.second[k].last);
    }
    for (std::size_t k = 0; k < a.first.size(); ++k) {
        const auto &p = a.first[k], &q = b.first[k];
        const bool same = p.u_i == q.u_i && p.u_j == q.u_j && p.fibre_i == q.fibre_i && p.fibre_j == q.fibre_j &&
                          p.normal == q.normal && p.weights_i == q.weights_i && p.weights_j == q.weights_j && p.cap == q.cap &&
                          p.zone == q.zone;
        CHECK(same);
    }
}

TEST_CASE("every search finds the same zones and contact elements, with an order forced or without") {
    const scene::Assembly assembly = interlaced();
    const Mesh mesh(assembly, Beam{});
    for (const bool forced : {true, false}) {
        const auto brute = elements_by(assembly, mesh, proximity::BruteSearch{{}}, forced);
        CHECK(brute.first.size() > 20);
        check_same(brute, elements_by(assembly, mesh, proximity::GridSearch{{}}, forced));
        check_same(brute, elements_by(assembly, mesh, proximity::KdTreeSearch{{}}, forced));
        check_same(brute, elements_by(assembly, mesh, proximity::TestPointSearch{{.spacing = 0.08}}, forced));
        check_same(brute, test::with_threads(1, [&] { return elements_by(assembly, mesh, proximity::GridSearch{{}}, forced); }));
    }
}

TEST_CASE("fibres that cross both ways take the order of each crossing, the nearest one where they have slid") {
    scene::Assembly assembly;
    const Index one = assembly.add_group("one"), other = assembly.add_group("other");
    for (const double width : {0.0, 0.05}) {  // a straight one, and one that crosses it at a quarter and at three quarters
        scene::FibreSpecification fibre = test::curved_fibre(
            [width](double t) { return Vec3(0.6 * (t - 0.5), width * std::cos(2.0 * std::numbers::pi * t), 0.0); }, r, 8);
        fibre.group = width == 0.0 ? one : other;
        assembly.add(fibre);
    }
    assembly.force_order({one, other, Vec3::UnitZ(), 0.2, 0.3});
    assembly.force_order({other, one, Vec3::UnitZ(), 0.9, 0.6});
    const Mesh mesh(assembly, Beam{});
    const auto [elements, zones] = elements_by(assembly, mesh, proximity::GridSearch{{}}, true);
    REQUIRE(elements.size() == 2);
    for (const auto& element : elements) CHECK(element.normal.z() == (element.u_i < 4.0 ? -1.0 : 1.0));  // from the first one
    CHECK(zones[core::at(elements[0].zone)].order != zones[core::at(elements[1].zone)].order);
}

TEST_CASE("a forced order gives the normal wherever fibres are, and every crossing has its element") {
    const scene::Assembly assembly = interlaced();
    const Mesh mesh(assembly, Beam{});
    const auto [elements, zones] = elements_by(assembly, mesh, proximity::GridSearch{{}}, true);
    int crossings = 0;
    for (const auto& element : elements) {
        if (!zones[core::at(element.zone)].forced) continue;
        ++crossings;
        CHECK(element.fibre_i < 4);
        CHECK(element.fibre_j >= 4);
        const bool over = (element.fibre_i / 2 + (element.fibre_j - 4) / 2) % 2 == 0;  // the first family is above
        CHECK(element.normal.z() * (over ? -1.0 : 1.0) > 0.9);
    }
    CHECK(crossings == 16);
}

TEST_CASE("a pair in a forced order has a zone however deep it is on the wrong side, and none where it is clear by two radii") {
    struct Case {
        double clear;
        Index zones, elements;
    };
    for (const Case& known : {Case{-30.0, 1, 1}, {-1.0, 1, 1}, {1.9, 1, 0}, {2.1, 0, 0}, {30.0, 0, 0}}) {
        const double clear = known.clear;
        CAPTURE(clear);
        scene::Assembly assembly;
        const Index one = assembly.add_group("one"), other = assembly.add_group("other");
        for (const bool upper : {false, true}) {
            const double height = upper ? (2.0 + clear) * r : 0.0;
            scene::FibreSpecification fibre = test::curved_fibre(
                [upper, height](double t) {
                    const double along = 0.6 * (t - 0.5);
                    return upper ? Vec3(0.1, along, height) : Vec3(along, 0.1, height);
                },
                r, 8);
            fibre.group = upper ? one : other;
            assembly.add(fibre);
        }
        assembly.force_order({one, other, Vec3::UnitZ()});
        const Mesh mesh(assembly, Beam{});
        const auto [elements, zones] = elements_by(assembly, mesh, proximity::GridSearch{{}}, true);
        CHECK(core::count(zones) == known.zones);
        CHECK(core::count(elements) == known.elements);
        if (!elements.empty()) CHECK(elements.front().gap(mesh.rest_state()) == test::near(clear * r, 1e-12));
    }
}

TEST_CASE("the order in which fibres are named changes no force") {
    const std::vector<scene::FibreSpecification> fibres = some_fibres();
    const std::vector<std::size_t> order{3, 0, 5, 2, 4, 1};
    std::vector<scene::FibreSpecification> permuted;
    for (const std::size_t k : order) permuted.push_back(fibres[k]);
    const Scene one(fibres), other(permuted);
    const auto force = [](const Scene& scene) {
        auto contacts = contacts_of(scene.assembly, scene.mesh);
        contacts.detect(scene.mesh.rest_state(), scene.mesh.rest_state(), 0.5 * r, false);
        return forces(contacts, scene.mesh.rest_state());
    };
    const Vector f = force(one), g = force(other);
    CHECK(f.norm() > 0.0);
    for (std::size_t k = 0; k < order.size(); ++k) {
        const Index size = 9 * one.mesh.node_count(static_cast<Index>(order[k]));
        // closest points and planes are solved to 1e-11 elements
        CHECK((f.segment(3 * one.mesh.node_vector(static_cast<Index>(order[k]), 0), size) -
               g.segment(3 * other.mesh.node_vector(static_cast<Index>(k), 0), size))
                  .norm() < 1e-8 * f.norm());
    }
}

TEST_CASE("a crossing that slides off the end of a fibre has the gap of a round end, without a leap") {
    // Wires that cross between the plates that hold their ends went to and fro by 0.09 r where the gap leapt by as much.
    const double angle = 40.0 * std::numbers::pi / 180.0, height = 1.95 * r;
    const Vec3 along(std::cos(angle), std::sin(angle), 0.0);
    double worst = 0.0;
    for (int k = -20; k <= 100; ++k) {
        const double beyond = 0.01 * k * r;  // where the lines cross
        const Vec3 centre(beyond, 0.0, height);
        scene::Assembly assembly;
        assembly.add(straight_fibre({-1.0, 0, 0}, {0, 0, 0}, r, 12));
        assembly.add(straight_fibre(centre - 0.5 * along, centre + 0.5 * along, r, 12));
        const Mesh mesh(assembly, Beam{});
        auto contacts = contacts_of(assembly, mesh);
        const Vector rest = mesh.rest_state();
        contacts.detect(rest, rest, 0.2 * r, false);
        contacts.evaluate(rest);
        REQUIRE(contacts.elements().size() == 1);
        const double aside = std::max(0.0, beyond) * std::sin(angle);
        worst = std::max(worst, std::abs(contacts.responses()[0].gap - (std::hypot(height, aside) - 2.0 * r)));
    }
    CHECK(worst < 1e-4 * r);
}

TEST_CASE("contacts remember their side when elements are made anew after fibres have passed through each other") {
    const Scene scene({straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 8),
                       straight_fibre({-0.5, 0, 1.9 * r}, {0.5, 0, 1.9 * r}, r, 8),
                       straight_fibre({0.1, -0.4, -1.9 * r}, {0.1, 0.5, -1.9 * r}, r, 6)});
    const Vector rest = scene.mesh.rest_state();
    auto contacts = contacts_of(scene.assembly, scene.mesh);
    contacts.detect(rest, rest, 0.5 * r, false);
    contacts.evaluate(rest);
    contacts.accept(rest);
    // Both to the other side of the first fibre.
    const Vector passed = moved(scene.mesh, moved(scene.mesh, rest, 1, {0, 0, -2.2 * r}), 2, {0, 0, 2.2 * r});
    for (const bool restored : {false, true}) {
        if (restored) contacts.restore();
        contacts.detect(passed, rest, 0.5 * r, false);
        contacts.evaluate(passed);
        Index seen = 0;
        for (const auto& element : contacts.elements()) {
            if (element.fibre_i != 0) continue;
            ++seen;
            CHECK((element.normal - (element.fibre_j == 1 ? 1.0 : -1.0) * Vec3::UnitZ()).norm() < 1e-12);
            CHECK(element.gap(passed) == test::near(-2.3 * r, 1e-12));
        }
        CHECK(seen > 10);
    }
}

TEST_CASE("accepting a state brings the stiffness of its zones to the target of the penetration") {
    const Scene scene(
        {straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 8), straight_fibre({0.1, -0.4, 1.9 * r}, {0.1, 0.5, 1.9 * r}, r, 6)});
    const Vector rest = scene.mesh.rest_state();
    auto contacts = contacts_of(scene.assembly, scene.mesh);
    contacts.detect(rest, rest, 0.5 * r, false);
    contacts.evaluate(rest);
    REQUIRE(contacts.zones().size() == 1);
    const double before = contacts.zones()[0].stiffness;
    contacts.accept(
        rest);  // the penetration is 0.1 r, twice the allowed one: over (0.6 * 0.05) it asks for more than three times
    CHECK(contacts.zones()[0].stiffness == test::near(3.0 * before, 1e-12));
    contacts.detect(rest, rest, 0.5 * r, false);
    CHECK(contacts.zones()[0].stiffness == test::near(3.0 * before, 1e-12));
}

TEST_CASE("a fibre that comes by twice keeps each of its crossings: what stands at the other one is another zone's") {
    // A hairpin whose legs cross a straight fibre, so near to each other that their zones have a part of it in common.
    const double leg = 8.0 * r, half = 1.3 * r;
    auto hairpin = test::curved_fibre(
        [=](double t) {
            const double whole = 2.0 * leg + std::numbers::pi * half, s = t * whole;
            const double a = std::clamp((s - leg) / half, 0.0, std::numbers::pi);
            const double straight = s < leg ? leg - s : s > whole - leg ? s - whole + leg : 0.0;
            return Vec3(-half * std::cos(a), straight - half * std::sin(a), 1.95 * r);
        },
        r, 24);
    const Scene scene({straight_fibre({-8 * r, 5 * r, 0}, {8 * r, 5 * r, 0}, r, 8), hairpin});
    const Mesh& mesh = scene.mesh;
    const Vector state = mesh.rest_state();
    auto parameters = contact_parameters();
    parameters.places = contact::Places::followed;
    Contacts<> contacts(scene.assembly, mesh, parameters, proximity::GridSearch{proximity::GridSearch::Parameters{}}, penalty,
                        Frictionless{});
    for (int increment = 0; increment < 3; ++increment) {
        CAPTURE(increment);
        contacts.detect(state, state, 2.0 * r, false);
        contacts.evaluate(state);
        contacts.accept(state);
        REQUIRE(contacts.zones().size() == 2);
        for (const contact::Zone& zone : contacts.zones()) {
            REQUIRE(zone.last == zone.first + 1);
            const auto& element = contacts.elements()[core::at(zone.first)];
            CHECK(element.u_j == test::near(zone.span.closest_j, 0.05));
            CHECK(contacts.responses()[core::at(zone.first)].gap == test::near(-0.05 * r, 1e-3));
        }
        const auto& one = contacts.zones()[0].span;
        const auto& other = contacts.zones()[1].span;
        CHECK(std::min(one.b_i, other.b_i) > std::max(one.a_i, other.a_i));  // what they have in common
    }
}

TEST_CASE("fibres bent around each other that do not move do not slip, nor when both turn, where sections are strained") {
    // Where a place stands beside the closest one, the way between centres is not across both fibres, and particles of sections
    // that are pressed together are apart: told along two normals, what is between them would be a slip.
    for (const double flatness : {1.0, 0.8}) {
        CAPTURE(flatness);
        const double R = 3.0 * r, half = 0.4 * std::numbers::pi;
        auto below = test::curved_fibre(
            [=](double t) {
                const double a = half * (2.0 * t - 1.0);
                return Vec3(R * std::sin(a), 0.0, R - R * std::cos(a));
            },
            r, 7);
        auto above = test::curved_fibre(
            [=](double t) {
                const double a = half * (2.0 * t - 1.0);
                return Vec3(0.1 * R * std::sin(a), R * std::sin(a), 1.9 * r - R + R * std::cos(a));
            },
            r, 7);
        if (flatness < 1.0) below.section = above.section = scene::elliptical(r, flatness * r);
        const Scene scene({below, above});
        const Mesh& mesh = scene.mesh;
        const double pressed = 0.9;
        Vector state = mesh.rest_state();
        for (Index fibre = 0; fibre < 2; ++fibre)
            for (Index node = 0; node < mesh.node_count(fibre); ++node)
                for (const Index g : {1, 2}) state.segment<3>(3 * (mesh.node_vector(fibre, node) + g)) *= pressed;
        Vector turned = state;
        const Mat3 turn = core::rotation(Vec3(0.3, -0.5, 0.4));
        for (Index k = 0; k < turned.size(); k += 3) turned.segment<3>(k) = turn * state.segment<3>(k);
        for (const Vector& now : {state, turned}) {
            auto contacts = contacts_of(scene.assembly, mesh, coulomb);
            contacts.detect(now, state, 0.5 * r, false);
            contacts.evaluate(now);
            Index beside = 0;
            for (Index k = 0; k < core::count(contacts.elements()); ++k) {
                const auto& element = contacts.elements()[core::at(k)];
                REQUIRE(contacts.slides(k));
                beside += element.slide != 0;
                const Vec3 slip = element.friction_offset(now) - element.friction.accepted_offset;
                CHECK((slip - slip.dot(element.normal) * element.normal).norm() < 1e-12 * R);
            }
            if (flatness == 1.0) CHECK(beside >= 2);  // wide faces have none
        }
    }
}

using Centred = beam::OnCentreline<Beam>;
using Sliding = beam::OnCentreline<Beam, beam::FrictionLever::dropped>;
static_assert(beam::BeamElement<Centred> && beam::BeamElement<Sliding>);
static_assert(sizeof(contact::ContactElement<Centred, RegularisedPenalty, Frictionless>) + (12 + 7) * sizeof(double) ==
                  sizeof(BareElement),
              "a weight a node and side, and no meeting point");
static_assert(sizeof(contact::ContactElement<Sliding, RegularisedPenalty, RegularisedCoulomb>) <
              sizeof(Element<RegularisedPenalty, RegularisedCoulomb>));
static_assert(!beam::LeverNeeded<Beam> && beam::LeverNeeded<Centred> && !beam::LeverNeeded<Sliding>);

TEST_CASE("contact on centrelines refuses a section that is not round") {
    scene::Assembly assembly;
    scene::FibreSpecification fibre = straight_fibre(Vec3::Zero(), Vec3::UnitX(), r, 4);
    fibre.section = scene::elliptical(r, 0.5 * r);
    assembly.add(fibre);
    const Centred beam;
    CHECK_THROWS_WITH_AS((beam::Mesh<Centred>(assembly, beam)), doctest::Contains("OnCentreline.rest: semi_axis_2 = 0.01"),
                         std::invalid_argument);
}

TEST_CASE("what a contact element costs in memory") {
    std::printf("contact element: %zu bytes frictionless, %zu with friction, %zu frictionless with a limited gap\n",
                sizeof(Element<RegularisedPenalty, Frictionless>), sizeof(Element<RegularisedPenalty, RegularisedCoulomb>),
                sizeof(Element<law::LimitedGap<RegularisedPenalty>, Frictionless>));
}

}  // namespace contact_set_test
