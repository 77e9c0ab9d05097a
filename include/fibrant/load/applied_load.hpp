// SPDX-License-Identifier: MIT
#pragma once
/// @file What a scene applies: dead forces and moments on nodal vectors, and line pressures.

#include <fibrant/connection/prescribed_motion.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/term/list.hpp>

#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::load {

/// Loads of a scene on a mesh: the term that every model has.
template <beam::BeamElement B>
class AppliedLoad : public term::NoSearch,
                    public term::NoSpring,
                    public term::NoCouplings,
                    public term::NoEnergy,
                    public term::NoMemory,
                    public term::NoPicture {
public:
    static constexpr auto role = term::Role::external;
    using Parameters = core::NoParameters;
    struct Slot {
        Parameters applied{};
    };
    explicit AppliedLoad(const term::SiteOf<B>& site, const Parameters& = {})
        : AppliedLoad(site.assembly(), site.mesh(), site.channels()) {}
    AppliedLoad(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const scene::Channels& channels) {
        const auto item = [&](const auto& load, int vector, bool there, const Vec3& value) {
            if (!there) core::refuse("load.vector", std::to_string(vector), "a vector of the beam's nodes");
            return Item{mesh.node_vector(load.at.fibre, mesh.node_at(load.at), vector), channels.find(load.channel), value};
        };
        for (const scene::LinePressure& load : assembly.pressures())
            pressures_.push_back({load.fibre, channels.find(load.channel), mesh.fibre(load.fibre).elements,
                                  mesh.first_unknown(load.fibre, 0), load.pressure, core::cross_matrix(load.axis)});
        if constexpr (beam::TurningSections<B>) {  // what acts on directors turns the section
            for (const scene::DeadForce& load : assembly.forces()) {
                if (load.vector == scene::NodeVector::position) {
                    forces_.push_back(item(load, 0, true, load.force));
                } else {
                    turning_.push_back(item(load, 1, true, load.force));
                    turning_.back().director = static_cast<int>(load.vector);
                }
            }
            for (const scene::Moment& load : assembly.moments()) turning_.push_back(item(load, 1, true, load.moment));
            return;
        }
        for (const scene::DeadForce& load : assembly.forces()) {
            const int vector = static_cast<int>(load.vector);
            forces_.push_back(
                item(load, vector, vector == 0 || (vector < B::vectors_per_node && !beam::CentrelineOnly<B>), load.force));
        }
        for (const scene::Moment& load : assembly.moments()) {
            int vector = static_cast<int>(load.director);
            if constexpr (requires { B::moment_vector(load.director); }) vector = B::moment_vector(load.director);
            moments_.push_back(item(load, vector, vector < B::vectors_per_node, load.moment));
        }
    }

    static std::vector<std::string> channels(const Parameters&) { return {}; }  // the scene's own
    void begin(std::span<const double> amplitudes, const Vector&) { amplitudes_.assign(amplitudes.begin(), amplitudes.end()); }

    /// Adds the external forces at the amplitudes of the increment.
    void add_forces(const Vector& state, Vector& external) const {
        const std::vector<double>& amplitudes = amplitudes_;
        for (const Pressure& load : pressures_) {
            const Coupling G = coupling();
            for (Index e = 0; e < load.elements; ++e) {
                const Index first = load.first_unknown + 3 * beam::Mesh<B>::vectors_per_element_step * e;
                for (Index a = 0; a < vectors; ++a) {
                    Vec3 sum = Vec3::Zero();
                    for (Index b = 0; b < vectors; ++b)
                        for (Index c = 0; c < 3; ++c) sum[c] += G[core::at(a)][core::at(b)] * state[first + 3 * b + c];
                    const Vec3 pushed = load.across * sum;
                    add(amplitudes[core::at(load.channel)] * load.value, pushed, first / 3 + a, external);
                }
            }
        }
        for (const Item& item : forces_) add(amplitudes[core::at(item.channel)], item.value, item.vector, external);
        if constexpr (beam::TurningSections<B>)
            for (const Item& item : turning_) {
                const Vec3 psi = state.segment<3>(3 * item.vector), value = amplitudes[core::at(item.channel)] * item.value;
                const Vec3 moment = item.director > 0 ? director(psi, item).cross(value) : value;
                external.segment<3>(3 * item.vector) += core::spin_matrix(psi).transpose() * moment;
            }
        for (const Item& item : moments_) {
            const Vec3 director = state.segment<3>(3 * item.vector), turn = item.value.cross(director);
            const double square = director.squaredNorm();
            for (Index c = 0; c < 3; ++c) external[3 * item.vector + c] += amplitudes[core::at(item.channel)] * turn[c] / square;
        }
    }

    /// Minus the derivative of each moment's force by its own director and of line pressures, symmetrised.
    void add_bands(const Vector& state, term::Bands& bands) const {
        add_stiffness(state, [&](Index vector, const Mat3& stiffness) { bands.diagonal(vector, stiffness); });
        add_element_stiffness([&](Index f, Index e, const beam::ElementMatrix<B>& stiffness) { bands.element(f, e, stiffness); });
    }

private:
    template <class Add>
    void add_stiffness(const Vector& state, const Add& add) const {
        const std::vector<double>& amplitudes = amplitudes_;
        for (const Item& item : moments_) {
            const Vec3 director = state.segment<3>(3 * item.vector);
            const Vec3 moment = amplitudes[core::at(item.channel)] * item.value;
            const double square = director.squaredNorm();
            const Mat3 cross = core::cross_matrix(moment);
            const Vec3 turn = moment.cross(director);
            Mat3 slope, sum;
            for (Index c = 0; c < 3; ++c)
                for (Index r = 0; r < 3; ++r)
                    slope(r, c) = cross(r, c) / square - 2.0 / (square * square) * turn[r] * director[c];
            for (Index c = 0; c < 3; ++c)
                for (Index r = 0; r < 3; ++r) sum(r, c) = -0.5 * (slope(r, c) + slope(c, r));
            add(item.vector, sum);
        }
        if constexpr (beam::TurningSections<B>)
            for (const Item& item : turning_) {
                const Vec3 psi = state.segment<3>(3 * item.vector), value = amplitudes[core::at(item.channel)] * item.value;
                if (item.director == 0) {
                    add(item.vector, Mat3(-core::spin_slope(psi, value)));
                } else {
                    const Vec3 g = director(psi, item);
                    Mat3 bend = 0.5 * (g * value.transpose() + value * g.transpose());
                    bend.diagonal().array() -= g.dot(value);
                    const Mat3 T = core::spin_matrix(psi);
                    add(item.vector, Mat3(-T.transpose() * bend * T - core::spin_slope(psi, g.cross(value))));
                }
            }
    }

    template <class Add>
    void add_element_stiffness(const Add& add) const {
        const std::vector<double>& amplitudes = amplitudes_;
        for (const Pressure& load : pressures_) {
            const Coupling G = coupling();
            beam::ElementMatrix<B> stiffness;
            for (Index a = 0; a < vectors; ++a)
                for (Index b = 0; b < vectors; ++b) {
                    const double turn = G[core::at(a)][core::at(b)] - G[core::at(b)][core::at(a)];
                    const double factor = -0.5 * amplitudes[core::at(load.channel)] * load.value * turn;
                    for (Index c = 0; c < 3; ++c)
                        for (Index r = 0; r < 3; ++r) stiffness(3 * a + r, 3 * b + c) = factor * load.across(r, c);
                }
            for (Index e = 0; e < load.elements; ++e) add(load.fibre, e, stiffness);
        }
    }

    static constexpr Index vectors = B::nodes * B::vectors_per_node;                        // of an element
    using Coupling = std::array<std::array<double, core::at(vectors)>, core::at(vectors)>;  // rows
    struct Pressure {
        Index fibre, channel, elements, first_unknown;
        double value;
        Mat3 across;  // axis x
    };
    /// Integral of the weights of the centreline times those of its derivative: what the vectors of an element are to its forces
    /// under a line pressure.
    static Coupling coupling() noexcept {
        Coupling sum{};
        const double place = std::sqrt(0.6);  // Gauss, exact to the fifth degree
        for (const auto& [xi, weight] : {std::pair{-place, 5.0 / 9.0}, std::pair{0.0, 8.0 / 9.0}, std::pair{place, 5.0 / 9.0}}) {
            const beam::ElementWeights<B> value = B::centreline_weights(xi), slope = B::centreline_derivative_weights(xi);
            for (Index a = 0; a < vectors; ++a)
                for (Index b = 0; b < vectors; ++b)
                    sum[core::at(a)][core::at(b)] += weight * value[core::at(a)] * slope[core::at(b)];
        }
        return sum;
    }
    static void add(double factor, const Vec3& value, Index vector, Vector& external) noexcept {
        for (Index c = 0; c < 3; ++c) external[3 * vector + c] += factor * value[c];
    }
    struct Item {
        Index vector, channel;
        Vec3 value;
        int director = 0;  ///< on which a force acts, where sections turn; 0: a moment
    };
    static Vec3 director(const Vec3& psi, const Item& item) noexcept { return core::rotation(psi).col(item.director - 1); }
    std::vector<Item> forces_, moments_, turning_;
    std::vector<Pressure> pressures_;
    std::vector<double> amplitudes_;
};

/// The same for any beam.
struct Applied {
    using Parameters = core::NoParameters;
    template <beam::BeamElement B>
    using Of = AppliedLoad<B>;
};

}  // namespace fibrant::load
