// SPDX-License-Identifier: MIT
#pragma once
/// @file Contact elements between fibres and rigid tools, with the laws and the histories of contact between fibres.

#include <fibrant/contact/acting_state.hpp>
#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/contact/seen_touch.hpp>
#include <fibrant/contact/tool_place.hpp>
#include <fibrant/contact/zone_stiffness.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/scene/tool.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::contact {

/// Contacts of all fibres with all tools: a station of a fibre each, so that histories need no transfer.
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
class ToolContacts {
public:
    using Element = ToolElement<B, Normal, Friction>;
    using Record = ToolRecord<Normal, Friction>;

    ToolContacts(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const StiffnessAdaptation& adaptation,
                 double points_per_element)
        : mesh_{&mesh}, tools_(assembly.tools()), step_{1.0 / points_per_element}, first_(core::at(mesh.fibre_count() + 1), 0) {
        for (const scene::Tool& tool : tools_) pose_.push_back(scene::tool_pose(tool, 0.0));
        accepted_pose_ = used_pose_ = pose_;
        for (const beam::MeshFibre& fibre : mesh.fibres()) {
            reference_.push_back(section_stiffness(fibre.material, 0.5 * fibre.element_length));
            stiffness_.insert(stiffness_.end(), tools_.size(), adaptation.initial_fraction * reference_.back());
        }
        accepted_stiffness_ = stiffness_;
    }

    const std::vector<scene::Tool>& tools() const noexcept { return tools_; }
    const std::vector<Element>& elements() const noexcept { return elements_; }
    const std::vector<ContactResponse>& responses() const noexcept { return responses_; }
    const std::vector<law::FrictionAnswer<Friction>>& frictions() const noexcept { return frictions_; }
    const scene::ToolPose& pose(Index tool) const noexcept { return pose_[core::at(tool)]; }
    /// Where it was in the last accepted state.
    const scene::ToolPose& accepted_pose(Index tool) const noexcept { return accepted_pose_[core::at(tool)]; }
    double stiffness(const Element& element) const noexcept { return stiffness_[slot(element.fibre, element.tool)]; }

    /// Puts the tools where an increment wants them.
    /// @param amplitudes  of the channel of each tool
    void move(std::span<const double> amplitudes) {
        for (std::size_t t = 0; t < tools_.size(); ++t) {
            core::with_place([&] { return scene::label("tool", static_cast<Index>(t), tools_[t].name); },
                             [&] { scene::require_at("Tool", amplitudes[t], tools_[t].path, tools_[t].rotation); });
            pose_[t] = scene::tool_pose(tools_[t], amplitudes[t]);
        }
        used_pose_ = pose_;
    }
    /// Evaluates against the tools as they were in the last accepted state, or as they are.
    void stand_back(bool back) { used_pose_ = back ? accepted_pose_ : pose_; }

    /// Outer loop: elements anew, at all stations that are within `reach` of a tool [length].
    void detect(const Vector& state, const Vector& accepted, double reach, const Normal& normal) {
        std::vector<Record> last = elements_.empty() ? accepted_ : records(state);
        const Index fibres = mesh_->fibre_count();
        // An increment begins with tools that have moved and fibres that have not: that overlap says nothing of how they will
        // press.
        starting_ = state == accepted;
        std::vector<std::vector<Element>> made(core::at(fibres));
        core::parallel_for(
            fibres,
            [&](Index f) {
                const double end = static_cast<double>(mesh_->fibre(f).elements);
                const auto stations = static_cast<Index>(std::ceil(end / step_ - 1e-9));
                for (Index t = 0; t < core::count(tools_); ++t)
                    for (Index s = 0; s < stations + (mesh_->fibre(f).closed ? 0 : 1); ++s) {
                        const double u = std::min(end, static_cast<double>(s) * step_);
                        const Vec3 place = used_pose_[core::at(t)].material(mesh_->position(state, f, u));
                        const double radius = mesh_->fibre(f).section.radius();
                        if (scene::tool_distance(tools_[core::at(t)], place).distance > 1.25 * radius + reach) continue;
                        Element element;
                        element.u = u;
                        element.fibre = static_cast<std::int32_t>(f), element.tool = static_cast<std::int32_t>(t);
                        element.station = static_cast<std::int32_t>(s);
                        element.first = static_cast<std::int32_t>(mesh_->first_unknown(f, mesh_->locate(f, u).first));
                        const Record key = Record::key_of(element);
                        if constexpr (law::Augmenting<Normal>) {
                            const Record* record = Record::find(last, key);
                            element.shift.multiplier = record ? record->multiplier : 0.0;
                        }
                        const bool end_one = s == 0 || s == stations;  // half of a step, but of closed fibres
                        see_length(element,
                                   (end_one && !mesh_->fibre(f).closed ? 0.5 : 1.0) * step_ * mesh_->fibre(f).element_length);
                        place_particle(element, state, accepted, normal);
                        if constexpr (core::Active<Friction>) {
                            if (const Record* record = Record::find(accepted_, key)) {
                                const TangentPlane plane(tangent(element, state), element.normal);
                                record->friction.give(plane, element.friction.history);
                            }
                        }
                        made[core::at(f)].push_back(element);
                    }
            },
            mesh_->grain());
        for (Index f = 0; f < fibres; ++f) first_[core::at(f + 1)] = first_[core::at(f)] + core::count(made[core::at(f)]);
        core::join(made, elements_);
    }

