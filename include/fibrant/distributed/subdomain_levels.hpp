// SPDX-License-Identifier: MIT
#pragma once
/// @file A linear system shared by ranks: its product, and a preconditioner of two levels, pieces of chains in subdomains and the
/// rigid motions of clusters of chains. What iterates with them is in `subdomain_pcg.hpp` and `petsc_krylov.hpp`.

#include <fibrant/distributed/agreement.hpp>
#include <fibrant/distributed/chain_joints.hpp>
#include <fibrant/distributed/halo.hpp>
#include <fibrant/distributed/part_product.hpp>
#include <fibrant/distributed/piece_system.hpp>
#include <fibrant/distributed/rank_use.hpp>
#include <fibrant/distributed/shared_ties.hpp>

#include <fibrant/core/stage_clock.hpp>
#include <fibrant/solver/chain_sweeps.hpp>
#include <fibrant/solver/rigid_coarse_space.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::distributed {

/// A system A, and what iterations on it need, by all ranks of an exchange: each holds a run of subdomains. All of them know the
/// whole system; vectors have the size of the whole, and their values are those of own vectors, and of what was refreshed.
///
/// Two levels, by A-DEF2 of Tang, Nabben, Vuik and Erlangga (Journal of Scientific Computing 39, 2009): z = N r, then z += Q (r -
/// A z). N adds up the sweeps forth and back of each subdomain over its pieces of chains (ChainSweeps), and the motions of whole
/// chains that are cut (ChainJoints); Q = P (P^T A P)^-1 P^T with P a RigidCoarseSpace of the whole scene, whose system is
/// gathered and factored by all. Where vectors are tied, P^T A P has springs in the place of the ties, so Q is not that of A: the
/// balanced z = (Q + (1 - Q A) N (1 - A Q)) r of Mandel (Communications in Numerical Methods in Engineering 9, 1993) takes its
/// place, which is positive definite with any Q, for one product more.
///
/// The number of subdomains belongs to the scene. Every sum is one of subdomains, added in their order: its bits depend on the
/// system and on that number, not on ranks and threads.
template <Exchange E = OneRank>
class SubdomainLevels {
public:
    struct Parameters {
        Subdomains::Parameters cut{};
        typename E::Parameters exchange{};
        int fibres_per_cluster = 19;   ///< about, > 0
        int elements_per_station = 2;  ///< along the chains, > 0
        void validate() const {
            cut.validate();
            core::require_at_least("SubdomainLevels.fibres_per_cluster", fibres_per_cluster, 1);
            core::require_at_least("SubdomainLevels.elements_per_station", elements_per_station, 1);
        }
    };
    explicit SubdomainLevels(const Parameters& parameters)
        : parameters_{core::validated(parameters)}, exchange_{parameters.exchange} {}

    /// @throws std::invalid_argument for closed chains and images of periodic cells, which are not shared among ranks yet
    template <assembly::LinearSystem System>
    void analyse(const System& system);
    template <assembly::LinearSystem System>
    solver::SolveStatus prepare(const System& system);
    /// Of the last preparation, the worst of all ranks.
    solver::SolveStatus status() const noexcept { return work_->status; }

    const E& exchange() const noexcept { return exchange_; }
    const Subdomains& cut() const noexcept { return work_->cut; }
    const RankUse& use() const noexcept { return work_->use; }
    /// Vectors of all own parts, part by part.
    std::vector<Index> own_vectors() const {
        std::vector<Index> all;
        for (Index part = 0; part < last_part() - first_part(); ++part) {
            const std::vector<Index>& own = owned(part);
            all.insert(all.end(), own.begin(), own.end());
        }
        return all;
    }

