// SPDX-License-Identifier: MIT
#pragma once
// What every term owes beyond the syntax of its concept.
#include <fibrant/term/list.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace fibrant::test {

/// A term of a scene, with its tangent as a full matrix.
template <class B, class T>
struct TermScene {
    scene::Assembly assembly;
    beam::Mesh<B> mesh;
    scene::Channels channels;
    term::For<T, B> term;

    TermScene(const scene::Assembly& of, const typename T::Parameters& parameters)
        : assembly{of},
          mesh{assembly, B()},
          channels{assembly, term::For<T, B>::channels(parameters)},
          term{term::SiteOf<B>(assembly, mesh, channels, mesh.layout()), parameters} {
        begin(1.0);
    }
    void begin(double amplitude) {
        if constexpr (term::Moving<term::For<T, B>>) term.last(0.1);
        term.begin(std::vector<double>(channels.names().size(), amplitude), mesh.start_state());
    }
    Vector forces(const Vector& state) {
        term.evaluate(state);
        Vector sum = Vector::Zero(state.size());
        term.add_forces(state, sum);
        return sum;
    }
    struct Sink {
        TermScene* of;
        Matrix all;
        static constexpr Index size = B::nodes * B::dofs_per_node;
        void add_diagonal(Index vector, const Mat3& stiffness) { all.block<3, 3>(3 * vector, 3 * vector) += stiffness; }
        void add_element(Index f, Index e, const double* entries) {
            const Index first = of->mesh.first_unknown(f, e);
            all.block<size, size>(first, first) += Eigen::Map<const Eigen::Matrix<double, size, size>>(entries);
        }
        void add_coupling(const term::CentrePoint& i, const term::CentrePoint& j, const Mat3& stiffness) {
            const auto add = [&](const term::CentrePoint& one, const term::CentrePoint& other, double sign) {
                for (Index a = 0; a < one.vectors; ++a)
                    for (Index b = 0; b < other.vectors; ++b)
                        all.block<3, 3>(3 * (one.first_vector + a), 3 * (other.first_vector + b)) +=
                            sign * one.weights.place[core::at(a)] * other.weights.place[core::at(b)] * stiffness;
            };
            add(i, i, 1.0), add(j, j, 1.0), add(i, j, -1.0), add(j, i, -1.0);
        }
    };
    Matrix stiffness(const Vector& state) {
        term.evaluate(state);
        Sink sink{this, Matrix::Zero(state.size(), state.size())};
        term::Bands bands(sink);
        term::Couplings couplings(sink);
        term.add_bands(state, bands);
        term.add_couplings(state, couplings);
        const scene::DofLayout& layout = mesh.layout();
        for (Index f = 0; f < mesh.fibre_count(); ++f)
            scene::for_own_vectors(layout, f, [&](Index v, double length) {
                sink.add_diagonal(v, term.spring(f) * length * length * Mat3::Identity());
            });
        return sink.all;
    }
};

/// What a term keeps, as a checkpoint has it.
std::vector<double> numbers_of(auto& term) {
    std::vector<double> all;
    term.each([&]<class Value>(Value& value) {
        if constexpr (std::is_same_v<Value, Vector>)
            all.insert(all.end(), value.begin(), value.end());
        else
            all.push_back(static_cast<double>(value));
    });
    return all;
}
void copy_numbers(auto& from, auto& to) {
    const std::vector<double> all = numbers_of(from);
    std::size_t next = 0;
    to.each([&]<class Value>(Value& value) {
        if constexpr (std::is_same_v<Value, Vector>)
            for (double& entry : value) entry = all[next++];
        else
            value = static_cast<Value>(all[next++]);
    });
    CHECK(next == all.size());
}

/// @param state  in which the term acts and is smooth; what it looks for is looked for there
template <class B, class T>
void check_term(const scene::Assembly& assembly, const typename T::Parameters& parameters, const Vector& state) {
    static_assert(term::TermFor<T, B>);
    TermScene<B, T> scene(assembly, parameters);
    auto& term = scene.term;
    term.detect(state, state, 1.0);
    const Vector forces = scene.forces(state);
    REQUIRE(forces.norm() > 0.0);
    // Central differences: their error is of the order of h^2, and rounding of 1e-16 / h, of forces and lengths of the order
    // of 1.
    const double h = 1e-5, bar = 1e-7;
    Matrix differences(state.size(), state.size());
    Vector slope(state.size());
    for (Index k = 0; k < state.size(); ++k) {
        Vector ahead = state, behind = state;
        ahead[k] += h, behind[k] -= h;
        differences.col(k) = (scene.forces(ahead) - scene.forces(behind)) / (2.0 * h);
        slope[k] = (term.stored(ahead) - term.stored(behind)) / (2.0 * h);
    }
    if (term.role == term::Role::external) differences = -differences;
    const Matrix symmetric = 0.5 * (differences + differences.transpose());
    const double size = std::max(symmetric.norm(), forces.norm());
    CHECK((scene.stiffness(state) - symmetric).norm() < bar * size);
    if (term.role == term::Role::structure || term.role == term::Role::interaction) {
        CHECK((slope - forces).norm() < bar * forces.norm());
        CHECK((differences - differences.transpose()).norm() < bar * size);
    }
    const double part = term.largest_part(0.1 * Vector::Ones(state.size()), 1e-3);
    CHECK((part > 0.0 && part <= 1.0));

    // What is not accepted is forgotten, and the same numbers are the same term.
    term.accept(state);
    const std::vector<double> accepted = numbers_of(term);
    scene.begin(1.0);
    const Vector before = scene.forces(state);
    const Vector other = state + 0.01 * Vector::LinSpaced(state.size(), -1.0, 1.0);
    scene.begin(1.0);
    scene.forces(other);
    term.restore();
    scene.begin(1.0);
    CHECK(scene.forces(state) == before);
    CHECK(numbers_of(term) == accepted);
    TermScene<B, T> again(assembly, parameters);
    copy_numbers(term, again.term);
    again.term.restore();
    again.term.detect(state, state, 1.0);
    again.begin(1.0);
    CHECK(again.forces(state) == before);
}

}  // namespace fibrant::test