    /// Middle loop: normals and particles at the same stations. @returns the largest turn of a normal that carries force [radian]
    double refresh(const Vector& state, const Vector& accepted, const Normal& normal) {
        std::vector<double> angle(elements_.size(), 0.0);
        core::parallel_for(
            core::count(elements_),
            [&](Index k) {
                Element& element = elements_[core::at(k)];
                const Vec3 before = element.normal;
                place_particle(element, state, accepted, normal);
                if constexpr (core::Active<Friction>) {
                    Vec3& reversible = element.friction.history.reversible;
                    reversible = turned(reversible, before, element.normal);
                    reversible -= reversible.dot(element.normal) * element.normal;
                }
                if (k < core::count(responses_) && responses_[core::at(k)].reaction != 0.0)
                    angle[core::at(k)] = std::atan2(before.cross(element.normal).norm(), before.dot(element.normal));
            },
            core::light_items);
        hold_reactions();
        return angle.empty() ? 0.0 : *std::max_element(angle.begin(), angle.end());
    }
    /// The reactions of the last evaluation bound friction from now on; at the start of an increment those accepted.
    void hold_reactions() {
        if constexpr (core::Active<Friction>) {
            const bool starting = std::exchange(starting_, false);
            for (std::size_t k = 0; k < std::min(elements_.size(), responses_.size()); ++k) {
                Element& element = elements_[k];
                const Record* record = starting ? Record::find(accepted_, Record::key_of(element)) : nullptr;
                element.friction.bound = !starting ? bound_of(k) : record ? record->multiplier : 0.0;
            }
            see_pressed_lengths(*mesh_, elements_, step_);
        }
    }

    /// Inner loop: gaps, reactions and friction of a state.
    void evaluate(const Vector& state, const Normal& normal, const Friction& friction) {
        evaluate(state, state, normal, friction);
    }
    /// @param acting  where in the increment contact acts
    void evaluate(const Vector& state, const Vector& acting, const Normal& normal, const Friction& friction) {
        responses_.resize(elements_.size());
        if constexpr (core::Active<Friction>) frictions_.resize(elements_.size());
        if constexpr (law::PullingNormal<Normal>) pushes_.resize(elements_.size());
        core::parallel_for(
            core::count(elements_),
            [&](Index k) {
                Element& element = elements_[core::at(k)];
                const Vec3 back = back_step(element);
                Vec3 slip = back;
                if constexpr (core::Active<Friction>)
                    slip += beam::Mesh<B>::point(state, element.first, element.friction.weights_j) - element.foot -
                            element.friction.accepted_offset;
                follow_particles(*mesh_, state, element);
                const double gap = element.gap(state) + element.normal.dot(back) + element.shift.value();
                const law::NormalResponse response = normal_answer(normal, *mesh_, element, gap, stiffness(element));
                responses_[core::at(k)] = {gap, response.reaction, response.slope};
                act_within(*mesh_, normal, state, acting, element);
                if constexpr (law::PullingNormal<Normal>)
                    pushes_[core::at(k)] = friction_bound(normal, *mesh_, element, responses_[core::at(k)]);
                if constexpr (core::Active<Friction>) {
                    slip -= slip.dot(element.normal) * element.normal;
                    const double bound = element.friction.bound < 0.0 ? bound_of(core::at(k)) : element.friction.bound;
                    frictions_[core::at(k)] =
                        friction_answer(friction, *mesh_, element, slip, tools_[core::at(element.tool)].friction_factor, bound);
                }
            },
            core::light_items);
    }

