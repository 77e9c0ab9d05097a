// SPDX-License-Identifier: MIT
// How long does each proximity search take on a scene, does it find exactly the pairs of the exact search, and how does it
// stand to others and to what cannot be beaten?
//
// search_bench [options] SCENE.fpl|SCENE.fpt...      prints CSV, one line a scene and search
//   --generate mat N   a random mat of N segments as one more scene
//   --brute            the exact search is brute force, which is quadratic; else GridSearch
//   --own              without the other libraries but nanoflann
//   --self             fibres pair with themselves too
//   --refine N         each segment cut into N
//   --repeats N        medians of so many, 7
//   --motion D         instead: 50 calls between which each vertex moves by D radii
//   --growth           instead: random mats of 1e4 to 1e6 segments, exponents
// Times are of the processor for one thread (set OMP_NUM_THREADS=1 and pin it), else on the wall. Ratios are to nanoflann
// used directly in the same run and to the floor: the vertices read once and the filter on the wanted pairs. `bytes` are those that a
// search keeps, without the pairs, over the segments.

#include "search/growth.hpp"
#include "search/motion.hpp"

#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/test_point_search.hpp>

#include <optional>
#include <utility>

using namespace fibrant;
using namespace fibrant::benchmarks;

namespace {

struct Options {
    bool brute = false, self = false, own = false;
    int repeats = 7, refine = 1;
    std::optional<double> motion{};
};

/// One search of the table.
struct Row {
    std::string name;
    Method method;
    bool once = false;
};

template <class Search>
Row halved(const std::string& name, Search& search, std::span<const proximity::Centreline> lines, double reach) {
    return {name, [&search, lines, reach] {
                const proximity::detail::SegmentTable table(lines, reach);
                search.build(table);
                Call call{.built = time_now()};
                call.pairs = search.search(table);
                call.bytes = search.bytes();
                return call;
            }};
}

void print_table(const Scene& scene, const Options& options) {
    const std::vector<proximity::Centreline> lines = scene.centrelines(options.self);
    const double reach = scene.margin, r = *std::min_element(scene.radius.begin(), scene.radius.end());
    proximity::GridSearch grid;
    proximity::BvhSearch tree;
    proximity::KdTreeSearch kd_tree;
    proximity::TestPointSearch test_points({.spacing = 4.0 * r});
    proximity::VerletSearch<proximity::GridSearch> verlet({.base = {}, .skin = r});
    std::vector<Row> rows{{"nanoflann", [&] { return nanoflann_pairs(lines, reach); }}};
#if defined(FIBRANT_BENCHMARK_BOOST)
    if (!options.own) rows.push_back({"Boost R-tree", [&] { return boost_pairs(lines, reach); }});
#endif
#if defined(FIBRANT_BENCHMARK_CGAL)
    if (!options.own) rows.push_back({"CGAL boxes", [&] { return cgal_pairs(lines, reach); }});
#endif
#if defined(FIBRANT_BENCHMARK_FCL)
    if (!options.own) rows.push_back({"FCL tree", [&] { return fcl_pairs(lines, reach); }});
#endif
    rows.push_back(halved("GridSearch", grid, lines, reach));
    rows.push_back(halved("BvhSearch", tree, lines, reach));
    rows.push_back({"KdTreeSearch", [&] { return Call{.pairs = kd_tree.pairs(lines, reach)}; }});
    rows.push_back({"TestPointSearch 4 r", [&] { return Call{.pairs = test_points.pairs(lines, reach)}; }});
    verlet.pairs(lines, reach);
    rows.push_back({"VerletSearch listed", [&] { return Call{.pairs = verlet.pairs(lines, reach)}; }});
    const auto brute = [&] { return Call{.pairs = proximity::BruteSearch{}.pairs(lines, reach)}; };
    const Pairs exact = options.brute ? brute().pairs : grid.pairs(lines, reach);
    if (options.brute) rows.push_back({"BruteSearch", brute, true});
    const double least = floor_seconds(options.repeats, lines, reach, exact);
    const auto segments = static_cast<double>(scene.segments());
    double peer = 0.0;
    const auto print = [&](const std::string& name, const Figures& f) {
        if (peer == 0.0) peer = f.total;
        std::printf("%s,%s,%.0f,%zu,%016llx,%zu,%zu,%.3f,%.3f,%.3f,%.4f,%.2f,%.0f\n", scene.name.c_str(), name.c_str(), segments, f.pairs.size(),
                    static_cast<unsigned long long>(checksum(f.pairs)), lacking(exact, f.pairs), lacking(f.pairs, exact), 1e3 * f.build,
                    1e3 * f.query, 1e3 * f.total, f.total / peer, f.total / least, static_cast<double>(f.bytes) / segments);
        std::fflush(stdout);
    };
    for (const Row& row : rows) print(row.name, measure(row.once ? 1 : options.repeats, row.method));
    print("floor", {.total = least, .pairs = exact});
    std::vector<proximity::ProximityZone> zones;
    print("zones from the pairs", measure(options.repeats, [&] {
              zones = proximity::zones_from_pairs(lines, reach, exact);
              return Call{.pairs = exact};
          }));
}

}  // namespace

int main(int argc, char** argv) try {
    Options options;
    std::vector<Scene> scenes;
    for (int a = 1; a < argc; ++a) {
        const std::string argument = argv[a];
        const auto next = [&] { return a + 1 < argc ? std::string(argv[++a]) : throw std::invalid_argument(argument + " needs a value"); };
        if (argument == "--brute") options.brute = true;
        else if (argument == "--own") options.own = true;
        else if (argument == "--self") options.self = true;
        else if (argument == "--repeats") options.repeats = std::max(1, std::stoi(next()));
        else if (argument == "--refine") options.refine = std::max(1, std::stoi(next()));
        else if (argument == "--motion") options.motion = std::stod(next());
        else if (argument == "--generate") {
            if (next() != "mat") throw std::invalid_argument("--generate mat N");
            scenes.push_back(random_mat(std::stoul(next())));
        } else if (argument == "--growth") {
            measure_growth(options.repeats);
            return 0;
        } else {
            scenes.push_back(read_scene(argument));
        }
    }
    if (!options.motion)
        std::printf("scene,search,segments,pairs,checksum,missed,extra,build_ms,query_ms,total_ms,ratio_to_nanoflann,ratio_to_floor,bytes\n");
    for (Scene& scene : scenes) {
        scene.refine(options.refine);
        if (options.motion) measure_motion(scene, *options.motion, 50, options.self);
        else print_table(scene, options);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
