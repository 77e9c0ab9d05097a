// SPDX-License-Identifier: MIT
#pragma once
/// @file Load cases of a finite sample of any textile: grips at two ends that are pulled, sheared or turned, or two plates.

#include <fibrant/compositions/textile/assemble.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// Channel that takes a load case from 0 to its amount at 1.
inline constexpr const char* load_channel = "load";

/// Names of the load cases of a textile, as scenes spell them.
inline const std::vector<std::string>& load_case_names() {
    static const std::vector<std::string> names{"tension", "shear", "bending", "compaction"};
    return names;
}

/// What is done to a sample.
struct LoadCaseParameters {
    std::string name = "tension";  ///< one of load_case_names()
    int axis = 0;                  ///< 0, 1 or 2: grips lie at the two ends of the sample along it; plates lie across it
    int across = 1;                ///< other than `axis`: direction of a shear, or in which a bent sample rises
    double grip = core::unset;     ///< length of either grip along the axis [length], > 0; of no use to plates
    /// Tension: change of the free length over it. Shear: displacement of a grip over the free length. Bending: angle between the
    /// grips [radian]. Compaction: approach of the plates over their distance.
    double amount = core::unset;
    /// Ends of open yarns that no grip holds, and that were held or pulled while they settled, keep their places across the axis
    /// in tension, along the third axis in shear and bending, as in a selvedge; else they are free.
    bool guided = true;

    void validate() const {
        const auto& names = load_case_names();
        if (std::find(names.begin(), names.end(), name) == names.end())
            core::refuse("LoadCaseParameters.name", name, "tension, shear, bending or compaction");
        core::require_between("LoadCaseParameters.axis", static_cast<double>(axis), 0.0, 2.0);
        core::require_between("LoadCaseParameters.across", static_cast<double>(across), 0.0, 2.0);
        if (across == axis) core::refuse("LoadCaseParameters.across", std::to_string(across), "another axis than axis");
        core::require_finite("LoadCaseParameters.amount", amount);
        if (name != "compaction") core::require_positive("LoadCaseParameters.grip", grip);
        const bool plates = name == "compaction", pulled = name == "tension";
        core::require(plates   ? amount > 0.0 && amount < 1.0
                      : pulled ? amount > -0.5 && amount != 0.0
                               : amount != 0.0,
                      "LoadCaseParameters.amount", amount,
                      plates   ? "in (0, 1), of plates"
                      : pulled ? "> -0.5 and not 0, of a tension"
                               : "not 0");
    }
};

/// A sample in its grips.
struct LoadCase {
    LoadCaseParameters parameters;
    scene::Assembly assembly;
    std::array<Index, 2> bodies{-1, -1}, plates{-1, -1};  ///< at the low and the high end
    double length = 0.0;                                  ///< between the grips, or between the plates, at the start [length]
    double width = 0.0, thickness = 0.0;  ///< of the sample at the start, across the axis: the greater one first [length]
    std::array<Index, 2> gripped{};       ///< fibres in either grip

    Vec3 along() const { return Vec3::Unit(parameters.axis); }
    Vec3 aside() const { return Vec3::Unit(parameters.across); }
};

/// What of a load case makes its curve.
struct LoadFigures {
    double measure = 0.0;  ///< strain [1], shear [1], curvature [1 / length] or distance of the plates [length]
    double effort = 0.0;   ///< force [force], or moment [force * length]
};
/// Names of the two figures.
inline std::pair<std::string, std::string> figure_names(const std::string& name) {
    if (name == "tension") return {"strain", "force"};
    if (name == "shear") return {"shear", "force"};
    if (name == "bending") return {"curvature", "moment"};
    return {"distance", "force"};
}