    /// Force of element k on its particle, against the internal forces [force].
    Vec3 force(Index k) const noexcept {
        Vec3 sum = -responses_[core::at(k)].reaction * elements_[core::at(k)].normal;
        if constexpr (core::Active<Friction>) sum += frictions_[core::at(k)].force;
        return sum;
    }
    void add_forces(Vector& residual) const {
        core::parallel_for(
            mesh_->fibre_count(),
            [&](Index f) {
                for (Index k = first_[core::at(f)]; k < first_[core::at(f + 1)]; ++k) {
                    const Element& element = elements_[core::at(k)];
                    beam::spread(element.weights, force(k), element.first, residual);
                }
            },
            mesh_->grain());
    }
    /// Of element k's force by where its particle is against the tool, symmetric and positive semidefinite [force / length].
    Mat3 tangent_of(Index k) const noexcept {
        const Vec3& normal = elements_[core::at(k)].normal;
        Mat3 sum = -responses_[core::at(k)].slope * normal * normal.transpose();
        if constexpr (core::Active<Friction>) {
            const Mat3 plane = Mat3::Identity() - normal * normal.transpose();
            sum += plane * frictions_[core::at(k)].tangent * plane;
        }
        return sum;
    }
    /// Tangent on a fibre, symmetric and positive semidefinite: add(first unknown, weights, stiffness) of rank-one terms.
    template <class Add>
    void stiffness_terms(Index fibre, const Vector& state, const Add& add) const {
        if (fibre >= mesh_->fibre_count()) return;  // images do not touch tools
        for (Index k = first_[core::at(fibre)]; k < first_[core::at(fibre + 1)]; ++k) {
            const Element& element = elements_[core::at(k)];
            const Mat3 sum = tangent_of(k);
            if (!sum.isZero(0.0)) add(element.first, element.weights, sum);
            section_stiffness_term(*mesh_, state, fibre, element.u, element.first, element.normal,
                                   responses_[core::at(k)].reaction, element.end, add);
        }
    }

    /// What fibres exert on a tool in the state that was evaluated last.
    ToolReaction reaction(Index tool) const {
        ToolReaction sum;
        const Vec3 origin = pose_[core::at(tool)].place(tools_[core::at(tool)].origin);
        for (Index k = 0; k < std::min(core::count(elements_), core::count(responses_)); ++k) {
            const Element& element = elements_[core::at(k)];
            if (element.tool != tool) continue;
            const Vec3 part = force(k);
            sum.force += part;
            sum.moment += (element.foot - origin).cross(part);
        }
        return sum;
    }
    /// Greatest motion of a particle along its normal in a step, by the radius of its fibre [1].
    double greatest_approach(const Vector& step) const {
        return core::largest(core::count(elements_), 0.0, [&](Index k) {
            const Element& element = elements_[core::at(k)];
            const double motion = element.normal.dot(beam::Mesh<B>::motion(step, element.first, element.weights));
            return std::abs(motion) / mesh_->fibre(element.fibre).section.radius();
        });
    }
    /// Half of the work that the forces of the last evaluation do on the way from the last accepted state: of the state that
    /// an increment ends with and, against the tools as they were, that which it starts from [force * length].
    double half_work() const {
        return half_work([](std::size_t) { return true; });
    }
    double half_work(const auto& counts) const {
        double sum = 0.0;
        for (std::size_t t = 0; t < tools_.size(); ++t) {
            if (!counts(t)) continue;
            const ToolReaction felt = reaction(static_cast<Index>(t));
            const Vec3 way = pose_[t].place(tools_[t].origin) - accepted_pose_[t].place(tools_[t].origin);
            const Eigen::AngleAxisd turn(Mat3(pose_[t].turn * accepted_pose_[t].turn.transpose()));
            sum -= 0.5 * (felt.force.dot(way) + felt.moment.dot(turn.angle() * turn.axis()));
        }
        return sum;
    }

