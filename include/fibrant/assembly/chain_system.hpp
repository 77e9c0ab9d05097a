// SPDX-License-Identifier: MIT
#pragma once
/// @file The tangent of one iteration, never formed as one matrix: a block band for every fibre, and a point term for every
/// contact element.

#include <fibrant/assembly/chain_rows.hpp>
#include <fibrant/assembly/linear_system.hpp>
#include <fibrant/assembly/particle_blocks.hpp>
#include <fibrant/assembly/point_product.hpp>
#include <fibrant/assembly/slide_products.hpp>
#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/sliding_place.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/scene/image_vectors.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::assembly {

/// Symmetric tangent of fibres whose elements are B, coupled by point terms between two elements.
///
/// Memory: the lower half of the blocks within elements, and some 600 bytes a contact that carries force. Every sum has a fixed
/// order, so the bits of a product do not depend on the number of threads.
template <beam::BeamElement B>
class ChainSystem {
public:
    static constexpr int block = B::dofs_per_node;
    static constexpr int reach = B::reach;
    static constexpr int vectors = B::nodes * B::vectors_per_node;  ///< of an element
    static_assert(reach == B::nodes - 1, "nodes couple within elements");
    using Row = typename ChainRows<block, reach>::Row;  ///< blocks A(a, a - reach) ... A(a, a)
    /// Stiffness between two particles of two elements.
    struct Point {
        std::int32_t first_i, first_j;  ///< first unknown of either element
        std::int32_t fibre_i, fibre_j;
        beam::Particle<B> weights_i, weights_j;
        Mat3 stiffness;
    };

    explicit ChainSystem(const beam::Mesh<B>& mesh) : ChainSystem(mesh.layout()) {}
    /// @param layout  chains of B's nodes
    explicit ChainSystem(scene::DofLayout layout) : layout_{std::move(layout)}, rows_{layout_} {
        Index nodes = 0;
        for (const scene::Chain& chain : layout_.chains) {
            if (chain.closed) closed_.push_back(core::count(first_node_));
            images_of_.emplace_back();
            first_node_.push_back(nodes);
            fibre_of_.insert(fibre_of_.end(), core::at(chain.nodes), static_cast<std::int32_t>(core::count(first_node_) - 1));
            nodes += chain.nodes;
        }
        first_node_.push_back(nodes);
        find_sources();
    }

    const scene::DofLayout& layout() const noexcept { return layout_; }
    scene::DofLayout& layout() noexcept { return layout_; }
    std::vector<Point>& points() noexcept { return points_; }
    const std::vector<Point>& points() const noexcept { return points_; }

    /// Stiffness of contacts whose places slide: few scenes have any. It reaches beyond elements: bands and node blocks have what
    /// lies within them, products and terms the whole.
    std::vector<contact::SlidingStiffness>& slides() noexcept { return slides_; }
    /// Unknowns beyond which bands have them. Smaller systems are factored where a preconditioner is indefinite without them:
    /// crossings at the limit of jamming need such exact steps.
    Index slides_in_bands_beyond = 6000;
    void fill_bands() noexcept { slides_in_bands_beyond = 0; }

    /// Part of a point term that is not symmetric: `column` (x) `row` beside its stiffness [force / length, 1].
    struct Skew {
        std::int32_t point;
        Vec3 column, row;
    };
    std::vector<Skew>& skews() noexcept { return skews_; }
    /// The tangent has a part that `apply` leaves out, and `apply_skews` adds.
    bool unsymmetric() const noexcept { return !skews_.empty(); }
    /// y += F S x, S the part that is not symmetric, for an x that lies within the free directions.
    void apply_skews(const Vector& free, Vector& y) const {
        const Vector& x = with_images(free);
        Vector forces = Vector::Zero(x.size());
        for (const Skew& skew : skews_) {
            const Point& point = points_[core::at(skew.point)];
            const Vec3 apart = beam::Mesh<B>::motion(x, point.first_j, point.weights_j) -
                               beam::Mesh<B>::motion(x, point.first_i, point.weights_i);
            const Vec3 force = skew.row.dot(apart) * skew.column;
            beam::spread(point.weights_j, force, point.first_j, forces);
            beam::spread(point.weights_i, Vec3(-force), point.first_i, forces);
        }
        scene::fold_images(layout_, forces);
        scene::project_free(layout_, forces);
        y += forces;
    }