/// The scene of a load case, which starts from a settled state of the same fibres. Of what held them while they settled nothing
/// is left: every section within a grip goes with its body.
/// Between plates, ends that were held or pulled keep their places along the plates. Grips are free along the axis in shear and
/// bending.
/// @param settled   the settled fibres
/// @param state     the same as the unknowns of their mesh
/// @throws std::invalid_argument naming what is wrong: a grip that is too long, or has no fibre
inline LoadCase load_case(const Textile& textile, const Assembled& assembled, const observe::Snapshot& settled,
                          const Vector& state, const LoadCaseParameters& parameters) {
    using scene::Coordinate;
    parameters.validate();
    LoadCase load;
    load.parameters = parameters, load.assembly = assembled.assembly;
    scene::Assembly& assembly = load.assembly;
    std::vector<Index> all;
    for (Index f = 0; f < core::count(settled.fibres); ++f) all.push_back(f);
    assembly.release(all);
    assembly.begin_at(state);
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const observe::FibreSnapshot& fibre : settled.fibres)
        for (const Vec3& node : fibre.position) {
            const Vec3 r = Vec3::Constant(fibre.section.radius());
            low = low.cwiseMin(node - r), high = high.cwiseMax(node + r);
        }
    const Vec3 a = load.along(), b = load.aside(), extent = high - low;
    const int other = 3 - parameters.axis - parameters.across;
    load.width = std::max(extent[parameters.across], extent[other]);
    load.thickness = std::min(extent[parameters.across], extent[other]);
    const auto last_node = [&](Index f) { return core::count(settled.fibres[core::at(f)].position) - 1; };
    if (parameters.name == "compaction") {
        load.length = extent[parameters.axis];
        for (const bool above : {false, true}) {
            scene::Tool plate;
            plate.name = above ? "upper plate" : "lower plate";
            plate.origin = above ? high : low, plate.axis = above ? Vec3(-a) : a;
            plate.displacement = (above ? -0.5 : 0.5) * parameters.amount * load.length * a;
            plate.channel = load_channel;
            load.plates[above ? 1 : 0] = assembly.add(plate);
        }
        for (const Index f : all) {
            const Path& path = textile.paths[core::at(assembled.path_of[core::at(f)])];
            const bool open = path.kind == PathKind::open;
            if (open && path.ends == Ends::free) continue;
            assembly.hold_axial_rotation(scene::first_end(f));
            if (!open) continue;
            for (const scene::Station& end : {scene::first_end(f), scene::last_end(f)})
                assembly.hold_position(end, Mat3::Identity() - a * a.transpose());
        }
        return load;
    }
    // Grips count from the outermost nodes: ends of fibres are flat.
    double first = std::numeric_limits<double>::infinity(), last = -first;
    for (const observe::FibreSnapshot& fibre : settled.fibres)
        for (const Vec3& node : fibre.position)
            first = std::min(first, node[parameters.axis]), last = std::max(last, node[parameters.axis]);
    const double inside = parameters.grip * (1.0 + 1e-9);  // a node on the edge of a grip is in it
    load.length = last - first - 2.0 * parameters.grip;
    core::require(load.length > 0.0, "LoadCaseParameters.grip", parameters.grip,
                  "< half the length of the sample along the axis, " + core::text(0.5 * (last - first)));
    for (const bool upper : {false, true}) {
        scene::RigidBody body;
        body.name = upper ? "high grip" : "low grip";
        body.position = 0.5 * (low + high);
        body.position[parameters.axis] = upper ? last - parameters.grip : first + parameters.grip;
        const double half = upper ? 0.5 : -0.5, whole = upper ? 1.0 : 0.0;
        const auto along = static_cast<std::size_t>(parameters.axis), aside = static_cast<std::size_t>(parameters.across);
        if (parameters.name == "tension")
            body.translation[along] = Coordinate::held_at(half * parameters.amount * load.length, load_channel);
        if (parameters.name == "shear")
            body.translation[aside] = Coordinate::held_at(whole * parameters.amount * load.length, load_channel);
        if (parameters.name == "bending") {
            // About the third axis; the sense is that in which the middle rises along `across` where the amount is positive.
            const double sense = a.cross(b)[other] > 0.0 ? -1.0 : 1.0;
            body.rotation[static_cast<std::size_t>(other)] = Coordinate::held_at(sense * half * parameters.amount, load_channel);
        }
        if (upper && parameters.name != "tension") body.translation[along] = Coordinate::loose();
        load.bodies[upper ? 1 : 0] = assembly.add(body);
    }
    std::vector<char> held(settled.fibres.size(), 0);  // by a grip
    for (const Index f : all) {
        const observe::FibreSnapshot& fibre = settled.fibres[core::at(f)];
        std::array<bool, 2> clamped{};
        for (Index n = 0; n < last_node(f) + (fibre.closed ? 0 : 1); ++n) {
            const double x = fibre.position[core::at(n)][parameters.axis];
            const bool lower = x <= first + inside, upper = x >= last - inside;
            if (!lower && !upper) continue;
            const std::size_t side = upper ? 1 : 0;
            const scene::Station at{f, static_cast<double>(n) / static_cast<double>(last_node(f))};
            Mat3 section;
            section.col(0) = fibre.director_1[core::at(n)].normalized();
            const Vec3& g = fibre.director_2[core::at(n)];
            section.col(1) = (g - g.dot(section.col(0)) * section.col(0)).normalized();
            section.col(2) = section.col(0).cross(section.col(1));
            assembly.clamp_to(load.bodies[side], at, section);
            load.gripped[side] += clamped[side] ? 0 : 1;
            clamped[side] = true, held[core::at(f)] = 1;
        }
        if (held[core::at(f)] != 0) continue;
        assembly.hold_axial_rotation(fibre.closed ? scene::first_end(f) : scene::Station{f, 0.5});
        const Path& path = textile.paths[core::at(assembled.path_of[core::at(f)])];
        if (!parameters.guided || path.kind != PathKind::open || path.ends == Ends::free) continue;
        const Vec3 third = Vec3::Unit(other);
        const Mat3 kept =
            parameters.name == "tension" ? Mat3(Mat3::Identity() - a * a.transpose()) : Mat3(third * third.transpose());
        for (const scene::Station& end : {scene::first_end(f), scene::last_end(f)}) assembly.hold_position(end, kept);
    }
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
        if (load.gripped[side] == 0)
            core::refuse("LoadCaseParameters.grip", core::text(parameters.grip),
                         side == 0 ? "long enough to hold a node of a fibre at the low end"
                                   : "long enough to hold a node of a fibre at the high end");
    return load;
}

