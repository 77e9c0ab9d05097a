// SPDX-License-Identifier: MIT
#pragma once
/// @file Keys and bounds that several programs have alike.

#include "scene_reader.hpp"

#include <fibrant/law/shaped_friction.hpp>
#include <fibrant/scene/elastic_material.hpp>

#include <string>
#include <vector>

namespace example {

/// Whether strand, composite and knot have models of sections and friction that obey laws of their own beside the usual one,
/// which takes twice as long to compile. What is left out is refused by its key.
#ifdef FIBRANT_OWN_LAWS
inline constexpr bool has_own_laws = true;
#else
inline constexpr bool has_own_laws = false;
#endif
inline constexpr const char* no_own_laws = "that of a build with -DFIBRANT_OWN_LAWS=ON; without it this program has no such law";

/// How a scene's linear systems are solved.
struct LinearSolver {
    std::string strategy = "automatic";  ///< one of `linear_solvers`
    fibrant::Index subdomains = 64;      ///< that ranks share, in [1, 4096]
    std::string petsc_options{};         ///< where PETSc iterates
};
/// Strategies of solver::AnySolver, or of example::RankSolver, whose headers are not for those who only read a scene.
inline const std::vector<std::string>& linear_solvers() {
    static const std::vector<std::string> names{"automatic",       "two_level_pcg",
#ifndef FIBRANT_WITH_MPI
                                                "fibre_block_pcg", "float_block_cholesky", "double_block_cholesky",
                                                "sparse_cholesky"
#elif defined FIBRANT_WITH_PETSC
                                                "petsc"
#endif
    };
    return names;
}
inline void read_linear_solver(SceneReader& file, LinearSolver& how) {
    file.read("solver", "linear_solver", how.strategy, linear_solvers(), "how linear systems are solved");
#ifdef FIBRANT_WITH_MPI
    file.read("solver", "subdomains", how.subdomains, between(1, 4096),
              "parts that the scene is cut into for the ranks; results depend on it, and not on the ranks");
#ifdef FIBRANT_WITH_PETSC
    file.names({{"PetscKrylov.options", "solver.petsc_options"}});
    file.read("solver", "petsc_options", how.petsc_options, {},
              "of PETSc where linear_solver is \"petsc\", as \"-ksp_type fgmres -ksp_monitor\"");
#endif
#endif
}

/// Young's modulus and Poisson's ratio; both must be given.
inline void read_material(SceneReader& file, const std::string& section, fibrant::scene::ElasticMaterial& material) {
    file.require(section, "young_modulus", material.young_modulus, positive(), "force/length^2", "Young's modulus of the fibres");
    file.require(section, "poisson_ratio", material.poisson_ratio, poisson_ratio(), "1", "Poisson's ratio of the fibres");
}

/// What fibres are across, by `[section.law]` kind = "transversely_isotropic"; young_modulus and poisson_ratio are those along
/// them then. To be checked by `check_transverse` once all keys are known.
inline void read_transverse(SceneReader& file, const std::string& section, std::string& kind,
                            fibrant::scene::TransverseConstants& across) {
    const std::string law = section + ".law";
    file.read(law, "kind", kind, {"isotropic", "transversely_isotropic"}, "how the material of the fibres behaves across them");
    file.read(law, "transverse_modulus", across.young_modulus, positive(), "force/length^2", "Young's modulus across the fibres");
    file.read(law, "transverse_poisson_ratio", across.poisson_ratio, inside(-1.0, 1.0), "1",
              "Poisson's ratio in the plane of the section");
    file.read(law, "shear_modulus", across.shear_modulus, positive(), "force/length^2",
              "shear modulus between the fibre axis and its section");
}
inline void check_transverse(const SceneReader& file, const std::string& section, const std::string& kind) {
    const std::string law = section + ".law";
    for (const char* key : {"transverse_modulus", "transverse_poisson_ratio", "shear_modulus"})
        file.check(file.given(law, key) == (kind != "isotropic"), law, key,
                   kind == "isotropic" ? "left out, for kind = \"isotropic\"" : "given, for kind = \"transversely_isotropic\"");
}

/// The same where the law of another section holds unless this one names its own: `across` comes in as that.
inline void read_own_transverse(SceneReader& file, const std::string& section, std::string& kind,
                                fibrant::scene::TransverseConstants& across) {
    const std::string law = section + ".law";
    for (const char* key : {"kind", "transverse_modulus", "transverse_poisson_ratio", "shear_modulus"})
        if (file.given(law, key)) {
            kind = "isotropic", across = {};
            break;
        }
    read_transverse(file, section, kind, across);
}

/// Friction of fibres. @param which  and when, as a user is told
inline void read_friction(SceneReader& file, double& coefficient, const char* which) {
    file.read("contact", "friction_coefficient", coefficient, friction(), "1", which);
}
/// What friction is over Coulomb's, [contact.friction]: by pressure, direction, adhesion and the way slid. @returns whether it is
/// anything else
inline bool read_friction_shape(SceneReader& file, fibrant::law::FrictionShape& shape) {
    const std::string own = "contact.friction";
    file.read(own, "across_over_along", shape.across, above(0.0, 1000.0), "1",
              "coefficient of friction across the fibres over that along them");
    file.read(own, "exponent", shape.exponent, above(0.0, 1.0), "1",
              "n of T = a N^n: friction of a line of contact grows by that power of its load");
    file.read(own, "line_load", shape.line_load, positive(), "force/length",
              "load of a line of contact at which the coefficient is that given, for an exponent below 1");
    file.read(own, "line_adhesion", shape.line_adhesion, not_negative(), "force/length",
              "load that friction of a line of contact has beside its own: adhesion");
    file.read(own, "crossing_adhesion", shape.crossing_adhesion, not_negative(), "force", "the same of a crossing");
    file.read(own, "static_over_kinetic", shape.static_over_kinetic, between(1.0, 1000.0), "1",
              "coefficient of what has not slid yet over that given, which is that of what has");
    file.read(own, "weakening_length", shape.weakening_length, positive(), "length",
              "way slid over which it falls by 1/e, for static_over_kinetic above 1");
    return !shape.coulomb();
}
/// The first key of it that is given.
inline const char* told_shape(const SceneReader& file) {
    for (const char* key : {"across_over_along", "exponent", "line_adhesion", "crossing_adhesion"})
        if (file.given("contact.friction", key)) return key;
    return "static_over_kinetic";
}
/// To be checked once all keys are known.
inline void check_friction_shape(const SceneReader& file, const fibrant::law::FrictionShape& shape) {
    const std::string own = "contact.friction";
    file.check(file.given(own, "line_load") == (shape.exponent < 1.0), own, "line_load",
               shape.exponent < 1.0 ? "given, for exponent below 1" : "left out, for exponent = 1");
    file.check(
        file.given(own, "weakening_length") == (shape.static_over_kinetic > 1.0), own, "weakening_length",
        shape.static_over_kinetic > 1.0 ? "given, for static_over_kinetic above 1" : "left out, for static_over_kinetic = 1");
}
/// Displacement over the radius that friction takes before it slides.
inline void read_reversible_displacement(SceneReader& file, double& over_radius) {
    file.read("contact", "reversible_displacement_over_radius", over_radius, above(0.0, 1.0), "1",
              "slip up to which friction is elastic, over the radius");
}
/// How deep fibres may be in each other over their radius.
inline void read_allowed_penetration(SceneReader& file, double& over_radius,
                                     const char* which = "how deep a contact may be, over the radius") {
    file.read("contact", "allowed_penetration_over_radius", over_radius, depth_over_radius(), "1", which);
}

/// Wires of a strand of full layers.
inline Bound wires() { return {.low = 7, .high = 91, .said = "7, 19, 37, 61 or 91", .values = {7, 19, 37, 61, 91}}; }
/// What a strand is of; all must be given. @param of  the wires whose angle it is
inline void read_wires(SceneReader& file, Index& count, double& radius, double& lay_angle_deg, const char* of) {
    file.require("strand", "wires", count, wires(), "number of wires: a core and layers of 6, 12, 18, 24, 30");
    file.require("strand", "radius", radius, positive(), "length", "radius of the wires");
    file.require("strand", "lay_angle_deg", lay_angle_deg, inside(-80.0, 80.0), "degree", of);
}

/// Directions of random fibres, and how finely each is divided.
inline void read_random_fibres(SceneReader& file, double& tilt_deg, Index& elements, const char* of) {
    file.read("mat", "tilt_deg", tilt_deg, between(0.0, 90.0), "degree",
              "greatest angle of a fibre to the plane; 90: all directions");
    file.read("mat", "elements", elements, between(1, 10000), of);
}
inline void read_seed(SceneReader& file, Index& seed) {
    file.read("mat", "seed", seed, between(0, 1e15), "seed of the random numbers");
}

}  // namespace example
