// SPDX-License-Identifier: MIT
#pragma once
/// @file A scene as a user writes it: fibres, groups of fibres in any hierarchy, and what is imposed on them.

#include <fibrant/core/rotation.hpp>
#include <fibrant/scene/conditions.hpp>
#include <fibrant/scene/cross_section.hpp>
#include <fibrant/scene/elastic_material.hpp>
#include <fibrant/scene/places.hpp>
#include <fibrant/scene/reference_shape.hpp>
#include <fibrant/scene/rigid_body.hpp>
#include <fibrant/scene/solid.hpp>
#include <fibrant/scene/tool.hpp>
#include <fibrant/scene/tube.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::scene {

/// One fibre: a straight one by its two ends, or a curved one by `curve`.
struct FibreSpecification {
    Vec3 from = Vec3::Constant(core::unset);  ///< centre of the first section [length]
    Vec3 to = Vec3::Constant(core::unset);    ///< centre of the last section [length]
    Curve curve{};                            ///< rest shape of a curved fibre, over [0, 1]; takes the place of from and to
    /// Where the fibre lies when a run begins, if not at rest: of the same length as its rest shape. Conditions count from there.
    Curve start{};
    CrossSection section{};  ///< at rest
    ElasticMaterial material{};
    Index elements = 0;            ///< along the fibre, >= 1
    Vec3 director = Vec3::Zero();  ///< g_1 at the first end, less its axial part; zero: across a plane curve, else any
    Index group = -1;              ///< from Assembly::add_group, or -1
    /// The end is the start: `start`, or `curve` where there is none, closes smoothly, and so do the directors. The rest shape
    /// may be open: of a closed fibre that is given by its start alone it is straight.
    bool closed = false;
    /// It goes on beyond both ends as its image: where it lies at first, and at rest, it is turned evenly along itself until its
    /// last section is that of its first one.
    bool repeats = false;
    double twist = 0.0;  ///< by which it is turned along itself before it is closed, or evenly along its `start` [radian]

    std::string law_channel{};  ///< that drives the law of its section: heat, shrinkage, growth; empty: none

    /// A closed fibre that is straight at rest, as long as its start is.
    bool straightened() const noexcept { return closed && start && !curve && !from.allFinite() && !to.allFinite(); }
    std::string name{};  ///< what messages call it beside its number; may be left out

    /// Curves are looked at when they are cut into elements.
    void validate() const {
        section.validate();
        material.validate();
        core::require_at_least("fibre.elements", elements, 1);
        if (elements > most_elements)
            core::refuse("fibre.elements", std::to_string(elements), "<= " + std::to_string(most_elements));
        require_finite("fibre.director", director);
        core::require_finite("fibre.twist", twist);
        if (closed && repeats) core::refuse("fibre.repeats", "true", "false, of a closed fibre");
        if (closed) {
            core::require_at_least("fibre.elements, of a closed fibre", elements, 3);
            if (!start && !curve)
                core::refuse("fibre.closed", "a straight fibre", "a curve, or a start, that ends where it begins");
        } else if (!start || repeats) {
            core::require(twist == 0.0, "fibre.twist", twist, "0, of a fibre that repeats, or neither closes nor has a start");
        }
        if (curve || straightened()) return;
        require_finite("fibre.from", from);
        require_finite("fibre.to", to);
        core::require_positive("fibre.to: distance from fibre.from", (to - from).norm());
    }
    /// Of one fibre: more than a million is a slip, and would run out of memory before anything else is said.
    static constexpr Index most_elements = 1'000'000;
};

/// A named set of fibres and of other groups.
struct Group {
    std::string name;
    Index parent = -1;  ///< the group it belongs to, or -1
};

/// Forces the normal between the fibres of two groups, whatever their present positions (Durville, section 15.3.5).
///
/// Where centrelines of the two groups cross, fibres of `above` are pushed along `axis`, those of `below` against it,
/// until they are on their sides. Groups that cross both ways have an order for each crossing, with its places: each crossing of
/// two fibres takes the order whose places are the nearest along both, so that it may slide by half the way to the next one.
struct ForcedOrder {
    Index above = -1, below = -1;  ///< groups
    Vec3 axis = Vec3::UnitZ();     ///< from below to above, unit; of all orders of a scene parallel
    /// Where the crossing is along fibres of `above` and of `below`, over their lengths [1], in [0, 1]; unset, both: anywhere.
    double at_above = core::unset, at_below = core::unset;

