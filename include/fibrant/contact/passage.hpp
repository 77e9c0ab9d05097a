// SPDX-License-Identifier: MIT
#pragma once
/// @file Whether a motion takes fibres through each other, through themselves or through tools: what no contact element may have
/// seen.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/bore_passage.hpp>
#include <fibrant/contact/contact_detection.hpp>
#include <fibrant/contact/passed_pair.hpp>
#include <fibrant/core/ordering.hpp>
#include <fibrant/proximity/moving_segments.hpp>
#include <fibrant/scene/tool.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::contact {

/// No check: for scenes in which nothing can pass through anything. A model says `using Passage = contact::NoPassage;`.
struct NoPassage : core::Inactive {
    using Parameters = core::NoParameters;
    explicit NoPassage(const Parameters& = {}) {}
    template <beam::BeamElement B>
    struct Of : core::Inactive {
        Of(const beam::Mesh<B>&, const Detection&) {}
    };
};

/// Checks the motion between two states of all fibres, each point on a straight line, for pairs that change sides.
///
/// Two that touch stay about as far apart as their surfaces say while they slide and roll on each other; what passes through
/// comes closer on its way than it is before and after. A pair has passed if its centrelines come closer than half of the least
/// of that: the smaller half widths of the sections at rest, and the distances of the two segments at the start and at the end.
/// So has a pair that was apart by more than half of these widths all along, and ends nearer somewhere: no law lets fibres so
/// deep, and what creeps through in many small motions has to come by there. Straight ways cut corners: one that goes round
/// another one by 120 degrees at once counts as having passed, and is cut. Where a fibre ends, it may slip off: within a touching
/// distance of its ends only centrelines that meet have passed. Pairs that a law with a limited gap parts have no side yet, and
/// those in a forced order may go the way it forces them. Images of fibres across the seams of a cell are fibres, which go on
/// where another one ends. Fibres in a tube pass if they come into its wall. Owes nothing to contact elements, and what moves
/// together costs nothing. The number of threads changes no bit.
struct Swept {
    using Parameters = core::NoParameters;
    explicit Swept(const Parameters& = {}) {}

    template <beam::BeamElement B>
    class Of {
    public:
        Of(const beam::Mesh<B>& mesh, const Detection& detection) : mesh_{&mesh}, self_{detection.self_contact} {}

        /// @param from, to        states
        /// @param forced          pairs in a forced order are pushed along its axis
        /// @param tools_moved     tools go from where they were accepted to where they are, instead of standing there
        template <class Contacts>
        std::optional<PassedPair> first(const Vector& from, const Vector& to, const Contacts& contacts, bool forced,
                                        bool tools_moved) const {
            if (!from.allFinite() || !to.allFinite()) return {};
            const Lines lines(*mesh_, from, to);
            std::vector<PassedPair> passed = between_fibres(lines, contacts, forced);
            const std::vector<PassedPair> out = through_walls(*mesh_, from, to);
            core::append(passed, out);
            if constexpr (requires { contacts.tools(); }) {
                const std::vector<PassedPair> through = through_tools(lines, contacts.tools(), tools_moved);
                core::append(passed, through);
            }
            if (passed.empty()) return {};
            PassedPair answer = passed.front();
            for (const PassedPair& pair : passed)
                if (pair.time < answer.time) answer = pair;
            if (answer.image) answer.other = mesh_->source(answer.other);
            for (const PassedPair& pair : passed) answer.touch = std::min(answer.touch, pair.touch);
            return answer;
        }

    private:
        static constexpr double share = 0.5;     // of the distance that two should keep
        static constexpr double meeting = 0.02;  // of the half widths: centrelines meet
        static constexpr double nothing =
            1e-3;  // of the half widths: closer than that at the start or the end, and there is no side
        static constexpr double chord_bound = 0.1;  // deviation of the curve from its segments, over the smaller half width
        static constexpr Index finest_cut = 16;

