// SPDX-License-Identifier: MIT
#pragma once
/// @file Conjugate gradients for fibres bonded to solids: two levels for the fibres, a factor for the solids that carry them.

#include <fibrant/assembly/system_view.hpp>
#include <fibrant/solid/hexahedron_map.hpp>
#include <fibrant/solver/block_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cassert>
#include <concepts>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// A system of fibres and of solids that they are bonded to.
template <class T>
concept SystemWithSolid = assembly::LinearSystem<T> && requires(const T system) {
    { system.fibres() } -> assembly::LinearSystem;
    system.solid().carriers();
};

/// What a preconditioner of the fibres offers.
template <class T>
concept FibrePreconditioner = std::constructible_from<T, typename T::Parameters> &&
    requires(T own, const assembly::SystemView system, const Vector r, Vector z) {
    own.analyse(system);
    { own.prepare(system) } -> std::same_as<SolveStatus>;
    own.precondition(system, r, z);
};

/// M^-1 = M_f^-1 + A_s^-1 + C (C^T A C)^-1 C^T: M_f a preconditioner of the fibres, the two levels of TwoLevelPcg if not told,
/// A_s the solids' own block, factored, C the motions in which the solids move and take the fibres along.
///
/// In M_f and A_s fibres and solids are held by their bonds to the other at rest: right for motions that differ from fibre to
/// solid, and far too stiff for those in which both move together, the more so the stiffer the bonds. Those C has; alone
/// beside M_f it would be too stiff where fibres that hardly stretch stay behind. C^T A C is summed and factored once an
/// analysis: it changes little from one iteration of Newton's method to the next.
/// Both factors are of floats: they are read from memory twice an iteration, and a preconditioner need not be finer.
///
/// Where nodes are tied, the parts have the supports of the ties in their place, and what a tie leaves free, the motions of free
/// bodies, would be held by them: C^T A C is let go along these motions.
///
/// @tparam Fibres  preconditions the fibres; symmetric and positive definite
template <FibrePreconditioner Fibres>
class SolidPcgWith {
public:
    static constexpr bool reads_whole_bands = ReadsWholeBands<Fibres>;
    struct Parameters {
        typename Fibres::Parameters fibres{};
        int iteration_limit = 2000;  ///< > 0
        bool carried = true;         ///< false: without C
        void validate() const {
            fibres.validate();
            core::require_at_least("SolidPcg.iteration_limit", iteration_limit, 1);
        }
    };
    SolidPcgWith() : SolidPcgWith(Parameters{}) {}
    explicit SolidPcgWith(const Parameters& parameters) : parameters_{core::validated(parameters)}, fibres_{parameters.fibres} {}

    template <SystemWithSolid System>
    void analyse(const System& system) {
        fibres_.analyse(assembly::seen(system.fibres()));
        find_pattern(system);
        work_->summed = false;
    }
    template <SystemWithSolid System>
    SolveStatus prepare(const System& system) {
        Work& work = *work_;
        work.status = fibres_.prepare(assembly::seen(system.fibres()));
        if (work.status == SolveStatus::not_finite) return work.status;
        if (!sum_alone(system)) {
            analyse_alone(system);
            [[maybe_unused]] const bool whole = sum_alone(system);
            assert(whole);
        }
        judge(work.alone.factor());
        if (parameters_.carried && !work.summed) {
            if (!sum(system)) {  // contacts that the analysis did not have
                find_pattern(system);
                [[maybe_unused]] const bool complete = sum(system);
                assert(complete);
            }
            const auto pivots = work.together.factor();
            work.summed = pivots.finite && pivots.negative == 0;
            judge(pivots);
            if (pivots.finite) let_go(system);
        }
        return work.status;
    }
    template <SystemWithSolid System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x) {
        Work& work = *work_;
        if (work.status == SolveStatus::not_finite) {
            x.setZero(b.size());
            return {};
        }
        const Index first = system.solid().first_vector(), nodes = system.solid().nodes();
        const auto precondition = [&](const Vector& r, Vector& z) {
            z.resize(r.size());
            work.residual = r.head(3 * first), work.correction.setZero(3 * first);
            fibres_.precondition(assembly::seen(system.fibres()), work.residual, work.correction);
            work.motion = r.tail(3 * nodes);
            z.head(3 * first) = work.correction;
            if (parameters_.carried) {
                gather(system, r, work.together_motion);
                work.together.solve(work.together_motion);
                if (work.freed.cols() > 0)
                    work.together_motion +=
                        work.freed * work.freed_factor.solve(work.freed_supports.transpose() * work.together_motion);
                core::parallel_for(
                    first,
                    [&](Index v) {
                        const auto* carrier = carrier_of(system, v);
                        if (carrier == nullptr) return;
                        const auto& cell = system.solid().cell(carrier->cell);
                        for (int k = 0; k < 8; ++k)
                            z.segment<3>(3 * v) +=
                                carrier->weights[k] * work.together_motion.template segment<3>(3 * cell[core::at(k)]);
                    },
                    first < 8192 ? first : 1);
            }
            work.alone.solve(work.motion);
            z.tail(3 * nodes) = work.motion;
            if (parameters_.carried) z.tail(3 * nodes) += work.together_motion;
        };
        if constexpr (UnsymmetricSystem<System> && requires { parameters_.fibres.unsymmetric; })
            if (parameters_.fibres.unsymmetric && system.unsymmetric())
                return stabilised_biconjugate_gradient(system, precondition, b, tolerance, parameters_.iteration_limit,
                                                       work.biconjugate, x);
        return conjugate_gradient(system, precondition, b, tolerance, parameters_.iteration_limit, work.vectors, x);
    }

    /// Entries of the factors.
    Index fill() const { return work_->alone.fill() + (parameters_.carried ? work_->together.fill() : 0); }

