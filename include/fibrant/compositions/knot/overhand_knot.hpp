// SPDX-License-Identifier: MIT
#pragma once
/// @file The overhand knot and its relatives in a straight rod: the shape it is tied in, the scene, and what is measured on it.

#include <fibrant/core/parameters.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/simulation/simulator.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace fibrant::compositions::knot {

/// Channel that draws the far end out; its amplitude is a length.
inline const std::string draw = "draw";

/// A knot of one loop, whose two strands wind around each other in a braid.
struct KnotParameters {
    double radius = core::unset;       ///< of the rod [length], > 0
    double loop_radius = core::unset;  ///< that it is tied with [length], > `least_loop_radius`
    double tail = core::unset;         ///< of each end, beyond the braid [length], > 0
    int crossings = 3;                 ///< of the braid: 3 overhand (trefoil), 5 double overhand (cinquefoil); odd
    scene::ElasticMaterial material;
    Index elements = 200;  ///< along the rod, >= 16

    /// The braid has room for half a turn of its strands a crossing in a part of the loop: in smaller ones they would begin in
    /// each other [length].
    double least_loop_radius() const noexcept { return std::max(20.0, 5.6 * crossings) * radius; }
    void validate() const {
        core::require_positive("KnotParameters.radius", radius);
        core::require(loop_radius > least_loop_radius(), "KnotParameters.loop_radius", loop_radius,
                      "> 20 radii, and > 5.6 radii for each crossing");
        core::require_positive("KnotParameters.tail", tail);
        if (crossings < 3 || crossings % 2 == 0)
            core::refuse("KnotParameters.crossings", std::to_string(crossings), "3, 5, 7, ...");
        core::require_at_least("KnotParameters.elements", elements, 16);
        material.validate();
    }
};

/// Centreline of the knot as it is tied: tails along x, a circle in the plane of x and y that touches them, and between them two
/// strands whose difference turns from -y to +y by as many half turns as there are crossings.
class TiedShape {
public:
    explicit TiedShape(const KnotParameters& parameters) : p_{core::validated(parameters)} {
        const double R = p_.loop_radius;
        reach_ = 0.6 * R;
        braid_ = std::min(0.55 * R, (1.0 + 0.9 * (p_.crossings - 1)) * std::sqrt(2.0 * p_.radius * R));
        angle_ = std::asin(reach_ / R);
        // Lengths of the pieces: tail, strand, loop, strand, tail.
        const double strand = R * angle_ + reach_;
        const double ends[] = {0.0, p_.tail, strand, 2.0 * (std::numbers::pi - angle_) * R, strand, p_.tail};
        for (const double length : ends) length_ += length, start_.push_back(length_);
    }
    /// @param t  in [0, 1], nearly in proportion to the arc
    Vec3 operator()(double t) const {
        const double s = t * length_, R = p_.loop_radius;
        std::size_t piece = 0;
        while (piece < 4 && s > start_[piece + 1]) ++piece;
        const double share = (s - start_[piece]) / (start_[piece + 1] - start_[piece]);
        switch (piece) {
            case 0:
                return {-reach_ - (1.0 - share) * p_.tail, 0.0, 0.0};
            case 1:
                return strand(-reach_ + 2.0 * share * reach_, 0.5);
            case 2: {
                const double angle = angle_ + share * 2.0 * (std::numbers::pi - angle_);
                return {R * std::sin(angle), R * (1.0 - std::cos(angle)), 0.0};
            }
            case 3:
                return strand(-reach_ + 2.0 * share * reach_, -0.5);
            default:
                return {reach_ + share * p_.tail, 0.0, 0.0};
        }
    }

