// SPDX-License-Identifier: MIT
#pragma once
/// @file Random fibres in a box, straight or bent, apart from each other: as a user describes them, and where they lie.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/proximity/segment_distance.hpp>
#include <fibrant/scene/elastic_material.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace fibrant::compositions::mat {

/// Uniform numbers of a counter (splitmix64): the same on every machine, and nothing but its seed.
class Draws {
public:
    explicit Draws(std::uint64_t seed) : state_{mixed(seed + 0x9E3779B97F4A7C15ull)} {}
    double operator()(double low, double high) {
        state_ += 0x9E3779B97F4A7C15ull;
        return low + (high - low) * static_cast<double>(mixed(state_) >> 11) * 0x1p-53;
    }

private:
    static std::uint64_t mixed(std::uint64_t z) noexcept {
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull, z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return z ^ (z >> 31);
    }
    std::uint64_t state_;
};

/// Fibres in a box of width x width x height whose corner is the origin; all of each fibre is inside, or what the box's sides
/// leave of it.
struct MatParameters {
    double radius = core::unset;  ///< of a fibre [length], > 0
    double length = core::unset;  ///< of a fibre [length], > 0
    double width = core::unset;   ///< of the box along x and y [length], > 0
    double height = core::unset;  ///< of the box along z [length], > 0
    Index fibres = 0;             ///< >= 1; of those that are cut, as many as have their length together
    /// A sample punched out of a wider mat: fibres reach through the sides of the box and are cut there, so that places and
    /// directions are as many at the sides as inside. What is shorter than a tenth of a fibre is left out. Straight fibres only.
    bool cut = false;
    double bend_deg = 0.0;  ///< by which each fibre turns from one end to the other, a circle's arc at rest [degree], in [0, 180]
    double tilt_deg = 90.0;  ///< greatest angle to the plane of x and y; 90: all directions alike [degree], in [0, 90]
    /// Greatest angle to the plane of x and z, as it is seen from above; 90: all directions of the plane of x and y alike
    /// [degree], in [0, 90].
    double spread_deg = 90.0;
    double clearance = 0.02;  ///< least gap between two fibres [radius]; -2 or less: they may lie in each other
    scene::ElasticMaterial material{};
    Index elements = 8;       ///< along each fibre
    std::uint64_t seed = 1;   ///< of the random numbers; the same gives the same mat
    Index draws = 2'000'000;  ///< of fibres in all, after which a box counts as full, >= fibres

    double diameter() const noexcept { return 2.0 * radius; }
    /// Part of the box that is fibre, at a height [1].
    double volume_fraction(double at_height) const noexcept {
        return static_cast<double>(fibres) * std::numbers::pi * radius * radius * length / (width * width * at_height);
    }
    void validate() const {
        core::require_positive("MatParameters.radius", radius);
        core::require_positive("MatParameters.length", length);
        core::require_positive("MatParameters.width", width);
        core::require_positive("MatParameters.height", height);
        core::require_at_least("MatParameters.fibres", fibres, 1);
        core::require_between("MatParameters.bend_deg", bend_deg, 0.0, 180.0);
        core::require_between("MatParameters.tilt_deg", tilt_deg, 0.0, 90.0);
        core::require_between("MatParameters.spread_deg", spread_deg, 0.0, 90.0);
        core::require_finite("MatParameters.clearance", clearance);
        core::require_at_least("MatParameters.elements", elements, 1);
        core::require_at_least("MatParameters.draws", draws, fibres);
        core::require(2.0 * radius < height && 2.0 * radius < width, "MatParameters.radius", radius,
                      "< half of height and width");
        core::require(!cut || bend_deg == 0.0, "MatParameters.bend_deg", bend_deg, "0 where fibres are cut");
        material.validate();
    }
    /// Of a fibre that is shorter than others: at least as fine.
    Index elements_of(double fibre_length) const {
        return std::max<Index>(1, static_cast<Index>(std::ceil(static_cast<double>(elements) * fibre_length / length - 1e-9)));
    }
};

/// Centreline of one fibre: an arc, or a straight line.
struct MatFibre {
    Vec3 middle = Vec3::Zero();
    Vec3 along = Vec3::UnitX(), side = Vec3::UnitY();  ///< unit, at the middle; it bends to `side`
    double length = 0.0, turn = 0.0;                   ///< [length], [radian]
    /// @param t  in [0, 1]
    Vec3 operator()(double t) const {
        const double s = (t - 0.5) * length;
        if (turn < 1e-9) return middle + s * along;
        const double R = length / turn, angle = s / R;
        return middle + R * std::sin(angle) * along + R * (1.0 - std::cos(angle)) * side;
    }
};