    /// Number of terms that couple what no band does: points, slides, and the last nodes of a closed one with its first.
    Index couplings() const noexcept { return core::count(points_) + core::count(slides_) + core::count(closed_); }

    /// Sets the values of the current state, which preconditioners read.
    void place(const Vector& state) {
        for (Index v = 0; v < layout_.vectors(); ++v) layout_.value[core::at(v)] = state.segment<3>(3 * v);
    }

    // Bands: cleared, added to from several threads for different fibres, and then closed. A band that has been closed can be
    // added to as well, which is slower; one that has not is refused where it is read.

    /// Sets a fibre's band to zero.
    void clear(Index fibre) { rows_.open(fibre); }
    /// What has been added to a fibre since is as products read it, and in less memory; more may come.
    void close(Index fibre) { rows_.close(fibre); }
    /// Adds values to a node's row, from its entry (i, column) on, as ChainRows does. @tparam Values  a matrix of fixed size
    template <class Values>
    void add_to_row(Index fibre, Index node, Index i, Index column, const Values& values) {
        rows_.add(fibre, node, i, column, values);
    }
    /// Adds an element's stiffness.
    void add(Index fibre, Index element, const beam::ElementMatrix<B>& stiffness) {
        for (Index a = 0; a < B::nodes; ++a)
            for (Index b = 0; b <= a; ++b)
                rows_.add(fibre, element * (B::nodes - 1) + a, 0, (reach - (a - b)) * block,
                          stiffness.template block<block, block>(a * block, b * block));
    }
    /// Adds (w w^T) (x) stiffness on the vectors of one element; of a particle whose section turns J^T stiffness J with the
    /// derivatives J of its place.
    /// @param first_unknown  of the element
    template <class Weights>
    void add_rank_one(Index fibre, Index first_unknown, const Weights& weights, const Mat3& stiffness) {
        const Index node = first_unknown / block - first_node_[core::at(fibre)];
        each_pair<B>(weights, stiffness, [&](Index a, Index v, Index b, Index w, const Mat3& product) {
            rows_.add(fibre, node + a, 3 * v, (reach - (a - b)) * block + 3 * w, product);
        });
    }
    /// Adds a stiffness of one nodal vector with itself.
    void add_diagonal(Index vector, const Mat3& stiffness) {
        const Index node = vector / B::vectors_per_node, v = vector % B::vectors_per_node;
        const Index fibre = fibre_of_[core::at(node)];
        rows_.add(fibre, node - first_node_[core::at(fibre)], 3 * v, reach * block + 3 * v, stiffness);
    }
    /// A copy, of a fibre that is closed.
    const Row row(Index fibre, Index node) const { return rows_.row(fibre, node); }

    /// To be called once bands and points are complete: closes all fibres, and arranges points for products. Again where points
    /// have changed since.
    void index_points() {
        for (Index f = 0; f < fibres(); ++f) close(f);
        pairs_.pack(points_, first_node_.back(),
                    [](const Point& point, int side) { return (side == 0 ? point.first_i : point.first_j) / block; });
        if (banded_slides()) slides_of_.index(slides_, layout_, [this](Index v) { return source(v); });
        supports_.clear();
        for (const scene::Tie& tie : layout_.ties)
            for (const Index vector : tie.vectors)
                supports_.emplace_back(vector, tie.support * layout_.length[core::at(vector)] * layout_.length[core::at(vector)]);
        std::sort(supports_.begin(), supports_.end());
    }

    /// y = A x.
    void apply(const Vector& x, Vector& y) const {
        const auto is_free = [&](const scene::HeldVector& held) {
            const Vec3 own = x.segment<3>(3 * held.vector), free = held.free * own;
            return free[0] == own[0] && free[1] == own[1] && free[2] == own[2];
        };
        if (layout_.ties.empty() &&
            std::all_of(layout_.held.begin(), layout_.held.end(), is_free)) {  // as directions of a solver are
            apply_unheld(x, y);
        } else {
            Vector free = x;
            scene::project_free(layout_, free);
            apply_unheld(free, y);
            scene::add_motion_stiffness(layout_, free, y);
            scene::complete_ties(layout_, x, y);
        }
        for (const scene::HeldVector& held : layout_.held) {
            const Vec3 own = x.segment<3>(3 * held.vector), before = y.segment<3>(3 * held.vector);
            const Vec3 whole = layout_.held_stiffness(held.vector) * own, taken = held.free * whole, left = held.free * before;
            for (Index c = 0; c < 3; ++c) y[3 * held.vector + c] = left[c] + whole[c] - taken[c];
        }
    }