    /// With fewer an element of the braid goes round by more than half a turn: its nodes do not tell by which side the strands
    /// pass each other, and it may be no knot that is tied.
    Index least_elements() const {
        constexpr double steepest = 1.875;                                    // slope of `smooth`, in its middle
        const double turns = 0.5 * steepest * p_.crossings / (2.0 * braid_);  // a length of the axis
        return static_cast<Index>(std::ceil(2.0 * turns * length_));
    }

private:
    static double smooth(double t) {
        const double c = std::clamp(t, 0.0, 1.0);
        return c * c * c * (10.0 - 15.0 * c + 6.0 * c * c);
    }
    Vec3 strand(double x, double side) const {
        const double R = p_.loop_radius, height = R - std::sqrt(R * R - x * x);
        const double touching = 2.06 * p_.radius * (1.0 - smooth((std::abs(x) - braid_) / (reach_ - braid_)));
        const double apart = std::hypot(height, touching);
        const double phi = std::numbers::pi * (1.0 - p_.crossings * smooth(0.5 + 0.5 * x / braid_));
        return {x, 0.5 * height + side * apart * std::cos(phi), side * apart * std::sin(phi)};
    }
    KnotParameters p_;
    double reach_, braid_, angle_, length_ = 0.0;
    std::vector<double> start_;
};

/// A straight rod, tied: its first end is held, and so is the line of its last end, which is drawn along x.
inline scene::Assembly tied_rod(const KnotParameters& parameters) {
    const TiedShape shape(parameters);
    // The length of the shape as the nodes will see it, so that the rod is neither stretched nor pressed.
    const std::vector<scene::NodeFrame> frames = scene::reference_frames(shape, 2 * parameters.elements + 1);
    double length = 0.0;
    for (std::size_t k = 1; k < frames.size(); ++k) {
        const double chord = (frames[k].position - frames[k - 1].position).norm();
        const double turn = std::acos(std::clamp(frames[k].tangent.dot(frames[k - 1].tangent), -1.0, 1.0));
        length += chord * (1.0 + turn * turn / 24.0);
    }
    scene::Assembly assembly;
    scene::FibreSpecification rod{.from = shape(0.0),
                                  .to = shape(0.0) + Vec3(length, 0, 0),
                                  .start = shape,
                                  .section = scene::circular(parameters.radius),
                                  .material = parameters.material,
                                  .elements = parameters.elements,
                                  .director = Vec3::UnitZ()};
    const Index fibre = assembly.add(rod);
    assembly.hold_position(scene::first_end(fibre));
    assembly.hold_axial_rotation(scene::first_end(fibre));
    scene::Hold end;
    end.at = scene::last_end(fibre), end.channel = draw, end.displacement = Vec3::UnitX();
    assembly.hold(end);  // free to turn about itself: no twist
    return assembly;
}

/// Penalty to start with, over that of a section: at which the contact force of the theory, half E I / (r^1/2 R^3/2), sinks by 2
/// % of a radius. A softer one lets the strands of the braid through each other before it has adapted.
inline double initial_stiffness_fraction(const KnotParameters& parameters) {
    const double r = parameters.radius, E = parameters.material.young_modulus;
    const double force =
        0.5 * 0.25 * E * std::numbers::pi * r * r * r * r / (std::sqrt(r) * std::pow(parameters.loop_radius, 1.5));
    const double element =
        (2.0 * std::numbers::pi * parameters.loop_radius + 2.0 * parameters.tail) / static_cast<double>(parameters.elements);
    return force / (0.02 * r) / contact::section_stiffness(parameters.material, 0.5 * element);
}

/// F R^2 / (E I) of a loose knot, R its shortening over 2 pi: (1/2) + (3 sigma / pi) (r / R)^1/2, within terms of the order of r
/// / R.
///
/// The first term is the circle's (Audoly, Clauvelin, Neukirch 2007), whose contact forces add up to sigma E I / (r^1/2 R^3/2).
/// The second follows from them: contacts are 2 r apart, so the energy W(e, r) of a knot without friction grows by 2 P with r, P
/// the sum of the contact forces; hence W = pi E I / R + 4 sigma E I r^1/2 / R^3/2, and F = -dW/de at e = 2 pi R.
/// @param crossings  3 or 5, for which sigma is known
inline double loose_force(int crossings, double r_over_R) {
    if (crossings != 3 && crossings != 5) core::refuse("loose_force.crossings", std::to_string(crossings), "3 or 5");
    const double sigma = crossings == 3 ? 0.4923009124 : 1.466842245;
    return 0.5 + 3.0 * sigma / std::numbers::pi * std::sqrt(r_over_R);
}