        /// Segments of all fibres, on their way.
        struct Lines {
            const beam::Mesh<B>& mesh;
            std::vector<Index> first, cut;  // segment of each fibre, and one more; segments an element
            std::vector<std::int32_t> fibre;
            std::vector<proximity::MovingSegment> segments;
            std::vector<double> half;  // smaller half width of each fibre

            Lines(const beam::Mesh<B>& of, const Vector& from, const Vector& to) : mesh{of}, first(1, 0) {
                for (Index f = 0; f < mesh.line_count(); ++f) {
                    const scene::CrossSection& section = mesh.fibre(f).section;
                    half.push_back(std::min(section.semi_axis_1, section.semi_axis_2));
                    double bend = 0.0;
                    for (Index e = 0; e < mesh.fibre(f).elements; ++e)
                        bend = std::max({bend, mesh.greatest_bend(from, f, e), mesh.greatest_bend(to, f, e)});
                    const double wanted = std::ceil(std::sqrt(0.125 * bend / (chord_bound * half.back())));
                    cut.push_back(std::clamp<Index>(static_cast<Index>(std::min(wanted, 1e3)), 1, finest_cut));
                    first.push_back(first.back() + cut.back() * mesh.fibre(f).elements);
                    fibre.insert(fibre.end(), core::at(first.back() - first[core::at(f)]), static_cast<std::int32_t>(f));
                }
                segments.resize(core::at(first.back()));
                core::parallel_for(
                    mesh.line_count(),
                    [&](Index f) {
                        Vec3 start = mesh.position(from, f, 0.0), start_motion = mesh.position(to, f, 0.0) - start;
                        for (Index k = first[core::at(f)]; k < first[core::at(f) + 1]; ++k) {
                            const double u = abscissa(k, 1.0);
                            const Vec3 end = mesh.position(from, f, u), end_motion = mesh.position(to, f, u) - end;
                            segments[core::at(k)] = {start, end, start_motion, end_motion};
                            start = end, start_motion = end_motion;
                        }
                    },
                    mesh.grain());
            }
            Index of(Index k) const noexcept { return fibre[core::at(k)]; }
            /// In elements, at a share s of segment k.
            double abscissa(Index k, double s) const noexcept {
                return (static_cast<double>(k - first[core::at(of(k))]) + s) / static_cast<double>(cut[core::at(of(k))]);
            }
            double along(Index k, double s) const noexcept {
                return abscissa(k, s) / static_cast<double>(mesh.fibre(of(k)).elements);
            }
            /// Is it further than `length` from the ends of its fibre, along it at rest?
            bool inside(Index k, double s, double length) const noexcept {
                const beam::MeshFibre& fibre_of = mesh.fibre(of(k));
                if (fibre_of.closed || fibre_of.goes_on) return true;
                const double arc = abscissa(k, s) * fibre_of.element_length;
                return arc > length && fibre_of.length() - arc > length;
            }
            /// Segments k < l of two fibres that may touch: of a fibre and the image that goes on where it ends, those beyond an
            /// arc; images do not touch each other.
            bool apart(Index k, Index l) const noexcept {
                const beam::MeshFibre& image = mesh.fibre(of(l));
                if (image.image_of < 0) return true;
                if (mesh.fibre(of(k)).image_of >= 0) return false;
                if (image.image_of != of(k) || image.joins == 0) return true;
                const double end = static_cast<double>(image.elements);
                const double arc =
                    image.joins > 0 ? end - abscissa(k, 1.0) + abscissa(l, 0.0) : end - abscissa(l, 1.0) + abscissa(k, 0.0);
                return arc * image.element_length > self_contact_arc(image.section.radius(), image.element_length);
            }
            /// Segments k < l of one fibre that may touch.
            bool beyond_arc(Index k, Index l) const noexcept {
                const beam::MeshFibre& fibre_of = mesh.fibre(of(k));
                const double least =
                    self_contact_arc(fibre_of.section.radius(), fibre_of.element_length) / fibre_of.element_length;
                if (fibre_of.closed && abscissa(k, 0.0) + static_cast<double>(fibre_of.elements) - abscissa(l, 1.0) <= least)
                    return false;
                return abscissa(l, 0.0) - abscissa(k, 1.0) > least;
            }
        };

