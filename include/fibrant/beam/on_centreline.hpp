// SPDX-License-Identifier: MIT
#pragma once
/// @file Lets contact act on a beam's centreline and leave its sections alone.

#include <fibrant/beam/beam_element.hpp>

namespace fibrant::beam {

/// What friction is to do that acts on centrelines, a radius away from the surface where it belongs.
enum class FrictionLever {
    needed,   ///< a law of friction is refused when the model is compiled
    dropped,  ///< it pulls fibres along without turning them
};

/// Friction has to be left out of contact on this beam's centreline.
template <class B>
concept LeverNeeded = TouchedOnCentreline<B> && requires {
    requires B::friction_lever == FrictionLever::needed;
};

/// A beam whose contact elements are pairs of particles of the centreline, a rest radius away from the surface. Sections neither
/// flatten nor roll under contact, contact elements and point terms are half as large, and fewer unknowns are coupled: for stages
/// without friction, before the same fibres go on with sections that feel it (`Simulator::go_on_from`).
/// @tparam Base  a beam with a position a node and other vectors beside it, whose sections do not turn by rotations
template <BeamElement Base, FrictionLever Lever = FrictionLever::needed>
    requires DeformableSections<Base>
class OnCentreline : public Base {
public:
    using Base::Base;
    using Rest = typename Base::Rest;
    using CentreWeights = beam::CentreWeights<Base::nodes, Base::vectors_per_node>;
    static constexpr FrictionLever friction_lever = Lever;

    /// Throws std::invalid_argument for a section that is not round beside what the beam itself refuses.
    Rest rest(const scene::CrossSection& section, const scene::ElasticMaterial& material,
              const ElementVector<Base>& configuration) const {
        core::require(section.semi_axis_2 == section.semi_axis_1, "OnCentreline.rest: semi_axis_2", section.semi_axis_2,
                      "semi_axis_1: a distance of centrelines knows round sections only");
        return Base::rest(section, material, configuration);
    }
    /// x_0 at xi in [-1, 1].
    static constexpr CentreWeights centre_weights(double xi) noexcept {
        CentreWeights centre;
        const ElementWeights<Base> all = Base::centreline_weights(xi);
        for (std::size_t node = 0; node < centre.size(); ++node)
            centre.weight[node] = all[node * static_cast<std::size_t>(CentreWeights::stride)];
        return centre;
    }
};

}  // namespace fibrant::beam
