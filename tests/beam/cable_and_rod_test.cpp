// SPDX-License-Identifier: MIT
// The Kirchhoff cable and the rod of rigid sections: the contract, and what their energies are in simple states.
#include <beam/beam_element_contract.hpp>
#include <near.hpp>
#include <refusal.hpp>

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>

#include <cstdio>
#include <numbers>

using namespace fibrant;

namespace cable_and_rod_test {

using namespace fibrant::test;
using beam::KirchhoffCable;
using beam::RigidSectionRod;

const double radius = 0.0201, length = 6.0 * radius, pi = std::numbers::pi;
const scene::ElasticMaterial material{7300.0, 0.3};
const scene::CrossSection section = scene::circular(radius);
const double area = pi * radius * radius, inertia = 0.25 * area * radius * radius, shear = 7300.0 / 2.6;

/// Frame of a section that turns at a constant rate about an axis of the section: a helix or an arc, from the origin.
scene::NodeFrame turned_frame(double s, const Vec3& curvature, double stretch = 1.0) {
    const double rate = curvature.norm();
    scene::NodeFrame frame;
    const Mat3 turn = core::rotation(s * curvature);
    frame.director_1 = turn.col(0), frame.director_2 = turn.col(1), frame.tangent = turn.col(2);
    // integral of exp(s [k]) e_3
    const double p = rate * s;
    const core::SpinCoefficients c = core::spin_coefficients(p);
    const Mat3 k = core::cross_matrix(s * curvature);
    frame.position = stretch * s * (Mat3::Identity() + c.b * k + c.c * k * k) * Vec3::UnitZ();
    return frame;
}
template <class B>
beam::ElementVector<B> element(const scene::NodeFrame& first, const scene::NodeFrame& last, const Mat3& turn = Mat3::Identity()) {
    beam::ElementVector<B> y;
    for (int node = 0; node < 2; ++node) {
        scene::NodeFrame frame = node == 0 ? first : last;
        frame.position = turn * frame.position, frame.tangent = turn * frame.tangent;
        frame.director_1 = turn * frame.director_1, frame.director_2 = turn * frame.director_2;
        if constexpr (beam::CentrelineOnly<B>) {
            const auto vectors = B::nodal_vectors(frame, length);
            y.template segment<6>(6 * node) << vectors[0], vectors[1];
        } else {
            const auto vectors = B::nodal_vectors(frame);
            y.template segment<6>(6 * node) << vectors[0], vectors[1];
        }
    }
    return y;
}
const Mat3 any_turn = Eigen::AngleAxisd(2.9, Vec3(1, 2, 3).normalized()).toRotationMatrix();

template <class B>
void report(const char* name, const ElementErrors& e) {
    std::printf("%s: force %.1e, tangent %.1e, prediction %.1e, rotation %.1e\n", name, e.force, e.tangent, e.prediction,
                e.rotation);
}

TEST_CASE_TEMPLATE("a straight element of each kind owes the contract of beam elements", B, KirchhoffCable, RigidSectionRod) {
    for (const Mat3& turn : {Mat3(Mat3::Identity()), any_turn}) {
        const beam::ElementVector<B> straight =
            element<B>(turned_frame(0.0, Vec3::Zero()), turned_frame(length, Vec3::Zero()), turn);
        const B beam;
        report<B>("straight", check_beam_element(beam, beam.rest(section, material, straight), straight, length, radius, 20));
    }
}

TEST_CASE("a rod that is a helix at rest, of an elliptical section, owes it too") {
    const Vec3 curvature = Vec3(0.3, -0.5, 0.4) / length;
    const auto helix = element<RigidSectionRod>(turned_frame(0.0, curvature), turned_frame(length, curvature), any_turn);
    const RigidSectionRod beam{{.shear_factor = 0.9}};
    report<RigidSectionRod>("helix", check_beam_element(beam, beam.rest(scene::elliptical(0.025, 0.014), material, helix), helix,
                                                        length, radius, 20));
}

TEST_CASE("a rod has the energy of its strains in any helix, however long the element") {
    const auto straight = element<RigidSectionRod>(turned_frame(0.0, Vec3::Zero()), turned_frame(length, Vec3::Zero()));
    const RigidSectionRod beam;
    const auto rest = beam.rest(section, material, straight);
    for (const double angle : {0.1, 1.0, 2.0}) {
        const Vec3 curvature = Vec3(0.5, -0.7, 0.5) * angle / length;
        const auto bent = element<RigidSectionRod>(turned_frame(0.0, curvature), turned_frame(length, curvature), any_turn);
        const Vec3 stiffness(7300.0 * inertia, 7300.0 * inertia, 2.0 * shear * inertia);
        const double expected = 0.5 * length * curvature.dot(stiffness.cwiseProduct(curvature));
        // The two sections turn as the helix does; the mean section sees the chord, which an arc is angle^2 / 24 longer than.
        const auto s = beam.stresses(rest, bent).value;
        CHECK(0.5 * length * s.tail<3>().dot(Vec3(s[3] / stiffness[0], s[4] / stiffness[1], s[5] / stiffness[2])) ==
              test::near(expected, 1e-13));
        CHECK(s.head<3>().norm() <= 7300.0 * area * angle * angle / 24.0);
    }
    const auto pulled = element<RigidSectionRod>(turned_frame(0.0, Vec3::Zero()), turned_frame(length, Vec3::Zero(), 1.01));
    CHECK(beam.energy(rest, pulled) == test::near(0.5 * 7300.0 * area * 1e-4 * length, 1e-12));
}

TEST_CASE("whole turns of a rotation vector change neither the strains of a rod nor its particles") {
    const auto straight = element<RigidSectionRod>(turned_frame(0.0, Vec3::Zero()), turned_frame(length, Vec3::Zero()), any_turn);
    const RigidSectionRod beam;
    const auto rest = beam.rest(section, material, straight);
    auto bent = straight;
    bent.segment<3>(3) += Vec3(0.2, -0.1, 0.15), bent.segment<3>(6) += 0.1 * length * Vec3(1, 2, 3),
        bent.segment<3>(9) += Vec3(-0.1, 0.3, 0.2);
    auto far = bent;
    for (const Index v : {3, 9}) {
        const Vec3 psi = bent.segment<3>(v);
        far.segment<3>(v) = psi * (1.0 - 2.0 * pi / psi.norm());
        CHECK((core::nearest_rotation_vector(Vec3(far.segment<3>(v)), psi) - psi).norm() < 1e-14);
        // The nearest of them, be it beyond or before.
        for (const auto& [turns, nearest] : {std::pair{0.4, 0.0}, {0.9, 1.0}, {1.6, 2.0}, {-0.4, 0.0}, {-0.9, -1.0}}) {
            const Vec3 to = psi * (1.0 + 2.0 * pi * turns / psi.norm());
            CHECK((core::nearest_rotation_vector(psi, to) - psi * (1.0 + 2.0 * pi * nearest / psi.norm())).norm() < 1e-13);
        }
    }
    CHECK(beam.energy(rest, far) == test::near(beam.energy(rest, bent), 1e-11));
    const RigidSectionRod::Particle particle = RigidSectionRod::particle_weights(0.3, 0.7 * radius, -0.4 * radius);
    CHECK((particle.place(far) - particle.place(bent)).norm() < 1e-14);
}

TEST_CASE("a particle of a rod moves as its derivatives say") {
    const auto straight = element<RigidSectionRod>(turned_frame(0.0, Vec3::Zero()), turned_frame(length, Vec3::Zero()), any_turn);
    RigidSectionRod::Particle particle = RigidSectionRod::particle_weights(-0.2, 0.6 * radius, 0.8 * radius);
    particle.follow(straight);
    for (Index k = 0; k < 12; ++k) {
        auto ahead = straight, behind = straight;
        ahead[k] += 1e-6, behind[k] -= 1e-6;  // relative errors 1e-12 by the step and 1e-10 by rounding
        const Vec3 difference = (particle.place(ahead) - particle.place(behind)) / 2e-6;
        CHECK((difference - particle.slope(k / 3).col(k % 3)).norm() < 1e-9);
    }
}

TEST_CASE("a cable bends by its curvature and stretches by its length") {
    const auto straight = element<KirchhoffCable>(turned_frame(0.0, Vec3::Zero()), turned_frame(length, Vec3::Zero()));
    const KirchhoffCable beam;
    const auto rest = beam.rest(section, material, straight);
    const auto pulled = element<KirchhoffCable>(turned_frame(0.0, Vec3::Zero()), turned_frame(length, Vec3::Zero()));
    CHECK(beam.energy(rest, 1.01 * pulled) == test::near(0.5 * 7300.0 * area * 1e-4 * length, 1e-12));
    for (const double angle : {0.05, 0.1}) {
        // Hermite's curve differs from the arc by a relative angle^2 / 100 or so in curvature
        const Vec3 curvature = Vec3(0.6, -0.8, 0.0) * angle / length;
        const auto bent = element<KirchhoffCable>(turned_frame(0.0, curvature), turned_frame(length, curvature), any_turn);
        const double expected = 0.5 * 7300.0 * inertia * angle * angle / length;
        CHECK(beam.energy(rest, bent) == test::near(expected, angle * angle / 10.0));
    }
}

TEST_CASE("what a cable cannot be is refused by name") {
    const Vec3 curvature(0.1 / length, 0.0, 0.0);
    const auto straight = element<KirchhoffCable>(turned_frame(0.0, Vec3::Zero()), turned_frame(length, Vec3::Zero()));
    const auto bent = element<KirchhoffCable>(turned_frame(0.0, curvature), turned_frame(length, curvature));
    CHECK(refusal([&] {
              KirchhoffCable{}.rest(scene::elliptical(0.02, 0.01), material, straight);
          }).find("KirchhoffCable.rest: semi_axis_2 = 0.01") == 0);
    CHECK(refusal([&] {
              KirchhoffCable{}.rest(section, material, bent);
          }).find("KirchhoffCable.rest: turn between chord and tangent = 0.05") == 0);
    CHECK(refusal([&] { RigidSectionRod{{.shear_factor = -1.0}}; }) ==
          "RigidSectionRod.shear_factor = -1, but it must be finite and > 0");
}

}  // namespace cable_and_rod_test