        template <class Item>
        static std::vector<Item> joined(const std::vector<std::vector<Item>>& parts) {
            std::vector<Item> all;
            for (const auto& part : parts) core::append(all, part);
            return all;
        }

        template <class Contacts>
        std::vector<PassedPair> between_fibres(const Lines& lines, const Contacts& contacts, bool forced) const {
            if (mesh_->line_count() < 2 && !self_) return {};
            std::vector<double> margins(lines.segments.size());
            for (std::size_t k = 0; k < margins.size(); ++k) margins[k] = share * lines.half[core::at(lines.fibre[k])];
            proximity::MovingTree tree(lines.segments, margins);
            std::vector<std::vector<PassedPair>> found(core::at(tree.make_tasks())), sunk(found.size());
            std::vector<std::vector<Fibres>> deep(found.size());  // pairs that were below half before: nothing holds them apart
            const std::vector<Fibres> parting = pairs_that_part(contacts);
            tree.visit_pairs([&](Index task, Index k, Index l) {
                const Index i = lines.of(k), j = lines.of(l);
                if (i == j ? !self_ || !lines.beyond_arc(k, l) : !lines.apart(k, l)) return;
                if (bore_between(*mesh_, i, j) != no_bore) return;
                const proximity::MovingSegment &a = lines.segments[core::at(k)], &b = lines.segments[core::at(l)];
                const double widths = lines.half[core::at(i)] + lines.half[core::at(j)],
                             motion = proximity::relative_motion(a, b);
                const double before = std::sqrt(proximity::segment_distance(a, b, 0.0).squared);
                if (before - share * widths >= motion) return;
                const double after = std::sqrt(proximity::segment_distance(a, b, 1.0).squared);
                const double least = std::min({widths, before, after});
                if (before < share * widths)
                    deep[core::at(task)].emplace_back(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
                const bool sinks = before >= share * widths && after < share * widths;
                if (least < nothing * widths && !sinks) return;
                const double near = share * (sinks ? widths : least),
                             touching = mesh_->fibre(i).section.radius() + mesh_->fibre(j).section.radius();
                const auto at_ends = [&](double s, double t) {
                    return !lines.inside(k, s, touching) || !lines.inside(l, t, touching);
                };
                const proximity::Approach at = proximity::first_approach(a, b, near, std::min(near, meeting * widths), at_ends);
                if (!at.close) return;
                const Vec3 motion_a = a.start_motion + at.s * (a.end_motion - a.start_motion),
                           motion_b = b.start_motion + at.t * (b.end_motion - b.start_motion);
                if (may_pass(i, j, before, widths, Vec3(motion_b - motion_a), parting, contacts, forced, lines.along(k, at.s),
                             lines.along(l, at.t)))
                    return;
                PassedPair pair;
                pair.fibre = i, pair.other = j, pair.image = mesh_->fibre(j).image_of >= 0, pair.along = lines.along(k, at.s),
                pair.along_other = lines.along(l, at.t);
                pair.place =
                    0.5 * (a.start_at(at.time) + at.s * a.chord_at(at.time) + b.start_at(at.time) + at.t * b.chord_at(at.time));
                pair.motion = (motion_b - motion_a).norm(), pair.time = at.time, pair.left = after / widths;
                pair.touch = proximity::first_approach(a, b, touching, touching, [](double, double) { return false; }).time;
                (sinks ? sunk : found)[core::at(task)].push_back(pair);
            });
            std::vector<PassedPair> passed = joined(found);
            const std::vector<Fibres> held_by_nothing = once_each(joined(deep));
            for (const PassedPair& pair : joined(sunk))
                if (!has(held_by_nothing, pair.fibre, pair.other)) passed.push_back(pair);
            return passed;
        }

        using Fibres = std::pair<std::int32_t, std::int32_t>;
        static std::vector<Fibres> once_each(std::vector<Fibres> pairs) {
            std::sort(pairs.begin(), pairs.end());
            pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
            return pairs;
        }
        static bool has(const std::vector<Fibres>& pairs, Index i, Index j) {
            return std::binary_search(pairs.begin(), pairs.end(),
                                      Fibres(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)));
        }

