// SPDX-License-Identifier: MIT
#pragma once
/// @file What a term of the equilibrium sees of a scene: fibres as rows of elements, whatever their beam is.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/scene/channels.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace fibrant::term {

/// Nodal vectors that an element may have at most: four nodes of a position and two directors.
inline constexpr std::size_t most_vectors = 12;

/// Weights of an element's nodal vectors: of a place on the centreline, and of its derivative by xi.
struct CentreWeights {
    std::array<double, most_vectors> place{}, derivative{};
};

/// A particle of a centreline.
struct CentrePoint {
    Index fibre = 0, element = 0;
    double xi = 0.0;         ///< in [-1, 1]
    Index first_vector = 0;  ///< of the element; `vectors` follow each other
    Index vectors = 0;
    CentreWeights weights{};

    /// Where it is [length].
    Vec3 place(const Vector& state) const noexcept { return sum(weights.place, state); }
    /// Derivative of that by xi [length].
    Vec3 derivative(const Vector& state) const noexcept { return sum(weights.derivative, state); }
    /// Adds to nodal forces what a force on it is to them.
    void push(const Vec3& force, Vector& forces) const noexcept {
        for (Index a = 0; a < vectors; ++a)
            for (Index c = 0; c < 3; ++c) forces[3 * (first_vector + a) + c] += weights.place[core::at(a)] * force[c];
    }

private:
    Vec3 sum(const std::array<double, most_vectors>& factors, const Vector& state) const noexcept {
        Vec3 all = Vec3::Zero();
        for (Index a = 0; a < vectors; ++a)
            for (Index c = 0; c < 3; ++c) all[c] += factors[core::at(a)] * state[3 * (first_vector + a) + c];
        return all;
    }
};

/// A scene as terms are built from it. It and what it looks at outlive them.
class Site {
public:
    /// @param layout  of all unknowns: those of fibres, and of solids behind them
    template <beam::BeamElement B>
    Site(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const scene::Channels& channels,
         const scene::DofLayout& layout)
        : assembly_{&assembly},
          channels_{&channels},
          layout_{&layout},
          fibres_{mesh.fibres()},
          rest_state_{&mesh.rest_state()},
          vectors_{B::nodes * B::vectors_per_node},
          step_{beam::Mesh<B>::vectors_per_element_step},
          weights_{&weights_of<B>} {}

    const scene::Assembly& assembly() const noexcept { return *assembly_; }
    const scene::DofLayout& layout() const noexcept { return *layout_; }
    std::span<const beam::MeshFibre> fibres() const noexcept { return fibres_; }
    const Vector& rest_state() const noexcept { return *rest_state_; }  ///< of the fibres

    /// Number of a channel, for amplitudes. @throws std::invalid_argument if the scene has none of this name
    Index channel(const std::string& name) const { return channels_->find(name); }
    /// Nodal vectors of an element.
    Index vectors() const noexcept { return vectors_; }
    /// A particle of element e of a fibre, at xi in [-1, 1].
    CentrePoint point(Index fibre, Index element, double xi) const noexcept {
        CentrePoint at{fibre, element, xi, fibres_[core::at(fibre)].first_vector + element * step_, vectors_, {}};
        weights_(xi, at.weights);
        return at;
    }
    /// The same at a part of the fibre's rest length. @throws std::invalid_argument naming what is no place of a fibre
    CentrePoint point(const scene::Station& at) const {
        if (at.fibre < 0 || at.fibre >= core::count(fibres_))
            core::refuse("Station.fibre", std::to_string(at.fibre), "a fibre of this assembly");
        core::require_between("Station.fraction", at.fraction, 0.0, 1.0);
        const Index elements = fibres_[core::at(at.fibre)].elements;
        const double u = at.fraction * static_cast<double>(elements);
        const Index element = std::min(elements - 1, static_cast<Index>(u));
        return point(at.fibre, element, 2.0 * (u - static_cast<double>(element)) - 1.0);
    }
    /// see(point, weight) at points of a fibre between two parts of its rest length: a sum of weight * f(point) is the integral
    /// of f over the rest length, exact where f is of the fifth degree in xi within an element [length].
    template <class See>
    void each_point(Index fibre, double from, double to, const See& see) const {
        const beam::MeshFibre& one = fibres_[core::at(fibre)];
        const double end = static_cast<double>(one.elements), place = std::sqrt(0.6);  // Gauss, three points
        for (Index e = 0; e < one.elements; ++e) {
            const double a = std::max(from * end, static_cast<double>(e)), b = std::min(to * end, static_cast<double>(e + 1));
            if (!(b > a)) continue;
            const std::array<std::array<double, 2>, 3> rule{{{-place, 5.0 / 18.0}, {0.0, 8.0 / 18.0}, {place, 5.0 / 18.0}}};
            for (const auto& [at, weight] : rule)
                see(point(fibre, e, 2.0 * (0.5 * (a + b) + 0.5 * (b - a) * at - static_cast<double>(e)) - 1.0),
                    weight * (b - a) * one.element_length);
        }
    }

private:
    template <beam::BeamElement B>
    static void weights_of(double xi, CentreWeights& weights) noexcept {
        static_assert(B::nodes * B::vectors_per_node <= static_cast<int>(most_vectors));
        const beam::ElementWeights<B> place = B::centreline_weights(xi), derivative = B::centreline_derivative_weights(xi);
        std::copy(place.begin(), place.end(), weights.place.begin());
        std::copy(derivative.begin(), derivative.end(), weights.derivative.begin());
    }

    const scene::Assembly* assembly_;
    const scene::Channels* channels_;
    const scene::DofLayout* layout_;
    std::span<const beam::MeshFibre> fibres_;
    const Vector* rest_state_;
    Index vectors_, step_;
    void (*weights_)(double, CentreWeights&) noexcept;
};

/// The same with the mesh itself, for terms that are made for a beam.
template <beam::BeamElement B>
class SiteOf : public Site {
public:
    SiteOf(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const scene::Channels& channels,
           const scene::DofLayout& layout)
        : Site(assembly, mesh, channels, layout), mesh_{&mesh}, channels_{&channels} {}
    const beam::Mesh<B>& mesh() const noexcept { return *mesh_; }
    const scene::Channels& channels() const noexcept { return *channels_; }

private:
    const beam::Mesh<B>* mesh_;
    const scene::Channels* channels_;
};

}  // namespace fibrant::term
