// SPDX-License-Identifier: MIT
// Fibres in a solid: patch, rigid motion, tangent, one fibre's pull-out, a bundle's moduli, the solver.
#include "../refusal.hpp"
#include "../support/bonded_scene.hpp"
#include "../support/random_vector.hpp"

#include <fibrant/connection/bonded_solid.hpp>
#include <fibrant/distributed/shared_fibres.hpp>
#include <fibrant/distributed/thread_ranks.hpp>
#include <fibrant/solver/solid_pcg.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>

using namespace fibrant;

namespace bonded_solid_test {

using test::block;
using test::cuts;

using Element = solid::Hexahedron<solid::EnhancedStrains, solid::SaintVenantKirchhoff>;
using Bonded = connection::BondedSolid<Element, connection::NeverDebonds>;
using Scene = test::BondedScene<Bonded>;
using System = Scene::Equilibrium::System;
static_assert(assembly::LinearSystem<System> && solver::LinearSolver<solver::SolidPcg, System>);

// What a scene without a solid pays for it: nothing.
static_assert(std::is_empty_v<solid::NoSolid> && !core::Active<solid::NoSolid>);
static_assert(std::is_same_v<assembly::Equilibrium<Scene::Beam, Scene::Contacts>::System, assembly::ChainSystem<Scene::Beam>>);
/// What an equilibrium of fibres holds, member by member.
struct FibresAlone {
    const beam::Mesh<Scene::Beam>* mesh;
    Scene::Beam beam;
    Scene::Contacts* contacts;
    connection::PrescribedMotion<Scene::Beam> motion;
    [[no_unique_address]] connection::NoConnections::Of<Scene::Beam> ties;
    assembly::ChainSystem<Scene::Beam> system;
    load::AppliedLoad<Scene::Beam> load;
    damping::PlaceSprings springs;
    std::vector<Scene::Beam::Stresses> stresses;
    contact::LearnedContacts learned;
    std::vector<Vec3> targets;
    Vector external, reaction;
    double rounding;
};
static_assert(sizeof(assembly::Equilibrium<Scene::Beam, Scene::Contacts>) == sizeof(FibresAlone));
static_assert(sizeof(Scene::Equilibrium) > sizeof(FibresAlone));

Mat3 some_gradient() {
    Mat3 gradient;
    gradient << 0.05, 0.02, 0.0, -0.01, -0.03, 0.01, 0.02, 0.0, 0.04;
    return gradient;
}

/// A unit cube of 3 x 3 x 3 cells whose inner nodes are shifted, all of its faces on the path F(amplitude), with three fibres.
scene::Assembly cube(const Mat3& gradient, scene::ElasticMaterial solid, scene::ElasticMaterial fibre, double radius = 0.01) {
    scene::Assembly assembly;
    scene::Solid body = block(cuts(0, 1, 3), cuts(0, 1, 3), cuts(0, 1, 3), solid);
    std::mt19937 generator(9);
    std::uniform_real_distribution<double> draw(-0.06, 0.06);
    const auto inner = [](const Vec3& x) { return (x.array() > 0.01).all() && (x.array() < 0.99).all(); };
    for (Vec3& node : body.nodes)
        if (inner(node)) node += test::random_vector(draw, generator);
    assembly.add(body);
    for (const Index node : test::nodes_where(body, [&](const Vec3& x) { return !inner(x); })) {
        scene::SolidHold hold;
        hold.nodes = {node};
        hold.displacement = gradient * body.nodes[core::at(node)];
        assembly.hold(hold);
    }
    for (int k = 0; k < 3; ++k) {
        scene::FibreSpecification one;
        one.from = Vec3(0.1, 0.3 + 0.05 * k, 0.15 + 0.3 * k), one.to = Vec3(0.85, 0.8 - 0.3 * k, 0.3 + 0.25 * k);
        one.section = scene::circular(radius), one.material = fibre, one.elements = 4;
        assembly.hold_axial_rotation(scene::first_end(assembly.add(one)));  // bonds do not hold a fibre's turn about itself
    }
    return assembly;
}

TEST_CASE("fibres much softer than a uniformly strained block leave its field uniform") {
    const Mat3 f = Mat3::Identity() + some_gradient(), strain = 0.5 * (f.transpose() * f - Mat3::Identity());
    Scene scene(cube(some_gradient(), {1000.0, 0.3}, {3e-2, 0.3}, 1e-3));
    REQUIRE(scene.solid().bonds().size() == 27);
    CHECK(scene.solve() <= 1e-10);
    double field = 0.0, place = 0.0, fibres = 0.0;
    for (Index c = 0; c < scene.solid().cells(); ++c)
        field = std::max(field, (scene.solid().mean_state(scene.state, c).strain - strain).norm());
    for (Index n = 0; n < scene.solid().nodes(); ++n)
        place =
            std::max(place, (scene.state.segment<3>(3 * (scene.solid().first_vector() + n)) - f * scene.solid().start(n)).norm());
    for (const connection::Bond& bond : scene.solid().bonds())
        fibres = std::max(
            fibres, (scene.state.segment<3>(3 * bond.vector) - f * scene.mesh.start_state().segment<3>(3 * bond.vector)).norm());
    // E A of the fibres is 1e-10 of that of the block.
    CHECK(field <= 1e-10);
    CHECK(place <= 1e-10);
    CHECK(fibres <= 1e-8);  // E A of a fibre over the stiffness of its bonds
}

TEST_CASE("a rigid motion of fibres and solid gives no force") {
    for (const double sections : {0.0, 1.0}) {
        Scene scene(cube(Mat3::Zero(), {1000.0, 0.3}, {7e4, 0.3}), {.section_factor = sections});
        const Mat3 turn = Eigen::AngleAxisd(1.9, Vec3(2, -1, 0.7).normalized()).toRotationMatrix();
        Vector residual;
        const auto& layout = scene.equilibrium.system().layout();
        scene.equilibrium.begin(std::vector<double>(1, 0.0), scene.state);
        for (Index v = 0; v < layout.vectors(); ++v) {
            const Vec3 value = scene.state.segment<3>(3 * v);
            scene.state.segment<3>(3 * v) = turn * value;
            if (layout.kind[core::at(v)] == scene::VectorKind::position) scene.state.segment<3>(3 * v) += Vec3(3.0, -2.0, 5.0);
        }
        scene.equilibrium.residual(scene.state, residual);
        // Coordinates of 5 carry 1e-15; E h of a cell is 300, E A / l of an element of a fibre about 100.
        CHECK(residual.cwiseAbs().maxCoeff() <= 1e-10);
        CHECK(scene.equilibrium.elastic_energy(scene.state) <= 1e-20);
    }
}

TEST_CASE("the tangent of fibres and solid is the derivative of the residual, and its parts are those of one matrix") {
    Scene scene(cube(some_gradient(), {1000.0, 0.3}, {7e4, 0.3}), {.section_factor = 1.0});
    REQUIRE(scene.solid().bonds().size() == 81);
    std::mt19937 generator(4);
    std::uniform_real_distribution<double> draw(-1.0, 1.0);
    const auto& system = scene.equilibrium.system();
    Vector& state = scene.state;
    for (Index v = 0; v < system.layout().vectors(); ++v) state.segment<3>(3 * v) += 1e-2 * test::random_vector(draw, generator);
    scene.equilibrium.begin(std::vector<double>(1, 0.0), state);
    scene.equilibrium.linearise(state, false, 0.0);
    Vector direction(state.size()), image(state.size()), up, down, terms(state.size());
    for (Index k = 0; k < state.size(); ++k) direction[k] = 1e-6 * draw(generator);
    for (const scene::HeldVector& held : system.layout().held)
        direction.segment<3>(3 * held.vector) = (held.free * direction.segment<3>(3 * held.vector)).eval();
    system.apply(direction, image);
    scene.equilibrium.residual(state + direction, up), scene.equilibrium.residual(state - direction, down);
    CHECK((0.5 * (up - down) - image).norm() <= 1e-7 * image.norm());  // third derivatives times 1e-12, rounding 1e-10
    assembly::apply_terms(system, direction, terms);
    CHECK((terms - image).norm() <= 1e-12 * image.norm());
    std::vector<Matrix> bands;
    assembly::chain_bands_from_terms(system, bands);
    for (Index c = 0; c < core::count(bands); ++c) {
        Matrix own;
        system.chain_band(c, own);
        CHECK((own - bands[core::at(c)]).norm() <= 1e-12 * own.norm());
    }
}

TEST_CASE("a fibre's bonds are those of its nodes in cells, and their stiffness adds up to that of its length") {
    scene::Assembly assembly;
    assembly.add(block(cuts(0, 2, 20), cuts(-0.5, 0.5, 5), cuts(-0.5, 0.5, 5), {100.0, 0.25}));
    scene::FibreSpecification one;
    one.from = Vec3(-1.0, 0, 0), one.to = Vec3(2.0, 0, 0);
    one.section = scene::circular(0.01), one.material = {1e4, 0.3}, one.elements = 15;
    assembly.add(one);
    Scene scene(assembly);
    CHECK(scene.solid().bonds().size() == 21);  // nodes every 0.1 from x = 0 to 2
    double sum = 0.0;
    for (const connection::Bond& bond : scene.solid().bonds()) {
        sum += bond.stiffness;
        Vec3 place = Vec3::Zero();
        for (int k = 0; k < 8; ++k) place += bond.weights[k] * scene.solid().start(bond.nodes[core::at(k)]);
        CHECK((place - scene.mesh.start_state().segment<3>(3 * bond.vector)).norm() <= 1e-12);
    }
    // 2 pi G / ln(h / 2r) a length of 2 and half an end node's share of the element before: cells 0.1 x 0.2 x 0.2.
    const double per_length = 2.0 * std::numbers::pi * 40.0 / std::log(std::cbrt(0.1 * 0.2 * 0.2) / 0.02);
    CHECK(sum == test::near(per_length * (2.0 + 0.2 / 6.0), 1e-12));
    // Half of the block away: half of the bonds, and never beyond it.
    scene::Solid half = block(cuts(0, 1, 10), cuts(-0.5, 0.5, 5), cuts(-0.5, 0.5, 5), {100.0, 0.25});
    scene::Assembly partly;
    partly.add(half);
    partly.add(one);
    CHECK(Scene(partly).solid().bonds().size() == 11);
}

TEST_CASE("a fibre that turns about itself in a block is held by bonds of its sections, and by nothing else") {
    const double radius = 0.01, angle = 1e-3, shear = 40.0;
    const auto stiffness = [&](double sections) {
        scene::Assembly assembly;
        assembly.add(block(cuts(0, 2, 20), cuts(-0.5, 0.5, 5), cuts(-0.5, 0.5, 5), {100.0, 0.25}));
        scene::FibreSpecification one;
        one.from = Vec3::Zero(), one.to = Vec3(2.0, 0, 0);
        one.section = scene::circular(radius), one.material = {1e4, 0.3}, one.elements = 10;
        assembly.add(one);
        Scene scene(assembly, {.section_factor = sections});
        const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix();
        const auto& layout = scene.equilibrium.system().layout();
        for (Index v = 0; v < scene.solid().first_vector(); ++v)
            if (layout.kind[core::at(v)] != scene::VectorKind::position)
                scene.state.segment<3>(3 * v) = turn * scene.state.segment<3>(3 * v);
        return scene.equilibrium.elastic_energy(scene.state) / (0.5 * angle * angle);
    };
    // A stiff cylinder that turns in a matrix takes 4 pi G r^2 a length. Springs to the field of displacement that were chosen
    // for the shear of the section hold a turn 16 (1 - nu) / (3 (3 - 4 nu)) = 2 times as stiffly, over the matrix's part 1 - V of
    // a cell.
    const double cylinder = 4.0 * std::numbers::pi * shear * radius * radius * 2.0,
                 matrix = 1.0 - std::numbers::pi * radius * radius / (0.2 * 0.2);
    CHECK(stiffness(0.0) <= 1e-9 * cylinder);                            // energies of the fibre's section strains in 1e-16 E
    CHECK(stiffness(1.0) == test::near(2.0 * cylinder / matrix, 2e-3));  // a cell of the fibre is 8e-3 of fibre
}

/// Force that draws a fibre by `pull` out of a block that holds still, of a fibre of the length 1 that ends inside.
double pull_out_of_rigid(Index elements, double pull) {
    scene::Assembly assembly;
    const scene::Solid body = block(cuts(-0.1, 1.1, 12), cuts(-0.05, 0.05, 1), cuts(-0.05, 0.05, 1), {10.0, 0.25});
    assembly.add(body);
    scene::SolidHold hold;
    hold.nodes = test::nodes_where(body, [](const Vec3&) { return true; });
    assembly.hold(hold);
    scene::FibreSpecification one;
    one.from = Vec3(0, 0, 0), one.to = Vec3(1, 0, 0);
    one.section = scene::circular(0.01), one.material = {2000.0, 0.0}, one.elements = elements;
    const Index f = assembly.add(one);
    assembly.prescribe(scene::last_end(f), Vec3(pull, 0, 0));
    Scene scene(assembly);
    scene.solve();
    return scene.reaction([](const Vec3& x) { return x.x() == 1.0 && x.y() == 0.0; }).x();
}

TEST_CASE("the force to draw one fibre out converges with its mesh to shear lag") {
    // A rod on springs: F = u sqrt(E A k) tanh(L sqrt(k / E A)), k = 2 pi G / ln(h / 2r) = 15.6 a length.
    const double k = 2.0 * std::numbers::pi * 4.0 / std::log(0.1 / 0.02), stiffness = 2000.0 * std::numbers::pi * 1e-4,
                 pull = 1e-6;
    const double exact = pull * std::sqrt(stiffness * k) * std::tanh(std::sqrt(k / stiffness));
    double last = 1.0;
    for (const Index elements : {4, 8, 16, 32}) {
        const double error = pull_out_of_rigid(elements, pull) / exact - 1.0;
        MESSAGE("elements " << elements << ", transfer lengths an element "
                            << std::sqrt(k / stiffness) / static_cast<double>(elements) << ": error " << error);
        CHECK(std::abs(error) < 0.3 * last);  // order 2 or better, until the law's own 1.5 strain shows
        last = std::max(std::abs(error), 2e-5);
    }
    CHECK(last <= 1e-4);
}

/// Stiffness a length of the slip of a stiff fibre along the middle of a square block held at its sides, over 2 pi G / ln(R / r)
/// with R = 1.0787 times half the side, the conformal radius of the square.
double axial_stiffness(Index cells, double radius, const Vec3& offset) {
    scene::Assembly assembly;
    const double length = 2.0 / static_cast<double>(cells);
    const scene::Solid body = block(cuts(0, length, 1), cuts(-1, 1, cells), cuts(-1, 1, cells), {2.5, 0.25});
    assembly.add(body);
    scene::SolidHold sides, plane;
    const auto side = [](const Vec3& x) { return std::max(std::abs(x.y()), std::abs(x.z())) > 0.999; };
    sides.nodes = test::nodes_where(body, side);
    plane.nodes = test::nodes_where(body, [&](const Vec3& x) { return !side(x); });
    plane.directions = Vec3(0, 1, 1).asDiagonal();
    assembly.hold(sides), assembly.hold(plane);
    scene::FibreSpecification one;
    one.from = offset, one.to = Vec3(length, 0, 0) + offset;
    one.section = scene::circular(radius), one.material = {1e9, 0.0}, one.elements = 2;
    const Index f = assembly.add(one);
    for (const double at : {0.0, 0.25, 0.5, 0.75, 1.0}) assembly.prescribe({f, at}, Vec3(1e-6, 0, 0));
    Scene scene(assembly);
    scene.solve(1.0, 3);
    Vec3 sum = Vec3::Zero();
    for (Index a = 0; a < scene.mesh.node_count(0); ++a)
        sum += scene.equilibrium.reaction().segment<3>(3 * scene.mesh.node_vector(0, a));
    return sum.x() / 1e-6 / length * std::log(1.0787 / radius) / (2.0 * std::numbers::pi);
}

TEST_CASE("how far a fibre's slip depends on the size of cells is bounded") {
    for (const double radius : {0.005, 0.02})
        for (const Index cells : {5, 9, 19, 39}) {
            const double middle = axial_stiffness(cells, radius, Vec3::Zero());
            const double node = axial_stiffness(cells, radius, Vec3(0, 1.0, 1.0) / static_cast<double>(cells));
            MESSAGE("cell over radius " << 2.0 / static_cast<double>(cells) / radius << ": stiffness over shear lag " << middle
                                        << " in the middle of a cell, " << node << " on an edge");
            // Cells of more than 4 radii: what they do not resolve is that of the formula, 5 % off; along an edge the cells
            // themselves give way more. Smaller cells are softer, as the formula is bounded there.
            const bool large = 2.0 / static_cast<double>(cells) > 4.0 * radius;
            CHECK(middle > (large ? 1.04 : 0.95));
            CHECK(middle < 1.08);
            CHECK(node > (large ? 0.72 : 0.65));
            CHECK(node < 0.80);
        }
}

struct Moduli {
    double along, across, shear, shear_along;
};
struct Bundle {
    double fraction, ratio;  ///< of the fibres' volume; their Young's modulus over that of the matrix
    Index cells = 4;         ///< of the unit cube along each edge, across the fibres
    double offset = 0.0;     ///< of the fibres from the middles of the quarters of the cube
    double section_factor = 0.0;
    bool lowered = false;  ///< fibres' moduli by those of the matrix
};
/// Moduli of a unit cube with 2 x 2 fibres along x, over those of the matrix: drawn along them, sides free; drawn across them at
/// a fixed length along them, the other sides free; sheared across and along them on all faces.
Moduli moduli(const Bundle& bundle) {
    Moduli result{};
    const double radius = 0.5 * std::sqrt(bundle.fraction / std::numbers::pi), strain = 1e-6;
    const scene::ElasticMaterial matrix{1.0, 0.3};
    for (int load = 0; load < 4; ++load) {
        scene::Assembly assembly;
        const scene::Solid body = block(cuts(0, 1, 4), cuts(0, 1, bundle.cells), cuts(0, 1, bundle.cells), matrix);
        assembly.add(body);
        Mat3 gradient = Mat3::Zero();
        if (load == 0) gradient(0, 0) = strain;
        if (load == 1) gradient(1, 1) = strain;
        if (load == 2) gradient(1, 2) = gradient(2, 1) = 0.5 * strain;
        if (load == 3) gradient(0, 1) = gradient(1, 0) = 0.5 * strain;
        for (Index n = 0; n < core::count(body.nodes); ++n) {
            const Vec3 x = body.nodes[core::at(n)];
            scene::SolidHold hold;
            hold.nodes = {n}, hold.displacement = gradient * x;
            const Index axis = load == 0 ? 0 : 1;
            if (load >= 2) {
                if ((x.array() > 1e-9).all() && (x.array() < 1.0 - 1e-9).all()) continue;
            } else {
                hold.directions.setZero();
                if (x[axis] < 1e-9 || x[axis] > 1.0 - 1e-9) hold.directions(axis, axis) = 1.0;
                for (int k = 0; k < 3; ++k)
                    if (x[k] < 1e-9) hold.directions(k, k) = 1.0;
                if (load == 1 && x.x() > 1.0 - 1e-9) hold.directions(0, 0) = 1.0;
                if (hold.directions.isZero()) continue;
            }
            assembly.hold(hold);
        }
        for (const double y : {0.25, 0.75})
            for (const double z : {0.25, 0.75}) {
                scene::FibreSpecification one;
                one.from = Vec3(0, y + bundle.offset, z + bundle.offset), one.to = Vec3(1, y + bundle.offset, z + bundle.offset);
                one.section = scene::circular(radius), one.material = {bundle.ratio - (bundle.lowered ? 1.0 : 0.0), 0.3},
                one.elements = 4;
                const Index f = assembly.add(one);
                if (load == 0) {
                    assembly.hold_position(scene::first_end(f), Vec3(1, 0, 0).asDiagonal());
                    scene::Hold hold;
                    hold.at = scene::last_end(f), hold.directions = Vec3(1, 0, 0).asDiagonal(),
                    hold.displacement = Vec3(strain, 0, 0);
                    assembly.hold(hold);
                }
                if (load == 1)
                    for (const scene::Station& end : {scene::first_end(f), scene::last_end(f)})
                        assembly.hold_position(end, Vec3(1, 0, 0).asDiagonal());
            }
        Scene scene(assembly, {.section_factor = bundle.section_factor});
        scene.solve(1.0, 3);
        if (load == 0) result.along = scene.reaction([](const Vec3& x) { return x.x() > 1.0 - 1e-9; }).x() / strain;
        if (load == 1)
            result.across = scene.reaction([](const Vec3& x) { return x.y() > 1.0 - 1e-9; }).y() / strain * (1.0 - 0.3 * 0.3);
        if (load >= 2)
            (load == 2 ? result.shear : result.shear_along) =
                scene.equilibrium.elastic_energy(scene.state) / (0.5 * strain * strain) / matrix.shear_modulus();
    }
    return result;
}

/// Bounds of the moduli across fibres, over those of the matrix: Young's modulus in plane strain, and shear modulus.
struct Bounds {
    double reuss, voigt, low_e, low_g, high_e, high_g;  ///< Hashin and Shtrikman: low and high
    double low_along, high_along;                       ///< of shear along the fibres
};
Bounds bounds(double fraction, double ratio, double nu = 0.3) {
    const auto shear = [&](double e) { return e / (2.0 * (1.0 + nu)); };
    const auto plane_bulk = [&](double e) { return shear(e) / (1.0 - 2.0 * nu); };  // of plane strain
    const double v = fraction, gm = shear(1.0), gf = shear(ratio), km = plane_bulk(1.0), kf = plane_bulk(ratio);
    // Hashin (1965): of plane-strain bulk and transverse shear; the upper ones with matrix and fibres exchanged.
    const auto bulk = [](double k1, double g1, double k2, double part) {
        return k1 + part / (1.0 / (k2 - k1) + (1.0 - part) / (k1 + g1));
    };
    const auto across = [](double k1, double g1, double g2, double part) {
        return g1 + part / (1.0 / (g2 - g1) + (1.0 - part) * (k1 + 2.0 * g1) / (2.0 * g1 * (k1 + g1)));
    };
    const auto along = [](double g1, double g2, double part) {
        return g1 + part / (1.0 / (g2 - g1) + (1.0 - part) / (2.0 * g1));
    };
    const auto young = [&](double g, double k) { return 4.0 / (1.0 / g + 1.0 / k) * (1.0 - nu * nu); };
    const double g_low = across(km, gm, gf, v), g_high = across(kf, gf, gm, 1.0 - v);
    return {1.0 / (v / ratio + 1.0 - v),
            v * ratio + 1.0 - v,
            young(g_low, bulk(km, gm, kf, v)),
            g_low / gm,
            young(g_high, bulk(kf, gf, km, 1.0 - v)),
            g_high / gm,
            along(gm, gf, v) / gm,
            along(gf, gm, 1.0 - v) / gm};
}

TEST_CASE(
    "a bundle of fibres in a matrix is as stiff along them as the rule of mixtures says, across them once sections are bonded") {
    for (const double fraction : {0.2, 0.5}) {
        const double ratio = 100.0;
        const Bounds bound = bounds(fraction, ratio);
        const Moduli centres = moduli({fraction, ratio});
        MESSAGE("fraction " << fraction << ", centres bonded: along " << centres.along << ", across " << centres.across
                            << ", shear " << centres.shear << "; Reuss " << bound.reuss);
        // The meshes overlap, so that the matrix fills the fibres' place too.
        CHECK(centres.along == test::near(fraction * ratio + 1.0, 1e-4));
        // Bonds hold centrelines, so that sections do not stiffen the matrix across them.
        CHECK(centres.across >= 1.0 - 1e-6);
        CHECK(centres.shear >= 1.0 - 1e-6);
        CHECK(centres.across < bound.reuss);
        for (const double stiff : {20.0, ratio})
            for (const Index cells : {1, 2, 3, 4}) {
                const Bounds own = bounds(fraction, stiff);
                const Moduli found = moduli({fraction, stiff, cells, cells == 4 ? 0.125 : 0.0, 1.0, true});
                MESSAGE("fraction " << fraction << ", E ratio " << stiff << ", " << cells
                                    << " cells an edge, sections bonded: along " << found.along << " of "
                                    << fraction * stiff + 1.0 - fraction << ", across " << found.across << " of " << own.low_e
                                    << " to " << own.high_e << ", shear " << found.shear << " of " << own.low_g << " to "
                                    << own.high_g << ", along " << found.shear_along << " of " << own.low_along << " to "
                                    << own.high_along << ", Reuss " << own.reuss);
                CHECK(found.along == test::near(fraction * stiff + 1.0 - fraction, 0.01));
                CHECK(found.across < own.high_e);
                CHECK(found.shear < own.high_g);
                // Where every cell holds as much fibre; cells smaller than that are stiff in some places and bare in others.
                if (cells <= 2) CHECK(found.across > own.low_e);
                if (cells <= 2) CHECK(found.shear > own.low_g);
                if (cells <= 2) CHECK(found.shear < 1.25 * own.low_g);
                // Sheared along the fibres: between the sums of compliances and of stiffnesses (one law for E and G, as Poisson's
                // ratio is the same), and within the narrower bounds while bonds, made for a thin fibre, are not those of half
                // the volume.
                CHECK(found.shear_along > own.reuss);
                CHECK(found.shear_along < own.high_along);
                if (fraction < 0.3) CHECK(found.shear_along > own.low_along);
            }
    }
}

/// A linear system of fibres in a block, and a load on all of it.
struct Linear {
    Scene scene;
    SparseMatrix matrix;
    Vector load, exact;
    explicit Linear(double factor)
        : scene{cube(some_gradient(), {1000.0, 0.3}, {7e4, 0.3}), {.bonding_factor = factor, .section_factor = factor}} {
        scene.equilibrium.begin(std::vector<double>(1, 0.0), scene.state);
        scene.equilibrium.linearise(scene.state, false, 0.0);
        assembly::assemble_from_terms(system(), matrix);
        std::mt19937 generator(4);
        std::uniform_real_distribution<double> draw(-1.0, 1.0);
        load.resize(matrix.rows());
        for (Index k = 0; k < load.size(); ++k) load[k] = draw(generator) * system().layout().length[core::at(k / 3)];
        exact = Eigen::SimplicialLDLT<SparseMatrix>(matrix).solve(load);
    }
    const System& system() const { return scene.equilibrium.system(); }
};

TEST_CASE("conjugate gradients find what a direct solver does, in few iterations however stiff bonds are") {
    for (const double factor : {1.0, 1000.0}) {
        const Linear linear(factor);
        const System& system = linear.system();
        Vector x;
        int iterations[2];
        for (const bool carried : {false, true}) {
            solver::SolidPcg pcg({.carried = carried});
            pcg.analyse(system);
            REQUIRE(pcg.prepare(system) == solver::SolveStatus::converged);
            const solver::SolveReport report = pcg.solve(system, linear.load, 1e-10, x);
            CHECK(report.status == solver::SolveStatus::converged);
            const Vector difference = linear.matrix * (x - linear.exact);
            CHECK(difference.norm() <= 1e-8 * linear.load.norm());
            iterations[carried ? 1 : 0] = report.iterations;
        }
        MESSAGE("bonds times " << factor << ": iterations " << iterations[1] << ", with blocks for fibres and solid alone "
                               << iterations[0]);
        CHECK(iterations[1] <= 40);
    }
}

template <distributed::Exchange E>
Vector solved(const Linear& linear, const typename E::Parameters& exchange = {}) {
    typename distributed::SharedSolidPcg<E>::Parameters parameters;
    parameters.fibres.cut.parts = 4, parameters.fibres.exchange = exchange;
    distributed::SharedSolidPcg<E> pcg(parameters);
    pcg.analyse(linear.system());
    Vector x = Vector::Zero(linear.load.size());
    if (pcg.prepare(linear.system()) == solver::SolveStatus::converged) pcg.solve(linear.system(), linear.load, 1e-10, x);
    return x;
}

TEST_CASE("ranks that share the fibres of a composite find what a direct solver does, with the same bits however many") {
    const Linear linear(1.0);
    const Vector alone = solved<distributed::OneRank>(linear);
    const Vector difference = linear.matrix * (alone - linear.exact);
    CHECK(difference.norm() <= 1e-8 * linear.load.norm());
    for (const int ranks : {2, 3})
        distributed::run_on_threads(ranks, [&](const auto& own) {
            const Linear same(1.0);  // a system serves one thread at a time
            CHECK(solved<distributed::ThreadRank>(same, own) == alone);
        });
}

TEST_CASE("wrong input is refused by name") {
    scene::Assembly assembly;
    scene::Solid body = block(cuts(0, 1, 1), cuts(0, 1, 1), cuts(0, 1, 1), {1.0, 0.5});
    CHECK(test::refusal([&] { assembly.add(body); }).starts_with("Solid.material.poisson_ratio = 0.5"));
    body.material = {1.0, 0.3};
    body.cells[0][3] = 8;
    CHECK(test::refusal([&] { assembly.add(body); }).starts_with("Solid.cells = 8"));
    body.cells.clear();
    CHECK(test::refusal([&] { assembly.add(body); }).starts_with("Solid.cells = 0"));
    CHECK(test::refusal([&] { assembly.hold(scene::SolidHold{}); }).starts_with("SolidHold.solid = 0"));
    CHECK(test::refusal([] { Bonded({.bonding_factor = 0.0}); }).starts_with("BondedSolid.bonding_factor = 0"));
    CHECK(test::refusal([] { Bonded({.section_factor = -1.0}); }).starts_with("BondedSolid.section_factor = -1"));
    CHECK(test::refusal([] { connection::DebondsAtTraction({}); }).starts_with("DebondsAtTraction.strength = nan"));
}

}  // namespace bonded_solid_test