    bool placed() const noexcept { return !std::isnan(at_above); }

    void validate() const {
        require_finite("ForcedOrder.axis", axis);
        core::require(std::abs(axis.norm() - 1.0) <= matrix_rounding, "ForcedOrder.axis: length", axis.norm(), "1");
        if (above == below) core::refuse("ForcedOrder.above", std::to_string(above), "another group than below");
        if (std::isnan(at_above) && std::isnan(at_below)) return;
        core::require_between("ForcedOrder.at_above", at_above, 0.0, 1.0);
        core::require_between("ForcedOrder.at_below", at_below, 0.0, 1.0);
    }
};

/// A scene: everything that does not depend on how it is computed.
class Assembly {
public:
    /// @returns index of the fibre, counted from 0
    /// @throws std::invalid_argument naming the field that is wrong
    Index add(const FibreSpecification& fibre) {
        core::with_place([&] { return label("fibre", core::count(fibres_), fibre.name); },
                         [&] {
                             fibre.validate();
                             if (fibre.group < -1 || fibre.group >= core::count(groups_))
                                 core::refuse("fibre.group", std::to_string(fibre.group), "-1 or a group of this assembly");
                         });
        fibres_.push_back(fibre);
        return core::count(fibres_) - 1;
    }

    /// @param parent  the group that holds this one, or -1
    Index add_group(std::string name, Index parent = -1) {
        if (parent < -1 || parent >= core::count(groups_))
            core::refuse("group.parent", std::to_string(parent), "-1 or an earlier group");
        groups_.push_back({std::move(name), parent});
        return core::count(groups_) - 1;
    }

    /// Holds components of a nodal vector on a path.
    void hold(const Hold& condition) {
        check(condition.at, condition);
        holds_.push_back(condition);
    }

    /// Takes away all holds of some fibres.
    void release(const std::vector<Index>& fibres) {
        std::erase_if(holds_,
                      [&](const Hold& hold) { return std::find(fibres.begin(), fibres.end(), hold.at.fibre) != fibres.end(); });
    }

    /// Holds the centre of a section in the given directions.
    void hold_position(Station at, const Mat3& directions = Mat3::Identity()) {
        Hold condition;
        condition.at = at;
        condition.directions = directions;
        hold(condition);
    }

    /// Moves the centre of a section by a displacement [length] as the channel goes to 1; all components are prescribed.
    void prescribe(Station at, const Vec3& displacement, const std::string& channel = "motion") {
        Hold condition;
        condition.at = at;
        condition.displacement = displacement;
        condition.channel = channel;
        hold(condition);
    }

    /// Moves both ends of a fibre by the same displacement [length].
    void prescribe_ends(Index fibre, const Vec3& displacement, const std::string& channel = "motion") {
        prescribe(first_end(fibre), displacement, channel);
        prescribe(last_end(fibre), displacement, channel);
    }

    /// Holds position and rotation of a section and leaves its stretches free. With a rotation vector the section turns
    /// by amplitude * angle about `pivot`; with a displacement it moves.
    void clamp(Station at, const Vec3& displacement = Vec3::Zero(), const Vec3& rotation = Vec3::Zero(),
               const Vec3& pivot = Vec3::Zero(), const std::string& channel = "motion") {
        hold(turned_section(at, displacement, rotation, pivot, channel));
        hold_rotation(at, rotation, channel);
    }

    /// The rotation of a clamp alone, where the position is held by other conditions.
    void hold_rotation(Station at, const Vec3& rotation = Vec3::Zero(), const std::string& channel = "motion") {
        Hold condition;
        condition.at = at;
        condition.channel = channel;
        condition.rotation = by_amplitude(rotation);
        condition.axes = Axes::section;
        condition.vector = NodeVector::director_1;
        condition.directions = Vec3(0, 1, 1).asDiagonal();  // not its own stretch
        hold(condition);
        condition.vector = NodeVector::director_2;
        condition.directions = Vec3(1, 0, 1).asDiagonal();
        hold(condition);
    }

