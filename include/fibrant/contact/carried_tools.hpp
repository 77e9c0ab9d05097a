// SPDX-License-Identifier: MIT
#pragma once
/// @file Tools that particles of fibres carry: driven by forces and by what they weigh, instead of a path.

#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/core/rotation.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::contact {

/// Contacts of fibres with tools, of which some go where a particle of a fibre goes: a plate on a ram. What such a tool feels
/// pushes the particle, whose unknowns are those of the tool: loads on the fibre, its stiffness, what holds it and its inertia
/// are those that the tool has, and equilibrium is found for all at once. What a fibre and the particle do to each other is as
/// between two fibres: no solver has to know of it. A tool that turns with a node of a rod has the arm of each contact there, as
/// a fibre that is touched on its surface.
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
class CarriedToolContacts : public ToolContacts<B, Normal, Friction> {
    using Base = ToolContacts<B, Normal, Friction>;
    using Element = typename Base::Element;

public:
    CarriedToolContacts(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const StiffnessAdaptation& adaptation,
                        double points_per_element)
        : Base(assembly, mesh, adaptation, points_per_element), of_tool_(this->tools_.size(), -1) {
        for (std::size_t t = 0; t < of_tool_.size(); ++t) {
            if (!this->tools_[t].carried()) continue;
            const scene::Station& at = this->tools_[t].carrier;
            const double u = at.fraction * static_cast<double>(mesh.fibre(at.fibre).elements);
            Carrier one;
            one.tool = t, one.fibre = at.fibre, one.first = mesh.first_unknown(at.fibre, mesh.locate(at.fibre, u).first);
            const double xi = mesh.locate(at.fibre, u).second;
            if constexpr (beam::TouchedOnCentreline<B>)
                one.particle = B::centre_weights(xi);
            else
                one.particle = B::particle_weights(xi, 0.0, 0.0);
            one.start = beam::Mesh<B>::point(mesh.start_state(), one.first, one.particle);
            if (this->tools_[t].turns) {
                const std::string place = scene::label("tool", static_cast<Index>(t), this->tools_[t].name);
                core::with_place([&] { return place; },
                                 [&] {
                                     if (!turning)
                                         core::refuse("Tool.turns", "true", "false, for a beam whose nodes have no rotation");
                                     core::require(std::abs(xi) == 1.0, "Tool.carrier: fraction", at.fraction,
                                                   "of a node, for a tool that turns");
                                 });
                one.rotation = one.first + (xi < 0.0 ? 3 : 9);
                one.start_turn = core::rotation(mesh.start_state().template segment<3>(one.rotation));
            }
            of_tool_[t] = core::count(carriers_);
            carriers_.push_back(one);
        }
    }

    /// Whether a tool is on a fibre, which then does not touch it.
    bool carries(Index fibre, Index tool) const noexcept {
        const Index k = of_tool_[core::at(tool)];
        return k >= 0 && carriers_[core::at(k)].fibre == fibre;
    }

    void detect(const Vector& state, const Vector& accepted, double reach, const Normal& normal) {
        follow(state, accepted);
        Base::detect(state, accepted, reach, normal);
        std::vector<Element>& elements = this->elements_;
        std::erase_if(elements, [&](const Element& element) { return carries(element.fibre, element.tool); });
        std::fill(this->first_.begin(), this->first_.end(), 0);
        for (const Element& element : elements) ++this->first_[core::at(element.fibre) + 1];
        for (std::size_t f = 1; f < this->first_.size(); ++f) this->first_[f] += this->first_[f - 1];
    }
    double refresh(const Vector& state, const Vector& accepted, const Normal& normal) {
        follow(state, accepted);
        return Base::refresh(state, accepted, normal);
    }
    void evaluate(const Vector& state, const Vector& acting, const Normal& normal, const Friction& friction) {
        follow(state);
        Base::evaluate(state, acting, normal, friction);
        if constexpr (turning) see_levers(state, ActingState<Normal>::within(normal) ? acting : state);
    }
    void stand_back(bool back) {
        back_ = back;
        Base::stand_back(back);
    }
    void accept(const Vector& state, const Normal& normal, const StiffnessAdaptation& adaptation) {
        follow(state);
        Base::accept(state, normal, adaptation);
    }

    void add_forces(Vector& residual) const {
        Base::add_forces(residual);
        for (Index k = 0; k < core::count(this->elements_); ++k)
            if (const Carrier* carrier = carrier_of(k))
                beam::spread(particle_of(k, *carrier), Vec3(-this->force(k)), carrier->first, residual);
    }
    /// What is in the bands of fibres: of tools that nothing carries, and of sections.
    template <class Add>
    void stiffness_terms(Index fibre, const Vector& state, const Add& add) const {
        if (fibre >= this->mesh_->fibre_count()) return;
        for (Index k = this->first_[core::at(fibre)]; k < this->first_[core::at(fibre + 1)]; ++k) {
            const Element& element = this->elements_[core::at(k)];
            if (!carrier_of(k))
                if (const Mat3 sum = this->tangent_of(k); !sum.isZero(0.0)) add(element.first, element.weights, sum);
            section_stiffness_term(*this->mesh_, state, fibre, element.u, element.first, element.normal,
                                   this->responses_[core::at(k)].reaction, element.end, add);
        }
    }
    /// Adds the pairs of particles that touch and carry, with their stiffness.
    template <class Point>
    void add_points(std::vector<Point>& points) const {
        for (Index k = 0; k < core::count(this->elements_); ++k) {
            const Carrier* carrier = carrier_of(k);
            if (!carrier) continue;
            const Element& element = this->elements_[core::at(k)];
            points.push_back({static_cast<std::int32_t>(carrier->first), element.first, static_cast<std::int32_t>(carrier->fibre),
                              element.fibre, particle_of(k, *carrier), element.weights, this->tangent_of(k)});
        }
    }