        /// Pairs of fibres whose gap a law limits.
        template <class Contacts>
        static std::vector<Fibres> pairs_that_part(const Contacts& contacts) {
            std::vector<Fibres> pairs;
            for (const auto& element : contacts.elements())
                if (element.shift.value() > 0.0) pairs.emplace_back(element.fibre_i, element.fibre_j);
            return once_each(std::move(pairs));
        }

        /// @param before    distance of the two segments at the start [length]
        /// @param widths    sum of the smaller half widths [length]
        /// @param motion    of j against i [length]
        /// @param at_i, at_j  where along both, over their lengths
        template <class Contacts>
        bool may_pass(Index i, Index j, double before, double widths, const Vec3& motion, const std::vector<Fibres>& parting,
                      const Contacts& contacts, bool forced, double at_i, double at_j) const {
            if (has(parting, i, j)) return true;
            if constexpr (requires { contacts.normal_law().limit(); })
                if (std::isfinite(contacts.normal_law().limit()) && before < share * widths) return true;
            const Index order = forced ? contacts.orders().between(i, j, at_i, at_j) : -1;
            return order >= 0 && motion.dot(contacts.orders().direction(order, i)) > 0.0;
        }

        template <class Tools>
        std::vector<PassedPair> through_tools(const Lines& lines, const Tools& tools, bool moved) const {
            std::vector<std::vector<PassedPair>> found(core::at(mesh_->fibre_count()));
            core::parallel_for(
                mesh_->fibre_count(),
                [&](Index f) {
                    for (Index t = 0; t < core::count(tools.tools()); ++t) {
                        if constexpr (requires { tools.carries(f, t); })
                            if (tools.carries(f, t)) continue;
                        const scene::Tool& tool = tools.tools()[core::at(t)];
                        const scene::ToolPose &now = tools.pose(t), &before = moved ? tools.accepted_pose(t) : now;
                        for (Index k = lines.first[core::at(f)]; k < lines.first[core::at(f) + 1]; ++k) {
                            const proximity::MovingSegment& way = lines.segments[core::at(k)];
                            // In the tool's own axes, in which it stands still.
                            proximity::MovingSegment seen;
                            seen.start = before.material(way.start), seen.end = before.material(way.end);
                            seen.start_motion = now.material(way.start + way.start_motion) - seen.start;
                            seen.end_motion = now.material(way.end + way.end_motion) - seen.end;
                            if (const auto at = beyond(lines, k, tool, seen)) {
                                PassedPair pair;
                                pair.fibre = f, pair.other = t, pair.tool = true, pair.along = lines.along(k, at->s);
                                pair.place = now.place(seen.start_at(1.0) + at->s * seen.chord_at(1.0));
                                pair.motion = std::max(seen.start_motion.norm(), seen.end_motion.norm()), pair.time = at->time;
                                pair.touch = at->t;
                                found[core::at(f)].push_back(pair);
                            }
                        }
                    }
                },
                mesh_->grain());
            return joined(found);
        }

