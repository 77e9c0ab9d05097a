// SPDX-License-Identifier: MIT
#pragma once
/// @file Parts the fibres of any scene that lie in each other where it begins, or says which two do not part.

#include <fibrant/contact/overlaps.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/observe/least_gap.hpp>
#include <fibrant/simulation/simulator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::simulation {

/// How fibres are parted. All follows from radii, moduli, lengths of elements and the allowed penetration; nothing has to be
/// given.
struct PartingParameters {
    double allowed_penetration = core::unset;  ///< at the end [length], > 0; unset: that of the model's contacts
    double gap_limit_over_radius =
        0.3;  ///< that fibres part by in an increment, over the radius of the thinnest one that overlaps [1], in (0, 1]
    /// Lets holds of fibres that do not part with them go along, if these begin at rest: conditions count from where a run
    /// begins, so their ends are held there.
    bool loosen_holds = true;
    Index most_increments = 400;  ///< of all, >= 1

    void validate() const {
        if (!std::isnan(allowed_penetration))
            core::require_positive("PartingParameters.allowed_penetration", allowed_penetration);
        core::require(gap_limit_over_radius > 0.0 && gap_limit_over_radius <= 1.0, "PartingParameters.gap_limit_over_radius",
                      gap_limit_over_radius, "in (0, 1]");
        core::require_at_least("PartingParameters.most_increments", most_increments, 1);
    }
};

/// What came of it.
struct Parting {
    bool parted = false;             ///< no two fibres are deeper in each other than allowed, anywhere
    std::string reason;              ///< why not: the two fibres that are deepest in each other, how deep and where
    contact::Overlap before, after;  ///< deepest
    Vector start;                    ///< nodal vectors of the fibres, for Assembly::begin_at
    std::vector<Index> loosened;     ///< fibres whose holds went along
    Index increments = 0;
    solver::IterationCounts counts;
};

namespace detail {

template <class M>
struct SameTools {};
template <HasTools M>
struct SameTools<M> {
    using Tools = typename M::Tools;
};
template <class M>
struct SameConnections {};
template <HasConnections M>
struct SameConnections<M> {
    using Connections = typename M::Connections;
};

/// The model of the parting: parts of the user's, but for laws that let go gently.
template <Model M>
struct PartingModel : SameTools<M>, SameConnections<M> {
    using Beam = typename M::Beam;
    using Proximity = typename M::Proximity;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = law::Frictionless;
    using Solver = typename M::Solver;
    using Passage = contact::NoPassage;  // where fibres lie in each other they have no sides yet
};

/// What is seen beside each other: fibres and their images across seams, those that go on where one ends as one.
struct SeenLines {
    observe::Snapshot shot;
    std::vector<Index> line;  ///< of the mesh, the first of those that each is of
};
template <beam::BeamElement Beam>
SeenLines seen_lines(const beam::Mesh<Beam>& mesh, const Vector& state) {
    SeenLines seen;
    seen.shot = snapshot_of(mesh, state);
    for (Index f = 0; f < mesh.fibre_count(); ++f) seen.line.push_back(f);
    if (mesh.line_count() == mesh.fibre_count()) return seen;
    std::vector<std::vector<Index>> images(core::at(mesh.fibre_count()));  // of each fibre, and itself: few
    for (Index f = 0; f < mesh.line_count(); ++f) images[core::at(mesh.source(f))].push_back(f);
    std::vector<observe::FibreSnapshot> all;
    seen.line.clear();
    for (Index f = 0; f < mesh.fibre_count(); ++f) {
        const observe::FibreSnapshot& own = seen.shot.fibres[core::at(f)];
        const double near = 1e-6 * mesh.fibre(f).length();  // rounding of what is drawn
        const std::vector<Index>& lines = images[core::at(f)];
        const auto end = [&](Index line, bool last) {
            return mesh.position(state, line, last ? static_cast<double>(mesh.fibre(line).elements) : 0.0);
        };
        const auto next = [&](Index line) {
            for (const Index other : lines)
                if (!own.closed && other != line && (end(line, true) - end(other, false)).norm() < near) return other;
            return Index{-1};
        };
        std::vector<char> follows(lines.size(), 0);
        for (const Index line : lines)
            for (std::size_t k = 0; k < lines.size(); ++k)
                if (next(line) == lines[k]) follows[k] = 1;
        for (std::size_t k = 0; k < lines.size(); ++k) {
            if (follows[k] != 0) continue;
            observe::FibreSnapshot joined = own;
            for (std::vector<Vec3>* values : {&joined.position, &joined.director_1, &joined.director_2}) values->clear();
            for (Index line = lines[k]; line >= 0; line = next(line)) {
                const Vec3 moved = end(line, false) - own.position.front();
                for (std::size_t a = joined.position.empty() ? 0 : 1; a < own.position.size(); ++a) {
                    joined.position.push_back(own.position[a] + moved);
                    joined.director_1.push_back(own.director_1[a]), joined.director_2.push_back(own.director_2[a]);
                }
            }
            all.push_back(std::move(joined)), seen.line.push_back(lines[k]);
        }
    }
    seen.shot.fibres = std::move(all);
    return seen;
}

/// Parts fibres that begin in each other, by least motion, under a limit of the gap.
template <Model M>
class OverlapParter {
public:
    using Parted = PartingModel<M>;
    using Contacts = typename detail::ContactsOf<Parted>::Type;
    static_assert(!HasSolid<M>, "fibres are parted before they are bonded to a solid");

