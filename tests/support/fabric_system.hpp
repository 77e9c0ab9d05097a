// SPDX-License-Identifier: MIT
#pragma once
/// @file A linear system as a fabric of fibre bundles gives it: director beams, contact elements side by side and at crossings.

#include <fibrant/assembly/chain_system.hpp>
#include <fibrant/assembly/visited_system.hpp>
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/core/parallel.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace fibrant::test {

/// Lengths in mm, forces in N; the values of the trial in the documentation unless changed.
struct Fabric {
    int bundles = 4;        ///< in each of two directions; 0 in the second if `parallel`
    bool parallel = false;  ///< one direction only: bundles that do not cross
    int fibres = 76;        ///< in a bundle, in an ellipse 2.5 : 1
    int elements = 32;      ///< of a fibre
    double length = 4.4;
    double radius = 0.0201;
    double spacing = 0.88;  ///< of bundles
    double young_modulus = 7300.0;
    double inertia_factor = 0.2;
    double tension = 9.27e-3;  ///< of every fibre
    double contact_stiffness = 50.0;
    double tangential = 0.5;    ///< tangential over normal stiffness where a contact sticks
    double sticking = 0.5;      ///< share of the contacts that stick
    double active = 1.0;        ///< share of the contacts that are there
    double misalignment = 0.1;  ///< of fibres along themselves, in elements
    double end_stiffness = 50.0;
    bool grouped = true;  ///< whether the layout names the bundles
    unsigned seed = 1;
};

/// Elements, contact elements and products that are parallel over fibres.
class FabricSystem {
public:
    using Beam = beam::DirectorBeam<>;
    static constexpr Index per_element = 9;  ///< vectors
    struct Point {
        std::array<Index, 2> first;  ///< vector of either element
        std::array<double, 18> weights;
        Mat3 stiffness;
    };

    explicit FabricSystem(const Fabric& fabric) : fabric_{fabric}, generator_{fabric.seed} {
        const int directions = fabric.parallel ? 1 : 2;
        for (int direction = 0; direction < directions; ++direction)
            for (int bundle = 0; bundle < fabric.bundles; ++bundle) add_bundle(direction, bundle);
        add_neighbours();
        if (directions == 2) add_crossings();
        std::shuffle(points_.begin(), points_.end(), generator_);
        points_.resize(static_cast<std::size_t>(fabric.active * static_cast<double>(points_.size())));
        list_sides();
        assembly::chain_bands_from_terms(*this, bands_);
    }

    const scene::DofLayout& layout() const { return layout_; }
    Index contacts() const { return core::count(points_); }
    const Fabric& fabric() const { return fabric_; }

    void apply(const Vector& x, Vector& y) const {
        force_.resize(points_.size());
        core::parallel_for(contacts(), [&](Index k) {
            const Point& point = points_[core::at(k)];
            Vec3 sum = Vec3::Zero();
            for (Index side = 0; side < 2; ++side)
                for (Index i = 0; i < 9; ++i)
                    sum += point.weights[core::at(9 * side + i)] * x.segment<3>(3 * (point.first[core::at(side)] + i));
            force_[core::at(k)] = point.stiffness * sum;
        });
        core::parallel_for(core::count(layout_.chains), [&](Index c) {
            const scene::Chain& chain = layout_.chains[core::at(c)];
            y.segment(3 * chain.first_vector, 9 * chain.nodes).setZero();
            for (Index e = 0; e < fabric_.elements; ++e) {
                const Index first = 3 * (chain.first_vector + 6 * e);
                y.segment<27>(first).noalias() += elements_[core::at(c * fabric_.elements + e)] * x.segment<27>(first);
            }
            for (const Index node : {Index{0}, chain.nodes - 1}) {
                y.segment<9>(3 * chain.first_vector + 9 * node) +=
                    end_.cwiseProduct(x.segment<9>(3 * chain.first_vector + 9 * node));
            }
            for (Index k = side_first_[core::at(c)]; k < side_first_[core::at(c + 1)]; ++k) {
                const Index side = sides_[core::at(k)] % 2;
                const Point& point = points_[core::at(sides_[core::at(k)] / 2)];
                for (Index i = 0; i < 9; ++i) {
                    y.segment<3>(3 * (point.first[core::at(side)] + i)) +=
                        point.weights[core::at(9 * side + i)] * force_[core::at(sides_[core::at(k)] / 2)];
                }
            }
        });
    }
    void chain_band(Index chain, Matrix& blocks) const { blocks = bands_[core::at(chain)]; }
    void node_blocks(Index chain, Matrix& blocks) const { blocks = bands_[core::at(chain)].leftCols<9>(); }
    template <class Visitor>
    void visit(Visitor& visitor) const {
        std::array<Index, 18> vectors{};
        for (Index c = 0; c < core::count(layout_.chains); ++c) {
            const scene::Chain& chain = layout_.chains[core::at(c)];
            for (Index e = 0; e < fabric_.elements; ++e) {
                for (Index i = 0; i < 9; ++i) vectors[core::at(i)] = chain.first_vector + 6 * e + i;
                visitor.dense(
                    assembly::DenseTerm{std::span<const Index>(vectors).first(9), elements_[core::at(c * fabric_.elements + e)]});
            }
            for (const Index node : {Index{0}, chain.nodes - 1})
                for (Index i = 0; i < 3; ++i) {
                    vectors[0] = chain.first_vector + 3 * node + i;
                    visitor.dense(assembly::DenseTerm{std::span<const Index>(vectors).first(1),
                                                      Matrix(end_.segment<3>(3 * i).asDiagonal())});
                }
        }
        for (const Point& point : points_) {
            for (Index i = 0; i < 18; ++i) vectors[core::at(i)] = point.first[core::at(i / 9)] + i % 9;
            visitor.point(assembly::PointTerm{vectors, point.weights, point.stiffness});
        }
    }

private:
    struct Fibre {
        int direction, bundle, column;
        double aside, height;  // in the bundle's section
        double shift;          // along itself [length]
    };

    double wave(int direction, int bundle, double s) const {
        const double sign = ((bundle + direction) % 2 == 0) ? 1.0 : -1.0;
        const double phase = std::numbers::pi * (s - 0.5 * fabric_.length) / fabric_.spacing +
                             (fabric_.bundles % 2 == 0 ? 0.5 * std::numbers::pi : 0.0);
        return (fabric_.parallel ? 1.0 : sign) * amplitude_ * std::cos(phase);
    }
    Vec3 centre(const Fibre& fibre, double s) const {
        const double across = (fibre.bundle - 0.5 * (fabric_.bundles - 1)) * fabric_.spacing + fibre.aside;
        const double z = wave(fibre.direction, fibre.bundle, s) + fibre.height;
        const double along = s - 0.5 * fabric_.length;
        return fibre.direction == 0 ? Vec3(along, across, z) : Vec3(across, along, z);
    }

    void add_bundle(int direction, int bundle) {
        const double pitch = 1.996 * fabric_.radius;
        std::vector<std::array<double, 3>> sites;  // distance in the ellipse, y, z
        for (int row = -40; row <= 40; ++row)
            for (int column = -40; column <= 40; ++column) {
                const double y = pitch * (column + (row % 2 == 0 ? 0.0 : 0.5)), z = pitch * row * 0.5 * std::numbers::sqrt3;
                sites.push_back({std::hypot(y / 2.5, z), y, z});
            }
        std::ranges::sort(sites);
        amplitude_ = 1.02 * sites[core::at(fabric_.fibres - 1)][0] + fabric_.radius;
        for (int f = 0; f < fabric_.fibres; ++f) {
            const auto& site = sites[core::at(f)];
            std::uniform_real_distribution<double> shift(-1.0, 1.0);
            const double step = fabric_.length / fabric_.elements;
            fibres_.push_back({direction, bundle, static_cast<int>(std::lround(site[1] / pitch * 2.0)), site[1], site[2],
                               fabric_.misalignment * step * shift(generator_)});
            add_fibre(direction * fabric_.bundles + bundle);
        }
    }

    void add_fibre(int group) {
        const Beam beam;
        const Fibre& fibre = fibres_.back();
        const Index first = layout_.vectors(), nodes = 2 * fabric_.elements + 1;
        layout_.chains.push_back({first, nodes, 3, 2, fabric_.grouped ? group : -1});
        const double step = fabric_.length / static_cast<double>(nodes - 1);
        for (Index a = 0; a < nodes; ++a) {
            const double s = static_cast<double>(a) * step + fibre.shift;
            const Vec3 tangent = (centre(fibre, s + 1e-4) - centre(fibre, s - 1e-4)).normalized();
            const Vec3 level = fibre.direction == 0 ? Vec3(0, 1, 0) : Vec3(-1, 0, 0);
            layout_.value.push_back(centre(fibre, s));
            layout_.value.push_back(level);
            layout_.value.push_back(tangent.cross(level));
            for (int i = 0; i < 3; ++i) {
                layout_.kind.push_back(i == 0 ? scene::VectorKind::position : scene::VectorKind::direction);
                layout_.length.push_back(i == 0 ? 1.0 : fabric_.radius);
            }
        }
        const auto section = scene::circular(fabric_.radius, fabric_.inertia_factor);
        for (Index e = 0; e < fabric_.elements; ++e) {
            Beam::ElementVector y;
            for (Index i = 0; i < 9; ++i) y.segment<3>(3 * i) = layout_.value[core::at(first + 6 * e + i)];
            const auto rest = beam.rest(section, {fabric_.young_modulus, 0.3}, y);
            Beam::Stresses stresses{};
            for (auto& value : stresses.value) value[beam::strain::e33] = fabric_.tension;
            elements_.push_back(beam.tangent_stiffness(rest, y, stresses));
        }
        end_.setConstant(fabric_.end_stiffness);
        end_.tail<6>() *= fabric_.radius * fabric_.radius;
    }

    /// Element and xi in it of a fibre at abscissa s of the bundle; false beyond its ends.
    bool place(const Fibre& fibre, double s, Index& element, double& xi) const {
        const double u = (s - fibre.shift) / fabric_.length * fabric_.elements;
        if (u < 0.0 || u >= fabric_.elements) return false;
        element = static_cast<Index>(u);
        xi = 2.0 * (u - static_cast<double>(element)) - 1.0;
        return true;
    }

    void add_point(Index i, double s_i, Index j, double s_j, double stiffness) {
        Point point;
        const std::array<Index, 2> chain{i, j};
        const std::array<double, 2> abscissa{s_i, s_j};
        Vec3 normal = centre(fibres_[core::at(j)], s_j) - centre(fibres_[core::at(i)], s_i);
        normal.normalize();
        for (std::size_t side = 0; side < 2; ++side) {
            Index element = 0;
            double xi = 0.0;
            if (!place(fibres_[core::at(chain[side])], abscissa[side], element, xi)) return;
            point.first[side] = layout_.chains[core::at(chain[side])].first_vector + 6 * element;
            const Vec3 towards = side == 0 ? normal : Vec3(-normal);
            const double xi1 = fabric_.radius * towards.dot(layout_.value[core::at(point.first[side] + 4)]);
            const double xi2 = fabric_.radius * towards.dot(layout_.value[core::at(point.first[side] + 5)]);
            const auto weights = Beam::particle_weights(xi, xi1, xi2);
            for (std::size_t k = 0; k < 9; ++k) point.weights[9 * side + k] = side == 0 ? -weights[k] : weights[k];
        }
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        const double tangential = uniform(generator_) < fabric_.sticking ? fabric_.tangential * stiffness : 0.0;
        point.stiffness = (stiffness - tangential) * normal * normal.transpose() + tangential * Mat3::Identity();
        points_.push_back(point);
    }
    /// Lognormal(1) of mean 1, one a zone.
    double zone_stiffness() {
        std::lognormal_distribution<double> zone(-0.5, 1.0);
        return fabric_.contact_stiffness * zone(generator_);
    }

    void add_neighbours() {
        const Index n = core::count(fibres_);
        for (Index i = 0; i < n; ++i)
            for (Index j = i + 1; j < n; ++j) {
                const Fibre &a = fibres_[core::at(i)], &b = fibres_[core::at(j)];
                if (a.direction != b.direction || a.bundle != b.bundle) continue;
                if (std::hypot(a.aside - b.aside, a.height - b.height) > 2.1 * fabric_.radius) continue;
                const double stiffness = zone_stiffness(), step = fabric_.length / fabric_.elements;
                for (int e = 0; e < 2 * fabric_.elements; ++e) {
                    const double s = a.shift + step * (0.5 * e + 0.25);
                    add_point(i, s, j, s, stiffness);
                }
            }
    }

    void add_crossings() {
        for (int k = 0; k < fabric_.bundles; ++k)
            for (int l = 0; l < fabric_.bundles; ++l) {
                const double s0 = 0.5 * fabric_.length + (l - 0.5 * (fabric_.bundles - 1)) * fabric_.spacing;
                const double s1 = 0.5 * fabric_.length + (k - 0.5 * (fabric_.bundles - 1)) * fabric_.spacing;
                const bool above = wave(0, k, s0) > wave(1, l, s1);  // the first of the two bundles
                for (const Index i : surface(0, k, !above))
                    for (const Index j : surface(1, l, above)) {
                        add_point(i, s0 + fibres_[core::at(j)].aside, j, s1 + fibres_[core::at(i)].aside, zone_stiffness());
                    }
            }
    }
    /// The outermost fibre of each column of a bundle.
    std::vector<Index> surface(int direction, int bundle, bool top) const {
        std::vector<Index> outer;
        for (Index i = 0; i < core::count(fibres_); ++i) {
            const Fibre& a = fibres_[core::at(i)];
            if (a.direction != direction || a.bundle != bundle) continue;
            bool outermost = true;
            for (const Fibre& b : fibres_) {
                if (b.direction == direction && b.bundle == bundle && std::abs(a.column - b.column) <= 0 &&
                    (top ? b.height > a.height : b.height < a.height))
                    outermost = false;
            }
            if (outermost) outer.push_back(i);
        }
        return outer;
    }

    void list_sides() {
        std::vector<std::vector<Index>> sides(layout_.chains.size());
        const assembly::VectorPlaces places(layout_);
        for (Index k = 0; k < contacts(); ++k)
            for (Index side = 0; side < 2; ++side)
                sides[core::at(places.chain(points_[core::at(k)].first[core::at(side)]))].push_back(2 * k + side);
        side_first_.push_back(0);
        for (const auto& list : sides) {
            sides_.insert(sides_.end(), list.begin(), list.end());
            side_first_.push_back(core::count(sides_));
        }
    }

    Fabric fabric_;
    std::mt19937 generator_;
    double amplitude_ = 0.0;
    std::vector<Fibre> fibres_;
    scene::DofLayout layout_;
    std::vector<Matrix> elements_;
    Eigen::Matrix<double, 9, 1> end_;
    std::vector<Point> points_;
    std::vector<Index> side_first_, sides_;
    std::vector<Matrix> bands_;
    mutable std::vector<Vec3> force_;
};
static_assert(assembly::LinearSystem<FabricSystem>);

/// A system of director beams and contact elements in the form that a simulation gives it, its contact elements pair by
/// pair along the fibres.
template <assembly::LinearSystem System>
assembly::ChainSystem<FabricSystem::Beam> chain_system(const System& other) {
    struct Terms {
        assembly::ChainSystem<FabricSystem::Beam> system;
        assembly::VectorPlaces places;
        void dense(const assembly::DenseTerm& term) {
            const Index fibre = places.chain(term.vectors.front());
            for (std::size_t i = 0; i < term.vectors.size(); ++i)
                for (std::size_t j = 0; j < term.vectors.size(); ++j) {
                    const Index k = places.number(term.vectors[i]), l = places.number(term.vectors[j]), apart = k / 3 - l / 3;
                    if (apart < 0) continue;
                    system.add_to_row(fibre, k / 3, 3 * (k % 3), (2 - apart) * 9 + 3 * (l % 3),
                                      term.stiffness.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j)));
                }
        }
        void point(const assembly::PointTerm& term) {
            assembly::ChainSystem<FabricSystem::Beam>::Point point;
            point.first_i = static_cast<std::int32_t>(3 * term.vectors[0]),
            point.first_j = static_cast<std::int32_t>(3 * term.vectors[9]);
            point.fibre_i = static_cast<std::int32_t>(places.chain(term.vectors[0]));
            point.fibre_j = static_cast<std::int32_t>(places.chain(term.vectors[9]));
            for (std::size_t k = 0; k < 9; ++k) point.weights_i[k] = -term.weights[k], point.weights_j[k] = term.weights[9 + k];
            point.stiffness = term.stiffness;
            system.points().push_back(point);
        }
    } terms{assembly::ChainSystem<FabricSystem::Beam>(other.layout()), assembly::VectorPlaces(other.layout())};
    for (Index f = 0; f < core::count(other.layout().chains); ++f) terms.system.clear(f);
    other.visit(terms);
    std::ranges::stable_sort(terms.system.points(), {}, [](const auto& point) {
        return std::array{point.fibre_i, point.fibre_j, point.first_i, point.first_j};
    });
    terms.system.index_points();
    return std::move(terms.system);
}