    /// y = K x, as if nothing were held; images count as their sources.
    void apply_unheld(const Vector& free, Vector& y) const {
        rows_.require_closed();
        const Vector& x = with_images(free);
        const Index grain = scene::grain(layout_, bands().packs());
        core::parallel_for(
            bands().packs(),
            [&](Index p) {
                bands().apply(p, x, y);
                pairs_.find_motions(sides(p), x);
            },
            grain);
        core::parallel_for(
            bands().packs(), [&](Index p) { pairs_.add_forces(sides(p), y); }, grain);
        for (const contact::SlidingStiffness& slide : slides_) add_slide(slide, x, y);
        scene::fold_images(layout_, y);
    }

    /// Lower block band of a fibre with its own part of every contact: block (a, d) is A(a, a - d). The last nodes of a closed
    /// fibre are not coupled with its first one in it: positive semidefinite where its elements are.
    void chain_band(Index fibre, Matrix& blocks) const {
        unheld_band(fibre, blocks);
        const scene::Chain& chain = layout_.chains[core::at(fibre)];
        if (chain.closed) blocks.topLeftCorner<block, block>() += blocks.block<block, block>((chain.nodes - 1) * block, 0);
        for (auto held = std::lower_bound(supports_.begin(), supports_.end(), std::pair<Index, double>(chain.first_vector, 0.0));
             held != supports_.end() && held->first < chain.first_vector + chain.nodes * chain.vectors_per_node; ++held) {
            const Index row = 3 * (held->first - chain.first_vector);
            blocks.block<3, 3>(row, row % block).diagonal().array() += held->second;
        }
        project_band(fibre, blocks);
    }
    /// Of a closed fibre the columns of its first node in the last nodes, as many as are coupled with it, in order: what
    /// chain_band leaves out.
    void chain_corner(Index fibre, Matrix& corner) const {
        Matrix blocks;
        unheld_band(fibre, blocks);
        const scene::Chain& chain = layout_.chains[core::at(fibre)];
        const Index own = chain.nodes - 1;
        corner.resize(reach * block, block);
        for (Index d = 1; d <= reach; ++d)
            corner.middleRows<block>((reach - d) * block) = blocks.block<block, block>(own * block, d * block).transpose();
        for (const scene::HeldVector& held : layout_.held) {
            const Index v = held.vector - chain.first_vector, last = v - (own - reach) * B::vectors_per_node;
            if (v >= 0 && v < B::vectors_per_node) corner.middleCols<3>(3 * v) = (corner.middleCols<3>(3 * v) * held.free).eval();
            if (last >= 0 && last < reach * B::vectors_per_node)
                corner.middleRows<3>(3 * last) = (held.free * corner.middleRows<3>(3 * last)).eval();
        }
    }

    /// Diagonal blocks of a fibre's nodes.
    void node_blocks(Index fibre, Matrix& blocks) const {
        Matrix band;
        chain_band(fibre, band);
        blocks = band.leftCols(block);
    }

