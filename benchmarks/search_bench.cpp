// SPDX-License-Identifier: MIT
// How long does each proximity search take on a scene, does it find exactly the pairs of the exact search, and how does it
// stand to others and to what cannot be beaten?
//
// search_bench [options] FILE...      prints CSV, one line a scene and search; `search_bench --help` tells the options
// Times are of the processor for one thread (set OMP_NUM_THREADS=1 and pin it), else on the wall. Ratios are to nanoflann
// used directly in the same run and to the floor: the vertices read once and the filter on the wanted pairs. `bytes` are those
// that a search keeps, without the pairs, and `peak_bytes` the most that its first call allocates at once, with the pairs; both
// over the segments.

#include "search/growth.hpp"
#include "search/motion.hpp"

#include <fibrant/proximity/automatic_search.hpp>
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/test_point_search.hpp>

#include <CLI/CLI.hpp>

#include <cstdlib>
#include <fstream>
#include <malloc.h>
#include <new>
#include <optional>
#include <utility>

using namespace fibrant;
using namespace fibrant::benchmarks;

namespace {

void* allocated(void* memory) {
    if (memory == nullptr) throw std::bad_alloc();
    Allocations::tell(static_cast<std::int64_t>(malloc_usable_size(memory)));
    return memory;
}
void given_back(void* memory) noexcept {
    if (memory != nullptr) Allocations::tell(-static_cast<std::int64_t>(malloc_usable_size(memory)));
    std::free(memory);
}

}  // namespace