/// A fibre of any place in the box, and of any direction within the tilt and the spread: equal parts of the sphere are equally
/// likely.
inline MatFibre drawn_fibre(const MatParameters& parameters, Draws& draw) {
    MatFibre fibre;
    const double beyond = parameters.cut ? 0.5 * parameters.length : 0.0;
    const double x = draw(-beyond, parameters.width + beyond), y = draw(-beyond, parameters.width + beyond),
                 z = draw(0.0, parameters.height);
    fibre.middle = {x, y, z};
    const double up = std::sin(parameters.tilt_deg * std::numbers::pi / 180.0), sine = draw(-up, up);
    const double azimuth = parameters.spread_deg < 90.0 ? draw(-1.0, 1.0) * parameters.spread_deg * std::numbers::pi / 180.0
                                                        : draw(0.0, 2.0 * std::numbers::pi);
    const double cosine = std::sqrt(std::max(0.0, 1.0 - sine * sine));
    fibre.along = {cosine * std::cos(azimuth), cosine * std::sin(azimuth), sine};
    // Bends as little out of the plane as its direction does.
    const Vec3 flat(-std::sin(azimuth), std::cos(azimuth), 0.0), other = fibre.along.cross(flat);
    const double roll = draw(0.0, 2.0 * std::numbers::pi);
    const Vec3 side = std::cos(roll) * flat + up * std::sin(roll) * other;
    fibre.side = side.norm() > 1e-9 ? Vec3(side.normalized()) : flat;
    fibre.length = parameters.length, fibre.turn = parameters.bend_deg * std::numbers::pi / 180.0;
    return fibre;
}

namespace detail {

/// Pieces of fibres by the cells of a grid that their middles are in.
class PieceGrid {
public:
    PieceGrid(const MatParameters& p, double reach)
        : reach_{reach}, piece_{std::min(p.length, std::max(4.0 * p.radius, p.length / 64.0))} {
        // Larger than what they have to find where a wide box has few fibres: no more cells than this for each piece.
        constexpr double most_cells = 100.0;
        const double pieces = static_cast<double>(p.fibres) * std::ceil(p.length / piece_);
        const auto count = [&](double size) { return std::floor(size / cell_) + 1.0; };
        for (cell_ = reach_ + piece_; count(p.width) * count(p.width) * count(p.height) > most_cells * pieces;) cell_ *= 1.25;
        across_ = static_cast<Index>(count(p.width)), up_ = static_cast<Index>(count(p.height));
        cells_.resize(core::at(across_ * across_ * up_));
    }
    std::vector<Vec3> pieces(const MatFibre& fibre) const {
        const auto n = static_cast<Index>(std::ceil(fibre.length / piece_));
        std::vector<Vec3> points;
        for (Index k = 0; k <= n; ++k) points.push_back(fibre(static_cast<double>(k) / static_cast<double>(n)));
        return points;
    }
    bool free(const std::vector<Vec3>& points) const {
        for (std::size_t k = 1; k < points.size(); ++k) {
            const Vec3 middle = 0.5 * (points[k - 1] + points[k]);
            const Index a = index(middle.x(), across_), b = index(middle.y(), across_), c = index(middle.z(), up_);
            for (Index i = std::max<Index>(a - 1, 0); i <= std::min(a + 1, across_ - 1); ++i)
                for (Index j = std::max<Index>(b - 1, 0); j <= std::min(b + 1, across_ - 1); ++j)
                    for (Index l = std::max<Index>(c - 1, 0); l <= std::min(c + 1, up_ - 1); ++l)
                        for (const Piece& piece : cells_[core::at((l * across_ + j) * across_ + i)])
                            if (proximity::segment_distance(points[k - 1], points[k] - points[k - 1], piece.from,
                                                            piece.to - piece.from)
                                    .squared < reach_ * reach_)
                                return false;
        }
        return true;
    }
    void add(const std::vector<Vec3>& points) {
        for (std::size_t k = 1; k < points.size(); ++k) {
            const Vec3 middle = 0.5 * (points[k - 1] + points[k]);
            const Index cell =
                (index(middle.z(), up_) * across_ + index(middle.y(), across_)) * across_ + index(middle.x(), across_);
            cells_[core::at(cell)].push_back({points[k - 1], points[k]});
        }
    }

private:
    struct Piece {
        Vec3 from, to;
    };
    Index index(double x, Index count) const { return std::clamp<Index>(static_cast<Index>(x / cell_), 0, count - 1); }
    double reach_, piece_, cell_ = 0.0;
    Index across_ = 1, up_ = 1;
    std::vector<std::vector<Piece>> cells_;
};

}  // namespace detail

