// SPDX-License-Identifier: MIT
#pragma once
/// @file What the forces that a cell bears at rest do as it bends: they turn with the surface.

#include <fibrant/compositions/textile/periodic.hpp>
#include <fibrant/connection/body_motion.hpp>
#include <fibrant/scene/assembly.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// Forces of a cell at rest, and what they add to its stiffness against curvatures.
///
/// A period of a bent plate turns as well as moves (James 2006, objective structures): the ends of a pair obey
/// last - first = p + k W m, m their mean, W the turn over the period p. Ties move them by what m was at rest. At equilibrium
/// that is enough for a cell without forces; the forces f of one that bears some turn with it, by -k W^T f / 2 at each end, and
/// work on k W (m - m_0). A surface that bends keeps its lengths: so does p, by k^2 |p|^3 / 12 along it. A tension N of the cell
/// needs the pressure N k of a curved surface. It acts along each fibre in proportion to its length, and is none of the moments.
/// So bending and twist do not depend on where the middle of a cell lies, on its size, or on how fibres slide along themselves.
/// To first order in the strains.
class CellPrestress {
public:
    /// @param resting  at rest, in the cell 0, which nothing strains and which has curvatures
    template <class Simulator>
    explicit CellPrestress(const Simulator& resting) {
        const auto& mesh = resting.mesh();
        const Vector& x = resting.state();
        const auto& ties = resting.equilibrium().ties();
        const auto& layout = resting.equilibrium().system().layout();
        for (Index f = 0; f < core::count(mesh.fibres()); ++f) {
            const beam::MeshFibre& fibre = mesh.fibre(f);
            for (Index n = 0; n < mesh.own_nodes(f); ++n) {
                const scene::Station at{f, static_cast<double>(n) / static_cast<double>(2 * fibre.elements)};
                // Simpson's rule along an element of three nodes.
                const bool end = !fibre.closed && (n == 0 || n == 2 * fibre.elements);
                const double share = (end ? 1.0 : n % 2 == 1 ? 4.0 : 2.0) / (6.0 * static_cast<double>(fibre.elements));
                for (int v = 0; v < 3; ++v) {
                    Place place;
                    place.at = at, place.kind = static_cast<scene::NodeVector>(v), place.share = share;
                    place.vector = mesh.node_vector(f, n, v), place.start = x.segment<3>(3 * place.vector);
                    of_vector_.resize(std::max(of_vector_.size(), core::at(place.vector) + 1), -1);
                    of_vector_[core::at(place.vector)] = core::count(places_);
                    places_.push_back(place);
                }
            }
        }
        ties.each_pair(0, [&](const scene::Tie& tie, const auto& one, const Vec3& force) {
            const Index first = tie.vectors.front(), last = tie.vectors.back();
            turns_.push_back(
                {first, last, force, one.period, 0.5 * (x.segment<3>(3 * first) + x.segment<3>(3 * last)), one.director});
        });
        const std::size_t pairs = turns_.size();
        ties.images().each(layout, 0, [&](const scene::ImageVector& one, const Vec3& period, const Vec3& force) {
            if (force.isZero(0.0)) return;
            const bool director = one.shift < 0;
            turns_.push_back(
                {one.source, -1, force, period, x.segment<3>(3 * one.source) + (director ? 0.0 : 0.5) * period, director});
            if (director) return;
            // It goes to the cell through the pairs that move the image, and is none of their own fibres'.
            for (const scene::ImageShift::Pair& pair : layout.shifts[core::at(one.shift)].pairs)
                for (std::size_t k = 0; k < pairs; ++k)
                    if (turns_[k].first == pair.first) turns_[k].force -= pair.times * force;
        });
        std::vector<std::array<double, 3>> pressure(mesh.fibres().size(), {0.0, 0.0, 0.0});
        for (const Turn& turn : turns_)
            for (int k = 0; k < 3; ++k) {
                const Vec3 load = -turn_of(turn.period, k).transpose() * turn.force;
                const Index ends = turn.last < 0 ? 1 : 2;
                for (const Index vector : {turn.first, turn.last})
                    if (vector >= 0) place_of(vector).load.col(k) += load / static_cast<double>(ends);
                if (!turn.director) pressure[core::at(place_of(turn.first).at.fibre)][core::at(k)] -= load.z();
            }
        for (Place& place : places_)
            for (int k = 0; k < 3 && place.kind == scene::NodeVector::position; ++k)
                place.pressure[k] = place.share * pressure[core::at(place.at.fibre)][core::at(k)];
    }

    /// Gives the cell 0 the forces that its curvatures turn.
    void apply(scene::Assembly& assembly) const {
        for (const Place& place : places_)
            for (int k = 0; k < 3; ++k)
                if (const Vec3 force = place.load.col(k) + place.pressure[k] * Vec3::UnitZ(); !force.isZero(0.0))
                    assembly.apply(scene::DeadForce{place.at, place.kind, force, cell_channels()[core::at(3 + k)]});
    }

