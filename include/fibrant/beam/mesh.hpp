// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres cut into beam elements: numbering of the unknowns, rest configuration, positions along a fibre.

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/beam/followed_shape.hpp>
#include <fibrant/beam/mesh_fibre.hpp>
#include <fibrant/beam/nodal_sums.hpp>
#include <fibrant/core/ordering.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/scene/dof_layout.hpp>
#include <fibrant/scene/image_vectors.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace fibrant::beam {

/// All fibres of a scene in elements of one kind. Abscissae u along a fibre are counted in elements, 0 <= u <= elements;
/// rest arc length is u element_length.
template <BeamElement B>
class Mesh {
public:
    static constexpr Index vectors_per_element_step = (B::nodes - 1) * B::vectors_per_node;
    static constexpr Index element_unknowns = B::nodes * B::dofs_per_node;

    Mesh(const scene::Assembly& assembly, const B& beam) {
        Index first = 0;
        std::vector<Vec3> start;
        for (const scene::FibreSpecification& fibre : assembly.fibres()) {
            const Index nodes = fibre.elements * (B::nodes - 1) + 1;
            const std::string label = scene::label("fibre", core::count(fibres_), fibre.name);
            std::vector<scene::NodeFrame> starts, frames;
            core::with_place([&] { return label; },
                             [&] {
                                 if (RoundAtRest<B> && fibre.section.semi_axis_1 != fibre.section.semi_axis_2)
                                     core::refuse("section.semi_axis_2", core::text(fibre.section.semi_axis_2),
                                                  "semi_axis_1 = " + core::text(fibre.section.semi_axis_1) +
                                                      ", for a beam that is round_at_rest");
                                 cut_fibre<B>(fibre, nodes, starts, frames);
                             });
            double length = 0.0;
            for (std::size_t k = 1; k < frames.size(); ++k) length += (frames[k].position - frames[k - 1].position).norm();
            fibres_.push_back({first, fibre.elements, length / static_cast<double>(fibre.elements), fibre.section, fibre.material,
                               fibre.group, fibre.closed, fibre.name});
            layout_.chains.push_back({first, nodes, B::vectors_per_node, B::reach, fibre.group, fibre.closed});
            for (Index v = 0; fibre.closed && v < B::vectors_per_node; ++v)
                layout_.images.push_back({first + (nodes - 1) * B::vectors_per_node + v, first + v});
            core::append(frames_, starts);
            for (const scene::NodeFrame& frame : starts)
                for (const Vec3& vector : nodal_vectors<B>(frame, fibres_.back().element_length)) start.push_back(vector);
            for (const scene::NodeFrame& frame : frames) {
                const std::array<Vec3, static_cast<std::size_t>(B::vectors_per_node)> vectors =
                    nodal_vectors<B>(frame, fibres_.back().element_length);
                for (std::size_t v = 0; v < vectors.size(); ++v) {
                    layout_.kind.push_back(B::kinds[v]);
                    layout_.length.push_back(
                        vector_length<B>(static_cast<int>(v), fibre.section.radius(), fibres_.back().element_length));
                    layout_.value.push_back(vectors[v]);
                }
            }
            first += nodes * B::vectors_per_node;
        }
        for (const scene::FibreImage& image : assembly.images()) add_image(assembly, image, first, start);
        // Contact elements keep the number of an unknown in 32 bits.
        if (3 * first > std::numeric_limits<std::int32_t>::max())
            core::refuse("assembly.fibres", std::to_string(3 * first) + " unknowns",
                         "<= " + std::to_string(std::numeric_limits<std::int32_t>::max()));
        set_units(layout_, fibres_), set_tubes(fibres_, assembly);
        rest_state_.resize(3 * first);
        for (Index v = 0; v < first; ++v) rest_state_.segment<3>(3 * v) = layout_.value[core::at(v)];
        start_state_.resize(3 * first);
        for (Index v = 0; v < first; ++v) start_state_.segment<3>(3 * v) = start[core::at(v)];
        find_images();
        if (assembly.start().size() > 0) begin_at(assembly.start());
        first_element_.assign(1, 0);
        for (const MeshFibre& fibre : fibres()) first_element_.push_back(first_element_.back() + fibre.elements);
        rest_.resize(core::at(first_element_.back()));
        core::parallel_for(
            fibre_count(),
            [&](Index f) {
                const MeshFibre& fibre = fibres_[core::at(f)];
                for (Index e = 0; e < fibre.elements; ++e)
                    core::with_place([&] { return element_label(f, e); },
                                     [&] {
                                         rest_[core::at(first_element_[core::at(f)] + e)] =
                                             beam.rest(fibre.section, fibre.material, element(rest_state_, f, e));
                                     });
            },
            grain());
    }
    /// What messages call a fibre, an element with its ends at rest, a node with its place at the start.
    std::string label(Index f) const {
        if (const Index of = fibre(f).image_of; of >= 0) return "the image of " + label(of) + " across a seam";
        return scene::label("fibre", f, fibre(f).name);
    }
    std::string element_label(Index f, Index e) const {
        const double u = static_cast<double>(e);
        return label(f) + ", element " + std::to_string(e) + ", from " + scene::text(position(rest_state_, f, u)) + " to " +
               scene::text(position(rest_state_, f, u + 1.0));
    }
    std::string node_label(Index f, Index node) const {
        return label(f) + ", node " + std::to_string(node) + " at " + scene::text(frame(f, node).position);
    }
    /// The same for the node that has a nodal vector.
    std::string vector_label(Index vector) const {
        Index f = 0;
        while (f + 1 < fibre_count() && fibre(f + 1).first_vector <= vector) ++f;
        return node_label(f, (vector - fibre(f).first_vector) / B::vectors_per_node);
    }