    /// Adds to the figures of a state: Figures has the members of ContactFigures.
    template <class Figures>
    void add_figures(const Vector& state, const Normal& normal, Figures& sum) const {
        sum.elements += core::count(elements_);
        for (Index k = 0; k < core::count(elements_); ++k) {
            const Element& element = elements_[core::at(k)];
            const ContactResponse& response = responses_[core::at(k)];
            if (response.reaction > 0.0) ++sum.active;
            if (element.shift.value() > 0.0) ++sum.shifted;
            sum.greatest_penetration = std::max(sum.greatest_penetration, -element.gap(state));
            sum.work += normal_energy(normal, *mesh_, element, response.gap, stiffness(element));
            sum.reaction_sum += response.reaction;
            sum.dissipated += normal_loss(normal, *mesh_, element, response.gap);
            if constexpr (core::Active<Friction>)
                sum.work += frictions_[core::at(k)].stored, sum.dissipated += frictions_[core::at(k)].dissipated;
        }
    }
    /// Greatest gap or penetration of what carries force [length].
    double misfit() const {
        double most = 0.0;
        for (std::size_t k = 0; k < elements_.size(); ++k)
            if (responses_[k].reaction > 0.0) most = std::max(most, std::abs(responses_[k].gap - elements_[k].shift.value()));
        return most;
    }

    struct Deepest {
        double depth = 0.0;  ///< [length]
        Index fibre = -1, tool = -1;
    };
    /// Greatest penetration that stiffness adapts to, but for gaps that a law limits.
    Deepest deepest() const {
        Deepest most;
        for (std::size_t k = 0; k < responses_.size(); ++k) {
            if (elements_[k].shift.value() > 0.0) continue;
            const double depth = adapting_penetration(elements_[k], responses_[k]);
            if (depth > most.depth) most = {depth, elements_[k].fibre, elements_[k].tool};
        }
        return most;
    }
    /// Stiffens pairs of a fibre and a tool that are deeper than allowed. @returns whether any became stiffer
    bool stiffen(const Normal& normal, const StiffnessAdaptation& adaptation) {
        const std::vector<double> depth = depths();
        bool any = false;
        for (Index f = 0; f < mesh_->fibre_count(); ++f)
            for (Index t = 0; t < core::count(tools_); ++t) {
                if (!(depth[slot(f, t)] > adaptation.allowed_penetration)) continue;
                double& own = stiffness_[slot(f, t)];
                const double before = own;
                own = strictly_adapted_stiffness(adaptation, normal, own, reference_[core::at(f)], depth[slot(f, t)]);
                any = any || own > before;
            }
        return any;
    }

    void accept(const Vector& state, const Normal& normal, const StiffnessAdaptation& adaptation) {
        accepted_ = records(state);
        const std::vector<double> deepest = depths();
        for (Index f = 0; f < mesh_->fibre_count(); ++f)
            for (Index t = 0; t < core::count(tools_); ++t) {
                double& own = stiffness_[slot(f, t)];
                own = adapted_stiffness(adaptation, normal, own, reference_[core::at(f)], deepest[slot(f, t)]);
            }
        accepted_stiffness_ = stiffness_;
        accepted_pose_ = pose_;
    }
    void restore() {
        stiffness_ = accepted_stiffness_;
        elements_.clear(), responses_.clear(), frictions_.clear(), pushes_.clear();
        std::fill(first_.begin(), first_.end(), 0);
    }
    /// Passes each number of what was accepted last to see(number): for files.
    template <class See>
    void each_accepted(const See& see) const {
        const Index size = core::count(accepted_);
        see(size);
        visit_accepted(*this, see);
    }
    /// The same the other way: see(number) sets it. The tools stand where that state had them.
    template <class See>
    void resume(const See& see) {
        Index size = 0;
        see(size);
        accepted_.resize(core::at(size));
        visit_accepted(*this, see);
        accepted_pose_ = pose_;
        restore();
    }

protected:  // for tools that fibres carry
    template <class Self, class See>
    static void visit_accepted(Self& self, const See& see) {
        for (auto& record : self.accepted_) Record::each(record, see);
        for (auto& value : self.accepted_stiffness_) see(value);
    }
    /// Sine of a fibre's angle to a tool beyond which its end is rounded, and not its last section a disc; there the two are a
    /// twentieth of a radius apart. A fibre that lies on a plate and sags keeps its sections.
    static constexpr double slanted = 0.3;