/// What is left of a straight fibre between the sides of the box, a radius and the clearance from them; length 0 if nothing is.
inline MatFibre cut_at_sides(const MatParameters& parameters, const MatFibre& fibre) {
    const double low = (1.0 + std::max(0.0, parameters.clearance)) * parameters.radius, high = parameters.width - low;
    double from = -0.5 * fibre.length, to = 0.5 * fibre.length;
    for (int axis = 0; axis < 2; ++axis) {
        const double slope = fibre.along[axis], x = fibre.middle[axis];
        if (std::abs(slope) < 1e-12) {
            if (x < low || x > high) to = from;
            continue;
        }
        const double a = (low - x) / slope, b = (high - x) / slope;
        from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
    }
    MatFibre piece = fibre;
    piece.length = std::max(0.0, to - from);
    piece.middle += 0.5 * (from + to) * fibre.along;
    return piece;
}

/// What is left of a fibre that is cut is at least this part of its length, or it is left out [1].
constexpr double shortest_piece = 0.1;

/// The longest straight piece of any direction within the tilt and the spread that fits between the sides of the box [length].
inline double longest_piece(const MatParameters& parameters) {
    const double degree = std::numbers::pi / 180.0,
                 across = parameters.width - 2.0 * (1.0 + std::max(0.0, parameters.clearance)) * parameters.radius,
                 flat = across / std::cos(std::min(parameters.spread_deg, 45.0) * degree),  // a square's diagonal is the most
        room = std::max(0.0, parameters.height - 2.0 * parameters.radius);
    return std::hypot(flat, std::min(room, flat * std::tan(parameters.tilt_deg * degree)));
}

/// Fibres one by one (random sequential addition): one that leaves the box or is too close to an earlier one is drawn anew.
/// @throws std::invalid_argument if the box is full before all have found a place, or is too small for what is cut
inline std::vector<MatFibre> random_fibres(const MatParameters& parameters) {
    parameters.validate();
    Draws draw(parameters.seed);
    std::vector<MatFibre> fibres;
    const double reach = (2.0 + parameters.clearance) * parameters.radius, r = parameters.radius;
    detail::PieceGrid grid(parameters, std::max(reach, 0.0));
    // Where fibres are cut, the length that is still to come: never less than a tenth of a fibre, but nothing.
    const double shortest = shortest_piece * parameters.length;
    double missing = static_cast<double>(parameters.fibres) * parameters.length;
    const auto full = [&] { return parameters.cut ? !(missing > 0.0) : core::count(fibres) >= parameters.fibres; };
    for (Index tries = 0, short_ones = 0; !full(); ++tries) {
        if (tries >= parameters.draws && 2 * short_ones > tries)
            core::refuse("MatParameters.length", core::text(parameters.length),
                         "less, or width more: of " + std::to_string(tries) +
                             " fibres that were drawn the box has a tenth or more of " + std::to_string(tries - short_ones) +
                             ", and shorter pieces are left out");
        if (tries >= parameters.draws && fibres.empty())
            core::refuse(
                "MatParameters.length", core::text(parameters.length),
                "less, or width or height more: of " + std::to_string(tries) + " fibres that were drawn none lies in the box");
        if (tries >= parameters.draws)
            core::refuse("MatParameters.fibres", std::to_string(parameters.fibres),
                         "at most " + std::to_string(fibres.size()) + ", which are all that " + std::to_string(tries) +
                             " draws found a place for");
        MatFibre fibre = drawn_fibre(parameters, draw);
        if (parameters.cut) {
            fibre = cut_at_sides(parameters, fibre);
            if (fibre.length >= missing)
                fibre.length = missing;
            else if (fibre.length > missing - shortest)
                fibre.length = missing - shortest;
            if (fibre.length < (1.0 - 1e-9) * shortest) {
                ++short_ones;
                continue;
            }
        }
        const auto inside = [&](const Vec3& x) {
            // Ends that were cut lie at the sides to the last bit, which is no reason to draw them anew.
            const bool between =
                parameters.cut || (x.head<2>().minCoeff() >= r && x.head<2>().maxCoeff() <= parameters.width - r);
            return between && x.z() >= r && x.z() <= parameters.height - r;
        };
        if (!inside(fibre(0.0)) || !inside(fibre(1.0))) continue;  // as most that are too long are told
        const std::vector<Vec3> points = grid.pieces(fibre);
        if (!std::all_of(points.begin(), points.end(), inside) || (reach > 0.0 && !grid.free(points))) continue;
        grid.add(points);
        fibres.push_back(fibre);
        missing = fibre.length == missing ? 0.0 : missing - fibre.length;
    }
    return fibres;
}

/// A flat mat of straight fibres that lie on each other as close as rigid ones can.
struct StackedMat {
    std::vector<MatFibre> fibres;
    double height = 0.0;  ///< of the box that they fill [length]
};

