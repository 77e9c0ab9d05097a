// SPDX-License-Identifier: MIT
#pragma once
/// @file Nodes where chains are cut, and the motions of whole chains that they stand for.

#include <fibrant/distributed/routes.hpp>
#include <fibrant/distributed/subdomains.hpp>

#include <fibrant/core/parallel.hpp>
#include <fibrant/solver/block_band_cholesky.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace fibrant::distributed {

/// J = Phi (Phi^T B Phi)^-1 Phi^T of the bands B of all chains: Phi moves the joints of a chain, the nodes at which it is cut,
/// and all between them as B has the least energy.
///
/// With B^-1 of the pieces between joints this is B^-1 of the whole chains (static condensation; Toselli and Widlund, Domain
/// Decomposition Methods, section 4.3): the stiff motions of a fibre along many subdomains, which neither their pieces nor a
/// coarse space of many fibres has. The joints of a chain are solved by the rank that has its first node. A node at the end of
/// an element has to part its chain: no band couples across it.
class ChainJoints {
public:
    void analyse(const scene::DofLayout& layout, const Subdomains& cut, const BlockRuns& runs, int rank) {
        segments_.clear(), chains_.clear();
        struct Sizes {
            Index values = 0, stiffness = 0;
        };
        std::vector<Sizes> sent(runs.counts().size()), solved(runs.counts().size());
        std::vector<Route> there, back, stiffness;
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            const std::vector<Subdomains::Run> parts = cut.runs(layout, c);
            if (parts.size() < 2 || chain.reach == 0) continue;
            const auto owner = [&](Index node) {
                return cut.owner()[core::at(chain.first_vector + node * chain.vectors_per_node)];
            };
            const Index m = 3 * chain.vectors_per_node;
            const int solver = runs.rank_of(owner(0));
            Sizes& to = solved[core::at(solver)];
            if (solver == rank) chains_.push_back({c, m, to.values, to.stiffness, {}, {}});
            for (std::size_t k = 0; k < parts.size(); ++k) {
                const Subdomains::Run& run = parts[k];
                const int own = runs.rank_of(run.part);
                Sizes& from = sent[core::at(own)];
                if (solver == rank && k + 1 < parts.size()) chains_.back().joints.push_back(run.last_node);
                if (own == rank)
                    segments_.push_back({c,
                                         m,
                                         run.first_node,
                                         run.last_node,
                                         from.values,
                                         from.stiffness,
                                         k > 0,
                                         k + 1 < parts.size(),
                                         owner(run.first_node) == run.part,
                                         owner(run.last_node) == run.part,
                                         {}});
                there.push_back({own, solver, from.values, to.values, 2 * m});
                back.push_back({solver, own, to.values, from.values, 2 * m});
                stiffness.push_back({own, solver, from.stiffness, to.stiffness, 4 * m * m});
                for (Sizes* sizes : {&from, &to}) sizes->values += 2 * m, sizes->stiffness += 4 * m * m;
            }
        }
        there_ = Routes(rank, there), back_ = Routes(rank, back), stiffness_ = Routes(rank, stiffness);
        own_.assign(core::at(sent[core::at(rank)].values), 0.0), at_solver_.assign(core::at(solved[core::at(rank)].values), 0.0);
        own_stiffness_.assign(core::at(sent[core::at(rank)].stiffness), 0.0);
        stiffness_at_solver_.assign(core::at(solved[core::at(rank)].stiffness), 0.0);
    }
    bool empty() const noexcept { return segments_.empty() && chains_.empty(); }

    /// Takes the values of the bands of chains that own parts have pieces of.
    template <Exchange E>
    void prepare(const E& exchange, const scene::DofLayout& layout, const std::vector<Matrix>& bands, Traffic& traffic) {
        core::parallel_for(core::count(segments_), [&](Index s) {
            Segment& segment = segments_[core::at(s)];
            const Matrix& band = bands[core::at(segment.chain)];
            Eigen::Map<Matrix> stiffness(own_stiffness_.data() + segment.first_stiffness, 2 * segment.block, 2 * segment.block);
            take(segment, layout.chains[core::at(segment.chain)].reach, band, stiffness);
        });
        stiffness_.move(exchange, own_stiffness_, stiffness_at_solver_, traffic);
        core::parallel_for(core::count(chains_), [&](Index k) {
            Chain& chain = chains_[core::at(k)];
            factor(chain, bands[core::at(chain.chain)]);
        });
    }

    /// z += J r in own vectors, of an r that is known in own vectors.
    template <Exchange E>
    void add_correction(const E& exchange, const scene::DofLayout& layout, const Vector& r, Vector& z, Traffic& traffic) {
        const auto first = [&](const Segment& segment, Index node) {
            const scene::Chain& chain = layout.chains[core::at(segment.chain)];
            return 3 * (chain.first_vector + node * chain.vectors_per_node);
        };
        core::parallel_for(core::count(segments_), [&](Index s) {
            const Segment& segment = segments_[core::at(s)];
            const Index m = segment.block;
            Eigen::Map<Vector> own(own_.data() + segment.first_value, 2 * m);
            own.setZero();
            if (segment.motions.rows() > 0)
                own.noalias() += segment.motions.transpose().lazyProduct(
                    r.segment(first(segment, segment.first_inner()), segment.motions.rows()));
            if (segment.has_left) own.head(m) += r.segment(first(segment, segment.first_node), m);
            if (segment.has_right) own.tail(m) += r.segment(first(segment, segment.last_node), m);
        });
        there_.move(exchange, own_, at_solver_, traffic);
        core::parallel_for(core::count(chains_), [&](Index k) { solve(chains_[core::at(k)]); });
        back_.move(exchange, at_solver_, own_, traffic);
        core::parallel_for(core::count(segments_), [&](Index s) {
            const Segment& segment = segments_[core::at(s)];
            const Index m = segment.block;
            const Eigen::Map<const Vector> own(own_.data() + segment.first_value, 2 * m);
            if (segment.motions.rows() > 0)
                z.segment(first(segment, segment.first_inner()), segment.motions.rows()).noalias() +=
                    segment.motions.lazyProduct(own);
            if (segment.has_left) z.segment(first(segment, segment.first_node), m) += own.head(m);
            if (segment.has_right) z.segment(first(segment, segment.last_node), m) += own.tail(m);
        });
    }

