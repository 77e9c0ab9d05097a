// SPDX-License-Identifier: MIT
#pragma once
/// @file Solids whose nodes follow those of the fibres in the numbering, and the bonds between the two.

#include <fibrant/connection/carriers.hpp>
#include <fibrant/connection/channels.hpp>
#include <fibrant/connection/turned_work.hpp>
#include <fibrant/core/symmetric_eigen.hpp>
#include <fibrant/solid/hexahedron.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::connection {

/// All solids of a scene, bonded to its fibres.
///
/// Its nodal vectors come after those of the fibres, which know nothing of them. Sums have a fixed order, so bits do not
/// depend on the number of threads.
/// @tparam Element    of the solids
/// @tparam Debonding  when bonds break
template <class Element, DebondingLaw Debonding>
class BondedSolid {
public:
    struct Parameters {
        typename Element::Parameters element{};
        double bonding_factor = 1.0;  ///< on the stiffness of bonds [1], > 0
        double section_factor = 0.0;  ///< on that of bonds of sections, which stiffen the solid across fibres [1], >= 0; 0: none
        [[no_unique_address]] typename Debonding::Parameters debonding{};
        void validate() const {
            core::require_positive("BondedSolid.bonding_factor", bonding_factor);
            core::require_not_negative("BondedSolid.section_factor", section_factor);
        }
    };
    explicit BondedSolid(const Parameters& parameters)
        : parameters_{core::validated(parameters)}, element_{parameters.element}, debonding_{parameters.debonding} {}

