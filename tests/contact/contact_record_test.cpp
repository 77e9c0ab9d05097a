// SPDX-License-Identifier: MIT
#include "../support/random_vector.hpp"
#include "fibres.hpp"

#include <fibrant/contact/contact_record.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace fibrant;

namespace contact_record_test {

using Memory = contact::ContactMemory<law::RegularisedPenalty, law::RegularisedCoulomb>;
using Record = Memory::Record;

static_assert(sizeof(contact::ContactRecord<law::RegularisedPenalty, law::Frictionless>) + 3 * sizeof(double) == sizeof(Record),
              "a record without friction keeps nothing of it");

Record record(int i, int j, double u_i, double u_j, double along = 0.0, double across = 0.0) {
    Record entry;
    entry.fibre_i = i, entry.fibre_j = j;
    entry.u_i = u_i, entry.u_j = u_j;
    entry.normal = Vec3::UnitZ();
    entry.friction = {along, across};
    return entry;
}

double field(double u) { return 0.3 - 0.07 * u; }

TEST_CASE("friction that is linear along a contact is carried over exactly to new places") {
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> step(0.2, 0.6), place(0.0, 6.0);
    for (const double slope : {1.0, -1.0, 0.8}) {  // abscissa of the second fibre: along, against, with longer elements
        std::vector<Record> list{record(0, 1, 2.0, 2.0, 9.0, 9.0), record(1, 2, 2.0, 2.0, 9.0, 9.0)};  // of other pairs
        const auto opposite = [&](double u) { return 5.0 + slope * (u - 3.0); };
        for (double u = 0.0; u < 6.5; u += step(generator))
            list.push_back(record(0, 2, u, opposite(u), field(u), 2.0 * field(u)));
        std::shuffle(list.begin(), list.end(), generator);
        Memory memory;
        memory.assign(list);
        for (int n = 0; n < 50; ++n) {
            const double u = place(generator);
            const auto read = memory.friction(0, 2, u, opposite(u), 0.75);
            CHECK(read.along == test::near(field(u), 1e-13));
            CHECK(read.across == test::near(2.0 * field(u), 1e-13));
        }
    }
}

TEST_CASE("beyond the last record friction is its value within range, and nothing further off") {
    Memory memory;
    memory.assign({record(0, 1, 2.0, 3.0, 0.4, -0.1), record(0, 1, 2.5, 3.5, 0.2, -0.3)});
    CHECK(memory.friction(0, 1, 2.9, 3.9, 0.75).along == 0.2);
    CHECK(memory.friction(0, 1, 1.5, 2.5, 0.75).across == -0.1);
    CHECK(memory.friction(0, 1, 3.5, 4.5, 0.75).along == 0.0);
    CHECK(memory.friction(0, 2, 2.0, 3.0, 0.75).along == 0.0);
    CHECK(memory.friction(0, 1, 2.0, 9.0, 0.75).along == 0.0);  // another contact of the same pair
    CHECK(memory.friction(0, 1, 2.0, 3.0, 0.75).along == 0.4);
    CHECK(Memory{}.friction(0, 1, 2.0, 3.0, 0.75).along == 0.0);
}

TEST_CASE("what is carried over does not depend on which fibre comes first") {
    std::vector<Record> list, turned;
    for (int k = 0; k < 8; ++k) {
        const double u = 0.5 * k, v = 6.0 - 0.45 * k, value = std::sin(1.0 * k);
        list.push_back(record(0, 1, u, v, value, -value));
        turned.push_back(record(0, 1, v, u, value, -value));
    }
    Memory memory, other;
    memory.assign(list), other.assign(turned);
    for (double u = -0.2; u < 4.0; u += 0.13) {
        const double v = 6.0 - 0.9 * u;
        CHECK(memory.friction(0, 1, u, v, 0.75).along == test::near(other.friction(0, 1, v, u, 0.75).along, 1e-12));
    }
}

TEST_CASE("the nearest record is found by brute force too") {
    std::mt19937 generator(6);
    std::uniform_real_distribution<double> place(0.0, 8.0);
    std::vector<Record> list;
    for (int k = 0; k < 300; ++k) list.push_back(record(k % 3, 3 + k % 2, place(generator), place(generator)));
    Memory memory;
    memory.assign(list);
    for (int n = 0; n < 300; ++n) {
        const double u = place(generator), v = place(generator), range = 0.8;
        double least = 1e300;
        for (const Record& entry : list)
            if (entry.fibre_i == 1 && entry.fibre_j == 4)
                least = std::min(least, std::max(std::abs(entry.u_i - u), std::abs(entry.u_j - v)));
        const Record* found = memory.nearest(1, 4, u, v, range);
        CHECK((found != nullptr) == (least <= range));
        if (found) CHECK(std::max(std::abs(found->u_i - u), std::abs(found->u_j - v)) == least);
    }
}

TEST_CASE("a station that is new beside the middle of two lines begins with what the middle remembers, on either side") {
    struct Station {
        int fibre_i = 0, fibre_j = 1;
        double u_i = 10.0, u_j = 10.0;
        int place = 0, slide = 1;
    };
    const double apart = 0.2;  // elements
    Memory memory;
    memory.assign({record(0, 1, 10.0 - apart, 10.0, -0.4, 0.1), record(0, 1, 10.0, 10.0, 0.0, 0.2),
                   record(0, 1, 10.0 + apart, 10.0, 0.4, 0.1)});
    for (const double side : {-1.0, 1.0})
        for (const double off : {-1e-14, 0.0, 1e-14}) {
            const auto read = memory.friction(Station{.u_i = 10.0 + off, .u_j = 10.0 + side * apart}, 0.75);
            CHECK(read.along == 0.0);
            CHECK(read.across == 0.2);
        }
}

TEST_CASE("a tangential vector is rebuilt from its two components, and turns with the fibres") {
    std::mt19937 generator(7);
    std::normal_distribution<double> value;
    for (int n = 0; n < 100; ++n) {
        const Vec3 normal = test::random_vector(value, generator).normalized();
        const Vec3 tangent = n % 10 == 0 ? normal : test::random_vector(value, generator).normalized();
        Vec3 slip = test::random_vector(value, generator);
        slip -= slip.dot(normal) * normal;
        const contact::TangentPlane plane(tangent, normal);
        CHECK(std::abs(plane.along.norm() - 1.0) < 1e-14);
        CHECK(std::abs(plane.across.norm() - 1.0) < 1e-14);
        CHECK(std::abs(plane.along.dot(plane.across)) < 1e-14);
        CHECK(std::abs(plane.along.dot(normal)) < 1e-13);
        const double along = slip.dot(plane.along), across = slip.dot(plane.across);
        CHECK((along * plane.along + across * plane.across - slip).norm() < 1e-13);
        if (n % 10 == 0) continue;  // at the end of a fibre its tangent gives no direction
        const Mat3 turn = Eigen::AngleAxisd(0.1 + n, test::random_vector(value, generator).normalized()).toRotationMatrix();
        const contact::TangentPlane turned(turn * tangent, turn * normal);
        CHECK((along * turned.along + across * turned.across - turn * slip).norm() < 1e-11);
    }
}

TEST_CASE("a record is its numbers, for files") {
    const Record entry = record(3, 5, 1.25, 2.5, 0.1, 0.2);
    std::vector<double> numbers;
    entry.each([&](const auto& number) { numbers.push_back(static_cast<double>(number)); });
    CHECK(numbers == std::vector<double>{3, 5, 1.25, 2.5, 0, 0, 1, 0.1, 0.2, 1});
}

}  // namespace contact_record_test