    /// A clamp that holds the shape of the section at rest as well. `clamp` leaves the lengths of both directors free and the
    /// angle between them not, so that what it lets a section do depends on how they stand in it: a plane ring whose directors
    /// are oblique to its plane leaves it a little. This one does not. Sections of rigid shape are held as by `clamp`.
    void clamp_section(Station at, const Vec3& displacement = Vec3::Zero(), const Vec3& rotation = Vec3::Zero(),
                       const Vec3& pivot = Vec3::Zero(), const std::string& channel = "motion") {
        hold(turned_section(at, displacement, rotation, pivot, channel));
        Hold condition = turned_section(at, Vec3::Zero(), rotation, Vec3::Zero(), channel);
        for (const NodeVector director : {NodeVector::director_1, NodeVector::director_2}) {
            condition.vector = director;
            hold(condition);
        }
    }

    /// Holds the rotation of a section about the fibre's own axis. Both off-axis components are held: one alone would let
    /// the torque enter through one director.
    void hold_axial_rotation(Station at) {
        Hold condition;
        condition.at = at;
        condition.axes = Axes::section;
        condition.vector = NodeVector::director_1;
        condition.directions = Vec3(0, 1, 0).asDiagonal();
        hold(condition);
        condition.vector = NodeVector::director_2;
        condition.directions = Vec3(1, 0, 0).asDiagonal();
        hold(condition);
    }

    /// A force that keeps its direction, on a place of a fibre.
    void apply(const DeadForce& load) {
        check(load.at, load);
        forces_.push_back(load);
    }

    /// A moment on a place of a fibre.
    void apply(const Moment& load) {
        check(load.at, load);
        moments_.push_back(load);
    }

    /// A pressure along a whole fibre.
    void apply(const LinePressure& load) {
        check(first_end(load.fibre));
        core::with_place([&] { return label("fibre", load.fibre, fibres_[core::at(load.fibre)].name); },
                         [&] {
                             core::require_finite("LinePressure.pressure", load.pressure);
                             core::require(std::abs(load.axis.norm() - 1.0) < 1e-9, "LinePressure.axis: length", load.axis.norm(),
                                           "1");
                         });
        pressures_.push_back(load);
    }

    /// One group is to be above another one where they cross, or at one crossing.
    void force_order(const ForcedOrder& order) {
        for (const Index group : {order.above, order.below})
            if (group < 0 || group >= core::count(groups_))
                core::refuse("ForcedOrder.group", std::to_string(group), "a group of this assembly");
        const auto place = [&] {
            return label("order", core::count(orders_)) + ", of " + group_label(order.above) + " above " +
                   group_label(order.below);
        };
        core::with_place(place, [&] {
            order.validate();
            const auto opposite = order_of_.find({order.below, order.above}), same = order_of_.find({order.above, order.below});
            for (const auto& other : {opposite, same})
                if (other != order_of_.end() && orders_[core::at(other->second)].placed() != order.placed())
                    core::refuse("ForcedOrder.at_above", order.placed() ? core::text(order.at_above) : "unset",
                                 "as in " + label("order", other->second) + " of the same groups: given in all, or in none");
            if (opposite != order_of_.end() && !order.placed())
                core::refuse("ForcedOrder.above", std::to_string(order.above),
                             "below: " + label("order", opposite->second) + " says so");
            const double sine = orders_.empty() ? 0.0 : orders_.front().axis.cross(order.axis).norm();
            core::require(sine <= matrix_rounding, "ForcedOrder.axis: sine of the angle to that of order 0", sine, "0");
        });
        order_of_.emplace(std::pair{order.above, order.below}, core::count(orders_));
        orders_.push_back(order);
    }

    /// Rules for pairs of groups; the last one given for a pair decides.
    void add(const PairRule& rule) {
        for (const Index group : {rule.first, rule.second})
            if (group < 0 || group >= core::count(groups_))
                core::refuse("PairRule.group", std::to_string(group), "a group of this assembly");
        core::with_place([&] { return group_label(rule.first) + " and " + group_label(rule.second); }, [&] { rule.validate(); });
        rules_.push_back(rule);
    }

    /// A hollow fibre and what is in it. To be added when these fibres are.
    void add(Tube tube) {
        require_tube(tube, fibres_);
        tubes_.push_back(std::move(tube));
    }

    /// A rigid tool, for models that have a part `Tools`.
    /// @returns index of the tool, counted from 0
    Index add(Tool tool) {
        core::with_place([&] { return label("tool", core::count(tools_), tool.name); },
                         [&] {
                             tool.validate();
                             if (tool.carried()) check(tool.carrier);
                         });
        tool.axis.normalize();
        tools_.push_back(std::move(tool));
        return core::count(tools_) - 1;
    }

