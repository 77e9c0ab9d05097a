// SPDX-License-Identifier: MIT
#include "search_contract.hpp"

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/automatic_search.hpp>
#include <fibrant/proximity/bvh_search.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/proximity/kd_tree_search.hpp>
#include <fibrant/proximity/test_point_search.hpp>
#include <fibrant/proximity/verlet_search.hpp>

#include <filesystem>
#include <fstream>

using namespace fibrant;

namespace search_test {

using namespace fibrant::proximity;
using fibrant::test::FibreSet;

/// Scene file: 8 bytes FIBPOL01, u64 fibres F, u64 vertices V, f64 margin, u64 skipped segments, F f64 radii,
/// F + 1 u64 first vertices, 3 V f64 coordinates; little endian.
FibreSet read_scene(const char* name) {
    std::ifstream in(std::filesystem::path(__FILE__).parent_path() / "scenes" / name, std::ios::binary);
    REQUIRE(in);
    const auto word = [&] {
        std::uint64_t value = 0;
        in.read(reinterpret_cast<char*>(&value), 8);
        return value;
    };
    const auto number = [&] { return std::bit_cast<double>(word()); };
    word();
    const std::uint64_t fibres = word();
    word();
    FibreSet set{.name = name, .reach = number()};
    word();
    for (std::uint64_t f = 0; f < fibres; ++f) set.radius.push_back(number());
    std::vector<std::uint64_t> first;
    for (std::uint64_t f = 0; f <= fibres; ++f) first.push_back(word());
    set.points.resize(fibres);
    for (std::uint64_t f = 0; f < fibres; ++f)
        for (std::uint64_t k = first[f]; k < first[f + 1]; ++k) {
            const double x = number(), y = number(), z = number();
            set.points[f].push_back({x, y, z});
        }
    REQUIRE(in);
    return set;
}

/// Independent of order: sum of splitmix64 of (i << 32) | j.
std::uint64_t checksum(const std::vector<SegmentPair>& pairs) {
    std::uint64_t sum = 0;
    for (const SegmentPair& pair : pairs) {
        std::uint64_t z = ((static_cast<std::uint64_t>(pair.i) << 32) | static_cast<std::uint64_t>(pair.j)) + 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        sum += z ^ (z >> 31);
    }
    return sum;
}

/// Each search with what parameters it has.
template <class Search>
Search make_search([[maybe_unused]] double spacing = 0.17, [[maybe_unused]] double skin = 0.05) {
    if constexpr (std::same_as<Search, TestPointSearch>)
        return Search{{.spacing = spacing}};
    else if constexpr (requires(Search search) { search.builds(); })
        return Search{{.base = {}, .skin = skin}};
    else
        return Search{typename Search::Parameters{}};
}

struct Threads {  // OpenMP's number of threads, put back at the end
    explicit Threads([[maybe_unused]] int n) {
#if defined(_OPENMP)
        omp_set_num_threads(n);
#endif
    }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;
    ~Threads() {
#if defined(_OPENMP)
        omp_set_num_threads(before);
#endif
    }
    int before = core::threads();
};

#define EVERY_SEARCH                                                                                              \
    AutomaticSearch, BruteSearch, BvhSearch, GridSearch, KdTreeSearch, TestPointSearch, VerletSearch<GridSearch>, \
        VerletSearch<KdTreeSearch>

TEST_CASE_TEMPLATE("a search finds the close pairs and zones that brute force finds, and no other", Search, EVERY_SEARCH) {
    static const std::vector<FibreSet> sets = test::search_cases();
    static const std::vector<std::vector<SegmentPair>> expected = [] {
        std::vector<std::vector<SegmentPair>> all;
        for (const FibreSet& set : sets) all.push_back(BruteSearch{}.pairs(set.centrelines(), set.reach));
        return all;
    }();
    Search search = make_search<Search>();
    for (std::size_t k = 0; k < sets.size(); ++k) test::check_search(search, sets[k], expected[k]);
}

TEST_CASE("brute force agrees with the definition of a close pair on sampled segments") {
    // The only check that does not go through the shared filter: distances of 11 x 11 points of two segments bound the true
    // distance from above, and exceed it by at most half a step on each segment.
    for (const FibreSet& set : test::search_cases()) {
        CAPTURE(set.name);
        if (!set.family.empty() || std::isfinite(set.self_skip) || set.points.size() > 70) continue;
        const auto pairs = BruteSearch{}.pairs(set.centrelines(), set.reach);
        int missed = 0, added = 0;
        Index first_f = 0;
        for (std::size_t f = 0; f < set.points.size(); ++f) {
            Index first_g = 0;
            for (std::size_t g = 0; g < set.points.size(); ++g) {
                for (std::size_t k = 0; f < g && k + 1 < set.points[f].size(); ++k)
                    for (std::size_t l = 0; l + 1 < set.points[g].size(); ++l) {
                        const Vec3 u = set.points[f][k + 1] - set.points[f][k], v = set.points[g][l + 1] - set.points[g][l];
                        double least = 1e300;
                        for (int a = 0; a <= 10; ++a)
                            for (int b = 0; b <= 10; ++b)
                                least = std::min(least,
                                                 Vec3(set.points[f][k] + a / 10.0 * u - set.points[g][l] - b / 10.0 * v).norm());
                        const double threshold = set.radius[f] + set.radius[g] + set.reach;
                        const SegmentPair pair{static_cast<std::int32_t>(first_f + static_cast<Index>(k)),
                                               static_cast<std::int32_t>(first_g + static_cast<Index>(l))};
                        const bool found = std::ranges::binary_search(pairs, pair);
                        if (!found && least < threshold * (1.0 - 1e-9)) ++missed;
                        if (found && least > threshold + 0.05 * (u.norm() + v.norm())) ++added;
                    }
                first_g += core::count(set.points[g]) - 1;
            }
            first_f += core::count(set.points[f]) - 1;
        }
        CHECK(missed == 0);
        CHECK(added == 0);
    }
}

TEST_CASE_TEMPLATE("a search finds the published pairs of a random mat of 10,000 segments", Search, BvhSearch, GridSearch,
                   KdTreeSearch, TestPointSearch, VerletSearch<GridSearch>) {
    const FibreSet set = read_scene("mat10k.fpl");
    Search search = make_search<Search>(4.0 * set.radius[0], set.radius[0]);
    const auto pairs = search.pairs(set.centrelines(), set.reach);
    CHECK(pairs.size() == 11587);  // count and checksum published with the scene
    CHECK(checksum(pairs) == 0xbf1345c216ac6e59u);
}

TEST_CASE("the automatic search takes the tree for mixtures of sizes and straight tows, and the grid for what else there is") {
    AutomaticSearch search;
    const auto tree = [&](const FibreSet& set) { return search.pairs(set.centrelines(), set.reach), search.takes_tree(); };
    const FibreSet crowd = test::random_fibres(18, 100, 10, 0.2, 0.2, 1.0);
    CHECK_FALSE(tree(crowd));
    FibreSet mixed = crowd, few = crowd, thin = crowd;
    for (std::size_t f = 0; f < 100; f += 2) mixed.radius[f] = 1.0;
    few.radius[0] = few.radius[1] = 1.0;
    for (std::size_t f = 2; f < 100; ++f) thin.radius[f] = 1.0;
    CHECK(tree(mixed));
    CHECK(tree(few));  // one thick fibre makes the cells of a grid too large for all others
    CHECK_FALSE(tree(thin));
    FibreSet tow{.name = "tow", .reach = 0.05}, mat = tow;
    std::mt19937 random(3);
    for (int f = 0; f < 40; ++f)
        tow.add({{2.02 * f, 0.0, 0.0}, {2.02 * f, 0.0, 1e3}}, 1.0),
            mat.add({Vec3::Zero(), Vec3(1e3 * test::uniform_vector(random))}, 1.0);
    CHECK(tree(tow));
    CHECK_FALSE(tree(mat));
}

TEST_CASE("neither a stray fibre nor long straight ones cost the precision and the memory of all") {
    const FibreSet crowd = test::random_fibres(18, 100, 10, 0.2, 0.2, 1.0);
    FibreSet stray = crowd;
    stray.add({{1e9, 1e9, -1e9}, {1e9, 1e9, 1 - 1e9}}, 0.05);
    const std::vector<Centreline> lines = crowd.centrelines(), with = stray.centrelines();
    const detail::BoxFrame alone(detail::SegmentTable(lines, crowd.reach)), both(detail::SegmentTable(with, crowd.reach));
    CHECK(both.slack < 2.0 * alone.slack);  // it was a billion times as much
    FibreSet tow{.name = "tow", .reach = 0.05};
    for (int f = 0; f < 400; ++f)
        tow.add({{2.02 * (f % 20), 2.02 * (f / 20), 0.0}, {2.02 * (f % 20), 2.02 * (f / 20), 3e5}}, 1.0);
    GridSearch search;
    CHECK(search.pairs(tow.centrelines(), tow.reach).size() == 2 * 20 * 19);
    CHECK(search.bytes() < 2000 * 400);  // eight pieces a segment at most
}

TEST_CASE_TEMPLATE("a search that gives its memory back has as little as a new one, and finds the same again", Search, BvhSearch,
                   GridSearch, AutomaticSearch) {
    const FibreSet set = test::random_fibres(18, 100, 10, 0.2, 0.2, 1.0);
    const std::vector<Centreline> lines = set.centrelines();
    Search search;
    const auto found = search.pairs(lines, set.reach);
    CHECK(search.bytes() > 1000);
    search.release();
    CHECK(search.bytes() == Search().bytes());
    CHECK(search.pairs(lines, set.reach) == found);
}

TEST_CASE_TEMPLATE("fibres that only just touch are found however far away another one is", Search, BvhSearch, GridSearch,
                   AutomaticSearch) {
    FibreSet set{.name = "pairs and a stray fibre", .reach = 0.1};
    std::mt19937 random(4);
    for (int k = 0; k < 200; ++k) {
        const Vec3 at = Vec3(0.0, 3.7 * k, 0.0) + test::uniform_vector(random);
        for (const double y : {0.0, 0.3 * (1.0 - 1e-9)}) set.add({at + Vec3(0, y, 0), at + Vec3(1, y, 0)}, 0.1);
    }
    Search search = make_search<Search>();
    CHECK(search.pairs(set.centrelines(), set.reach).size() == 200);
    set.add({Vec3::Constant(1e14), Vec3(1e14, 1e14, 1e14 + 1.0)}, 0.1);
    CHECK(search.pairs(set.centrelines(), set.reach).size() == 200);
}

TEST_CASE_TEMPLATE("fibres of two sizes, few or many of each, dense or sparse, pair as by brute force", Search, BvhSearch,
                   GridSearch, AutomaticSearch) {
    Search search = make_search<Search>();
    for (const double box : {1.0, 4.0})
        for (const double ratio : {3.0, 10.0, 100.0})
            for (const std::size_t thick : {1u, 20u, 100u}) {
                FibreSet set = test::random_fibres(31, 200, 8, 0.02, 0.02, box);
                for (std::size_t f = 0; f < thick; ++f) {
                    set.radius[f] *= ratio;
                    for (Vec3& x : set.points[f]) x = set.points[f][0] + 0.2 * ratio * (x - set.points[f][0]);
                }
                CAPTURE(box);
                CAPTURE(ratio);
                CAPTURE(thick);
                const auto lines = set.centrelines();
                CHECK(search.pairs(lines, set.reach) == BruteSearch{}.pairs(lines, set.reach));
            }
}

TEST_CASE_TEMPLATE("thin fibres far apart, each with another one along it, pair as by brute force", Search, BvhSearch, GridSearch,
                   AutomaticSearch) {
    // Cells are wider there than boxes, most have one fibre alone, and thick ones are asked for by cells.
    Search search = make_search<Search>();
    for (const double box : {10.0, 30.0})
        for (const std::size_t thick : {0u, 1u, 40u}) {
            FibreSet set = test::random_fibres(32, 120, 8, 0.2, 0.2, box);
            std::mt19937 random(33);
            for (std::size_t f = 0; f < 120; ++f) {
                std::vector<Vec3> along = set.points[f];
                for (Vec3& x : along) x += 0.1 * test::uniform_vector(random);
                if (f < thick)
                    set.radius[f] *= 20.0;
                else
                    set.add(along, 0.05);
            }
            CAPTURE(box);
            CAPTURE(thick);
            const auto lines = set.centrelines();
            const auto pairs = search.pairs(lines, set.reach);
            CHECK(pairs.size() > 500);
            CHECK(pairs == BruteSearch{}.pairs(lines, set.reach));
        }
}

TEST_CASE_TEMPLATE("pairs and zones have the same bits for one thread and for three", Search, EVERY_SEARCH) {
    const FibreSet set = test::random_fibres(21, 150, 15, 0.2, 0.4, 1.0);
    const auto lines = set.centrelines();
    std::vector<SegmentPair> pairs[2];
    std::vector<ProximityZone> zones[2];
    for (const int many : {0, 1}) {
        const Threads threads(many == 1 ? 3 : 1);
        Search search = make_search<Search>();
        pairs[many] = search.pairs(lines, set.reach);
        zones[many] = search.find(lines, set.reach);
    }
    CHECK(pairs[0] == pairs[1]);
    CHECK(zones[0] == zones[1]);
}

TEST_CASE_TEMPLATE("a rigid motion of the fibres changes neither the pairs nor the number of zones", Search, GridSearch,
                   KdTreeSearch, TestPointSearch) {
    const FibreSet set = test::random_fibres(22, 100, 15, 0.2, 0.4, 1.0);
    Search search = make_search<Search>();
    const auto pairs = search.pairs(set.centrelines(), set.reach);
    const auto zones = search.find(set.centrelines(), set.reach);
    CHECK(pairs.size() > 100);
    for (int k = 1; k < 5; ++k) {
        const Mat3 rotation = Eigen::AngleAxisd(0.7 * k, Vec3(k, 1, -2).normalized()).toRotationMatrix();
        const FibreSet moved = set.turned(rotation, Vec3(10.0 * k, -3, 1));
        CHECK(search.pairs(moved.centrelines(), set.reach) == pairs);
        CHECK(search.find(moved.centrelines(), set.reach).size() == zones.size());
    }
}

TEST_CASE_TEMPLATE("fibres of one family never pair", Search, EVERY_SEARCH) {
    FibreSet set{.name = "two pairs of crossing fibres", .reach = 0.1};
    set.add({{-1, 0, 0}, {1, 0, 0}}, 0.1);
    set.add({{0, -1, 0.1}, {0, 1, 0.1}}, 0.1);
    set.add({{0.1, -1, 0.05}, {0.1, 1, 0.05}}, 0.1);
    Search search = make_search<Search>();
    CHECK(search.pairs(set.centrelines(), set.reach).size() == 3);
    set.family = {5, -1, 5};
    CHECK(search.pairs(set.centrelines(), set.reach) == std::vector<SegmentPair>{{0, 1}, {1, 2}});
    set.family = {-1, -1, -1};
    CHECK(search.pairs(set.centrelines(), set.reach).size() == 3);
    set.family = {0, 0, 0};
    CHECK(search.find(set.centrelines(), set.reach).empty());
}

TEST_CASE_TEMPLATE("a fibre meets itself only beyond the skipped arc", Search, EVERY_SEARCH) {
    FibreSet set{.name = "a hairpin with segments of 1", .reach = 0.3};
    std::vector<Vec3> line;
    for (int k = 0; k <= 6; ++k) line.push_back({1.0 * k, 0, 0});
    for (int k = 6; k >= 0; --k) line.push_back({1.0 * k, 1, 0});
    set.add(line, 0.4);
    Search search = make_search<Search>();
    CHECK(search.find(set.centrelines(), set.reach).empty());
    // Segments 5 and 7 face each other across the turn, one segment of 1 between them.
    set.self_skip = 0.99;
    auto pairs = search.pairs(set.centrelines(), set.reach);
    CHECK(std::ranges::binary_search(pairs, SegmentPair{5, 7}));
    CHECK(std::ranges::binary_search(pairs, SegmentPair{0, 12}));
    set.self_skip = 1.01;
    pairs = search.pairs(set.centrelines(), set.reach);
    CHECK(!std::ranges::binary_search(pairs, SegmentPair{5, 7}));
    CHECK(std::ranges::binary_search(pairs, SegmentPair{4, 7}));
    const auto zones = search.find(set.centrelines(), set.reach);
    REQUIRE(zones.size() == 1);
    CHECK(zones[0].a_i == 0.0);
    CHECK(zones[0].a_j == 13.0);  // the limbs run against each other
    CHECK(zones[0].b_j < zones[0].a_j);
}

TEST_CASE_TEMPLATE("input that cannot be searched is refused by fibre and vertex", Search, EVERY_SEARCH) {
    Search search = make_search<Search>();
    const auto refusal = [&](const FibreSet& set) -> std::string {
        try {
            search.find(set.centrelines(), set.reach);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "accepted";
    };
    const FibreSet good = test::random_fibres(31, 3, 4, 0.2, 0.4, 1.0);
    CHECK(refusal(good) == "accepted");
    FibreSet bad = good;
    bad.points[1][2][0] = std::nan("");
    CHECK(refusal(bad).starts_with("fibre 1, vertex 2 = nan"));
    bad = good;
    bad.points[2][4][1] = std::numeric_limits<double>::infinity();
    CHECK(refusal(bad).starts_with("fibre 2, vertex 4 = "));
    bad = good;
    bad.points[0].resize(1);
    CHECK(refusal(bad) == "fibre 0: vertices = 1, but it must be >= 2");
    bad = good;
    bad.radius[2] = 0.0;
    CHECK(refusal(bad) == "fibre 2: radius = 0, but it must be finite and > 0");
    bad = good;
    bad.reach = -1.0;
    CHECK(refusal(bad) == "reach = -1, but it must be finite and >= 0");
    bad = good;
    bad.inflation = {{0, 0, 0, 0}, {0, 0, 0}, {0, 0, 0, 0}};
    CHECK(refusal(bad) == "fibre 1: inflations = 3, but it must be none or one a segment, 4");
    bad.inflation[1] = {0, 0, -0.1, 0};
    CHECK(refusal(bad) == "fibre 1, segment 2: inflation = -0.1, but it must be finite and >= 0");
    bad = good;
    bad.self_skip = -1.0;
    CHECK(refusal(bad) == "fibre 0: self_skip = -1, but it must be >= 0 (infinite: never)");
}

TEST_CASE("parameters of searches are refused by name") {
    CHECK_THROWS_WITH_AS((TestPointSearch{{.spacing = 0.0}}), "TestPointSearch.spacing = 0, but it must be finite and > 0",
                         std::invalid_argument);
    CHECK_THROWS_WITH_AS((VerletSearch<GridSearch>{{.base = {}, .skin = -1.0}}),
                         "VerletSearch.skin = -1, but it must be finite and >= 0", std::invalid_argument);
    CHECK_THROWS_AS((TestPointSearch{TestPointSearch::Parameters{}}), std::invalid_argument);
}

TEST_CASE("a Verlet list serves small motions, and is built anew before it could miss a pair") {
    FibreSet set = test::random_fibres(41, 60, 10, 0.2, 0.4, 0.6);
    set.self_skip = 0.5;
    VerletSearch<GridSearch> search{{.base = {}, .skin = 0.05}};
    std::mt19937 random(42);
    const int steps = 60;
    for (int step = 0; step < steps; ++step) {
        test::check_search(search, set, BruteSearch{}.pairs(set.centrelines(), set.reach));
        // Every third of the steps is a jump, which no list survives.
        const double size = step % 20 == 19 ? 0.2 : 0.002;
        for (auto& line : set.points)
            for (Vec3& x : line) x += size * test::uniform_vector(random);
        if (step == 30) set.reach = 0.05;
        if (step == 40) set.reach = 0.01;
    }
    // 0.05 / (2 x 0.002 sqrt(3)) = 7 steps at least to a list while steps add up (random ones add up less), 3 jumps, 1 reach.
    CHECK(search.builds() <= steps / 7 + 4);
    CHECK(search.builds() >= 4);
}

TEST_CASE("a Verlet list without a skin of its own takes one from the motion, and none where it would not live") {
    FibreSet set = test::random_fibres(43, 60, 10, 0.2, 0.4, 0.6);  // of radius 0.05
    set.self_skip = 0.5;
    VerletSearch<GridSearch> search{{}};
    std::mt19937 random(44);
    Index last = 0;
    // Two calls a step. 15 calls a list; bounded by 1.5 radii, so that 0.075 / (2 x 0.01) = 3.75 steps; below 3 calls, the base
    // alone.
    struct Motion {
        double step;
        Index least, most;  // builds
    };
    for (const Motion& motion : {Motion{1e-4, 2, 5}, Motion{0.01, 9, 12}, Motion{0.05, 59, 61}, Motion{0.001, 2, 5}}) {
        std::vector<Vec3> way;
        for (std::size_t k = 0; k < 660; ++k) way.push_back(motion.step * test::uniform_vector(random).normalized());
        for (int call = 0; call < 30; ++call) {
            std::size_t vertex = 0;
            for (auto& line : set.points)
                for (Vec3& x : line) x += way[vertex++];
            test::check_search(search, set, BruteSearch{}.pairs(set.centrelines(), set.reach));
        }
        CAPTURE(motion.step);
        CHECK(search.builds() - last >= motion.least);
        CHECK(search.builds() - last <= motion.most);
        last = search.builds();
    }
}

TEST_CASE("a Verlet list does not miss fibres that approach each other step by step") {
    // Both move, from just outside the list: the gap closes by twice the displacement, and all of the skin is used up.
    for (const double step : {0.001, 0.003, 0.0049, 0.01, 0.024}) {
        CAPTURE(step);
        FibreSet set{.name = "approach", .reach = 0.02};
        set.add({{-1, 0, 0}, {1, 0, 0}}, 0.1);
        set.add({{0, -1, 0.2701}, {0, 1, 0.2701}}, 0.1);
        VerletSearch<BruteSearch> search{{.base = {}, .skin = 0.05}};
        for (int k = 0; k < 60; ++k) {
            const double height = std::abs(set.points[1][0][2] - set.points[0][0][2]);
            CHECK(search.pairs(set.centrelines(), set.reach).size() == (height < 0.22 ? 1u : 0u));
            for (Vec3& x : set.points[0]) x[2] += step;
            for (Vec3& x : set.points[1]) x[2] -= step;
        }
    }
}

TEST_CASE("curves cut into chords lose none of their contacts once the chords are inflated") {
    // Quadratic curves x0 (1-t)^2 + ..., cut into 2 chords an element; the truth comes from 65 points of each curve.
    std::mt19937 random(51);
    const double radius = 0.05, reach = 0.01;
    const int curves = 120, chords = 2, samples = 64;
    FibreSet set{.name = "curves", .reach = reach};
    std::vector<std::vector<Vec3>> sampled;
    for (int c = 0; c < curves; ++c) {
        const Vec3 x0 = 0.35 * test::uniform_vector(random), x1 = x0 + 0.3 * test::uniform_vector(random);
        const Vec3 x2 = x1 + 0.3 * test::uniform_vector(random);
        const auto at = [&](double t) {  // interpolates x0, x1, x2 at t = 0, 1/2, 1
            return Vec3((1 - t) * (1 - 2 * t) * x0 + 4 * t * (1 - t) * x1 + t * (2 * t - 1) * x2);
        };
        std::vector<Vec3> line, fine;
        for (int k = 0; k <= chords; ++k) line.push_back(at(static_cast<double>(k) / chords));
        for (int k = 0; k <= samples; ++k) fine.push_back(at(static_cast<double>(k) / samples));
        set.add(line, radius);
        sampled.push_back(fine);
        set.inflation.push_back(std::vector<double>(chords, Vec3(x0 - 2 * x1 + x2).norm() / (2.0 * chords * chords)));
    }
    GridSearch search;
    const auto inflated = search.pairs(set.centrelines(), reach);
    const auto zones = search.find(set.centrelines(), reach);
    set.inflation.clear();
    const auto bare = search.pairs(set.centrelines(), reach);
    int contacts = 0, missed = 0, outside = 0, missed_bare = 0;
    for (int c = 0; c < curves; ++c)
        for (int d = c + 1; d < curves; ++d)
            for (int p = 0; p < chords; ++p)
                for (int q = 0; q < chords; ++q) {
                    double least = 1e300, s = 0, t = 0;
                    const int per = samples / chords;
                    for (int a = p * per; a <= (p + 1) * per; ++a)
                        for (int b = q * per; b <= (q + 1) * per; ++b) {
                            const double distance =
                                (sampled[core::at(c)][core::at(a)] - sampled[core::at(d)][core::at(b)]).norm();
                            if (distance < least) least = distance, s = a / double(per), t = b / double(per);
                        }
                    if (least >= 2 * radius + reach) continue;
                    ++contacts;
                    const SegmentPair pair{chords * c + p, chords * d + q};
                    missed += std::ranges::binary_search(inflated, pair) ? 0 : 1;
                    missed_bare += std::ranges::binary_search(bare, pair) ? 0 : 1;
                    const bool inside = std::ranges::any_of(zones, [&](const ProximityZone& zone) {
                        return zone.fibre_i == c && zone.fibre_j == d && zone.a_i <= s && s <= zone.b_i &&
                               std::min(zone.a_j, zone.b_j) <= t && t <= std::max(zone.a_j, zone.b_j);
                    });
                    outside += inside ? 0 : 1;
                }
    CHECK(contacts > 500);
    CHECK(missed == 0);
    CHECK(outside == 0);
    CHECK(missed_bare > 0);  // the inflation is what did it
}

}  // namespace search_test