    double dot(const Vector& a, const Vector& b) {
        return sum_of_parts([&](Index part) {
            double sum = 0.0;
            for (const Index v : owned(part)) sum += a.segment<3>(3 * v).dot(b.segment<3>(3 * v));
            return sum;
        });
    }
    double scaled_norm(const scene::DofLayout& layout, const Vector& r) {
        return std::sqrt(sum_of_parts([&](Index part) {
            double sum = 0.0;
            for (const Index v : owned(part)) {
                const double length = layout.length[core::at(v)];
                sum += r.segment<3>(3 * v).squaredNorm() / (length * length);
            }
            return sum;
        }));
    }
    /// body(first number) of each own vector.
    template <class Body>
    void for_owned(const Body& body) {
        core::parallel_for(last_part() - first_part(), [&](Index part) {
            for (const Index v : owned(part)) body(3 * v);
        });
    }
    /// Values that this rank reads and others own.
    void refresh(Vector& x) {
        timed(work_->use.waiting_seconds, [&] { work_->halo.refresh(exchange_, x, work_->use.traffic); });
    }
    /// y = A x in own vectors, of an x that is refreshed.
    void apply(const Vector& x, Vector& y) {
        timed(work_->use.product_seconds, [&] { work_->product.apply(x, y); });
        timed(work_->use.waiting_seconds,
              [&] { work_->ties.complete(exchange_, work_->product.layout(), x, y, work_->use.traffic); });
    }
    /// Held directions and what is tied have no part in z, of which own vectors are known.
    void project(const scene::DofLayout& layout, Vector& z) {
        scene::project_held(layout, z);
        timed(work_->use.waiting_seconds, [&] { work_->ties.project(exchange_, layout, z, work_->use.traffic); });
    }
    /// r = b - A x in own vectors; x is refreshed.
    void find_residual(const Vector& b, Vector& x, Vector& r) {
        refresh(x);
        apply(x, r);
        for_owned([&](Index k) { r.segment<3>(k) = b.segment<3>(k) - r.segment<3>(k); });
    }
    /// x += Q r, and r with it: conjugate gradients with this preconditioner begin where r has no coarse part.
    void start(const scene::DofLayout& layout, const Vector& b, Vector& x, Vector& r) {
        add_coarse(layout, r, x);
        project(layout, x);
        find_residual(b, x, r);
    }

    /// z = N r in own vectors.
    void smooth(const scene::DofLayout& layout, const Vector& r, Vector& z);
    /// z += Q r in own vectors.
    void add_coarse(const scene::DofLayout& layout, const Vector& r, Vector& z);
    /// z = (N + Q - Q A N) r in own vectors; z is refreshed before its coarse part. Balanced where vectors are tied.
    void precondition(const scene::DofLayout& layout, const Vector& r, Vector& z) {
        Vector& left = work_->left;
        if (left.size() != r.size()) left.setZero(r.size());
        if (!layout.ties.empty()) return balance(layout, r, z, left);
        smooth(layout, r, z);
        refresh(z);
        apply(z, left);
        for_owned([&](Index k) { left.segment<3>(k) = r.segment<3>(k) - left.segment<3>(k); });
        add_coarse(layout, left, z);
        project(layout, z);
    }
    /// z = (Q + (1 - Q A) N (1 - A Q)) r in own vectors: positive definite whatever r is.
    void balance(const scene::DofLayout& layout, const Vector& r, Vector& z) {
        Vector& left = work_->left;
        if (left.size() != r.size()) left.setZero(r.size());
        balance(layout, r, z, left);
    }
    /// Throws std::runtime_error on all ranks if they do not know the same x (require_alike).
    void require_alike(const Vector& x) const { distributed::require_alike(exchange_, {x.data(), core::at(x.size())}); }
    /// All ranks get all of x, of which each has its own vectors.
    void share(Vector& x) {
        timed(work_->use.waiting_seconds, [&] { gather_owned(exchange_, work_->cut, work_->runs, x, work_->use.traffic); });
    }
    /// x = (N + Q) b in own vectors: both are positive, and so is b.x.
    void descend(const scene::DofLayout& layout, const Vector& b, Vector& x) {
        Vector& motion = work_->left;
        if (motion.size() != b.size()) motion.setZero(b.size());
        smooth(layout, b, motion);
        x.setZero(b.size());
        add_coarse(layout, b, x);
        for_owned([&](Index k) { x.segment<3>(k) += motion.segment<3>(k); });
        project(layout, x);
    }