    /// A rigid body, for models that have a part `Connections`.
    /// @returns index of the body, counted from 0
    Index add(RigidBody body) {
        if (body.parent < -1 || body.parent >= core::count(bodies_))
            core::refuse("RigidBody.parent", std::to_string(body.parent), "-1 or an earlier body");
        core::with_place([&] { return label("body", core::count(bodies_), body.name); }, [&] { body.validate(); });
        bodies_.push_back(std::move(body));
        return core::count(bodies_) - 1;
    }

    /// Ties the mean of places on fibres or of nodes of solids to a body.
    void connect(AverageConnection connection) {
        if (connection.body < 0 || connection.body >= core::count(bodies_))
            core::refuse("AverageConnection.body", std::to_string(connection.body), "a body of this assembly");
        const auto place = [&] {
            return label("connection", core::count(averages_)) + " to " +
                   label("body", connection.body, bodies_[core::at(connection.body)].name);
        };
        core::with_place(place, [&] {
            connection.validate();
            for (const Station& at : connection.ends) check(at);
            for (const SolidNode& at : connection.nodes)
                if (at.solid < 0 || at.solid >= core::count(solids_) || at.node < 0 ||
                    at.node >= core::count(solids_[core::at(at.solid)].nodes))
                    core::refuse("AverageConnection.nodes", std::to_string(at.solid) + ":" + std::to_string(at.node),
                                 "a node of a solid of this assembly");
        });
        averages_.push_back(std::move(connection));
    }

    /// Clamps a section to a body: position and rotation follow it, the section's stretches are free.
    void clamp_to(Index body, Station at, const Mat3& section) {
        connect({.ends = {at}, .body = body});
        connect(
            {.ends = {at}, .vector = NodeVector::director_1, .body = body, .directions = section, .tied = {false, true, true}});
        connect(
            {.ends = {at}, .vector = NodeVector::director_2, .body = body, .directions = section, .tied = {true, false, true}});
    }

    /// @returns index of the cell, counted from 0
    Index add(PeriodicCell cell) {
        core::with_place([&] { return label("cell", core::count(cells_), cell.name); }, [&] { cell.validate(); });
        cells_.push_back(std::move(cell));
        return core::count(cells_) - 1;
    }
    void connect(const PeriodicPair& pair) {
        if (pair.cell < 0 || pair.cell >= core::count(cells_))
            core::refuse("PeriodicPair.cell", std::to_string(pair.cell), "a cell of this assembly");
        check(pair.first), check(pair.last);
        core::with_place([&] { return "from " + station_label(pair.first) + " to " + station_label(pair.last); },
                         [&] { require_finite("PeriodicPair.period", pair.period); });
        pairs_.push_back(pair);
    }
    /// A fibre that contact sees beside its cell, too. To be added when all fibres are.
    void add(FibreImage image) {
        if (image.fibre < 0 || image.fibre >= core::count(fibres_))
            core::refuse("FibreImage.fibre", std::to_string(image.fibre), "a fibre of this assembly");
        core::with_place([&] { return "image of " + label("fibre", image.fibre, fibres_[core::at(image.fibre)].name); },
                         [&] {
                             if (image.shifts.empty()) core::refuse("FibreImage.shifts", "none", "one at least");
                             for (const FibreImage::Shift& shift : image.shifts) {
                                 if (shift.pair < 0 || shift.pair >= core::count(pairs_))
                                     core::refuse("FibreImage.shifts.pair", std::to_string(shift.pair),
                                                  "a pair of this assembly");
                                 core::require_finite("FibreImage.shifts.times", shift.times);
                             }
                         });
        images_.push_back(std::move(image));
    }
    /// A solid, for models that have a part `Solid`.
    /// @returns index of the solid, counted from 0
    Index add(Solid solid) {
        core::with_place([&] { return label("solid", core::count(solids_)); }, [&] { solid.validate(); });
        solids_.push_back(std::move(solid));
        return core::count(solids_) - 1;
    }
    /// Holds components of nodes of a solid on a path.
    void hold(const SolidHold& condition) {
        if (condition.solid < 0 || condition.solid >= core::count(solids_))
            core::refuse("SolidHold.solid", std::to_string(condition.solid), "a solid of this assembly");
        for (const Index node : condition.nodes)
            if (node < 0 || node >= core::count(solids_[core::at(condition.solid)].nodes))
                core::refuse("SolidHold.nodes", std::to_string(node), "a node of the solid");
        core::with_place([&] { return label("solid", condition.solid); }, [&] { condition.validate(); });
        solid_holds_.push_back(condition);
    }