/// Forces of random size and direction between the particles of every contact element: what the residual of a contact
/// step looks like.
template <assembly::LinearSystem System>
Vector contact_load(const System& system) {
    struct Load {
        Vector b;
        std::mt19937 generator{3};
        std::normal_distribution<double> normal{};
        void dense(const assembly::DenseTerm&) const {}
        void point(const assembly::PointTerm& term) {
            Vec3 gap;
            for (const Index k : {2, 1, 0})
                gap[k] = normal(generator);  // one by one: as arguments, in an order that the compiler chooses
            const Vec3 force = term.stiffness * gap;
            for (std::size_t i = 0; i < term.vectors.size(); ++i) b.segment<3>(3 * term.vectors[i]) += term.weights[i] * force;
        }
    } load{Vector::Zero(system.layout().unknowns())};
    system.visit(load);
    return load.b;
}

/// A force in the middle of every third fibre.
inline Vector pulled_middles(const scene::DofLayout& layout) {
    Vector b = Vector::Zero(layout.unknowns());
    for (std::size_t c = 0; c < layout.chains.size(); c += 3) {
        const scene::Chain& chain = layout.chains[c];
        b.segment<3>(3 * (chain.first_vector + (chain.nodes / 2) * chain.vectors_per_node)) = Vec3(0.1, -0.2, 0.3);
    }
    return b;
}

}  // namespace fibrant::test