void* operator new(std::size_t bytes) { return allocated(std::malloc(std::max<std::size_t>(bytes, 1))); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
    const auto unit = std::max(static_cast<std::size_t>(alignment), sizeof(void*));
    return allocated(std::aligned_alloc(unit, (std::max<std::size_t>(bytes, 1) + unit - 1) / unit * unit));
}
void operator delete(void* memory) noexcept { given_back(memory); }
void operator delete(void* memory, std::size_t) noexcept { given_back(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { given_back(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { given_back(memory); }

namespace {

struct Options {
    bool brute = false, self = false, own = false, growth = false, series = false, page = false, mixtures = false;
    int repeats = 7, refine = 1;
    std::optional<double> motion{}, reach{};  // radii
    double radius = core::unset;
    std::size_t mat = 0;
    std::vector<std::string> files{};
    std::vector<int> threads{core::threads()};
    std::string plot{};
};

/// One search of the table.
struct Row {
    std::string name;
    Method method;
    bool once = false, ours = false;  // ours: one to choose where nothing is known of the motion
};

template <class Search>
Row halved(const std::string& name, Search& search, std::span<const proximity::Centreline> lines, double reach) {
    return {name,
            [&search, lines, reach] {
                const proximity::detail::SegmentTable table(lines, reach);
                search.build(table);
                Call call{.built = time_now()};
                call.pairs = search.search(table);
                call.bytes = search.bytes();
                return call;
            },
            false, true};
}

/// One line on which search to take, and what of the data says so.
void advise(const Scene& scene, const std::vector<Row>& rows, const std::vector<Figures>& figures, double pairs_a_segment) {
    std::size_t best = rows.size();
    for (std::size_t m = 0; m < rows.size(); ++m)
        if (rows[m].ours && (best == rows.size() || figures[m].total < figures[best].total)) best = m;
    const auto [thin, thick] = std::minmax_element(scene.radius.begin(), scene.radius.end());
    double length = 0.0, width = 0.0;
    for (std::size_t f = 0; f < scene.points.size(); ++f)
        for (std::size_t k = 1; k < scene.points[f].size(); ++k)
            length += (scene.points[f][k] - scene.points[f][k - 1]).norm(), width += 2.0 * scene.radius[f];
    std::fprintf(
        stderr,
        "%s: take %s (%.3g ms); segments are %.3g times as long as thick, radii differ %.3g times, %.3g pairs a segment%s. "
        "Where fibres move by less than a tenth of a radius from one search to the next, put VerletSearch around it: --motion\n",
        scene.name.c_str(), rows[best].name.c_str(), 1e3 * figures[best].total, length / width, *thick / *thin, pairs_a_segment,
        pairs_a_segment > 30.0 ? ": many, coarser segments would do" : "");
}

/// @name The tables of docs/evidence/search.md: a line a scene.
/// @{
void print_page_head() {
    std::printf(
        "| scene | segments | pairs | GridSearch, ms | over nanoflann | over Boost's R-tree | over CGAL's boxes | over FCL's "
        "tree "
        "| over the floor | BvhSearch | KdTreeSearch | TestPointSearch, 4 r | VerletSearch, list alive | zones over pairs | "
        "bytes a segment | missed, too many |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}
/// @param figures  of the rows, and then of zones from the pairs
void print_page_row(const Scene& scene, const std::vector<Row>& rows, const std::vector<Figures>& figures, double floor,
                    const Pairs& exact) {
    const auto of = [&](const std::string& name) -> const Figures* {
        for (std::size_t m = 0; m < rows.size(); ++m)
            if (rows[m].name == name) return &figures[m];
        return nullptr;
    };
    const Figures &grid = *of("GridSearch"), &peer = *of("nanoflann");
    std::printf("| %s | %zu | %zu | %.1f", scene.name.c_str(), scene.segments(), exact.size(), 1e3 * grid.total);
    for (const char* name : {"nanoflann", "Boost R-tree", "CGAL boxes", "FCL tree"})
        if (const Figures* other = of(name))
            std::printf(" | %.3f", grid.total / other->total);
        else
            std::printf(" | -");
    std::printf(" | %.1f", grid.total / floor);
    for (const char* name : {"BvhSearch", "KdTreeSearch", "TestPointSearch 4 r", "VerletSearch listed"})
        std::printf(" | %.3f", of(name)->total / peer.total);
    std::size_t missed = 0, extra = 0;
    for (const Figures& f : figures) missed += lacking(exact, f.pairs), extra += lacking(f.pairs, exact);
    std::printf(" | %.2f | %.0f | %zu, %zu |\n", figures.back().total / grid.total,
                static_cast<double>(grid.bytes) / static_cast<double>(scene.segments()), missed, extra);
    std::fflush(stdout);
}

/// Fibres of two sizes, for which the other libraries are no measure.
void print_mixtures(const Options& options) {
    std::printf(
        "| fibres | pairs | GridSearch, ms | over BvhSearch | BvhSearch, ms | zones over pairs | same pairs |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const Mixture& mixture : std::initializer_list<Mixture>{{1, 2000, 10.0, false},
                                                                 {1, 2000, 10.0, true},
                                                                 {1, 2000, 100.0, false},
                                                                 {1, 2000, 100.0, true},
                                                                 {1, 10000, 100.0, false},
                                                                 {100, 2000, 10.0, false},
                                                                 {100, 2000, 10.0, true},
                                                                 {100, 2000, 100.0, false},
                                                                 {100, 10000, 10.0, false},
                                                                 {200, 1800, 10.0, false},
                                                                 {200, 1800, 100.0, false},
                                                                 {2000, 2000, 10.0, false},
                                                                 {2000, 2000, 100.0, false},
                                                                 {2000, 100, 10.0, false},
                                                                 {2000, 2000, 1.0, false}}) {
        const Scene scene = random_mixture(mixture);
        const std::vector<proximity::Centreline> lines = scene.centrelines(options.self);
        proximity::GridSearch grid;
        proximity::BvhSearch tree;
        const Pairs exact = grid.pairs(lines, scene.margin);
        const std::vector<Figures> figures = measure_in_turn(
            options.repeats,
            {{halved("", grid, lines, scene.margin).method}, {halved("", tree, lines, scene.margin).method}, {[&] {
                 proximity::zones_from_pairs(lines, scene.margin, exact);
                 return Call{};
             }}});
        std::printf("| %s | %zu | %.2f | %.2f | %.2f | %.2f | %s |\n", scene.name.c_str(), exact.size(), 1e3 * figures[0].total,
                    figures[0].total / figures[1].total, 1e3 * figures[1].total, figures[2].total / figures[0].total,
                    figures[0].pairs == figures[1].pairs ? "yes" : "NO");
        std::fflush(stdout);
    }
}
/// @}

/// @return time [ms] against segments, one point a search
std::vector<observe::PlotLine> print_table(const Scene& scene, const Options& options) {
    const std::vector<proximity::Centreline> lines = scene.centrelines(options.self);
    const double reach = scene.margin, r = *std::min_element(scene.radius.begin(), scene.radius.end());
    proximity::GridSearch grid;
    proximity::BvhSearch tree;
    proximity::AutomaticSearch automatic;
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
    rows.push_back(halved("AutomaticSearch", automatic, lines, reach));
    rows.back().ours = false;  // one of the two
    rows.push_back({"KdTreeSearch", [&] { return Call{.pairs = kd_tree.pairs(lines, reach)}; }, false, true});
    rows.push_back({"TestPointSearch 4 r", [&] { return Call{.pairs = test_points.pairs(lines, reach)}; }});
    verlet.pairs(lines, reach);
    rows.push_back({"VerletSearch listed", [&] { return Call{.pairs = verlet.pairs(lines, reach)}; }});
    const auto brute = [&] { return Call{.pairs = proximity::BruteSearch{}.pairs(lines, reach)}; };
    const Pairs exact = options.brute ? brute().pairs : proximity::GridSearch{}.pairs(lines, reach);
    if (options.brute) rows.push_back({"BruteSearch", brute, true});
    const double least = floor_seconds(options.repeats, lines, reach, exact);
    const auto segments = static_cast<double>(scene.segments());
    double peer = 0.0;
    const auto print = [&](const std::string& name, const Figures& f) {
        if (peer == 0.0) peer = f.total;
        std::printf("%s,%s,%d,%.0f,%zu,%016llx,%zu,%zu,%.3f,%.3f,%.3f,%.3f,%.3f,%.4f,%.2f,%.0f,%.0f\n", scene.name.c_str(),
                    name.c_str(), core::threads(), segments, f.pairs.size(), static_cast<unsigned long long>(checksum(f.pairs)),
                    lacking(exact, f.pairs), lacking(f.pairs, exact), 1e3 * f.build, 1e3 * f.query, 1e3 * f.total, 1e3 * f.least,
                    1e3 * f.most, f.total / peer, f.total / least, static_cast<double>(f.bytes) / segments,
                    static_cast<double>(f.peak) / segments);
        std::fflush(stdout);
    };
    std::vector<Turn> turns;
    for (const Row& row : rows) turns.push_back({row.method, row.once});
    std::vector<proximity::ProximityZone> zones;
    turns.push_back({[&] {
        zones = proximity::zones_from_pairs(lines, reach, exact);
        return Call{.pairs = exact};
    }});
    const std::vector<Figures> figures = measure_in_turn(options.repeats, turns);
    if (options.page) {
        print_page_row(scene, rows, figures, least, exact);
    } else {
        for (std::size_t m = 0; m < rows.size(); ++m) print(rows[m].name, figures[m]);
        print("floor", {.total = least, .least = least, .most = least, .pairs = exact});
        print("zones from the pairs", figures.back());
    }
    advise(scene, rows, figures, static_cast<double>(exact.size()) / segments);
    std::vector<observe::PlotLine> curves;
    for (std::size_t m = 0; m < rows.size(); ++m) curves.push_back({rows[m].name, {{segments, 1e3 * figures[m].total}}});
    return curves;
}

/// Lines of a plot; those of one name are one.
void add(std::vector<observe::PlotLine>& all, const std::vector<observe::PlotLine>& lines, const std::string& prefix) {
    for (const observe::PlotLine& line : lines) {
        const std::string name = prefix + line.name;
        const auto same = std::find_if(all.begin(), all.end(), [&](const auto& known) { return known.name == name; });
        auto& points = (same == all.end() ? all.emplace_back(observe::PlotLine{name, {}}) : *same).points;
        points.insert(points.end(), line.points.begin(), line.points.end());
        std::sort(points.begin(), points.end());
    }
}

void use_threads(int threads) {
#if defined(_OPENMP)
    omp_set_num_threads(threads);
#else
    if (threads > 1) throw std::invalid_argument("--threads: this build has one thread");
#endif
}

void measure(const Options& options) {
    if (options.mixtures) return print_mixtures(options);
    std::vector<Scene> scenes;
    for (const std::string& file : options.files) {
        scenes.push_back(read_scene(file, options.radius));
        if (options.series) scenes.back().require_fibres_of(scenes.front(), file);
    }
    if (options.series && scenes.size() < 2) throw std::invalid_argument("--series: files of two moments at least");
    if (options.mat > 0) scenes.push_back(random_mat(options.mat));
    if (scenes.empty() && !options.growth) throw std::invalid_argument("nothing to search: a file, --mat or --growth");
    for (Scene& scene : scenes) {
        if (options.reach) scene.margin = *options.reach * *std::min_element(scene.radius.begin(), scene.radius.end());
        scene.refine(options.refine);
        proximity::detail::SegmentTable(scene.centrelines(options.self), scene.margin);  // refuses before anything is printed
    }
    std::ofstream picture;
    if (!options.plot.empty() && (picture.open(options.plot), !picture))
        throw std::invalid_argument(options.plot + ": cannot be written");
    const bool moves = options.series || options.motion;
    if (options.page)
        print_page_head();
    else if (options.growth)
        print_growth_head();
    else if (moves)
        print_motion_head();
    else
        std::printf(
            "scene,search,threads,segments,pairs,checksum,missed,extra,build_ms,query_ms,total_ms,least_ms,most_ms,"
            "ratio_to_nanoflann,ratio_to_floor,bytes,peak_bytes\n");
    std::vector<observe::PlotLine> curves;
    for (const int threads : options.threads) {
        use_threads(threads);
        const std::string on = options.threads.size() > 1 ? std::to_string(threads) + " threads, " : "";
        if (options.growth && scenes.empty()) add(curves, growth_of_mats(options.repeats), on);
        if (options.series)
            add(curves,
                measure_motion(scenes.front(), static_cast<int>(scenes.size()) - 1, options.self,
                               [&](Scene& scene, int call) { scene.points = scenes[static_cast<std::size_t>(call)].points; }),
                on);
        else
            for (const Scene& scene : scenes) {
                const std::string of = on + (scenes.size() > 1 && (moves || options.growth) ? scene.name + ", " : "");
                if (options.growth)
                    add(curves, growth_of(scene, options.repeats, options.self), of);
                else if (options.motion)
                    add(curves, measure_motion(scene, 50, options.self, straight_on(scene, *options.motion)), of);
                else
                    add(curves, print_table(scene, options), of);
            }
    }
    if (options.plot.empty()) return;
    picture << observe::log_log_svg({.title = "Contact search",
                                     .x_label = moves && !options.growth ? "call" : "segments",
                                     .y_label = "ms",
                                     .lines = std::move(curves)});
    if (!picture.flush()) throw std::runtime_error(options.plot + ": cannot be written");
}

}  // namespace

int main(int argc, char** argv) try {
    Options options;
    CLI::App app{
        "How long does each proximity search take on your fibres, does it find exactly the pairs of the exact search, and how "
        "does it stand to others?"};
    app.add_option("files", options.files, "centrelines: .csv .vtk .vtp .obj .bcc .inp .tg3, or scenes .fpl .fpt");
    app.add_option("--reach", options.reach,
                   "pairs closer than touching and this many of the least radii; 0.5, or what a scene says")
        ->check(CLI::Range(0.0, 1e6));
    app.add_option("--radius", options.radius, "of fibres whose file has none [length]")->check(CLI::PositiveNumber);
    CLI::Option* mat = app.add_option("--mat", options.mat, "a random mat of so many segments as one more scene")
                           ->check(CLI::Range(64, 100'000'000));
    app.add_option("--refine", options.refine, "each segment cut into so many")->check(CLI::Range(1, 1000));
    app.add_option("--repeats", options.repeats, "calls of each search, in turn with the others")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    CLI::Option* motion =
        app.add_option("--motion", options.motion, "instead: 50 calls between which each vertex moves by so many radii")
            ->check(CLI::Range(0.0, 1e6));
    app.add_flag("--brute", options.brute, "the exact search is brute force, which is quadratic; else GridSearch");
    app.add_flag("--own", options.own, "without the other libraries but nanoflann");
    app.add_flag("--self", options.self, "fibres pair with themselves too");
    CLI::Option* growth =
        app.add_flag("--growth", options.growth,
                     "instead: each scene and 2, 4, 8 copies side by side, or mats of 1e4 to 1e6 segments; exponents");
    app.add_flag("--series", options.series, "instead: the files are one scene at one moment after another")
        ->excludes(motion)
        ->excludes(mat)
        ->excludes(growth);
    growth->excludes(motion);
    app.add_flag("--page", options.page, "a table of one line a scene, as docs/evidence/search.md has it")
        ->excludes(motion)
        ->excludes(growth);
    app.add_flag("--mixtures", options.mixtures,
                 "instead: fibres of two sizes, few or many of each, by the grid and by the tree");
    app.add_option("--threads", options.threads, "numbers of threads, such as 1,2: all is measured with each")
        ->delimiter(',')
        ->check(CLI::Range(1, 1024));
    app.add_option("--plot", options.plot, "an SVG file of the times");
    CLI11_PARSE(app, argc, argv);
    measure(options);
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