    /// Keeps fibres that repeat where they are along themselves, as a shear moves them: without friction nothing else does. Next
    /// to their middles, since no node is held twice.
    void keep_along(scene::Assembly& assembly) {
        for (const Turn& turn : turns_) {
            if (turn.last < 0 || turn.director) continue;
            const Index f = place_of(turn.first).at.fibre;
            const Index elements = assembly.fibres()[core::at(f)].elements;
            scene::Hold hold;
            hold.at = {f, (static_cast<double>(elements) + 1.0) / static_cast<double>(2 * elements)};
            const Vec3 along = turn.period.normalized();
            const auto middle = std::find_if(places_.begin(), places_.end(), [&](const Place& place) {
                return place.at.fibre == f && place.kind == scene::NodeVector::position &&
                       place.at.fraction >= hold.at.fraction - 1e-9;
            });
            hold.directions = along * along.transpose();
            hold.displacement = hold.directions * Vec3(0.5 * middle->start.y(), 0.5 * middle->start.x(), 0.0);
            hold.channel = cell_channels()[2];
            assembly.hold(hold), kept_.emplace_back(hold.at, hold.displacement);
        }
    }

    /// What it adds to cell_efforts, times the area of the cell [force * length, force * length^2].
    template <class Simulator>
    CellVector work(const Simulator& simulator) const {
        const auto& motion = simulator.equilibrium().ties().motion();
        const Vec3 bent = motion.curvature(0);
        const Mat3 gradient = motion.gradient(0);
        const Vector& x = simulator.state();
        CellVector sum = CellVector::Zero();
        for (const auto& [at, moved] : kept_) sum[2] += simulator.reaction(at).dot(moved);
        for (const Turn& turn : turns_) {
            const Vec3 first = x.segment<3>(3 * turn.first);
            const Vec3 moved = turn.last < 0 ? Vec3(first - place_of(turn.first).start)
                                             : Vec3(0.5 * (first + x.segment<3>(3 * turn.last)) - turn.middle);
            const Vec3 &p = turn.period, strained = gradient * p;
            const std::array<Vec3, 3> strains{Vec3(p.x(), 0, 0), Vec3(0, p.y(), 0), Vec3(0.5 * p.y(), 0.5 * p.x(), 0)};
            Mat3 all = Mat3::Zero();
            for (int k = 0; k < 3; ++k) all += bent[k] * turn_of(p, k);
            for (int k = 0; k < 3; ++k) {
                const Mat3 own = turn_of(p, k);
                sum[3 + k] += turn.force.dot(own * moved + turn_of(strained, k) * turn.middle);
                // The mean of a place and its image moves by half of what the image does.
                if (turn.last < 0) sum[3 + k] += 0.5 * turn.force.dot((own * all + all * own) * turn.middle);
                for (int g = 0; g < 3; ++g) sum[g] += bent[k] * turn.force.dot(turn_of(strains[core::at(g)], k) * turn.middle);
            }
            if (turn.director) continue;
            const double length = p.norm();
            const Vec3 t = p / length, share(t.x() * t.x(), t.y() * t.y(), 2.0 * t.x() * t.y());
            const double aside = t.x() * turn.middle.y() - t.y() * turn.middle.x(), along = turn.force.dot(t);
            // What a surface with a Gaussian curvature keeps of lengths beside its middle is kept as well.
            sum.tail<3>() += along * length *
                             (length * length / 6.0 * share.dot(bent) * share +
                              0.5 * aside * aside * Vec3(bent.y(), bent.x(), -2.0 * bent.z()));
        }
        for (const Place& place : places_) {
            if (place.pressure.isZero(0.0)) continue;
            const Vec3& s = place.start;
            const Vec3 height(0.5 * s.x() * s.x(), 0.5 * s.y() * s.y(), s.x() * s.y());
            const double out = x[3 * place.vector + 2] - s.z() - height.dot(bent);  // of the surface
            sum.tail<3>() += place.pressure.dot(bent) * height - out * place.pressure;
        }
        return sum;
    }

private:
    struct Place {  // a vector of a node
        scene::Station at;
        scene::NodeVector kind = scene::NodeVector::position;
        Index vector = -1;
        Vec3 start = Vec3::Zero();
        Mat3 load = Mat3::Zero();      // for each curvature of 1, a column each
        Vec3 pressure = Vec3::Zero();  // along z
        double share = 0.0;            // of the length of its fibre
    };
    struct Turn {  // a pair of vectors, or a vector and its image: then there is no last
        Index first, last;
        Vec3 force, period, middle;
        bool director;
    };
    static Mat3 turn_of(const Vec3& period, int curvature) noexcept {
        Mat3 turn;
        for (int i = 0; i < 3; ++i) turn.col(i) = connection::bend_jump(Vec3::Unit(i), period, true).col(curvature);
        return turn;
    }
    Place& place_of(Index vector) { return places_[core::at(of_vector_[core::at(vector)])]; }
    const Place& place_of(Index vector) const { return places_[core::at(of_vector_[core::at(vector)])]; }

    std::vector<Place> places_;
    std::vector<Index> of_vector_;
    std::vector<Turn> turns_;
    std::vector<std::pair<scene::Station, Vec3>> kept_;
};

/// Efforts of a cell in the present state of a run that started from rest with its prestress.
/// @param area  of the cell [length^2], > 0
template <class Simulator>
CellVector cell_efforts(const Simulator& simulator, double area, const CellPrestress& prestress) {
    return cell_efforts(simulator, area) + prestress.work(simulator) / area;
}

}  // namespace fibrant::compositions::textile