    Index fibre_count() const noexcept { return core::count(fibres_) - images_; }
    /// Fibres and, behind them, images: what contact sees.
    Index line_count() const noexcept { return core::count(fibres_); }
    /// The fibre itself, or that which it is an image of.
    Index source(Index f) const noexcept { return fibre(f).image_of >= 0 ? fibre(f).image_of : f; }
    /// Of a loop over fibres: a small mesh is left to one thread.
    Index grain() const noexcept { return scene::grain(layout_, fibre_count()); }
    Index element_count() const noexcept { return first_element_.back(); }
    std::span<const MeshFibre> fibres() const noexcept { return std::span(fibres_).first(core::at(fibre_count())); }
    const MeshFibre& fibre(Index f) const noexcept { return fibres_[core::at(f)]; }
    const scene::DofLayout& layout() const noexcept { return layout_; }
    const Vector& rest_state() const noexcept { return rest_state_; }
    const typename B::Rest& rest(Index f, Index e) const noexcept { return rest_[core::at(first_element_[core::at(f)] + e)]; }
    std::vector<typename B::Rest>& rests() noexcept { return rest_; }
    const std::vector<typename B::Rest>& rests() const noexcept { return rest_; }
    /// Number of element e of fibre f in the whole mesh.
    Index element_index(Index f, Index e) const noexcept { return first_element_[core::at(f)] + e; }
    Index node_count(Index f) const noexcept { return fibre(f).elements * (B::nodes - 1) + 1; }
    /// Node of a station.
    Index node_at(const scene::Station& at) const {
        return static_cast<Index>(std::lround(at.fraction * static_cast<double>(node_count(at.fibre) - 1)));
    }
    /// Nodes with unknowns of their own: all but the last one of a closed fibre.
    Index own_nodes(Index f) const noexcept { return node_count(f) - (fibre(f).closed ? 1 : 0); }
    /// A vector of a node; of the last node of a closed fibre that of its first one.
    Index node_vector(Index f, Index node, Index vector = 0) const noexcept {
        if (node >= own_nodes(f)) node -= own_nodes(f);
        return fibre(f).first_vector + node * B::vectors_per_node + vector;
    }
    /// Where a run begins: at rest, but for fibres that say otherwise.
    const Vector& start_state() const noexcept { return start_state_; }
    /// Frame of a node where a run begins.
    const scene::NodeFrame& frame(Index f, Index node) const noexcept {
        return frames_[core::at(fibre(f).first_vector / B::vectors_per_node + node)];
    }
    /// First unknown of an element; its unknowns follow in one piece.
    Index first_unknown(Index f, Index e) const noexcept { return 3 * (fibre(f).first_vector + e * vectors_per_element_step); }
    /// Takes rotation vectors to the shortest ones of their rotations, and forces on them with them. To be called between
    /// increments; nothing for beams without rotations.
    void rewind([[maybe_unused]] Vector& state, [[maybe_unused]] std::initializer_list<Vector*> forces) const {
        if constexpr (TurningSections<B>) {
            for (Index v = 0; v < layout_.vectors(); ++v) {
                if (layout_.kind[core::at(v)] != scene::VectorKind::rotation) continue;
                const Vec3 before = state.segment<3>(3 * v), after = core::nearest_rotation_vector(before, Vec3::Zero());
                if (before == after) continue;
                state.segment<3>(3 * v) = after;
                const Mat3 change = core::spin_matrix(after).transpose() * core::spin_matrix(before).transpose().inverse();
                for (Vector* force : forces)
                    if (force->size() == state.size()) force->segment<3>(3 * v) = (change * force->segment<3>(3 * v)).eval();
            }
        }
    }
    auto element(const Vector& state, Index f, Index e) const noexcept {
        return state.segment<element_unknowns>(first_unknown(f, e));
    }
    /// Least and greatest abscissa of a fibre: none of a closed one, around which they go on.
    std::pair<double, double> bounds(Index f) const noexcept {
        constexpr double none = std::numeric_limits<double>::infinity();
        return fibre(f).closed ? std::pair<double, double>{-none, none}
                               : std::pair<double, double>{0.0, static_cast<double>(fibre(f).elements)};
    }
    /// Abscissae around each fibre, 0 of open ones; empty if all are open.
    std::vector<double> periods() const {
        std::vector<double> all;
        for (Index f = 0; f < line_count() && !layout_.images.empty(); ++f)
            all.push_back(fibre(f).closed ? static_cast<double>(fibre(f).elements) : 0.0);
        return all;
    }
    /// Way along a fibre between two of its particles, of a closed one the shorter [elements].
    double apart(Index f, double u, double v) const noexcept {
        const double way = std::abs(u - v);
        return fibre(f).closed ? std::abs(std::remainder(way, static_cast<double>(fibre(f).elements))) : way;
    }
    /// The same particle's abscissa in [0, elements) of a closed fibre.
    double wrapped(Index f, double u) const noexcept {
        if (!fibre(f).closed) return u;
        const double end = static_cast<double>(fibre(f).elements), inside = u - end * std::floor(u / end);
        return inside < end ? inside : 0.0;
    }
    /// Element that holds the abscissa u (clamped to the fibre, or wrapped), and its natural coordinate in [-1, 1].
    std::pair<Index, double> locate(Index f, double u) const noexcept {
        const double end = static_cast<double>(fibre(f).elements);
        if (fibre(f).closed) u = wrapped(f, u);
        const double inside = std::clamp(u, 0.0, end);
        const Index e = std::min(fibre(f).elements - 1, static_cast<Index>(inside));
        return {e, std::clamp(2.0 * (inside - static_cast<double>(e)) - 1.0, -1.0, 1.0)};
    }
    /// Weighted sum of the vectors of an element.
    static Vec3 point(const Vector& state, Index first_unknown, const ElementWeights<B>& weights) noexcept {
        Vec3 sum = Vec3::Zero();
        for (std::size_t a = 0; a < weights.size(); ++a)
            sum += weights[a] * state.segment<3>(first_unknown + 3 * static_cast<Index>(a));
        return sum;
    }
    /// The same for weights of the centreline or of its derivatives.
    static Vec3 centre(const Vector& state, Index first_unknown, const ElementWeights<B>& weights) noexcept {
        constexpr int only = detail::only_vector<B>([](double xi) { return B::centreline_weights(xi); });
        return point_of<only>(state, first_unknown, weights);
    }
    /// The same for weights of director g_1 (Which = 1) or g_2 (Which = 2), of beams whose particles are weighted sums.
    template <int Which>
    static Vec3 director(const Vector& state, Index first_unknown, const ElementWeights<B>& weights) noexcept {
        constexpr int only = detail::only_vector<B>([](double xi) { return director_weights<B>(xi, Which); });
        return point_of<only>(state, first_unknown, weights);
    }
    /// Place of a particle of the centreline.
    static Vec3 point(const Vector& state, Index first_unknown,
                      const CentreWeights<B::nodes, B::vectors_per_node>& centre) noexcept {
        Vec3 sum = Vec3::Zero();
        for (std::size_t node = 0; node < centre.size(); ++node)
            sum += centre[node] * state.segment<3>(first_unknown + 3 * B::vectors_per_node * static_cast<Index>(node));
        return sum;
    }
    /// Place of a particle whose section turns.
    static Vec3 point(const Vector& state, Index first_unknown,
                      const Particle<B>& particle) noexcept requires TurningSections<B> {
        return particle.place(state.segment<element_unknowns>(first_unknown));
    }
    /// What a small step does to a particle's place [length].
    static Vec3 motion(const Vector& step, Index first_unknown, const Particle<B>& particle) noexcept {
        if constexpr (TurningSections<B>) {
            Vec3 sum = Vec3::Zero();
            for (Index a = 0; a < B::nodes * B::vectors_per_node; ++a)
                sum += particle.slope(a) * step.segment<3>(first_unknown + 3 * a);
            return sum;
        } else {
            return point(step, first_unknown, particle);
        }
    }
    Vec3 position(const Vector& state, Index f, double u) const noexcept {
        const auto [e, xi] = locate(f, u);
        return centre(state, first_unknown(f, e), B::centreline_weights(xi));
    }
    /// Derivative of the centreline by u [length].
    Vec3 derivative(const Vector& state, Index f, double u) const noexcept {
        const auto [e, xi] = locate(f, u);
        return 2.0 * centre(state, first_unknown(f, e), B::centreline_derivative_weights(xi));
    }
    /// Directors of the section at u; of a beam that has none, any two across the centreline.
    std::pair<Vec3, Vec3> directors(const Vector& state, Index f, double u) const noexcept {
        const auto [e, xi] = locate(f, u);
        const Index first = first_unknown(f, e);
        return element_directors(state, first, xi);
    }
    /// The same in the element with this first unknown.
    static std::pair<Vec3, Vec3> element_directors(const Vector& state, Index first, double xi) noexcept {
        if constexpr (CentrelineOnly<B>) {
            const Vec3 tangent = centre(state, first, B::centreline_derivative_weights(xi)).normalized(),
                       across = tangent.unitOrthogonal();
            return {across, tangent.cross(across)};
        } else if constexpr (TurningSections<B>) {
            const Mat3 turn = B::particle_weights(xi, 0.0, 0.0).turn(state.segment<element_unknowns>(first));
            return {turn.col(0), turn.col(1)};
        } else {
            return {director<1>(state, first, director_weights<B>(xi, 1)), director<2>(state, first, director_weights<B>(xi, 2))};
        }
    }
    /// Second derivative of the centreline by u [length]; the same all along an element unless the beam says otherwise.
    Vec3 second_derivative(const Vector& state, Index f, double u) const noexcept {
        const auto [e, xi] = locate(f, u);
        const Index first = first_unknown(f, e);
        if constexpr (requires { B::centreline_bend_weights(0.0); }) {
            return point(state, first, B::centreline_bend_weights(xi));
        } else {
            return 2.0 * (centre(state, first, B::centreline_derivative_weights(1.0)) -
                          centre(state, first, B::centreline_derivative_weights(-1.0)));
        }
    }
    /// The same as it is felt over an element: straight elements have all of their bend between them [length].
    Vec3 mean_second_derivative(const Vector& state, Index f, double u) const noexcept {
        if constexpr (B::nodes > 2 || requires { B::centreline_bend_weights(0.0); }) {
            return second_derivative(state, f, u);
        } else {
            const double last = static_cast<double>(node_count(f) - 1),
                         middle = fibre(f).closed ? u : std::clamp(u, 0.5, std::max(0.5, last - 0.5));
            if (fibre(f).closed) return derivative(state, f, middle + 0.5) - derivative(state, f, middle - 0.5);
            return derivative(state, f, std::min(last, middle + 0.5)) - derivative(state, f, middle - 0.5);
        }
    }
    /// Its greatest size in element e [length].
    double greatest_bend(const Vector& state, Index f, Index e) const noexcept {
        if constexpr (requires { B::centreline_bend_weights(0.0); }) {
            const Index first = first_unknown(f, e);  // linear between the ends, so greatest at one of them
            return std::max(point(state, first, B::centreline_bend_weights(-1.0)).norm(),
                            point(state, first, B::centreline_bend_weights(1.0)).norm());
        } else {
            return second_derivative(state, f, static_cast<double>(e) + 0.5).norm();
        }
    }

private:
    /// Adds a fibre that is an image of another one, with its vectors. @param first  its first vector, and
    /// then that behind its last one
    void add_image(const scene::Assembly& assembly, const scene::FibreImage& image, Index& first, std::vector<Vec3>& start) {
        const MeshFibre source = fibres_[core::at(image.fibre)];
        const Index vectors = node_count(image.fibre) * B::vectors_per_node;
        scene::ImageShift shift;
        for (const scene::FibreImage::Shift& one : image.shifts) {
            const scene::PeriodicPair& pair = assembly.pairs()[core::at(one.pair)];
            shift.pairs.push_back({node_vector(pair.first.fibre, node_at(pair.first)),
                                   node_vector(pair.last.fibre, node_at(pair.last)), one.times});
        }
        layout_.shifts.push_back(shift);
        fibres_.push_back(source);
        fibres_.back().first_vector = first, fibres_.back().image_of = image.fibre;
        layout_.chains.push_back(layout_.chains[core::at(image.fibre)]);
        layout_.chains.back().first_vector = first, layout_.chains.back().closed = false;
        for (Index v = 0; v < vectors; ++v) {
            const Index of = source.first_vector + v;
            const Index node = v / B::vectors_per_node, of_node = v % B::vectors_per_node;
            layout_.kind.push_back(layout_.kind[core::at(of)]), layout_.length.push_back(layout_.length[core::at(of)]);
            layout_.value.push_back(layout_.value[core::at(of)]), start.push_back(start[core::at(of)]);
            const bool moves = layout_.kind.back() == scene::VectorKind::position;
            layout_.images.push_back(
                {first + v, node_vector(image.fibre, node, of_node), moves ? core::count(layout_.shifts) - 1 : -1});
        }
        first += vectors, ++images_;
    }
    /// Puts images where they belong, and finds those that go on where a fibre ends.
    void find_images() {
        if (images_ == 0) return;
        scene::copy_to_images(layout_, rest_state_), scene::copy_to_images(layout_, start_state_);
        for (Index f = fibre_count(); f < line_count(); ++f) {
            MeshFibre &image = fibres_[core::at(f)], &source = fibres_[core::at(image.image_of)];
            if (image.closed) continue;
            const auto end = [&](Index fibre, bool last) {
                return Vec3(start_state_.segment<3>(3 * node_vector(fibre, last ? node_count(fibre) - 1 : 0)));
            };
            const double near = 1e-6 * image.length();  // rounding of what is drawn
            if ((end(f, false) - end(image.image_of, true)).norm() < near) image.joins = 1;
            if ((end(f, true) - end(image.image_of, false)).norm() < near) image.joins = -1;
            if (image.joins != 0) source.goes_on = true;
        }
        for (Index f = fibre_count(); f < line_count(); ++f)
            fibres_[core::at(f)].goes_on = fibres_[core::at(fibres_[core::at(f)].image_of)].goes_on;
    }
    /// Weighted sum of one vector of each node of an element; of all if Of < 0.
    template <int Of>
    static Vec3 point_of(const Vector& state, Index first_unknown, const ElementWeights<B>& weights) noexcept {
        if constexpr (Of < 0) {
            return point(state, first_unknown, weights);
        } else {
            Vec3 sum = Vec3::Zero();
            for (int a = Of; a < B::nodes * B::vectors_per_node; a += B::vectors_per_node)
                sum += weights[core::at(a)] * state.segment<3>(first_unknown + 3 * a);
            return sum;
        }
    }
    /// Starts where an earlier run ended.
    void begin_at(const Vector& state) {
        if (state.size() != start_state_.size())
            core::refuse("Assembly.start", std::to_string(state.size()) + " numbers",
                         std::to_string(start_state_.size()) + ", as the fibres' nodes have");
        for (Index v = 0; v < layout_.vectors(); ++v)
            if (const Vec3 value = state.segment<3>(3 * v); !value.allFinite())
                core::with_place([&] { return vector_label(v); },
                                 [&] { core::refuse("Assembly.start", scene::text(value), "finite"); });
        start_state_ = state;
        for (const scene::ImageVector& one : layout_.images)
            if (one.shift < 0)
                core::require(state.segment<3>(3 * one.image) == state.segment<3>(3 * one.source),
                              "Assembly.start: last node of a closed fibre",
                              (state.segment<3>(3 * one.image) - state.segment<3>(3 * one.source)).norm(), "the first one");
        for (Index f = 0; f < fibre_count(); ++f)
            for (Index a = 0; a < node_count(f); ++a) {
                const double u = static_cast<double>(a) / static_cast<double>(B::nodes - 1);
                scene::NodeFrame& frame = frames_[core::at(fibre(f).first_vector / B::vectors_per_node + a)];
                frame.position = position(state, f, u);
                frame.tangent = derivative(state, f, u).normalized();
                const Vec3 director = directors(state, f, u).first;
                frame.director_1 = (director - director.dot(frame.tangent) * frame.tangent).normalized();
                frame.director_2 = frame.tangent.cross(frame.director_1);
            }
    }

    std::vector<MeshFibre> fibres_;
    std::vector<Index> first_element_;
    std::vector<typename B::Rest> rest_;
    std::vector<scene::NodeFrame> frames_;
    scene::DofLayout layout_;
    Vector rest_state_, start_state_;
    Index images_ = 0;  // at the end of the fibres
};

}  // namespace fibrant::beam