    /// What every iteration begins and ends with. Its sums are of own vectors; held directions take what b says, and all ranks
    /// get all of x.
    /// @param iterate  (free part of b, norm of b) -> SolveReport; begins with x = 0, and leaves x in own vectors
    template <class Iterate>
    solver::SolveReport solve(const scene::DofLayout& layout, const Vector& b, Vector& x, const Iterate& iterate) {
        require_alike(b);
        x.setZero(b.size());
        if (status() == solver::SolveStatus::not_finite || !b.allFinite()) return {};
        const double norm = solver::scaled_norm(layout, b);
        if (norm == 0.0) return {solver::SolveStatus::converged, 0, 0.0, core::unset};
        const auto begun = core::wall_seconds();
        Work& work = *work_;
        work.free = b;
        scene::project_free(layout, work.free);  // all ranks know all of b
        const Vector& free = work.free;
        const solver::SolveReport report = iterate(free, norm);
        share(x);
        scene::add_held(layout, b, free, x);
        work.use.solves += 1, work.use.iterations += report.iterations;
        work.use.whole_seconds += core::seconds_since(begun);
        return report;
    }

private:
    struct Work {
        Subdomains cut;
        BlockRuns runs;
        PieceSystem pieces;
        solver::ChainSweeps sweeps;
        solver::RigidCoarseSpace<> coarse;
        PairTerms terms;
        std::vector<Matrix> bands;  // of chains that own parts have elements of
        PartProduct product;
        ChainJoints joints;
        SharedTies ties;
        Halo halo;
        std::vector<Halo::Reader> fixed_readers;  // of bands
        std::vector<std::vector<int>> stations;   // of each part, own or not
        std::vector<std::vector<int>> places;     // of each own part: place of a station in its list
        std::vector<Index> station_counts;        // numbers that each rank gives
        Vector free, slots, moved, left, motion, station_values;
        std::vector<double> own_values, all_values, sums;
        solver::SolveStatus status = solver::SolveStatus::not_finite;
        RankUse use;
    };
    int rank() const noexcept { return exchange_.rank(); }
    Index first_part() const { return work_->runs.first(rank()); }
    Index last_part() const { return work_->runs.first(rank() + 1); }
    const std::vector<Index>& owned(Index part) const noexcept { return work_->cut.owned()[core::at(first_part() + part)]; }

    template <class Body>
    static void timed(double& seconds, const Body& body) {
        const auto start = core::wall_seconds();
        body();
        seconds += core::seconds_since(start);
    }
    /// Sum over all parts of what body(part) is of each.
    template <class Body>
    double sum_of_parts(const Body& body) {
        Work& work = *work_;
        const Index first = first_part();
        work.sums.resize(core::at(last_part() - first));
        core::parallel_for(core::count(work.sums), [&](Index part) { work.sums[core::at(part)] = body(part); });
        count_gathering(core::count(work.sums));
        double sum = 0.0;
        timed(work.use.waiting_seconds, [&] { sum = ordered_sum(exchange_, work.runs, work.sums); });
        return sum;
    }
    void count_gathering(Index numbers) noexcept {
        if (exchange_.ranks() == 1) return;
        work_->use.traffic.gatherings += 1, work_->use.traffic.gathered_bytes += 8 * numbers;
    }
    void balance(const scene::DofLayout& layout, const Vector& r, Vector& z, Vector& left) {
        Vector& motion = work_->motion;
        if (motion.size() != r.size()) motion.setZero(r.size());
        for_owned([&](Index k) { z.segment<3>(k).setZero(); });
        add_coarse(layout, r, z);
        project(layout, z);
        find_residual(r, z, left);
        smooth(layout, left, motion);
        refresh(motion);
        apply(motion, left);
        for_owned([&](Index k) { z.segment<3>(k) += motion.segment<3>(k), left.segment<3>(k) = -left.segment<3>(k); });
        add_coarse(layout, left, z);
        project(layout, z);
    }
    void find_stations(const scene::DofLayout& layout);

    Parameters parameters_;
    E exchange_;
    solver::Workspace<Work> work_;
};

template <Exchange E>
template <assembly::LinearSystem System>
void SubdomainLevels<E>::analyse(const System& system) {
    Work& work = *work_;
    const scene::DofLayout& layout = system.layout();
    for (const scene::Chain& chain : layout.chains)
        if (chain.closed)
            core::refuse("SubdomainLevels.system", "a closed chain", "of open ones: rings are not shared among ranks yet");
    if (!layout.images.empty())
        core::refuse("SubdomainLevels.system", "images of fibres", "without periodic cells: they are not shared among ranks yet");
    work.cut = Subdomains(system, parameters_.cut);
    work.runs = BlockRuns(work.cut.parts(), exchange_.ranks());
    work.pieces.analyse(layout, work.cut, first_part(), last_part());
    work.sweeps.analyse(work.pieces.layout());
    work.product = PartProduct(layout, work.cut, first_part(), last_part());
    work.joints.analyse(layout, work.cut, work.runs, rank());
    work.ties.analyse(layout, work.cut, work.runs, exchange_.ranks());
    work.coarse.analyse(system, parameters_.fibres_per_cluster, parameters_.elements_per_station);
    work.fixed_readers = band_readers(layout, work.cut, work.runs);
    find_stations(layout);
    work.use.parts = work.cut.parts(), work.use.coarse_unknowns = 6 * work.coarse.stations();
}