    /// All nodal vectors of the fibres where a run begins, as an earlier run of the same fibres left them. Takes the place of
    /// the fibres' own start; their rest shapes stay. Conditions count from there.
    void begin_at(Vector state) { start_ = std::move(state); }
    const Vector& start() const noexcept { return start_; }

    /// What stands in the scene, in the order in which it was added.
    const std::vector<FibreSpecification>& fibres() const noexcept { return fibres_; }
    const std::vector<Group>& groups() const noexcept { return groups_; }
    const std::vector<Hold>& holds() const noexcept { return holds_; }
    const std::vector<DeadForce>& forces() const noexcept { return forces_; }
    const std::vector<Moment>& moments() const noexcept { return moments_; }
    const std::vector<LinePressure>& pressures() const noexcept { return pressures_; }
    const std::vector<ForcedOrder>& orders() const noexcept { return orders_; }
    const std::vector<PairRule>& rules() const noexcept { return rules_; }
    const std::vector<Tube>& tubes() const noexcept { return tubes_; }
    const std::vector<Tool>& tools() const noexcept { return tools_; }
    const std::vector<RigidBody>& bodies() const noexcept { return bodies_; }
    const std::vector<AverageConnection>& averages() const noexcept { return averages_; }
    const std::vector<PeriodicCell>& cells() const noexcept { return cells_; }
    const std::vector<PeriodicPair>& pairs() const noexcept { return pairs_; }
    const std::vector<FibreImage>& images() const noexcept { return images_; }
    const std::vector<Solid>& solids() const noexcept { return solids_; }
    const std::vector<SolidHold>& solid_holds() const noexcept { return solid_holds_; }

private:
    static std::function<Mat3(double)> by_amplitude(const Vec3& rotation) {
        if (!(rotation.norm() > 0.0)) return {};
        return [rotation](double amplitude) { return core::turn_about(rotation.normalized(), amplitude * rotation.norm()); };
    }
    /// The position of a section that is moved and turned about a pivot.
    static Hold turned_section(Station at, const Vec3& displacement, const Vec3& rotation, const Vec3& pivot,
                               const std::string& channel) {
        Hold condition;
        condition.at = at;
        condition.channel = channel;
        condition.pivot = pivot;
        condition.rotation = by_amplitude(rotation);
        condition.displacement = displacement;
        return condition;
    }
    void check(const Station& at) const {
        if (at.fibre < 0 || at.fibre >= core::count(fibres_))
            core::refuse("Station.fibre", std::to_string(at.fibre), "a fibre of this assembly");
        core::with_place([&] { return label("fibre", at.fibre, fibres_[core::at(at.fibre)].name); },
                         [&] { core::require_between("Station.fraction", at.fraction, 0.0, 1.0); });
    }
    template <class Condition>
    void check(const Station& at, const Condition& condition) const {
        check(at);
        core::with_place([&] { return station_label(at); }, [&] { condition.validate(); });
    }
    std::string group_label(Index group) const { return label("group", group, groups_[core::at(group)].name); }
    std::string station_label(const Station& at) const {
        return label("fibre", at.fibre, fibres_[core::at(at.fibre)].name) + ", at " + core::text(at.fraction) + " of its length";
    }

    std::vector<FibreSpecification> fibres_;
    std::vector<Group> groups_;
    std::vector<Hold> holds_;
    std::vector<DeadForce> forces_;
    std::vector<Moment> moments_;
    std::vector<LinePressure> pressures_;
    std::vector<ForcedOrder> orders_;
    std::map<std::pair<Index, Index>, Index> order_of_;  // by the groups above and below
    std::vector<PairRule> rules_;
    std::vector<Tube> tubes_;
    std::vector<Tool> tools_;
    std::vector<RigidBody> bodies_;
    std::vector<AverageConnection> averages_;
    std::vector<PeriodicCell> cells_;
    std::vector<PeriodicPair> pairs_;
    std::vector<FibreImage> images_;
    std::vector<Solid> solids_;
    std::vector<SolidHold> solid_holds_;
    Vector start_;
};

}  // namespace fibrant::scene