    OverlapParter(const ModelParameters<M>& given, const PartingParameters& parting) : parting_{core::validated(parting)} {
        parameters_.beam = given.beam, parameters_.proximity = given.proximity, parameters_.solver = given.solver;
        parameters_.contact = given.contact, parameters_.iteration = given.iteration;
        if (!std::isnan(parting.allowed_penetration))
            parameters_.contact.stiffness.allowed_penetration = parting.allowed_penetration;
        allowed_ = parameters_.contact.stiffness.allowed_penetration;
        core::require_positive("StiffnessAdaptation.allowed_penetration", allowed_);
        parameters_.contact.normal.kept_within = kept_within;
        parameters_.normal.law.regularisation_depth = allowed_;
        parameters_.normal.limit = std::numeric_limits<double>::infinity();
    }

    /// One go from where the scene begins.
    /// @param deep  gets the fibres that are still too deep in another one
    /// @returns the reason of the loading, or nothing where it came to its end
    std::string go(const scene::Assembly& assembly, Parting& parting, std::vector<Index>& deep) {
        Simulator<Parted> simulator(assembly, parameters_);
        const auto& mesh = simulator.mesh();
        simulator.contacts().resume(sides(assembly, mesh), {});
        const bool forced = !assembly.orders().empty();
        parting.after = overlap(simulator, forced, deep);
        if (parting.before.fibre_i < 0) parting.before = parting.after;
        std::string reason;
        if (parting.after.depth > allowed_) {
            const double limit = parting_.gap_limit_over_radius * parting.after.thinnest, depth = parting.after.depth;
            double target = allowed_;
            for (int pass = 0; pass < 3 && reason.empty(); ++pass, target *= 0.6) {  // between contact points fibres are deeper
                const Report report = simulator.run(loading(mesh, limit, target, forced, pass == 0 ? depth : 0.0));
                parting.increments += core::count(report.increments), parting.counts += report.counts;
                reason = report.reason;
                parting.after = deepest(simulator, deep);
                if (parting.after.depth <= allowed_) break;
            }
        }
        parting.start = simulator.state().head(mesh.start_state().size());
        parting.parted = parting.after.depth <= allowed_;
        parting.reason = parting.parted ? std::string() : contact::text(parting.after, mesh);
        for (Index& fibre : deep) fibre = mesh.source(fibre);
        for (contact::Overlap* overlap : {&parting.before, &parting.after})
            for (Index* fibre : {&overlap->fibre_i, &overlap->fibre_j})
                if (*fibre >= 0) *fibre = mesh.source(*fibre);
        return reason;
    }