        /// Where a segment gets to the other side of a tool that stands still, if it does: through its axis or its middle, or
        /// under its surface.
        /// @returns with the time at which they touch in the place of t
        std::optional<proximity::Approach> beyond(const Lines& lines, Index k, const scene::Tool& tool,
                                                  const proximity::MovingSegment& way) const {
            const double half = lines.half[core::at(lines.of(k))], widths = tool.radius + half;
            if (tool.shape == scene::ToolShape::surface) return into_body(tool, way, half);
            for (const double s : {0.0, 1.0}) {  // a surface that curves away from fibres, or not at all, is nearest at ends
                const Vec3 from = s == 0.0 ? way.start : way.end, to = from + (s == 0.0 ? way.start_motion : way.end_motion);
                const double before = scene::tool_distance(tool, from).distance, after = scene::tool_distance(tool, to).distance;
                if (before >= 0.0 && after < 0.0)
                    return proximity::Approach{true, before / (before - after), s,
                                               std::max(0.0, (before - half) / (before - after)), 0.0};
            }
            if (tool.shape == scene::ToolShape::plane || tool.hollow) return {};
            proximity::MovingSegment middle{tool.origin, tool.origin, Vec3::Zero(), Vec3::Zero()};
            if (tool.shape == scene::ToolShape::cylinder) {  // as much of its axis as the segment faces
                double low = 0.0, high = 0.0;
                for (const Vec3& x : {way.start, way.end, Vec3(way.start + way.start_motion), Vec3(way.end + way.end_motion)}) {
                    const double place = tool.axis.dot(x - tool.origin);
                    low = std::min(low, place), high = std::max(high, place);
                }
                middle.start += low * tool.axis, middle.end += high * tool.axis;
            }
            const auto touch = [&] {
                return proximity::first_approach(way, middle, widths, widths, [](double, double) { return false; }).time;
            };
            const proximity::SegmentDistance start = proximity::segment_distance(way, middle, 0.0),
                                             end = proximity::segment_distance(way, middle, 1.0);
            const double before = std::sqrt(start.squared), after = std::sqrt(end.squared);
            if (before >= tool.radius && after < tool.radius) return proximity::Approach{true, 1.0, end.s, touch(), after};
            const double least = std::min({widths, before, after});
            if (before - share * widths >= proximity::relative_motion(way, middle) || least < nothing * widths) return {};
            const double end_zone = half + std::min(tool.radius, 2.0 * half);
            const auto at_ends = [&](double s, double) { return !lines.inside(k, s, end_zone); };
            proximity::Approach at =
                proximity::first_approach(way, middle, share * least, std::min(share * least, meeting * widths), at_ends);
            if (!at.close) return {};
            at.t = touch();
            return at;
        }

        /// The same of a body of any shape, which may be thin: points of the segment, half a fibre's width apart, go their way in
        /// steps that are no longer than what is free about them.
        static std::optional<proximity::Approach> into_body(const scene::Tool& tool, const proximity::MovingSegment& way,
                                                            double half) {
            const auto points = static_cast<Index>(std::ceil((way.end - way.start).norm() / half));
            for (Index k = 0; k <= points; ++k) {
                const double s = points > 0 ? static_cast<double>(k) / static_cast<double>(points) : 0.0;
                const Vec3 from = way.start + s * (way.end - way.start),
                           motion = way.start_motion + s * (way.end_motion - way.start_motion);
                const double length = motion.norm();
                double free = scene::tool_distance(tool, from).distance, touch = 1.0;
                if (free < 0.0 || free >= length) continue;  // it has been there before, or does not get there
                for (double time = 0.0; time < 1.0;) {
                    if (free < half) touch = std::min(touch, time);
                    time = std::min(1.0, time + std::max(free, meeting * half) / length);
                    free = scene::tool_distance(tool, from + time * motion).distance;
                    if (free < 0.0) return proximity::Approach{true, time, s, std::min(touch, time), 0.0};
                }
            }
            return {};
        }

        const beam::Mesh<B>* mesh_;
        bool self_;
    };
};

}  // namespace fibrant::contact