/// Stations that the nodes of each part stand between, in rising order.
template <Exchange E>
void SubdomainLevels<E>::find_stations(const scene::DofLayout& layout) {
    Work& work = *work_;
    const PartProduct all(layout, work.cut, 0, work.cut.parts());
    const Vector one = Vector::Ones(layout.unknowns());  // a force everywhere
    work.coarse.begin(layout);
    work.stations.assign(core::at(work.cut.parts()), {});
    for (Index part = 0; part < work.cut.parts(); ++part) {
        std::vector<int>& own = work.stations[core::at(part)];
        for (const PartProduct::Run& run : all.runs(part))
            work.coarse.restrict_nodes(layout, one, run.chain, run.first_node, run.last_node + 1,
                                       [&](int station, const auto&) { own.push_back(station); });
        std::sort(own.begin(), own.end());
        own.erase(std::unique(own.begin(), own.end()), own.end());
    }
    work.places.assign(core::at(last_part() - first_part()), {});
    for (std::size_t part = 0; part < work.places.size(); ++part) {
        const std::vector<int>& own = work.stations[core::at(first_part()) + part];
        work.places[part].assign(core::at(work.coarse.stations()), -1);
        for (std::size_t k = 0; k < own.size(); ++k) work.places[part][core::at(own[k])] = static_cast<int>(k);
    }
    work.station_counts.clear();
    for (int r = 0; r < exchange_.ranks(); ++r) {
        Index sum = 0;
        for (Index part = work.runs.first(r); part < work.runs.first(r + 1); ++part)
            sum += 6 * core::count(work.stations[core::at(part)]);
        work.station_counts.push_back(sum);
    }
}

template <Exchange E>
template <assembly::LinearSystem System>
solver::SolveStatus SubdomainLevels<E>::prepare(const System& system) {
    Work& work = *work_;
    const scene::DofLayout& layout = system.layout();
    timed(work.use.prepare_seconds, [&] {
        // Terms that own parts have to do with; who reads what because of terms that ranks share.
        std::vector<Halo::Reader> readers = work.fixed_readers;
        const auto rank_of = [&](Index v) { return work.runs.rank_of(work.cut.owner()[core::at(v)]); };
        work.terms.take(system, [&](std::span<const Index> vectors) {
            bool own = false, shared = false;
            const int first = rank_of(vectors.front());
            for (const Index v : vectors) {
                const int rank_here = rank_of(v);
                own = own || rank_here == rank();
                shared = shared || rank_here != first;
            }
            if (shared)
                for (const Index v : vectors)
                    for (const Index w : vectors)
                        if (rank_of(v) != rank_of(w)) readers.emplace_back(rank_of(v), w);
            return own;
        });
        work.halo = Halo(rank(), work.runs, work.cut.owner(), std::move(readers));

        // Bands: of own pieces for the sweeps, and of a share of all chains for the coarse space.
        work.bands.resize(layout.chains.size());
        std::vector<char> needed(layout.chains.size(), 0), here(layout.chains.size(), 0);
        for (Index c = 0; c < core::count(layout.chains); ++c)
            for (const Subdomains::Run& run : work.cut.runs(layout, c))
                if (run.part >= first_part() && run.part < last_part()) needed[core::at(c)] = 1;
        const BlockRuns chains(core::count(layout.chains), exchange_.ranks());
        for (Index c = chains.first(rank()); c < chains.first(rank() + 1); ++c) here[core::at(c)] = 1;
        const assembly::HeldProjector held(layout);
        work.coarse.begin(layout);
        std::vector<char> finite(layout.chains.size(), 1);
        core::parallel_for(
            core::count(layout.chains),
            [&](Index c) {
                Matrix& band = work.bands[core::at(c)];
                if (needed[core::at(c)] != 0 || here[core::at(c)] != 0) system.chain_band(c, band);
                if (here[core::at(c)] != 0)
                    work.coarse.add_chain(layout, held, c, band);
                else
                    work.coarse.expect_chain(layout, c);
                finite[core::at(c)] = band.allFinite();
                if (needed[core::at(c)] == 0) band.resize(0, 0);
            },
            solver::grain(layout, core::count(layout.chains)));
        if (exchange_.ranks() > 1) {
            std::vector<Index> counts;
            for (int r = 0; r < exchange_.ranks(); ++r) {
                Index sum = 0;
                for (Index c = chains.first(r); c < chains.first(r + 1); ++c) sum += core::count(work.coarse.chain_values(c));
                counts.push_back(sum);
            }
            std::vector<double> own, all;
            for (Index c = chains.first(rank()); c < chains.first(rank() + 1); ++c) {
                const auto values = work.coarse.chain_values(c);
                own.insert(own.end(), values.begin(), values.end());
            }
            Index whole = 0;
            for (const Index n : counts) whole += n;
            all.resize(core::at(whole));
            count_gathering(core::count(own));
            exchange_.gather(own, counts, all);
            auto from = all.begin();
            for (Index c = 0; c < core::count(layout.chains); ++c) {
                const auto values = work.coarse.chain_values(c);
                std::copy_n(from, values.size(), values.begin());
                from += static_cast<std::ptrdiff_t>(values.size());
            }
        }
        work.pieces.take(layout, work.bands, work.terms);
        work.product.take(layout, work.cut, work.bands, work.terms);
        work.joints.prepare(exchange_, layout, work.bands, work.use.traffic);
        const solver::SolveStatus coarse = work.coarse.finish(system);
        work.status = std::find(finite.begin(), finite.end(), 0) != finite.end()
                          ? solver::SolveStatus::not_finite
                          : work.sweeps.prepare(
                                work.pieces, [](Index, const Matrix&) {}, true);
        if (coarse != solver::SolveStatus::converged && work.status != solver::SolveStatus::not_finite) work.status = coarse;

        // The worst of all ranks, so that all go on alike.
        const std::vector<double> all = gather_one(exchange_, static_cast<double>(static_cast<int>(work.status)));
        work.status = static_cast<solver::SolveStatus>(static_cast<int>(*std::max_element(all.begin(), all.end())));
    });
    return work.status;
}
static_assert(solver::SolveStatus::converged < solver::SolveStatus::indefinite &&
              solver::SolveStatus::indefinite < solver::SolveStatus::not_finite);

