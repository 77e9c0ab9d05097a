// SPDX-License-Identifier: MIT
// What contacts of closed fibres remember, around the seam.
#include <fibrant/contact/contact_record.hpp>
#include <fibrant/contact/zone_stiffness.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace closed_contact_record_test {

using Memory = contact::ContactMemory<law::RegularisedPenalty, law::RegularisedCoulomb>;

Memory::Record record(std::int32_t i, std::int32_t j, double u_i, double u_j, const Vec3& normal, double along, double across,
                      double sign) {
    Memory::Record one;
    one.fibre_i = i, one.fibre_j = j, one.u_i = u_i, one.u_j = u_j, one.normal = normal;
    one.friction.along = along, one.friction.across = across, one.friction.sign = sign;
    return one;
}

TEST_CASE("a contact that slips over the seam of a closed fibre finds what it was") {
    const Memory memory({40.0, 0.0}, {record(0, 1, 0.1, 7.0, Vec3::UnitX(), 0.2, 0.3, 1.0),
                                      record(0, 1, 20.0, 7.0, Vec3::UnitY(), 0.4, 0.5, 1.0)});
    const auto* found = memory.nearest(0, 1, 39.9, 7.1, 1.5);
    REQUIRE(found != nullptr);
    CHECK(found->normal == Vec3::UnitX());
    CHECK(memory.friction(0, 1, 39.9, 7.1, 0.75).along == 0.2);
    CHECK(memory.nearest(0, 1, 37.0, 7.0, 1.5) == nullptr);
    CHECK(memory.nearest(0, 1, 39.9, 33.0, 1.5) == nullptr);
    // Between records on both sides of the seam friction is interpolated.
    const Memory both({40.0, 0.0}, {record(0, 1, 0.1, 7.1, Vec3::UnitX(), 0.2, 0.0, 1.0),
                                    record(0, 1, 39.7, 6.7, Vec3::UnitX(), 0.4, 0.0, 1.0)});
    CHECK(both.friction(0, 1, 39.8, 6.8, 0.75).along == test::near(0.35, 1e-12));
    // Without a period nothing goes around.
    CHECK(Memory({}, {record(0, 1, 0.1, 7.0, Vec3::UnitX(), 0.2, 0.3, 1.0)}).nearest(0, 1, 39.9, 7.1, 1.5) == nullptr);
}

TEST_CASE("on one closed fibre it is found with its particles the other way around") {
    const Memory memory({40.0}, {record(0, 0, 0.1, 15.0, Vec3::UnitX(), 0.2, 0.3, -1.0)});
    const auto* found = memory.nearest(0, 0, 15.1, 39.9, 1.5);  // the first particle is at -0.1 now
    REQUIRE(found != nullptr);
    CHECK(found->normal == -Vec3::UnitX());
    // From the other particle the slip is opposite. The direction between t_i and sign t_j is sign times that between t_j and
    // sign t_i, the normal is opposite, and so is normal x direction times sign.
    CHECK(found->friction.along == 0.2);
    CHECK(found->friction.across == -0.3);
    CHECK(found->friction.sign == -1.0);
}

TEST_CASE("a zone keeps its stiffness across the seam, with either part first") {
    std::vector<contact::Zone> before(1);
    before[0].span = {0, 0, 38.0, 41.0, 12.0, 15.0, 39.0, 13.0, 0.1};
    const std::vector<double> periods{40.0};
    const auto has = [&](double a_i, double b_i, double a_j, double b_j) {
        return contact::predecessor(before, {0, 0, a_i, b_i, a_j, b_j, a_i, a_j, 0.1}, 1.0, periods) != nullptr;
    };
    CHECK(has(0.5, 1.5, 14.0, 16.0));
    CHECK(has(13.0, 15.0, 39.5, 41.0));
    CHECK_FALSE(has(20.0, 22.0, 12.0, 15.0));
}

}  // namespace closed_contact_record_test