/// Horizontal fibres of random places and directions, laid one by one in the lowest gap that takes them as they are. All are then
/// let down as far as straight fibres go, and lifted as far as they go below a lid that leaves `slack` times the height that they
/// need; each lies half way. As what keeps two fibres apart is linear in their heights, half way is apart too.
/// @param slack  >= 1
inline StackedMat stacked_fibres(const MatParameters& parameters, double slack) {
    core::require(slack >= 1.0, "stacked_fibres.slack", slack, ">= 1");
    core::require(parameters.tilt_deg == 0.0, "MatParameters.tilt_deg", parameters.tilt_deg, "0 where fibres are stacked");
    core::require(parameters.bend_deg == 0.0, "MatParameters.bend_deg", parameters.bend_deg, "0 where fibres are stacked");
    MatParameters through = parameters;
    through.clearance = -2.0;
    StackedMat mat;
    mat.fibres = random_fibres(through);
    std::vector<MatFibre>& fibres = mat.fibres;
    const double r = parameters.radius, reach = (2.0 + std::max(0.0, parameters.clearance)) * r;
    // Which of them cross in plan, and how much higher one then lies than the other: what is near is found by the search.
    struct Crossing {
        std::size_t below, above;
        double rise;  // [length]
    };
    std::vector<std::array<Vec3, 2>> plan;
    for (const MatFibre& fibre : fibres) {
        plan.push_back({fibre(0.0), fibre(1.0)});
        for (Vec3& end : plan.back()) end.z() = 0.0;
    }
    std::vector<proximity::Centreline> lines;
    for (const auto& ends : plan) lines.push_back({.points = ends, .radius = 0.5 * reach});
    std::vector<Crossing> crossings;
    for (const auto& [i, j] : proximity::GridSearch().pairs(lines, 0.0)) {  // of lines of one segment each
        const std::size_t first = core::at(i), second = core::at(j);
        const double squared = proximity::segment_distance(plan[first][0], plan[first][1] - plan[first][0], plan[second][0],
                                                           plan[second][1] - plan[second][0])
                                   .squared;
        if (squared < reach * reach) crossings.push_back({first, second, std::sqrt(reach * reach - squared)});
    }
    const auto by_above = [](const Crossing& x, const Crossing& y) { return x.above < y.above; };
    std::stable_sort(crossings.begin(), crossings.end(), by_above);
    std::vector<std::array<double, 2>> taken;
    auto crossing = crossings.begin();
    for (std::size_t k = 0; k < fibres.size(); ++k) {
        taken.clear();
        for (; crossing != crossings.end() && crossing->above == k; ++crossing) {
            const double z = fibres[crossing->below].middle.z();
            taken.push_back({z - crossing->rise, z + crossing->rise});
        }
        std::sort(taken.begin(), taken.end());
        double z = r;
        for (const auto& [from, to] : taken)
            if (from < z) z = std::max(z, to);
        fibres[k].middle.z() = z;
    }
    // From below, each fibre's rank in height in the place of its number.
    std::vector<std::size_t> order(fibres.size()), rank(fibres.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return fibres[x].middle.z() < fibres[y].middle.z(); });
    std::vector<MatFibre> sorted;
    for (const std::size_t k : order) rank[k] = sorted.size(), sorted.push_back(fibres[k]);
    fibres.swap(sorted);
    for (Crossing& one : crossings) {
        const auto [below, above] = std::minmax(rank[one.below], rank[one.above]);
        one.below = below, one.above = above;
    }
    std::stable_sort(crossings.begin(), crossings.end(), by_above);
    std::vector<double> low(fibres.size(), r), high(fibres.size());
    for (const Crossing& one : crossings) low[one.above] = std::max(low[one.above], low[one.below] + one.rise);
    mat.height = slack * (*std::max_element(low.begin(), low.end()) + r);
    std::fill(high.begin(), high.end(), mat.height - r);
    std::stable_sort(crossings.begin(), crossings.end(), [](const Crossing& x, const Crossing& y) { return x.below > y.below; });
    for (const Crossing& one : crossings) high[one.below] = std::min(high[one.below], high[one.above] - one.rise);
    for (std::size_t k = 0; k < fibres.size(); ++k) fibres[k].middle.z() = 0.5 * (low[k] + high[k]);
    return mat;
}

/// Expected number of pairs, among n straight fibres without bulk, that are nearer than `distance` in a periodic box (Onsager's
/// excluded volume): n (n - 1) / 2 (2 L^2 d <sin> + 2 pi L d^2 + 4 pi d^3 / 3) / V.
/// @param sine  mean of |sin| of the angle of two fibres: pi / 4 if all directions are alike, 2 / pi in a plane
inline double expected_pairs(double n, double length, double distance, double sine, double volume) {
    const double excluded = 2.0 * length * length * distance * sine + 2.0 * std::numbers::pi * length * distance * distance +
                            4.0 / 3.0 * std::numbers::pi * distance * distance * distance;
    return 0.5 * n * (n - 1.0) * excluded / volume;
}

}  // namespace fibrant::compositions::mat
