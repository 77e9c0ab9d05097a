// SPDX-License-Identifier: MIT
#include "refusal.hpp"

#include <fibrant/scene/reference_shape.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <numbers>

using namespace fibrant;

namespace reference_shape_test {

using test::refusal;

/// Helix of radius R and rise c a radian, `turns` turns.
struct Helix {
    double R = 1.0, c = 0.5, turns = 2.0;
    double speed() const { return std::hypot(R, c); }
    double angle_at(double s) const { return s / speed(); }
    double length() const { return 2.0 * std::numbers::pi * turns * speed(); }
    double torsion() const { return c / (R * R + c * c); }
    Vec3 position(double a) const { return {R * std::cos(a), R * std::sin(a), c * a}; }
    Vec3 tangent(double a) const { return Vec3(-R * std::sin(a), R * std::cos(a), c) / speed(); }
    Vec3 normal(double a) const { return {-std::cos(a), -std::sin(a), 0.0}; }
    Vec3 binormal(double a) const { return tangent(a).cross(normal(a)); }
    /// The vector that starts as the principal normal and does not turn about the tangent (Bishop 1975).
    Vec3 untwisted(double a) const {
        const double turned = torsion() * a * speed();
        return std::cos(turned) * normal(a) - std::sin(turned) * binormal(a);
    }
    scene::Curve curve() const {
        return [*this](double t) { return position(2.0 * std::numbers::pi * turns * t); };
    }
};

TEST_CASE("directors are carried along a helix without twist about its axis") {
    const Helix helix;
    const auto error = [&](Index nodes) {
        const auto frames = scene::reference_frames(helix.curve(), nodes, helix.normal(0.0));
        double most = 0.0;
        for (Index k = 0; k < nodes; ++k) {
            const double a = helix.angle_at(helix.length() * static_cast<double>(k) / static_cast<double>(nodes - 1));
            const scene::NodeFrame& frame = frames[core::at(k)];
            most = std::max({most, (frame.position - helix.position(a)).norm(), (frame.tangent - helix.tangent(a)).norm(),
                             (frame.director_1 - helix.untwisted(a)).norm()});
            CHECK((frame.basis().transpose() * frame.basis() - Mat3::Identity()).norm() < 1e-14);
            CHECK(frame.basis().determinant() == test::near(1.0, 1e-12));
        }
        return most;
    };
    // The transport of two reflections is of the fourth order: 16 steps a node on 2 turns are 0.05 radian each with
    // 17 nodes, and (0.05)^4 = 6e-6 a turn at most. Arc length is exact here but for the same order.
    const double coarse = error(17), fine = error(33);
    CHECK(coarse < 1e-6);
    CHECK(fine < coarse / 12.0);
}

TEST_CASE("nodes are equally far apart along a curve, however its parameter runs") {
    const Helix helix;
    const scene::Curve uneven = [&](double t) { return helix.curve()(0.5 * (t + t * t)); };  // three times as fast at the end
    const auto frames = scene::reference_frames(uneven, 33);
    for (Index k = 0; k < 33; ++k) {
        const double s = helix.length() * static_cast<double>(k) / 32.0;
        // Arc length is summed over 512 chords, which fall short of arcs of up to 0.04 by (0.8 0.04)^2 / 24 = 4e-5 where
        // the parameter runs fast and by a ninth of it where it runs slow: places shift by a part of that.
        CHECK((frames[core::at(k)].position - helix.position(helix.angle_at(s))).norm() < 1e-5 * helix.length());
    }
    CHECK((frames.front().position - uneven(0.0)).norm() == 0.0);
    CHECK((frames.back().position - uneven(1.0)).norm() == 0.0);
}

TEST_CASE("a closed plane curve brings its directors back") {
    const scene::Curve circle = [](double t) {
        const double a = 2.0 * std::numbers::pi * t;
        return Vec3(std::cos(a), std::sin(a), 0.0);
    };
    const auto frames = scene::reference_frames(circle, 17, Vec3(1, 0, 1));  // half way between the plane and its normal
    CHECK((frames.back().director_1 - frames.front().director_1).norm() < 1e-9);
    CHECK(frames.front().director_1.dot(Vec3::UnitZ()) == test::near(std::sqrt(0.5), 1e-12));
}

TEST_CASE("a straight fibre has nodes at equal distances, and the director that was asked for less its axial part") {
    const Vec3 from(1, 2, 3), to(4, 6, 3);
    const auto frames = scene::straight_frames(from, to, 6, Vec3(1, 1, 1));
    REQUIRE(frames.size() == 6);
    const Vec3 tangent(0.6, 0.8, 0.0);
    const Vec3 asked = (Vec3(1, 1, 1) - tangent.dot(Vec3(1, 1, 1)) * tangent).normalized();
    for (Index k = 0; k < 6; ++k) {
        const scene::NodeFrame& frame = frames[core::at(k)];
        CHECK((frame.position - (from + static_cast<double>(k) * tangent)).norm() < 1e-14);
        CHECK((frame.director_1 - asked).norm() < 1e-15);
        CHECK((frame.director_1.cross(frame.director_2) - frame.tangent).norm() < 1e-15);
    }
    CHECK(frames.front().position == from);
    CHECK(frames.back().position == to);
}

TEST_CASE("without a director, or with one along the fibre, any perpendicular one is taken") {
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(1, 1, 1), Vec3(-3, 2, 1e-9)}) {
        for (const Vec3& asked : {Vec3(Vec3::Zero()), axis}) {
            const auto frames = scene::straight_frames(Vec3::Zero(), axis, 2, asked);
            CHECK(std::abs(frames[0].director_1.dot(frames[0].tangent)) < 1e-15);
            CHECK(frames[0].director_1.norm() == test::near(1.0, 1e-12));
        }
    }
}