    /// Penetration of each fibre in each tool [length].
    std::vector<double> depths() const {
        std::vector<double> depth(stiffness_.size(), 0.0);
        for (std::size_t k = 0; k < elements_.size(); ++k) {
            double& own = depth[slot(elements_[k].fibre, elements_[k].tool)];
            own = std::max(own, adapting_penetration(elements_[k], responses_[k]));
        }
        return depth;
    }
    /// What bounds friction of an element in the last evaluation [force].
    double bound_of(std::size_t k) const noexcept {
        if constexpr (law::PullingNormal<Normal>)
            return pushes_[k];
        else
            return responses_[k].reaction;
    }
    std::size_t slot(Index fibre, Index tool) const noexcept { return core::at(fibre * core::count(tools_) + tool); }
    Vec3 tangent(const Element& element, const Vector& state) const {
        return contact_tangent(*mesh_, state, element.fibre, element.u).normalized();
    }
    /// How far the tool's point stood from its present place, where the last evaluation is of the accepted state.
    Vec3 back_step(const Element& element) const {
        const std::size_t t = core::at(element.tool);
        return element.foot - used_pose_[t].place(pose_[t].material(element.foot));
    }

    void place_particle(Element& element, const Vector& state, const Vector& accepted,
                        [[maybe_unused]] const Normal& normal) const {
        const std::size_t t = core::at(element.tool);
        const scene::ToolPose& pose = pose_[t];
        element.normal = pose.turn * normal_at_fibre(*mesh_, state, element.fibre, element.u, element.first, tools_[t], pose);
        // Of a section that faces the tool with its flat side, the furthest particle is now here, now there: a rounded end is
        // not.
        const bool last = element.u == 0.0 || element.u == static_cast<double>(mesh_->fibre(element.fibre).elements);
        element.end = last && std::abs(tangent(element, state).dot(element.normal)) > slanted;
        follow_particles(*mesh_, state, element);
        const Vec3 particle = beam::Mesh<B>::point(state, element.first, element.weights);
        element.foot = particle - scene::tool_distance(tools_[t], pose.material(particle)).distance * element.normal;
        if constexpr (law::GapShifting<Normal>) element.shift.shift = normal.gap_shift(element.gap(accepted));
        if constexpr (law::Augmenting<Normal>)
            element.shift.shift = -normal.penetration(element.shift.multiplier, stiffness(element));
        see_directions(*mesh_, state, element);
        if constexpr (law::SteppedNormal<Normal>) {
            Element then = element;
            follow_particles(*mesh_, accepted, then);
            then.foot = accepted_pose_[t].place(pose.material(element.foot));
            element.shift.before = then.normal.dot(then.offset(accepted));
        }
        if constexpr (core::Active<Friction>) {
            element.friction.weights_j = element.weights;
            const scene::ToolPose& before = accepted_pose_[t];
            element.friction.accepted_offset =
                pose.turn * before.turn.transpose() *
                (beam::Mesh<B>::point(accepted, element.first, element.weights) - before.place(pose.material(element.foot)));
        }
    }

    std::vector<Record> records(const Vector& state) const {
        std::vector<Record> list(elements_.size());
        for (std::size_t k = 0; k < elements_.size(); ++k) {
            const Element& element = elements_[k];
            list[k].fibre = element.fibre, list[k].tool = element.tool, list[k].station = element.station;
            if (k >= responses_.size()) continue;
            list[k].multiplier = bound_of(k);
            if constexpr (core::Active<Friction>) {
                if (responses_[k].reaction == 0.0) continue;
                const TangentPlane plane(tangent(element, state), element.normal);
                list[k].friction = RecordedFriction<Friction>::of(frictions_[k].history, plane);
            }
        }
        return list;
    }

    const beam::Mesh<B>* mesh_;
    std::vector<scene::Tool> tools_;
    double step_;  // between stations, in elements
    std::vector<scene::ToolPose> pose_, accepted_pose_, used_pose_;
    std::vector<double> reference_, stiffness_, accepted_stiffness_;  // by fibre; by fibre and tool
    std::vector<Element> elements_;
    std::vector<Index> first_;  // element of each fibre
    std::vector<ContactResponse> responses_;
    std::vector<law::FrictionAnswer<Friction>> frictions_;
    std::vector<double> pushes_;  // of a law that pulls: what is left of its reactions then
    std::vector<Record> accepted_;
    bool starting_ = false;  // fibres stand where the last increment left them
};

}  // namespace fibrant::contact
