// SPDX-License-Identifier: MIT
#pragma once
/// @file What tests of Newton's method and of the loops around it say of a problem of one node, and of contacts that are none.

#include <fibrant/solver/newton.hpp>

#include <vector>

namespace fibrant::test {

/// A node without chains and fibres. A problem adds its forces: `linearise`, `residual` and `prescribed_step`.
struct OneNode {
    struct System {
        scene::DofLayout own;
        const scene::DofLayout& layout() const { return own; }
        double coupling = 0.0;  // of the held node, which is the second one, to the first
        void apply_unheld(const Vector& x, Vector& y) const {
            y = x;
            if (x.size() > 3) y.head<3>() -= coupling * x.tail<3>();
        }
        Matrix row(Index, Index) const { return Matrix::Identity(3, 3); }
    };
    struct Fibre {
        scene::CrossSection section{.semi_axis_1 = 1e3, .semi_axis_2 = 1e3};
    };
    struct Mesh {
        Fibre only;
        Index fibre_count() const { return 0; }
        Index node_count(Index) const { return 0; }
        const Fibre& fibre(Index) const { return only; }
    };
    System own{{.chains = {{.nodes = 1, .vectors_per_node = 1}},
                .kind = {scene::VectorKind::position},
                .value = {Vec3::Zero()},
                .length = {1.0},
                .held = {},
                .images = {},
                .ties = {},
                .motions = {}},
               0.0};
    Mesh fibres;
    contact::LearnedContacts memory;

    const System& system() const { return own; }
    const Mesh& mesh() const { return fibres; }
    void close_chains(Vector&, const Vector&) const {}
    void evaluate(const Vector&) const {}
    double largest_part(const Vector&, double, double part) const { return part; }
    void predict_stresses(const Vector&, const Vector&) {}
    void reset_stresses(const Vector&) {}
    double greatest(const Vector& step) const { return step.norm(); }
    double norm(const Vector& forces) const { return forces.norm(); }
    double product(const Vector& a, const Vector& b) const { return a.dot(b); }
    contact::LearnedContacts& learned() { return memory; }
    void add_learned(Vector&) const {}
};

/// Contacts without an element.
struct Untouched {
    struct Places {
        bool rehosted() const { return false; }
    };
    struct Element {
        Vec3 normal;
        Index fibre_i = 0, fibre_j = 1;
        Vec3 motion(const Vector&) const { return Vec3::Zero(); }
    };
    std::vector<Element> none;
    std::vector<contact::ContactResponse> nothing;

    Places places() const { return {}; }
    const std::vector<Element>& elements() const { return none; }
    bool forced(const Element&) const { return false; }
    void evaluate(const Vector&) {}
    Vec3 force(Index) const { return Vec3::Zero(); }
    Mat3 tangent(Index) const { return Mat3::Zero(); }
    const std::vector<contact::ContactResponse>& responses() const { return nothing; }
};

}  // namespace fibrant::test