template <Exchange E>
void SubdomainLevels<E>::smooth(const scene::DofLayout& layout, const Vector& r, Vector& z) {
    Work& work = *work_;
    timed(work.use.sweep_seconds, [&] {
        Vector& slots = work.slots;
        slots.resize(3 * work.pieces.slots()), work.moved.resize(slots.size());
        core::parallel_for(
            work.pieces.slots(), [&](Index s) { slots.segment<3>(3 * s) = r.segment<3>(3 * work.pieces.vector()[core::at(s)]); },
            core::light_items);
        scene::project_held(work.pieces.layout(), slots);
        work.sweeps.apply(work.pieces.layout(), work.slots, work.moved, [](const Vector&, Vector&) {});
    });
    for_owned([&](Index k) { z.segment<3>(k).setZero(); });
    const Vector& moved = work.moved;
    core::parallel_for(
        work.pieces.slots(), [&](Index s) { z.segment<3>(3 * work.pieces.vector()[core::at(s)]) = moved.segment<3>(3 * s); },
        core::light_items);
    timed(work.use.joint_seconds, [&] { work.joints.add_correction(exchange_, layout, r, z, work.use.traffic); });
    project(layout, z);
}

template <Exchange E>
void SubdomainLevels<E>::add_coarse(const scene::DofLayout& layout, const Vector& r, Vector& z) {
    Work& work = *work_;
    timed(work.use.coarse_seconds, [&] {
        const Index first = first_part(), parts = last_part() - first;
        work.own_values.assign(core::at(work.station_counts[core::at(rank())]), 0.0);
        std::vector<Index> begin{0};
        for (Index part = 0; part < parts; ++part)
            begin.push_back(begin.back() + 6 * core::count(work.stations[core::at(first + part)]));
        core::parallel_for(parts, [&](Index part) {
            for (const PartProduct::Run& run : work.product.runs(part))
                work.coarse.restrict_nodes(layout, r, run.chain, run.first_node, run.last_node + 1,
                                           [&](int station, const auto& sum) {
                                               const int place = work.places[core::at(part)][core::at(station)];
                                               double* to = work.own_values.data() + begin[core::at(part)] + 6 * place;
                                               for (Index i = 0; i < 6; ++i) to[i] += sum[i];
                                           });
        });
        Index whole = 0;
        for (const Index n : work.station_counts) whole += n;
        work.all_values.resize(core::at(whole));
        count_gathering(core::count(work.own_values));
        exchange_.gather(work.own_values, work.station_counts, work.all_values);
        work.station_values.setZero(6 * work.coarse.stations());
        const double* from = work.all_values.data();
        for (const std::vector<int>& stations : work.stations)
            for (const int station : stations) {
                for (Index i = 0; i < 6; ++i) work.station_values[6 * Index{station} + i] += from[i];
                from += 6;
            }
        work.coarse.solve_stations(work.station_values);
        core::parallel_for(parts, [&](Index part) {
            for (const PartProduct::Run& run : work.product.runs(part))
                work.coarse.prolong_to_nodes(layout, work.station_values, run.chain, run.first_node, run.last_node + 1, z);
        });
    });
}

}  // namespace fibrant::distributed