    /// Takes the solids of a scene, and bonds fibres to them where they are at the start.
    /// @throws std::invalid_argument if a cell is not valid
    template <beam::BeamElement B>
    void take(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const Channels& channels) {
        first_vector_ = mesh.layout().vectors();
        for (const scene::Solid& solid : assembly.solids()) {
            solid::require_valid_cells(solid);
            for (std::size_t c = 0; c < solid.cells.size(); ++c) {
                cells_.push_back({{}, solid.material, Element::rest(solid::cell_nodes(solid, static_cast<Index>(c)))});
                for (std::size_t k = 0; k < 8; ++k) cells_.back().nodes[k] = core::count(start_) + solid.cells[c][k];
            }
            first_node_.push_back(core::count(start_));
            start_.insert(start_.end(), solid.nodes.begin(), solid.nodes.end());
        }
        first_node_.push_back(core::count(start_));
        for (const scene::SolidHold& hold : assembly.solid_holds()) {
            holds_.push_back({hold, channels.find(hold.channel)});
            for (const Index node : hold.nodes)
                held_.push_back({first_node_[core::at(hold.solid)] + node, core::count(holds_) - 1});
        }
        std::stable_sort(held_.begin(), held_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        std::vector<bool> used(start_.size(), false);
        for (const Cell& cell : cells_)
            for (const Index node : cell.nodes) used[core::at(node)] = true;
        for (std::size_t k = 0; k < used.size(); ++k)
            if (!used[k]) core::refuse("Solid.nodes", std::to_string(k), "a node of a cell: nothing would hold it");
        bonds_ = find_bonds(mesh, assembly.solids(), mesh.start_state(), parameters_.bonding_factor, parameters_.section_factor);
        carriers_ = find_carriers(mesh, assembly.solids(), bonds_, mesh.start_state());
        broken_.assign(core::Active<Debonding> ? bonds_.size() : 0, false);
        find_pattern();
    }

    Index nodes() const noexcept { return core::count(start_); }
    Index first_vector() const noexcept { return first_vector_; }
    const Vec3& start(Index node) const noexcept { return start_[core::at(node)]; }
    Index cells() const noexcept { return core::count(cells_); }
    const std::vector<Bond>& bonds() const noexcept { return bonds_; }
    /// Of each nodal vector of the fibres: how it goes along with the solids.
    const std::vector<Carrier>& carriers() const noexcept { return carriers_; }
    bool holds(std::size_t bond) const noexcept { return broken_.empty() || !broken_[bond]; }
    const std::array<Index, 8>& cell(Index c) const noexcept { return cells_[core::at(c)].nodes; }
    /// Nodes of solid s: [first, last).
    std::pair<Index, Index> nodes_of(Index s) const noexcept { return {first_node_[core::at(s)], first_node_[core::at(s + 1)]}; }

    /// The state of the fibres, with the solids at rest after it.
    Vector with_rest(const Vector& fibres) const {
        Vector state(fibres.size() + 3 * nodes());
        state.head(fibres.size()) = fibres;
        for (Index n = 0; n < nodes(); ++n) state.segment<3>(fibres.size() + 3 * n) = start_[core::at(n)];
        return state;
    }
    void add_to(scene::DofLayout& layout) const {
        if (nodes() == 0) return;
        layout.chains.push_back({first_vector_, nodes(), 1, 0, -1});
        layout.kind.insert(layout.kind.end(), start_.size(), scene::VectorKind::position);
        layout.value.insert(layout.value.end(), start_.begin(), start_.end());
        layout.length.insert(layout.length.end(), start_.size(), 1.0);
    }
    /// Force of rounding at a node: stresses keep the digits of coordinates over a cell's size [force].
    double rounding_scale(double extent) const noexcept {
        double sum = 0.0;
        for (const Cell& cell : cells_) {
            const double force = cell.material.young_modulus * std::cbrt(cell.rest.size()) * extent;
            sum += 8.0 * force * force;
        }
        return std::sqrt(sum);
    }

    /// Appends what is held at the given amplitudes.
    void hold(std::span<const double> amplitudes, std::vector<scene::HeldVector>& held, std::vector<Vec3>& targets) const {
        for (const auto& [node, h] : held_) {
            const auto& [hold, channel] = holds_[core::at(h)];
            const double amplitude = amplitudes[core::at(channel)];
            const Mat3 turn = hold.rotation ? hold.rotation(amplitude) : Mat3(Mat3::Identity());
            Mat3 directions = turn * hold.directions * turn.transpose();
            const Vec3 goal = hold.goal(start_[core::at(node)], amplitude);
            if (!held.empty() && held.back().vector == first_vector_ + node) {  // what an earlier hold has left free
                const Mat3 before = held.back().free;
                directions = before * directions * before;
                // Of axes that are neither the same nor across, the earlier one decides.
                const core::SymmetricEigen<3> axes(directions);
                directions.setZero();
                for (int k = 0; k < 3; ++k)
                    if (axes.values()[k] > 0.5) directions += axes.vectors().col(k) * axes.vectors().col(k).transpose();
                held.back().free = before - directions;
                targets.back() += directions * goal;
            } else {
                held.push_back({first_vector_ + node, Mat3::Identity() - directions});
                targets.push_back(directions * goal);
            }
        }
    }

    /// As of `PrescribedMotion`.
    double beyond_chords(const Way& way) const {
        std::array<std::vector<scene::HeldVector>, 2> held;
        std::vector<Vec3> targets;
        double sum = 0.0;
        for (std::size_t first = 0, entry = 0; first < held_.size(); ++entry) {
            const Index node = held_[first].first;
            const scene::SolidHold* turned = nullptr;
            Index channel = -1;
            for (; first < held_.size() && held_[first].first == node; ++first) {
                const auto& [hold, driven] = holds_[core::at(held_[first].second)];
                const bool goes = way.amplitudes[0][core::at(driven)] != way.amplitudes[1][core::at(driven)];
                if (!turned && hold.rotation && goes) turned = &hold, channel = driven;
            }
            if (!turned) continue;
            std::array<Turned, 2> ends;
            for (const std::size_t k : {0u, 1u}) {
                if (held[k].empty()) hold(way.amplitudes[k], held[k], targets);
                const double amplitude = way.amplitudes[k][core::at(channel)];
                ends[k] = {turned->rotation(amplitude), turned->goal(turned->pivot, amplitude),
                           way.place(k, first_vector_ + node), way.force(k, first_vector_ + node, held[k][entry].free)};
            }
            sum += beyond_chord(ends);
        }
        return sum;
    }

    /// Adds internal forces of cells and bonds.
    void add_forces(const Vector& state, Vector& forces) {
        if (cells_.empty()) return;
        force_.resize(cells_.size());
        core::parallel_for(cells(), [&](Index c) {
            const Cell& cell = cells_[core::at(c)];
            force_[core::at(c)] = element_.force(cell.rest, cell.material, places(state, c));
        });
        for (Index c = 0; c < cells(); ++c)
            for (int k = 0; k < 8; ++k)
                at(forces, cells_[core::at(c)].nodes[core::at(k)]) += force_[core::at(c)].template segment<3>(3 * k);
        for (std::size_t b = 0; b < bonds_.size(); ++b) {
            if (!holds(b)) continue;
            const Vec3 force = bond_force(state, b);
            forces.segment<3>(3 * bonds_[b].vector) += force;
            for (int k = 0; k < 8; ++k) at(forces, bonds_[b].nodes[core::at(k)]) -= bonds_[b].weights[k] * force;
        }
    }
    /// k_b (x_f - sum w_J X_J): what the solid takes, and the fibre's internal force [force; of a section's bond force * length].
    Vec3 bond_force(const Vector& state, std::size_t b) const {
        const Bond& bond = bonds_[b];
        Vec3 gap = state.segment<3>(3 * bond.vector);
        for (int k = 0; k < 8; ++k) gap -= bond.weights[k] * state.segment<3>(3 * (first_vector_ + bond.nodes[core::at(k)]));
        return bond.stiffness * gap;
    }
    double energy(const Vector& state) const {
        std::vector<double> part(cells_.size());
        core::parallel_for(cells(), [&](Index c) {
            part[core::at(c)] = element_.energy(cells_[core::at(c)].rest, cells_[core::at(c)].material, places(state, c));
        });
        double sum = 0.0;
        for (const double value : part) sum += value;
        for (std::size_t b = 0; b < bonds_.size(); ++b)
            if (holds(b)) sum += 0.5 * bond_force(state, b).squaredNorm() / bonds_[b].stiffness;
        return sum;
    }

    /// Tangent of the solids alone, what the bonds add to it included.
    /// @param shift  on every node [force / length]
    void linearise(const Vector& state, bool tension_only, double shift) {
        tangent_.resize(cells_.size());
        core::parallel_for(cells(), [&](Index c) {
            const Cell& cell = cells_[core::at(c)];
            solid::CellVector force;
            element_.force_and_tangent(cell.rest, cell.material, places(state, c), force, tangent_[core::at(c)], tension_only);
        });
        block_ = constant_;
        for (Index c = 0; c < cells(); ++c)
            for (int a = 0; a < 8; ++a)
                for (int b = 0; b < 8; ++b)
                    block_[core::at(cells_[core::at(c)].entry[core::at(8 * a + b)])] +=
                        tangent_[core::at(c)].template block<3, 3>(3 * a, 3 * b);
        if (shift > 0.0)
            for (Index n = 0; n < nodes(); ++n) block_[core::at(diagonal_[core::at(n)])].diagonal().array() += shift;
    }
    /// see(vector, stiffness) of what the bonds add to the diagonal of the fibres.
    template <class See>
    void add_to_fibres(const See& see) const {
        for (std::size_t b = 0; b < bonds_.size(); ++b)
            if (holds(b)) see(bonds_[b].vector, Mat3(bonds_[b].stiffness * Mat3::Identity()));
    }
    /// y = the solids' rows of K x, and y += what bonds add to those of the fibres beyond their diagonal.
    void apply(const Vector& x, Vector& y) const {
        const Index size = 3 * first_vector_;
        core::parallel_for(
            nodes(),
            [&](Index n) {
                Vec3 sum = Vec3::Zero();
                for (Index k = start_of_[core::at(n)]; k < start_of_[core::at(n + 1)]; ++k)
                    sum.noalias() += block_[core::at(k)] * x.segment<3>(size + 3 * neighbour_[core::at(k)]);
                for (Index k = bonds_start_[core::at(n)]; k < bonds_start_[core::at(n + 1)]; ++k) {
                    const auto& [b, weight] = bonds_of_[core::at(k)];
                    if (holds(core::at(b)))
                        sum -= weight * bonds_[core::at(b)].stiffness * x.segment<3>(3 * bonds_[core::at(b)].vector);
                }
                y.segment<3>(size + 3 * n) = sum;
            },
            nodes() < 2000 ? nodes() : 1);
        for (std::size_t b = 0; b < bonds_.size(); ++b) {
            if (!holds(b)) continue;
            const Bond& bond = bonds_[b];
            Vec3 sum = Vec3::Zero();
            for (int k = 0; k < 8; ++k) sum += bond.weights[k] * x.segment<3>(size + 3 * bond.nodes[core::at(k)]);
            y.segment<3>(3 * bond.vector) -= bond.stiffness * sum;
        }
    }
    /// see(i, j, block) of the solids' nodes, j <= i, in order.
    template <class See>
    void visit_blocks(const See& see) const {
        for (Index n = 0; n < nodes(); ++n)
            for (Index k = start_of_[core::at(n)]; k < start_of_[core::at(n + 1)] && neighbour_[core::at(k)] <= n; ++k)
                see(n, neighbour_[core::at(k)], block_[core::at(k)]);
    }
    const Mat3& diagonal(Index node) const noexcept { return block_[core::at(diagonal_[core::at(node)])]; }

    /// Breaks what is over its strength in an accepted state. @returns how many
    Index accept([[maybe_unused]] const Vector& state) {
        Index count = 0;
        if constexpr (core::Active<Debonding>) {
            for (std::size_t b = 0; b < bonds_.size(); ++b)
                if (bonds_[b].section ? !broken_[b] && broken_[b - 1]
                                      : !broken_[b] && debonding_.breaks(bonds_[b], bond_force(state, b).norm()))
                    broken_[b] = true, ++count;  // with the bond of the centre go those of the section, which follow it
            if (count > 0) set_constant();
        }
        return count;
    }
    const std::vector<bool>& broken() const noexcept { return broken_; }
    void set_broken(std::vector<bool> broken) { broken_ = std::move(broken), set_constant(); }

    /// Strains and stresses of a cell, means over its points.
    typename Element::State mean_state(const Vector& state, Index c) const {
        const Cell& cell = cells_[core::at(c)];
        const auto points = element_.states(cell.rest, cell.material, places(state, c));
        typename Element::State mean{Mat3::Zero(), Mat3::Zero()};
        const double whole = cell.rest.size();
        for (std::size_t p = 0; p < 8; ++p)
            mean.strain += cell.rest.volume[p] / whole * points[p].strain,
                mean.stress += cell.rest.volume[p] / whole * points[p].stress;
        return mean;
    }

private:
    struct Cell {
        std::array<Index, 8> nodes{};  // numbered through all solids
        scene::ElasticMaterial material;
        typename Element::Rest rest;
        std::array<Index, 64> entry{};  // where its blocks are
    };
    auto at(Vector& forces, Index node) const { return forces.segment<3>(3 * (first_vector_ + node)); }
    solid::CellNodes places(const Vector& state, Index c) const {
        solid::CellNodes nodes;
        for (int k = 0; k < 8; ++k)
            nodes.row(k) = state.segment<3>(3 * (first_vector_ + cells_[core::at(c)].nodes[core::at(k)])).transpose();
        return nodes;
    }
    void find_pattern() {
        std::vector<std::vector<Index>> rows(start_.size());
        for (const Cell& cell : cells_)
            for (const Index a : cell.nodes)
                rows[core::at(a)].insert(rows[core::at(a)].end(), cell.nodes.begin(), cell.nodes.end());
        start_of_.assign(1, 0);
        for (std::vector<Index>& row : rows) {
            std::sort(row.begin(), row.end());
            row.erase(std::unique(row.begin(), row.end()), row.end());
            neighbour_.insert(neighbour_.end(), row.begin(), row.end());
            start_of_.push_back(core::count(neighbour_));
        }
        for (Index n = 0; n < nodes(); ++n) diagonal_.push_back(entry(n, n));
        for (Cell& cell : cells_)
            for (std::size_t a = 0; a < 8; ++a)
                for (std::size_t b = 0; b < 8; ++b) cell.entry[8 * a + b] = entry(cell.nodes[a], cell.nodes[b]);
        bonds_start_.assign(start_.size() + 1, 0);
        for (const Bond& bond : bonds_)
            for (const Index node : bond.nodes) ++bonds_start_[core::at(node + 1)];
        for (std::size_t n = 1; n < bonds_start_.size(); ++n) bonds_start_[n] += bonds_start_[n - 1];
        bonds_of_.resize(core::at(bonds_start_.back()));
        std::vector<Index> next(bonds_start_.begin(), bonds_start_.end() - 1);
        for (Index b = 0; b < core::count(bonds_); ++b)
            for (int k = 0; k < 8; ++k)
                bonds_of_[core::at(next[core::at(bonds_[core::at(b)].nodes[core::at(k)])]++)] = {b,
                                                                                                 bonds_[core::at(b)].weights[k]};
        set_constant();
        block_ = constant_;
    }
    /// What bonds add to the solids' own tangent: constant, and summed once.
    void set_constant() {
        constant_.assign(neighbour_.size(), Mat3::Zero());
        for (std::size_t b = 0; b < bonds_.size(); ++b) {
            if (!holds(b)) continue;
            const Cell& cell = cells_[core::at(bonds_[b].cell + first_cell(bonds_[b].solid))];
            for (int k = 0; k < 8; ++k)
                for (int l = 0; l < 8; ++l)
                    constant_[core::at(cell.entry[core::at(8 * k + l)])].diagonal().array() +=
                        bonds_[b].stiffness * bonds_[b].weights[k] * bonds_[b].weights[l];
        }
    }
    Index first_cell(Index s) const noexcept {
        Index first = 0;  // cells are in the order of solids, as their nodes
        const auto it = std::partition_point(cells_.begin(), cells_.end(),
                                             [&](const Cell& cell) { return cell.nodes[0] < first_node_[core::at(s)]; });
        first = it - cells_.begin();
        return first;
    }
    Index entry(Index row, Index column) const {
        const auto begin = neighbour_.begin() + start_of_[core::at(row)], end = neighbour_.begin() + start_of_[core::at(row + 1)];
        return std::lower_bound(begin, end, column) - neighbour_.begin();
    }

    Parameters parameters_;
    Element element_;
    [[no_unique_address]] Debonding debonding_;
    Index first_vector_ = 0;
    std::vector<Vec3> start_;
    std::vector<Index> first_node_;
    std::vector<Cell> cells_;
    std::vector<Bond> bonds_;
    std::vector<Carrier> carriers_;
    std::vector<bool> broken_;
    std::vector<std::pair<scene::SolidHold, Index>> holds_;  // with their channels
    std::vector<std::pair<Index, Index>> held_;              // node, hold
    std::vector<Index> start_of_, neighbour_, diagonal_, bonds_start_;
    std::vector<std::pair<Index, double>> bonds_of_;
    std::vector<Mat3> block_, constant_;
    std::vector<solid::CellVector> force_;
    std::vector<solid::CellMatrix> tangent_;
};

}  // namespace fibrant::connection