    /// Every node's row of beam stiffness and every point once, in a fixed order; not projected.
    template <class Terms>
    void visit(Terms& terms) const {
        Matrix dense;
        for (Index f = 0; f < fibres(); ++f)
            for (Index a = 0; a < nodes(f); ++a) visit_row(f, a, dense, terms);
        const double one = 1.0;
        for (const auto& [vector, stiffness] : supports_) {
            const Index alone = vector;
            terms.point(PointTerm{std::span<const Index>(&alone, 1), std::span<const double>(&one, 1),
                                  Mat3(stiffness * Mat3::Identity())});
        }
        visit_couplings(terms, 0, core::count(points_) + core::count(slides_));
    }
    /// The points, and where chains close: else a beam's stiffness couples nothing beyond its chain's band.
    template <class Terms>
    void visit_couplings(Terms& terms) const {
        visit_couplings(terms, 0, couplings());
    }
    /// [first, last) of them; from several threads at once.
    template <class Terms>
    void visit_couplings(Terms& terms, Index first, Index last) const {
        constexpr Index stride = beam::TouchedOnCentreline<B> ? B::vectors_per_node : 1, weighted = vectors / stride;
        std::array<Index, core::at(2 * weighted)> both{};
        [[maybe_unused]] std::array<double, core::at(2 * weighted)> weights{};
        const Index points = core::count(points_), open = points + core::count(slides_);
        for (Index k = std::max(first, open); k < last; ++k) {
            const Index fibre = closed_[core::at(k - open)];
            Matrix dense;
            visit_row(fibre, nodes(fibre) - 1, dense, terms);
        }
        for (Index k = std::max(first, points); k < std::min(last, open); ++k) {
            const contact::SlidingStiffness& slide = slides_[core::at(k - points)];
            const Matrix dense = whole_slide(slide);
            std::vector<Index> numbers(slide.vectors.begin(), slide.vectors.end());
            replace_images(numbers);
            terms.dense(DenseTerm{numbers, dense});
        }
        first = std::min(first, points), last = std::min(last, points);
        for (const Point& point : std::span<const Point>(points_).subspan(core::at(first), core::at(last - first))) {
            for (Index k = 0; k < weighted; ++k)
                both[core::at(k)] = point.first_i / 3 + stride * k, both[core::at(weighted + k)] = point.first_j / 3 + stride * k;
            replace_images(both);
            if constexpr (beam::TurningSections<B>) {
                visit_turning(point, both, terms);
            } else {
                for (Index k = 0; k < weighted; ++k)
                    weights[core::at(k)] = -point.weights_i[core::at(k)],
                    weights[core::at(weighted + k)] = point.weights_j[core::at(k)];
                terms.point(PointTerm{both, weights, point.stiffness});
            }
        }
    }

private:
    /// The band as if nothing were held, and the last node of a closed fibre were one of its own.
    void unheld_band(Index fibre, Matrix& blocks) const {
        blocks.setZero(nodes(fibre) * block, (reach + 1) * block);
        add_band(fibre, blocks);
        for (const Index image : images_of_[core::at(fibre)]) add_band(image, blocks);
        if (banded_slides())
            slides_of_.add(
                slides_, layout_, fibre, [this](Index v) { return source(v); }, blocks);
    }
    void add_band(Index fibre, Matrix& blocks) const {
        rows_.add_to(fibre, blocks);
        pairs_.add_own(pairs_.sides(first_node_[core::at(fibre)], first_node_[core::at(fibre + 1)]),
                       [&](std::int32_t first, const beam::Particle<B>& weights, const Mat3& stiffness) {
                           const Index node = (first - first_unknown(fibre)) / block;
                           each_pair<B>(weights, stiffness, [&](Index a, Index v, Index b, Index w, const Mat3& product) {
                               blocks.block<3, 3>((node + a) * block + 3 * v, (a - b) * block + 3 * w) += product;
                           });
                       });
    }
    bool banded_slides() const noexcept { return !slides_.empty() && layout_.unknowns() > slides_in_bands_beyond; }
    /// Vectors of images become those of their sources: what shifts them is left to products.
    void replace_images(std::span<Index> numbers) const noexcept {
        if (source_.empty()) return;
        for (Index& vector : numbers) vector = source_[core::at(vector)];
    }
    Index source(Index vector) const noexcept { return source_.empty() ? vector : source_[core::at(vector)]; }
    /// Of each vector that which it is an image of, or itself; and of each chain its images beside the cell.
    void find_sources() {
        if (layout_.images.empty()) return;
        source_.resize(core::at(layout_.vectors()));
        std::iota(source_.begin(), source_.end(), Index{0});
        for (const scene::ImageVector& one : layout_.images) source_[core::at(one.image)] = one.source;
        for (Index c = 0; c < fibres(); ++c) {
            const Index first = layout_.chains[core::at(c)].first_vector, source = source_[core::at(first)];
            if (source == first) continue;
            const auto after = std::upper_bound(layout_.chains.begin(), layout_.chains.end(), source,
                                                [](Index v, const scene::Chain& chain) { return v < chain.first_vector; });
            images_of_[core::at(after - layout_.chains.begin() - 1)].push_back(c);
        }
    }
    /// x, with the values of images where there are any.
    const Vector& with_images(const Vector& x) const {
        if (layout_.images.empty()) return x;
        whole_ = x;
        scene::copy_to_images(layout_, whole_);
        return whole_;
    }
    /// A node's row of a fibre's band, with its column.
    template <class Terms>
    void visit_row(Index f, Index a, Matrix& dense, Terms& terms) const {
        std::array<Index, core::at((reach + 1) * B::vectors_per_node)> numbers{};
        const std::size_t count = whole_row(f, a, numbers, dense);
        terms.dense(DenseTerm{std::span<const Index>(numbers.data(), count), dense});
    }
    /// @returns the number of its vectors
    std::size_t whole_row(Index f, Index a, std::span<Index> numbers, Matrix& dense) const {
        const Index before = std::min<Index>(a, reach), size = (before + 1) * block;
        const Index first = layout_.chains[core::at(f)].first_vector + (a - before) * B::vectors_per_node;
        for (Index k = 0; k < size / 3; ++k) numbers[core::at(k)] = first + k;
        replace_images(std::span(numbers).first(core::at(size / 3)));
        dense.setZero(size, size);
        const Row own = row(f, a);
        for (Index c = 0; c < size; ++c)
            for (Index r = 0; r < block; ++r) {
                const double value = own(r, (reach + 1) * block - size + c);
                dense(size - block + r, c) = value;
                if (c < size - block) dense(c, size - block + r) = value;
            }
        return core::at(size / 3);
    }
    /// Particles that turn have no scalar weights: the whole matrix of the point.
    template <class Terms>
    static void visit_turning(const Point& point, const std::array<Index, core::at(2 * vectors)>& both, Terms& terms) {
        Eigen::Matrix<double, 3, 6 * vectors> J;
        for (Index k = 0; k < vectors; ++k)
            J.template middleCols<3>(3 * k) = -point.weights_i.slope(k),
                                         J.template middleCols<3>(3 * (vectors + k)) = point.weights_j.slope(k);
        const Matrix whole = J.transpose() * point.stiffness * J;
        terms.dense(DenseTerm{both, whole});
    }
    /// Sides of points on the fibres of a pack, and on one fibre.
    std::pair<Index, Index> sides(Index pack) const noexcept {
        const auto [first, last] = bands().chains(pack);
        return pairs_.sides(first_node_[core::at(first)], first_node_[core::at(last)]);
    }