/// The two figures of a load case as it stands.
template <class Simulator>
LoadFigures load_figures(const LoadCase& load, const Simulator& simulator) {
    const Vec3 a = load.along(), b = load.aside();
    if (load.parameters.name == "compaction") {
        const auto& tools = simulator.contacts().tools();
        return {load.length * (1.0 - load.parameters.amount * simulator.amplitude(load_channel)),
                0.5 * std::abs((tools.reaction(load.plates[1]).force - tools.reaction(load.plates[0]).force).dot(a))};
    }
    const auto& ties = simulator.equilibrium().ties();
    const Vec3 apart = ties.motion().position(load.bodies[1]) - ties.motion().position(load.bodies[0]);
    const Vec3 force = 0.5 * (ties.wrench(load.bodies[1]).force - ties.wrench(load.bodies[0]).force);
    if (load.parameters.name == "tension") return {apart.dot(a) / load.length - 1.0, force.dot(a)};
    if (load.parameters.name == "shear") return {apart.dot(b) / load.length, force.dot(b)};
    const Vec3 axis = a.cross(b);
    const auto turn = [&](Index body) { return core::rotation_vector(ties.motion().frame(body)).dot(axis); };
    return {(turn(load.bodies[0]) - turn(load.bodies[1])) / load.length,
            0.5 * (ties.wrench(load.bodies[0]).moment - ties.wrench(load.bodies[1]).moment).dot(axis)};
}

/// A polynomial through points of a curve by least squares, and how far it misses them.
struct CurveFit {
    std::vector<double> coefficients{};  ///< of 1, x, x^2, ..
    double misfit = 0.0;                 ///< greatest distance from a point over the greatest value [1]
};

/// The polynomial that is nearest to points, by least squares.
/// @param degree  >= 1; less where there are fewer points that differ
inline CurveFit fit_curve(const std::vector<std::pair<double, double>>& points, Index degree = 3) {
    core::require_at_least("fit_curve.degree", degree, 1);
    CurveFit fit;
    double most_x = 0.0, most_y = 0.0;
    for (const auto& [x, y] : points) most_x = std::max(most_x, std::abs(x)), most_y = std::max(most_y, std::abs(y));
    if (points.empty() || !(most_x > 0.0)) return fit;
    const Index terms = std::min<Index>(degree + 1, core::count(points));
    Eigen::MatrixXd powers(core::count(points), terms);
    Vector values(core::count(points));
    for (Index k = 0; k < core::count(points); ++k) {
        const auto& [x, y] = points[core::at(k)];
        values[k] = y;
        for (Index n = 0; n < terms; ++n) powers(k, n) = std::pow(x / most_x, static_cast<double>(n));
    }
    const Vector solved = powers.colPivHouseholderQr().solve(values);
    const Vector missed = powers * solved - values;
    for (Index n = 0; n < terms; ++n) fit.coefficients.push_back(solved[n] / std::pow(most_x, static_cast<double>(n)));
    fit.misfit = most_y > 0.0 ? missed.cwiseAbs().maxCoeff() / most_y : 0.0;
    return fit;
}

/// Slope of the line through the first fifth of a curve's points, three at least, by least squares.
inline double initial_slope(const std::vector<std::pair<double, double>>& points) {
    const std::size_t count = std::min(points.size(), std::max<std::size_t>(3, points.size() / 5));
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (std::size_t k = 0; k < count; ++k) x += points[k].first, y += points[k].second;
    x /= static_cast<double>(count), y /= static_cast<double>(count);
    for (std::size_t k = 0; k < count; ++k)
        xx += (points[k].first - x) * (points[k].first - x), xy += (points[k].first - x) * (points[k].second - y);
    return xx > 0.0 ? xy / xx : 0.0;
}

}  // namespace fibrant::compositions::textile