private:
    struct Work {
        BlockCholesky<float> alone{SmallPivot::magnitude}, together{SmallPivot::magnitude};  // A_s and C^T A C
        std::vector<std::uint8_t> held;  // vectors of fibres that are held, and not carried
        Vector residual, correction, motion, together_motion;
        bool summed = false;               // C^T A C since the last analysis
        Matrix freed, freed_supports;      // G = K^-1 W and W, of the motions that supports must not hold
        Eigen::LDLT<Matrix> freed_factor;  // of U^T D U - W^T G
        ConjugateGradientVectors vectors;
        BiconjugateVectors biconjugate;
        SolveStatus status = SolveStatus::not_finite;
    };

    void judge(const BlockCholesky<float>::Pivots& pivots) {
        if (!pivots.finite)
            work_->status = SolveStatus::not_finite;
        else if (pivots.negative > 0 && work_->status == SolveStatus::converged)
            work_->status = SolveStatus::indefinite;
    }
    template <class System>
    auto carrier_of(const System& system, Index v) const -> decltype(system.solid().carriers().data()) {
        const auto& carrier = system.solid().carriers()[core::at(v)];
        return carrier.cell < 0 || work_->held[core::at(v)] != 0 ? nullptr : &carrier;
    }
    template <class System>
    void mark_held(const System& system) {
        work_->held.assign(core::at(system.solid().first_vector()), 0);
        for (const scene::HeldVector& held : system.fibres().layout().held) work_->held[core::at(held.vector)] = 1;
    }

    /// C^T r
    template <class System>
    void gather(const System& system, const Vector& r, Vector& motion) const {
        const Index first = system.solid().first_vector();
        motion = r.tail(3 * system.solid().nodes());
        for (Index v = 0; v < first; ++v) {
            const auto* carrier = carrier_of(system, v);
            if (carrier == nullptr) continue;
            const auto& cell = system.solid().cell(carrier->cell);
            for (int k = 0; k < 8; ++k) motion.segment<3>(3 * cell[core::at(k)]) += carrier->weights[k] * r.segment<3>(3 * v);
        }
        for (const scene::HeldVector& held : system.layout().held) {
            const Index n = held.vector - first;
            if (n >= 0) motion.segment<3>(3 * n) = (held.free * motion.segment<3>(3 * n)).eval();
        }
    }

    /// K - W (U^T D U)^-1 W^T in the place of K = C^T A C: D the supports of tied scalars, U how these may move together,
    /// W = C^T B^T D U. Its inverse is K^-1 + G (U^T D U - W^T G)^-1 G^T, and G^T r = W^T K^-1 r.
    template <class System>
    void let_go(const System& system) {
        Work& work = *work_;
        const scene::DofLayout& layout = system.layout();
        Index modes = 0;
        for (const scene::TiedMotion& motion : layout.motions) modes += motion.modes.cols();
        work.freed.resize(0, 0);
        if (modes == 0) return;
        Vector supports(scene::tied_scalars(layout));
        for (const scene::Tie& tie : layout.ties) {
            const double length = layout.length[core::at(tie.vectors.front())];
            supports.segment(tie.first, tie.count).setConstant(tie.support * length * length);
        }
        const Index size = 3 * system.solid().nodes();
        work.freed.resize(size, modes), work.freed_supports.resize(size, modes);
        Matrix inner = Matrix::Zero(modes, modes);
        Index first = 0;
        Vector full, column;
        for (const scene::TiedMotion& motion : layout.motions) {
            const Index own = motion.modes.cols();
            Matrix weighted = motion.modes;
            for (Index k = 0; k < weighted.rows(); ++k) weighted.row(k) *= supports[motion.scalars[core::at(k)]];
            inner.block(first, first, own, own) = motion.modes.transpose() * weighted;
            for (Index m = 0; m < own; ++m) {
                Vector scalars = Vector::Zero(supports.size());
                for (Index k = 0; k < weighted.rows(); ++k) scalars[motion.scalars[core::at(k)]] = weighted(k, m);
                full.setZero(layout.unknowns());
                scene::add_tied(layout, scalars, full);
                gather(system, full, column);
                work.freed_supports.col(first + m) = column;
                work.together.solve(column);
                work.freed.col(first + m) = column;
            }
            first += own;
        }
        inner -= work.freed_supports.transpose() * work.freed;
        work.freed_factor.compute(inner);
        if (work.freed_factor.info() != Eigen::Success || !work.freed_factor.isPositive() ||
            !(work.freed_factor.vectorD().minCoeff() > 0.0))
            work.freed.resize(0, 0);
    }

    /// The cells that carry the vectors of a term, each once.
    template <class System>
    void find_cells(const System& system, std::span<const Index> vectors, std::vector<Index>& cells) const {
        cells.clear();
        for (const Index v : vectors)
            if (const auto* carrier = carrier_of(system, v))
                if (std::find(cells.begin(), cells.end(), carrier->cell) == cells.end()) cells.push_back(carrier->cell);
    }

    template <class System>
    static std::vector<Supernodes::Pair> solid_pairs(const System& system) {
        std::vector<Supernodes::Pair> pairs;
        system.solid().visit_blocks([&](Index i, Index j, const Mat3&) {
            if (i != j) pairs.emplace_back(static_cast<int>(i), static_cast<int>(j));
        });
        return pairs;
    }
    /// Where nodes were at the start: the order of a factor, and with it its last bits, are those of any run of the scene.
    template <class System>
    static std::vector<Vec3> solid_places(const System& system) {
        std::vector<Vec3> places;
        for (Index n = 0; n < system.solid().nodes(); ++n) places.push_back(system.solid().start(n));
        return places;
    }
    template <class System>
    void analyse_alone(const System& system) {
        work_->alone.analyse(std::vector<int>(core::at(system.solid().nodes()), 3), solid_pairs(system), solid_places(system));
    }
    template <class System>
    void find_pattern(const System& system) {
        mark_held(system);
        if (work_->alone.unknowns() != 3 * system.solid().nodes()) analyse_alone(system);
        if (!parameters_.carried) return;
        struct Pairs {
            const SolidPcgWith& self;
            const System& system;
            std::vector<std::pair<Index, Index>> cells;
            std::vector<Index> own;
            void add(std::span<const Index> vectors) {
                self.find_cells(system, vectors, own);
                for (const Index a : own)
                    for (const Index b : own)
                        if (a > b) cells.emplace_back(a, b);
            }
            void point(const assembly::PointTerm& term) { add(term.vectors); }
            void dense(const assembly::DenseTerm& term) { add(term.vectors); }
        } list{*this, system, {}, {}};
        system.fibres().visit(list);
        std::sort(list.cells.begin(), list.cells.end());
        list.cells.erase(std::unique(list.cells.begin(), list.cells.end()), list.cells.end());
        std::vector<Supernodes::Pair> pairs = solid_pairs(system);
        for (const auto& [a, b] : list.cells)
            for (const Index i : system.solid().cell(a))
                for (const Index j : system.solid().cell(b))
                    if (i != j) pairs.emplace_back(static_cast<int>(std::max(i, j)), static_cast<int>(std::min(i, j)));
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        work_->together.analyse(std::vector<int>(core::at(system.solid().nodes()), 3), pairs, solid_places(system));
    }

    /// A_s. @returns false if the pattern is that of another solid
    template <class System>
    bool sum_alone(const System& system) {
        BlockCholesky<float>& matrix = work_->alone;
        bool complete = true;
        const assembly::HeldProjector held(system.layout());
        const Index first = system.solid().first_vector();
        matrix.clear();
        system.visit_solid_blocks([&](Index i, Index j, Mat3 block) {
            held.project(first + i, first + j, block);
            const auto entry = matrix.entry(static_cast<int>(i), static_cast<int>(j));
            if (entry.value == nullptr)
                complete = false;
            else
                entry.add(0, 0, block);
        });
        complete_held(system, matrix);
        return complete;
    }
    /// What held nodes have outside their free directions.
    template <class System>
    static void complete_held(const System& system, BlockCholesky<float>& matrix) {
        const assembly::HeldProjector projector(system.layout());
        for (const scene::HeldVector& held : system.layout().held) {
            const Index n = held.vector - system.solid().first_vector();
            if (n >= 0) matrix.entry(static_cast<int>(n), static_cast<int>(n)).add(0, 0, projector.held_part(held));
        }
    }

    /// C^T A C. @returns false if the pattern lacks a part of it
    template <class System>
    bool sum(const System& system) {
        struct Sum {
            const SolidPcgWith& self;
            const System& system;
            BlockCholesky<float>& matrix;
            const assembly::HeldProjector held;
            bool complete = true;
            std::vector<Index> cells;
            std::vector<solid::CellWeights> weights;
            Matrix half, whole;

            /// Adds a block between solid nodes, and its mirror; of i = j all of it.
            void add(Index i, Index j, Mat3 block) {
                if (i < j) return;
                const Index first = system.solid().first_vector();
                held.project(first + i, first + j, block);
                const auto entry = matrix.entry(static_cast<int>(i), static_cast<int>(j));
                if (entry.value == nullptr)
                    complete = false;
                else
                    entry.add(0, 0, block);
            }
            void point(const assembly::PointTerm& term) {
                self.find_cells(system, term.vectors, cells);
                weights.assign(cells.size(), solid::CellWeights::Zero());
                for (std::size_t k = 0; k < term.vectors.size(); ++k)
                    if (const auto* carrier = self.carrier_of(system, term.vectors[k]))
                        weights[core::at(std::find(cells.begin(), cells.end(), carrier->cell) - cells.begin())] +=
                            term.weights[k] * carrier->weights;
                for (std::size_t a = 0; a < cells.size(); ++a)
                    for (std::size_t b = 0; b < cells.size(); ++b)
                        for (int i = 0; i < 8; ++i)
                            for (int j = 0; j < 8; ++j)
                                add(system.solid().cell(cells[a])[core::at(i)], system.solid().cell(cells[b])[core::at(j)],
                                    Mat3(weights[a][i] * weights[b][j] * term.stiffness));
            }
            void dense(const assembly::DenseTerm& term) {
                self.find_cells(system, term.vectors, cells);
                const Index size = 3 * core::count(term.vectors);
                for (const Index b : cells) {
                    half.setZero(size, 24);
                    for (Index v = 0; v < core::count(term.vectors); ++v) {
                        const auto* carrier = self.carrier_of(system, term.vectors[core::at(v)]);
                        if (carrier == nullptr || carrier->cell != b) continue;
                        for (int j = 0; j < 8; ++j)
                            half.middleCols<3>(3 * j) += carrier->weights[j] * term.stiffness.middleCols<3>(3 * v);
                    }
                    for (const Index a : cells) {
                        whole.setZero(24, 24);
                        for (Index v = 0; v < core::count(term.vectors); ++v) {
                            const auto* carrier = self.carrier_of(system, term.vectors[core::at(v)]);
                            if (carrier == nullptr || carrier->cell != a) continue;
                            for (int i = 0; i < 8; ++i)
                                whole.middleRows<3>(3 * i) += carrier->weights[i] * half.middleRows<3>(3 * v);
                        }
                        for (int i = 0; i < 8; ++i)
                            for (int j = 0; j < 8; ++j)
                                add(system.solid().cell(a)[core::at(i)], system.solid().cell(b)[core::at(j)],
                                    Mat3(whole.block<3, 3>(3 * i, 3 * j)));
                    }
                }
            }
        };
        mark_held(system);
        work_->together.clear();
        Sum sum{*this, system, work_->together, assembly::HeldProjector(system.layout()), true, {}, {}, {}, {}};
        const auto& solid = system.solid();
        system.visit_solid_blocks([&](Index i, Index j, const Mat3& block) { sum.add(i, j, block); });
        system.fibres().visit(sum);
        for (std::size_t b = 0; b < solid.bonds().size(); ++b) {  // between a fibre and the solid
            if (!solid.holds(b)) continue;
            const auto& bond = solid.bonds()[b];
            const auto* carrier = carrier_of(system, bond.vector);
            if (carrier == nullptr) continue;
            const auto& cell = solid.cell(carrier->cell);
            for (int i = 0; i < 8; ++i)
                for (int j = 0; j < 8; ++j) {
                    const Mat3 block = -bond.stiffness * bond.weights[i] * carrier->weights[j] * Mat3::Identity();
                    sum.add(bond.nodes[core::at(i)], cell[core::at(j)], block);
                    sum.add(cell[core::at(j)], bond.nodes[core::at(i)], block);
                }
        }
        complete_held(system, work_->together);
        return sum.complete;
    }

    Parameters parameters_;
    Fibres fibres_;
    Workspace<Work> work_;
};

/// With the two levels of TwoLevelPcg for the fibres.
using SolidPcg = SolidPcgWith<TwoLevelPcg>;

}  // namespace fibrant::solver