    double allowed() const noexcept { return allowed_; }

private:
    /// Of the distance at which sections touch, within which normals are kept: half is no more than a lean of a quarter turn.
    static constexpr double kept_within = 1.0;
    /// Length over which a push bends a fibre, over its radius: springs of the damping are the bedding that it is pushed against.
    /// Short against most fibres, and long enough that the push, some 8 E I (gap limit) / length^3, dents no section.
    static constexpr double bending_length = 10.0;
    /// Part of the radius of the thinner fibre that two sections may give way by: more, and they are squeezed, not parted.
    static constexpr double greatest_squeeze = 0.05;
    static constexpr double slack =
        5.0;  ///< on the penetration at which fibres have parted, before contact is as stiff as it is to be

    std::vector<typename Contacts::Memory::Record> sides(const scene::Assembly& assembly,
                                                         const beam::Mesh<typename M::Beam>& mesh) const {
        typename M::Proximity search(parameters_.proximity);
        const contact::ForcedOrders orders(assembly, mesh);
        const std::vector<contact::Zone> zones =
            contact::find_zones(mesh, mesh.start_state(), search, parameters_.contact.detection, orders, 0.0, !orders.empty());
        std::vector<contact::Zone> own;
        for (const contact::Zone& zone : zones)
            if (!zone.forced) own.push_back(zone);
        std::vector<typename Contacts::Memory::Record> records;
        for (const auto& side :
             contact::OverlapSides<typename M::Beam>(mesh, mesh.start_state()).of(own, parameters_.contact.spacing)) {
            typename Contacts::Memory::Record record;
            record.fibre_i = static_cast<std::int32_t>(side.fibre_i), record.fibre_j = static_cast<std::int32_t>(side.fibre_j);
            record.u_i = side.u_i, record.u_j = side.u_j, record.normal = side.normal;
            records.push_back(record);
        }
        return records;
    }

    Loading<Parted> loading(const beam::Mesh<typename M::Beam>& mesh, double limit, double target, bool forced,
                            double depth) const {
        double bedding = std::numeric_limits<double>::infinity();  // of the most slender fibre's node [force / length]
        for (const beam::MeshFibre& fibre : mesh.fibres()) {
            const double bending =
                fibre.material.young_modulus * std::min(fibre.section.second_moment_1(), fibre.section.second_moment_2());
            const double node = fibre.element_length / static_cast<double>(M::Beam::nodes - 1);
            bedding = std::min(bedding, 4.0 * bending * node / std::pow(bending_length * fibre.section.radius(), 4));
        }
        Stage<Parted> parting;
        parting.name = "parting";
        parting.increments = 1;
        // Fibres part by about the limit; what does not move in several times as many increments is held, or wedged.
        parting.most_increments = std::min(parting_.most_increments, static_cast<Index>(12.0 + 6.0 * depth / limit));
        parting.gap_limit = limit, parting.forced_orders = forced, parting.damping = bedding;
        parting.largest_displacement = 4.0 * limit, parting.looseness = 5.0;
        parting.until = until_separated(slack * allowed_);
        Stage<Parted> settling = parting;
        settling.name = "settling";
        settling.forced_orders = false;
        settling.damping_decay = 0.5, settling.damping_share = 1e-2, settling.damping_calm = 0.5 * limit;
        settling.until = until_settled(0.05 * limit, target, 1e-2);
        settling.enough_increments = 30, settling.most_increments = 100;
        Loading<Parted> loading;
        loading.most_rejected = 24;
        if (depth > 0.0) loading.stages.push_back(parting);
        loading.stages.push_back(settling);
        return loading;
    }

