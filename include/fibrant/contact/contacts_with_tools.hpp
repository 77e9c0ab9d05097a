// SPDX-License-Identifier: MIT
#pragma once
/// @file Contacts between fibres and with rigid tools, as one set: what a model with tools has in the place of ContactSet.

#include <fibrant/contact/contact_set.hpp>
#include <fibrant/contact/tool_contacts.hpp>

#include <algorithm>
#include <span>

namespace fibrant::contact {

/// The part `Tools` of a model whose scenes have rigid tools. Models without it have no trace of them.
struct RigidTools {
    using Parameters = core::NoParameters;
    explicit RigidTools(const Parameters& = {}) {}
    template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
    using Of = ToolContacts<B, Normal, Friction>;
};

/// A ContactSet whose loops take the tools along. Its functions hide those of the set: it is used by its own type.
/// @tparam Part  RigidTools, or what has more of tools
template <beam::BeamElement B, proximity::ProximitySearch Search, law::NormalLaw Normal, law::FrictionLaw Friction, class Part>
class ContactsWithTools : public ContactSet<B, Search, Normal, Friction> {
public:
    using Base = ContactSet<B, Search, Normal, Friction>;
    using Tools = typename Part::template Of<B, Normal, Friction>;

    ContactsWithTools(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const ContactParameters& parameters,
                      Search search, Normal normal, Friction friction)
        : Base(assembly, mesh, parameters, std::move(search), normal, friction),
          tools_(assembly, mesh, parameters.stiffness, parameters.spacing.points_per_element) {}

    Tools& tools() noexcept { return tools_; }
    const Tools& tools() const noexcept { return tools_; }

    void detect(const Vector& state, const Vector& accepted, double reach, bool forced) {
        Base::detect(state, accepted, reach, forced);
        reach_ = reach;
        tools_.detect(this->acting(state, accepted), accepted, reach, this->normal_law());
    }
    void regenerate(const Vector& state, const Vector& accepted) {
        Base::regenerate(state, accepted);
        tools_.detect(this->acting(state, accepted), accepted, reach_, this->normal_law());
    }
    double refresh(const Vector& state, const Vector& accepted) {
        const double turn = Base::refresh(state, accepted);
        return std::max(turn, tools_.refresh(this->acting(state, accepted), accepted, this->normal_law()));
    }
    void hold_reactions() {
        Base::hold_reactions();
        tools_.hold_reactions();
    }
    void evaluate(const Vector& state, bool start = false) {
        Base::evaluate(state, start);
        tools_.evaluate(state, this->acting(state), this->normal_law(), this->friction_law());
    }
    template <class Add>
    void section_stiffness_terms(Index fibre, const Vector& state, const Add& add) const {
        Base::section_stiffness_terms(fibre, state, add);
        tools_.stiffness_terms(fibre, state, add);
    }
    void add_forces(Vector& residual) const {
        Base::add_forces(residual);
        tools_.add_forces(residual);
    }
    ContactFigures figures(const Vector& state) const {
        ContactFigures sum = Base::figures(state);
        tools_.add_figures(state, this->normal_law(), sum);
        return sum;
    }
    double misfit() const { return std::max(Base::misfit(), tools_.misfit()); }
    void accept(const Vector& state) {
        Base::accept(state);
        tools_.accept(state, this->normal_law(), this->parameters().stiffness);
    }
    void restore() {
        Base::restore();
        tools_.restore();
    }

private:
    Tools tools_;
    double reach_ = 0.0;
};

}  // namespace fibrant::contact