    double greatest_approach(const Vector& step) const {
        double most = 0.0;
        for (Index k = 0; k < core::count(this->elements_); ++k) {
            const Element& element = this->elements_[core::at(k)];
            Vec3 motion = beam::Mesh<B>::motion(step, element.first, element.weights);
            if (const Carrier* carrier = carrier_of(k))
                motion -= beam::Mesh<B>::motion(step, carrier->first, particle_of(k, *carrier));
            most = std::max(most, std::abs(element.normal.dot(motion)) / this->mesh_->fibre(element.fibre).section.radius());
        }
        return most;
    }
    /// Of those that nothing carries: what is carried does the work of its carrier, which is counted there.
    double half_work() const {
        return Base::half_work([&](std::size_t t) { return of_tool_[t] < 0; });
    }

private:
    static constexpr bool turning = beam::TurningSections<B>;
    struct Carrier {
        std::size_t tool = 0;
        Index fibre = -1, first = 0;   // its element's first unknown
        Index rotation = -1;           // of the node's rotation vector, of a tool that turns
        beam::Particle<B> particle{};  // of that element
        Vec3 start = Vec3::Zero();     // where a run begins
        Mat3 start_turn = Mat3::Identity();
    };
    scene::ToolPose pose_in(const Carrier& carrier, const Vector& state) const {
        scene::ToolPose pose;
        if (carrier.rotation >= 0)
            pose.turn = core::rotation(state.segment<3>(carrier.rotation)) * carrier.start_turn.transpose();
        const Vec3 turned = carrier.rotation >= 0 ? Vec3(pose.turn * carrier.start) : carrier.start;
        pose.shift = beam::Mesh<B>::point(state, carrier.first, carrier.particle) - turned;
        return pose;
    }
    const Carrier* carrier_of(Index element) const noexcept {
        const Index k = of_tool_[core::at(this->elements_[core::at(element)].tool)];
        return k < 0 ? nullptr : &carriers_[core::at(k)];
    }
    /// The particle that the tool's force of an element acts on.
    const beam::Particle<B>& particle_of(Index element, const Carrier& carrier) const noexcept {
        return carrier.rotation >= 0 ? levers_[core::at(element)] : carrier.particle;
    }
    /// Puts what is carried where a state has it, with the places of it that fibres are above.
    void follow(const Vector& state) {
        for (const Carrier& carrier : carriers_) {
            scene::ToolPose& pose = this->pose_[carrier.tool];
            const scene::ToolPose before = std::exchange(pose, pose_in(carrier, state));
            if (!back_) this->used_pose_[carrier.tool] = pose;
            const Vec3 by = pose.shift - before.shift;
            for (Element& element : this->elements_)
                if (core::at(element.tool) == carrier.tool)
                    element.foot = carrier.rotation >= 0 ? pose.place(before.material(element.foot)) : Vec3(element.foot + by);
        }
    }
    void follow(const Vector& state, const Vector& accepted) {
        for (const Carrier& carrier : carriers_) this->accepted_pose_[carrier.tool] = pose_in(carrier, accepted);
        follow(state);
    }
    /// Both forces of a contact act where the particle of the fibre is.
    void see_levers(const Vector& state, const Vector& acting) {
        levers_.resize(this->elements_.size());
        for (Index k = 0; k < core::count(this->elements_); ++k) {
            const Carrier* carrier = carrier_of(k);
            if (!carrier || carrier->rotation < 0) continue;
            const Element& element = this->elements_[core::at(k)];
            const Vec3 place = beam::Mesh<B>::point(state, element.first, element.weights),
                       from = beam::Mesh<B>::point(state, carrier->first, carrier->particle);
            beam::Particle<B>& lever = levers_[core::at(k)];
            lever = carrier->particle;
            lever.shift(core::rotation(state.segment<3>(carrier->rotation)).transpose() * (place - from));
            constexpr Index size = beam::Mesh<B>::element_unknowns;
            lever.follow(state.segment<size>(carrier->first), acting.segment<size>(carrier->first));
        }
    }

    std::vector<Carrier> carriers_;
    std::vector<Index> of_tool_;             // carrier of each tool, or -1
    std::vector<beam::Particle<B>> levers_;  // of the last evaluation, by element
    bool back_ = false;                      // evaluated against the tools as they were
};

/// The part `Tools` of a model whose scenes have tools that fibres carry, beside others.
struct CarriedTools {
    using Parameters = core::NoParameters;
    explicit CarriedTools(const Parameters& = {}) {}
    static constexpr bool carried = true;
    template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
    using Of = CarriedToolContacts<B, Normal, Friction>;
};

}  // namespace fibrant::contact