    contact::Overlap overlap(Simulator<Parted>& simulator, bool forced, std::vector<Index>& deep) const {
        deep.clear();
        return look_at_contacts(simulator, forced, [&](const Contacts& contacts) {
            return contact::deepest_overlap(contacts, simulator.mesh(), simulator.state(), false, &deep, allowed_);
        });
    }
    /// As contact elements see it, and for elements of three nodes as nobody but geometry does.
    contact::Overlap deepest(Simulator<Parted>& simulator, std::vector<Index>& deep) const {
        contact::Overlap found = overlap(simulator, false, deep);
        if constexpr (M::Beam::nodes == 3) {
            const SeenLines seen = seen_lines(simulator.mesh(), simulator.state());
            observe::LeastGap least = observe::least_gap(
                seen.shot, typename M::Proximity(parameters_.proximity),
                parameters_.contact.detection.self_contact ? observe::OwnTurns::counted : observe::OwnTurns::left_out);
            if (-least.gap > found.depth) {
                least.fibre_i = seen.line[core::at(least.fibre_i)], least.fibre_j = seen.line[core::at(least.fibre_j)];
                const double radius = std::min(simulator.mesh().fibre(least.fibre_i).section.radius(),
                                               simulator.mesh().fibre(least.fibre_j).section.radius());
                found = {least.fibre_i, least.fibre_j, 0.0, 0.0, -least.gap, radius, radius, least.position};
                if (found.depth > allowed_) deep.push_back(found.fibre_i), deep.push_back(found.fibre_j);
            }
        }
        const contact::Overlap squeezed = look_at_contacts(simulator, false, [&](const Contacts& contacts) {
            return contact::deepest_squeeze(contacts, simulator.mesh(), simulator.state(), greatest_squeeze, deep);
        });
        return squeezed.depth > found.depth ? squeezed : found;
    }

    PartingParameters parting_;
    ModelParameters<Parted> parameters_;
    double allowed_ = 0.0;
};

}  // namespace detail

/// Parts all fibres of a scene that lie in each other where it begins: side by side, one in the other, thin in thick, on one
/// line, in themselves where the model's contacts are searched for that. Forced orders of the scene are kept; where there is
/// none, fibres part by least motion (contact::OverlapSides). Images across the seams of a cell are seen as fibres; messages name
/// them so, and fields by the fibre that they are of.
///
/// Contact is shown a limited gap (Durville, section 15.3.5), without friction, and what moves is bedded in springs to its last
/// place; then the fibres come to rest under the allowed penetration. What is held stays; fibres that do not part so take their
/// holds along, if `loosen_holds`. A scene that begins at `start` has conditions that count from there:
///     const auto parting = simulation::part_overlaps<Model>(assembly, parameters);
///     if (parting.parted) assembly.begin_at(parting.start);
/// @returns a report, with the two fibres that are deepest in each other and how deep they are where not all have parted
/// @throws std::invalid_argument for a wrong scene or parameter
template <Model M>
Parting part_overlaps(const scene::Assembly& assembly, const ModelParameters<M>& parameters,
                      const PartingParameters& parting = PartingParameters()) {
    detail::OverlapParter<M> parter(parameters, parting);
    Parting result;
    std::vector<Index> deep;
    std::string reason = parter.go(assembly, result, deep);
    scene::Assembly loose = assembly;
    constexpr int rounds = 3;  // a fibre that has gone along may meet the next one that is held
    for (int round = 0; round < rounds && !result.parted && parting.loosen_holds && assembly.start().size() == 0; ++round) {
        const std::size_t before = result.loosened.size();
        for (const Index f : deep)
            if (!assembly.fibres()[core::at(f)].start) result.loosened.push_back(f);
        std::sort(result.loosened.begin(), result.loosened.end());
        result.loosened.erase(std::unique(result.loosened.begin(), result.loosened.end()), result.loosened.end());
        if (result.loosened.size() == before) break;
        loose.release(result.loosened);
        reason = parter.go(loose, result, deep);
    }
    if (!result.parted) {
        result.reason += "; allowed are " + core::text(parter.allowed());
        if (!reason.empty()) result.reason += " (" + reason + ")";
    }
    return result;
}

}  // namespace fibrant::simulation