/// A knot as it is.
struct KnotState {
    double force = 0.0;          ///< in the tails [force]
    double shortening = 0.0;     ///< length that the knot takes up, 2 pi times the radius of a loose loop [length]
    double contact_force = 0.0;  ///< P, sum over all contacts [force]
    double energy = 0.0;         ///< W of the rod [force * length]
    /// (W + 2 r P) / (F e) - 1, e the shortening: 0 for any inextensible rod without friction, loose or tight, since W(e, r) is E
    /// I / e times a function of r / e [1].
    double virial = 0.0;
    /// How far the upper part of the loop, two fifths of it, is from (force along the rod) + E I curvature^2 / 2 = force in the
    /// tails, which holds exactly for an inextensible rod without friction, over that force [1].
    double imbalance = 0.0;
};

/// Forces, shortening and energy of a knot in the present state of a run.
template <simulation::Model M>
KnotState measure(const simulation::Simulator<M>& simulator, const KnotParameters& parameters) {
    KnotState state;
    const auto& mesh = simulator.mesh();
    const Vector& now = simulator.state();
    state.force = simulator.reaction(scene::last_end(0)).x();
    state.shortening = mesh.fibre(0).length() - (simulator.value(scene::last_end(0)) - simulator.value(scene::first_end(0))).x();
    for (const contact::ContactResponse& response : simulator.contacts().responses()) state.contact_force += response.reaction;
    state.energy = simulator.equilibrium().elastic_energy(now);
    state.virial = (state.energy + 2.0 * parameters.radius * state.contact_force) / (state.force * state.shortening) - 1.0;
    // The top of the loop is half way along the rod.
    const double h = mesh.fibre(0).element_length, middle = 0.5 * static_cast<double>(parameters.elements);
    const double reach = 0.2 * state.shortening / h;
    const double area = mesh.fibre(0).section.area(), E = parameters.material.young_modulus,
                 bending = 0.25 * E * area * parameters.radius * parameters.radius;
    for (Index e = static_cast<Index>(std::ceil(middle - reach)); static_cast<double>(e) < middle + reach - 1.0; ++e) {
        double along = 0.0;
        for (const double side : {-1.0, 1.0}) {  // at the element's stress points
            const double square =
                mesh.derivative(now, 0, static_cast<double>(e) + 0.5 + 0.5 * side / std::sqrt(3.0)).squaredNorm() / (h * h);
            along += 0.5 * E * area * 0.5 * (square - 1.0) * std::sqrt(square);
        }
        // Curvature by the tangents at the middles of the two neighbours: those of one element have kinks at its ends.
        const Vec3 before = mesh.derivative(now, 0, static_cast<double>(e) - 0.5),
                   after = mesh.derivative(now, 0, static_cast<double>(e) + 1.5);
        const double curvature = std::atan2(before.cross(after).norm(), before.dot(after)) / (2.0 * h);
        // Bending strains are a . g', so bending pulls along the rod with E I curvature^2 beside what the stretch does; it also
        // presses the section, A S_11 = -E I curvature^2, which takes nu times that off again.
        along += (1.0 - parameters.material.poisson_ratio) * bending * curvature * curvature;
        state.imbalance =
            std::max(state.imbalance, std::abs((along + 0.5 * bending * curvature * curvature) / state.force - 1.0));
    }
    return state;
}

}  // namespace fibrant::compositions::knot