private:
    /// Nodes of a chain from joint to joint, or to its end; both joints are among them.
    struct Segment {
        Index chain, block, first_node, last_node, first_value, first_stiffness;
        bool left, right;          // whether there is a joint at that end
        bool has_left, has_right;  // whether this part owns it
        Matrix motions;            // of the inner nodes, for 2 block unknowns of both joints
        Index first_inner() const noexcept { return first_node + (left ? 1 : 0); }
        Index last_inner() const noexcept { return last_node - (right ? 1 : 0); }
    };
    struct Chain {
        Index chain, block, first_value, first_stiffness;
        std::vector<Index> joints;  // nodes
        std::vector<Matrix>
            factor;  // of each joint: the inverse of its block, and what couples it with the one before times that
    };

    /// Motions of the inner nodes, and what the segment adds to the stiffness of its joints beside the blocks that they have.
    static void take(Segment& segment, Index reach, const Matrix& band, Eigen::Map<Matrix> stiffness) {
        const Index m = segment.block, first = segment.first_inner(), last = segment.last_inner();
        stiffness.setZero();
        const auto block = [&](Index a, Index b) {  // A(a, b) of nodes a > b
            return a - b <= reach ? Matrix(band.block(a * m, (a - b) * m, m, m)) : Matrix(Matrix::Zero(m, m));
        };
        if (segment.left && segment.right) stiffness.block(m, 0, m, m) = block(segment.last_node, segment.first_node);
        segment.motions.resize(std::max<Index>(0, last - first + 1) * m, 2 * m);
        if (last >= first) {
            const Index nodes = last - first + 1, within = std::min(reach, nodes - 1);
            Matrix inner = band.block(first * m, 0, nodes * m, (within + 1) * m);
            for (Index a = 0; a < within; ++a) inner.block(a * m, (a + 1) * m, m, (within - a) * m).setZero();
            Matrix coupling = Matrix::Zero(nodes * m, 2 * m);
            for (Index a = first; a <= last; ++a) {
                if (segment.left) coupling.block((a - first) * m, 0, m, m) = block(a, segment.first_node);
                if (segment.right) coupling.block((a - first) * m, m, m, m) = block(segment.last_node, a).transpose();
            }
            if (!solve_inner(m, within, inner, coupling, segment.motions)) segment.motions.setZero();
            // Phi^T B Phi with Phi as it came to be: positive semidefinite, whatever was rounded.
            Matrix product = coupling;
            for (Index a = 0; a < nodes; ++a)
                for (Index d = 0; d <= std::min(a, within); ++d) {
                    const auto part = inner.block(a * m, d * m, m, m);
                    product.middleRows(a * m, m).noalias() += part.lazyProduct(segment.motions.middleRows((a - d) * m, m));
                    if (d > 0)
                        product.middleRows((a - d) * m, m).noalias() +=
                            part.transpose().lazyProduct(segment.motions.middleRows(a * m, m));
                }
            const Matrix whole =
                segment.motions.transpose().lazyProduct(product) + coupling.transpose().lazyProduct(segment.motions);
            stiffness += 0.5 * (whole + whole.transpose());
        }
    }
    /// motions = - inner^-1 coupling; false if the band is not positive definite.
    static bool solve_inner(Index m, Index reach, const Matrix& inner, const Matrix& coupling, Matrix& motions) {
        constexpr int lanes = 8;
        constexpr double least_pivot = 1e-12;  // of ChainFactors
        using Factor = solver::BlockBandCholesky<0, lanes>;
        Factor factor({static_cast<int>(inner.rows() / m), static_cast<int>(m), static_cast<int>(reach)});
        std::array<Matrix, lanes> bands;
        const double unit = inner.cwiseAbs().maxCoeff();  // floats hold no stiffness in all units
        if (!(unit > 0.0) || !std::isfinite(unit)) return false;
        bands.fill(inner / unit);
        if (!factor.factor(std::span<const Matrix, lanes>(bands), least_pivot)[0]) return false;
        std::vector<Factor::Kept> values(core::at(inner.rows()));
        for (Index first = 0; first < coupling.cols(); first += lanes) {
            const Index count = std::min<Index>(lanes, coupling.cols() - first);
            for (Index k = 0; k < inner.rows(); ++k)
                for (Index lane = 0; lane < lanes; ++lane)
                    values[core::at(k)][lane] = lane < count ? static_cast<float>(-coupling(k, first + lane) / unit) : 0.0f;
            factor.solve(values.data());
            for (Index k = 0; k < inner.rows(); ++k)
                for (Index lane = 0; lane < count; ++lane)
                    motions(k, first + lane) = static_cast<double>(values[core::at(k)][lane]);
        }
        return true;
    }
    /// Block Cholesky factors along the joints of a chain. A joint that is not held is left out.
    void factor(Chain& chain, const Matrix& band) const {
        const Index m = chain.block;
        const auto segment = [&](std::size_t k) {
            return Eigen::Map<const Matrix>(
                stiffness_at_solver_.data() + chain.first_stiffness + static_cast<Index>(k) * 4 * m * m, 2 * m, 2 * m);
        };
        chain.factor.assign(2 * chain.joints.size(), Matrix::Zero(m, m));
        for (std::size_t k = 0; k < chain.joints.size(); ++k) {
            Matrix own = band.block(chain.joints[k] * m, 0, m, m) + segment(k).bottomRightCorner(m, m) +
                         segment(k + 1).topLeftCorner(m, m);
            if (k > 0) {
                chain.factor[2 * k + 1] = segment(k).bottomLeftCorner(m, m).lazyProduct(chain.factor[2 * k - 2]);
                own -= chain.factor[2 * k + 1].lazyProduct(segment(k).bottomLeftCorner(m, m).transpose());
            }
            own = 0.5 * (own + own.transpose()).eval();
            const Eigen::LLT<Matrix> cholesky(own);
            if (cholesky.info() == Eigen::Success) chain.factor[2 * k] = cholesky.solve(Matrix::Identity(m, m));
        }
    }
    /// What the segments of a chain have summed up becomes the motions of their joints.
    void solve(const Chain& chain) {
        const Index m = chain.block;
        const auto values = [&](std::size_t segment, Index end) {
            return Eigen::Map<Vector>(at_solver_.data() + chain.first_value + (2 * static_cast<Index>(segment) + end) * m, m);
        };
        std::vector<Vector> x;
        for (std::size_t k = 0; k < chain.joints.size(); ++k) {
            x.emplace_back(values(k, 1) + values(k + 1, 0));
            if (k > 0) x[k] -= chain.factor[2 * k + 1].lazyProduct(x[k - 1]);
        }
        for (std::size_t k = chain.joints.size(); k-- > 0;) {
            const Vector right = x[k];
            x[k] = chain.factor[2 * k].lazyProduct(right);
            if (k + 1 < chain.joints.size()) x[k] -= chain.factor[2 * k + 3].transpose().lazyProduct(x[k + 1]);
            values(k, 1) = x[k], values(k + 1, 0) = x[k];
        }
        values(0, 0).setZero(), values(chain.joints.size(), 1).setZero();
    }

    std::vector<Segment> segments_;  // of own parts
    std::vector<Chain> chains_;      // solved here
    Routes there_, back_, stiffness_;
    std::vector<double> own_, at_solver_, own_stiffness_, stiffness_at_solver_;
};

}  // namespace fibrant::distributed