    void project_band(Index fibre, Matrix& blocks) const {
        const scene::Chain& chain = layout_.chains[core::at(fibre)];
        const Index last = chain.first_vector + chain.nodes * chain.vectors_per_node;
        auto held = std::lower_bound(layout_.held.begin(), layout_.held.end(), chain.first_vector,
                                     [](const scene::HeldVector& h, Index v) { return h.vector < v; });
        for (; held != layout_.held.end() && held->vector < last; ++held) {
            const Index local = held->vector - chain.first_vector, a = local / B::vectors_per_node,
                        v = local % B::vectors_per_node;
            for (Index d = 0; d <= std::min<Index>(a, reach); ++d)  // its row
                blocks.block<3, block>(a * block + 3 * v, d * block) =
                    (held->free * blocks.block<3, block>(a * block + 3 * v, d * block)).eval();
            for (Index d = 0; d <= std::min<Index>(chain.nodes - 1 - a, reach); ++d)  // its column, in rows below
                blocks.block<block, 3>((a + d) * block, d * block + 3 * v) =
                    (blocks.block<block, 3>((a + d) * block, d * block + 3 * v) * held->free).eval();
            blocks.block<3, 3>(a * block + 3 * v, 3 * v) +=
                layout_.held_stiffness(held->vector) * (Mat3::Identity() - held->free);
        }
    }

    const BandProduct<block, reach>& bands() const noexcept { return rows_.product(); }
    Index fibres() const noexcept { return core::count(layout_.chains); }
    Index nodes(Index fibre) const noexcept { return layout_.chains[core::at(fibre)].nodes; }
    Index first_unknown(Index fibre) const noexcept { return 3 * layout_.chains[core::at(fibre)].first_vector; }

    scene::DofLayout layout_;
    std::vector<Index> first_node_;
    std::vector<std::int32_t> fibre_of_;         // of each node
    std::vector<Index> closed_;                  // fibres
    std::vector<std::vector<Index>> images_of_;  // of each chain: chains that are images of it
    std::vector<Index> source_;                  // of each vector; empty: none is an image
    ChainRows<block, reach> rows_;
    std::vector<Point> points_;
    std::vector<Skew> skews_;
    std::vector<contact::SlidingStiffness> slides_;
    SlidesOfChains<contact::SlidingStiffness> slides_of_;
    std::vector<std::pair<Index, double>> supports_;  // of tied vectors, sorted
    PointProduct<vectors, beam::Particle<B>> pairs_;
    mutable Vector whole_;  // scratch of a product: one system serves one thread at a time
};

}  // namespace fibrant::assembly
