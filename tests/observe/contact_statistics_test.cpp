// SPDX-License-Identifier: MIT
#include "observe/snapshot_samples.hpp"

#include <fibrant/observe/contact_statistics.hpp>
#include <fibrant/observe/loading_curve.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace contact_statistics_test {

using namespace fibrant::observe;

TEST_CASE("statistics count all elements, and weigh those that press") {
    const ContactStatistics figures = contact_statistics(crossing_pair(), 4);
    CHECK(figures.elements == 2);
    CHECK(figures.active == 1);
    CHECK(figures.crossings == 1);
    CHECK(figures.fibre_pairs == 1);
    CHECK(figures.least_gap == -0.005);
    CHECK(figures.greatest_penetration == 0.005);
    CHECK(figures.greatest_penetration_over_radius == test::near(0.05, 1e-12));  // of the thinner fibre
    CHECK(figures.sum_of_reactions == 2.0);
    CHECK(figures.sum_of_friction == test::near(0.5, 1e-12));
    CHECK(figures.orientation == Mat3(Vec3(0, 0, 1).asDiagonal()));
}

TEST_CASE("a penetration is weighed by the thinner of two fibres, whichever comes first") {
    Snapshot turned = crossing_pair();
    for (ContactSnapshot& contact : turned.contacts) std::swap(contact.fibre_i, contact.fibre_j);
    CHECK(contact_statistics(turned).greatest_penetration_over_radius == test::near(0.05, 1e-12));
}

TEST_CASE("a histogram holds every active element once, the strongest in the last bin") {
    Snapshot snapshot = crossing_pair();
    const ContactSnapshot closed = snapshot.contacts.front();
    for (const double reaction : {0.1, 0.9, 1.1, 1.9}) {
        snapshot.contacts.push_back(closed);
        snapshot.contacts.back().reaction = reaction;
        std::swap(snapshot.contacts.back().fibre_i, snapshot.contacts.back().fibre_j);
    }
    const ContactStatistics figures = contact_statistics(snapshot, 4);
    CHECK(figures.reaction.high == 2.0);
    CHECK(figures.reaction.counts == std::vector<Index>{1, 1, 1, 2});
    CHECK(figures.penetration.counts == std::vector<Index>{0, 0, 0, 5});
    CHECK(figures.fibre_pairs == 2);
    CHECK(figures.orientation.trace() == test::near(1.0, 1e-12));
}

TEST_CASE("a scene without contacts has statistics all the same") {
    Snapshot snapshot = crossing_pair();
    snapshot.contacts.clear();
    const ContactStatistics figures = contact_statistics(snapshot);
    CHECK(figures.elements == 0);
    CHECK(figures.greatest_penetration == 0.0);
    CHECK(figures.orientation.isZero());
    CHECK(figures.reaction.counts.size() == 20);
}

TEST_CASE("a loading curve collects one quantity against progress") {
    LoadingCurve reactions;
    LoadingCurve heights([](const Snapshot& snapshot) { return snapshot.fibres[1].position[0].z(); });
    Snapshot snapshot = crossing_pair();
    for (const double progress : {0.5, 1.0}) {
        snapshot.progress = progress;
        snapshot.contacts[1].reaction = progress;
        reactions.accepted(snapshot);
        heights.accepted(snapshot);
    }
    REQUIRE(reactions.points().size() == 2);
    CHECK(reactions.points()[0].progress == 0.5);
    CHECK(reactions.points()[0].value == 2.5);
    CHECK(reactions.points()[1].value == 3.0);
    CHECK(heights.points()[1].value == 0.3);
    static_assert(Observer<decltype(heights)>);
}

}  // namespace contact_statistics_test