TEST_CASE("curves that are no fibre are refused by name") {
    const auto refused = [](const scene::Curve& curve) { return refusal([&] { scene::reference_frames(curve, 9); }); };
    CHECK(refused([](double) { return Vec3(1, 2, 3); }).starts_with("fibre.curve: length = 0,"));
    CHECK(refused([](double t) {
              return Vec3(t, core::unset, 0);
          }).starts_with("fibre.curve: point = (0, nan, 0), but it must be finite, at parameter 0, point"));
    CHECK(refused([](double t) { return Vec3(std::max(t, 0.5), 0, 0); }).starts_with("fibre.curve: speed = 0,"));
    CHECK(refusal([] { scene::reference_frames([](double t) { return Vec3(t, 0, 0); }, 1); }) ==
          "reference_frames.nodes = 1, but it must be >= 2");
    CHECK(refusal([] {
              scene::straight_frames(Vec3(1, 1, 1), Vec3(1, 1, 1), 2);
          }).starts_with("fibre.to: distance from fibre.from = 0,"));
}

TEST_CASE("a director that is not given lies across a plane curve, wherever its plane is") {
    const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    const double pi = std::numbers::pi;
    const scene::Curve half_ring = [&](double t) { return Vec3(turn * Vec3(std::cos(pi * t), std::sin(pi * t), 0.0)); },
                       wave = [&](double t) { return Vec3(turn * Vec3(t, 1e-3 * std::sin(4.0 * pi * t), 2.0)); };
    for (const scene::Curve& curve : {half_ring, wave})
        for (const scene::NodeFrame& frame : scene::reference_frames(curve, 21))
            CHECK(std::abs(frame.director_1.dot(turn.col(2))) == test::near(1.0, 1e-12));
    // Of a helix no plane is.
    const Helix helix;
    CHECK(scene::plane_normal(helix.curve()).isZero(0.0));
    CHECK(scene::plane_normal([](double t) { return Vec3(t, 2.0 * t, 0.0); }).isZero(0.0));
}

}  // namespace reference_shape_test
