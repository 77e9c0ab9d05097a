// SPDX-License-Identifier: MIT
// How long does each proximity search take on a scene, and does it find exactly the pairs that brute force finds?
//
// search_bench [--brute] [--self] [--refine N] [--repeats N] SCENE.fpl...      prints CSV, one line a scene and search.
// `--brute` also runs the quadratic oracle, and takes `misses` from it; without it they are against the grid's pairs.
// `--refine` cuts each segment into N. Times are of the processor with one thread, else on the wall.
// The peer is nanoflann's static kd-tree over segment middles, radius for the longest segment, which must give the same pairs; its
// pairs are neither sorted nor joined. "VerletSearch listed" is a call that the list serves (skin r). A scene file is little endian: 8 bytes FIBPOL01; u64 fibres F; u64 vertices V; f64 margin;
// u64 selfskip; F f64 radii; F + 1 u64 first vertices; 3 V f64 coordinates.

#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/proximity/kd_tree_search.hpp>
#include <fibrant/proximity/test_point_search.hpp>
#include <fibrant/proximity/verlet_search.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

namespace {

using namespace fibrant;
using namespace fibrant::proximity;

struct SceneFile {
    std::string name;
    double margin = 0.0;
    std::uint64_t self_skip = 0;  // segments
    std::vector<std::vector<Vec3>> points;
    std::vector<double> radius;

    void refine(int n) {
        self_skip *= static_cast<std::uint64_t>(n);
        for (auto& line : points) {
            std::vector<Vec3> fine{line.front()};
            for (std::size_t k = 1; k < line.size(); ++k)
                for (int part = 1; part <= n; ++part) fine.push_back(line[k - 1] + (line[k] - line[k - 1]) * (static_cast<double>(part) / n));
            line = fine;
        }
    }

    std::vector<Centreline> centrelines(bool self) const {
        std::vector<Centreline> lines(points.size());
        for (std::size_t f = 0; f < points.size(); ++f) {
            lines[f].points = points[f];
            lines[f].radius = radius[f];
            double length = 0.0;
            for (std::size_t k = 1; k < points[f].size(); ++k) length += (points[f][k] - points[f][k - 1]).norm();
            // |i - j| > skip on segments of one length: half a segment below the arc of skip segments between them.
            if (self) lines[f].self_skip = (static_cast<double>(self_skip) - 0.5) * length / static_cast<double>(points[f].size() - 1);
        }
        return lines;
    }
};

template <class T>
void read(std::ifstream& in, T* values, std::size_t n) {
    in.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(n * sizeof(T)));
    if (!in) throw std::runtime_error("the scene file ends too early");
}

SceneFile read_scene(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    char magic[8];
    read(in, magic, 8);
    if (std::string(magic, 8) != "FIBPOL01") throw std::runtime_error(path + " is no scene file");
    SceneFile scene;
    const std::size_t slash = path.find_last_of('/');
    scene.name = path.substr(slash == std::string::npos ? 0 : slash + 1);
    std::uint64_t fibres = 0, vertices = 0;
    read(in, &fibres, 1);
    read(in, &vertices, 1);
    read(in, &scene.margin, 1);
    read(in, &scene.self_skip, 1);
    scene.radius.resize(fibres);
    read(in, scene.radius.data(), fibres);
    std::vector<std::uint64_t> first(fibres + 1);
    read(in, first.data(), fibres + 1);
    scene.points.resize(fibres);
    for (std::size_t f = 0; f < fibres; ++f) {
        scene.points[f].resize(first[f + 1] - first[f]);
        read(in, scene.points[f].front().data(), 3 * scene.points[f].size());
    }
    return scene;
}

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

/// Processor time for one thread, which others on the machine disturb least; else time on the wall.
double now() {
    if (core::threads() == 1) return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Body>
double median_seconds(int repeats, const Body& body) {
    std::vector<double> seconds;
    for (int k = 0; k < repeats; ++k) {
        const double start = now();
        body();
        seconds.push_back(now() - start);
    }
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
}

/// The kd-tree as one would write it by hand: one tree, one radius, pairs as they come.
std::vector<SegmentPair> peer(std::span<const Centreline> fibres, double reach) {
    const detail::SegmentTable table(fibres, reach);
    const std::vector<detail::SegmentRecord> records = table.records();
    std::vector<detail::Plain3> middles;
    middles.reserve(records.size());
    double longest = 0.0;
    for (const auto& r : records) {
        middles.push_back({r.start.x + 0.5 * r.chord.x, r.start.y + 0.5 * r.chord.y, r.start.z + 0.5 * r.chord.z});
        longest = std::max(longest, 0.5 * std::sqrt(detail::dot(r.chord, r.chord)) + r.half);
    }
    const detail::PointTree tree(middles);
    std::vector<SegmentPair> close;
    std::vector<std::int32_t> found;
    std::vector<detail::Candidate> candidates;
    for (const auto& r : records) {
        found.clear();
        candidates.clear();
        tree.within(middles[core::at(r.segment)],
                    0.5 * std::sqrt(detail::dot(r.chord, r.chord)) + r.half + longest + reach * 1.0000001, found);
        for (const std::int32_t f : found)
            if (f > r.segment) candidates.push_back({r.segment, f});
        detail::keep_close(table, records.data(), candidates, close);
    }
    return close;
}

template <class Find>
void report(const SceneFile& scene, const char* name, int repeats, double peer_seconds,
            const std::vector<SegmentPair>& reference, const Find& find) {
    std::vector<SegmentPair> pairs;
    const double seconds = median_seconds(repeats, [&] { pairs = find(); });
    std::sort(pairs.begin(), pairs.end());
    std::vector<SegmentPair> missed;
    std::set_difference(reference.begin(), reference.end(), pairs.begin(), pairs.end(), std::back_inserter(missed));
    std::printf("%s,%s,%zu,%016llx,%zu,%.3f,%.4f\n", scene.name.c_str(), name, pairs.size(),
                static_cast<unsigned long long>(checksum(pairs)), missed.size(), 1e3 * seconds, seconds / peer_seconds);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    bool brute = false, self = false;
    int repeats = 7, refine = 1;
    std::printf("scene,search,pairs,checksum,misses,milliseconds,ratio_to_nanoflann\n");
    for (int a = 1; a < argc; ++a) {
        const std::string argument = argv[a];
        if (argument == "--brute") {
            brute = true;
        } else if (argument == "--self") {
            self = true;
        } else if (argument == "--repeats" && a + 1 < argc) {
            repeats = std::max(1, std::atoi(argv[++a]));
        } else if (argument == "--refine" && a + 1 < argc) {
            refine = std::max(1, std::atoi(argv[++a]));
        } else {
            SceneFile scene = read_scene(argument);
            scene.refine(refine);
            const std::vector<Centreline> lines = scene.centrelines(self);
            const double reach = scene.margin;
            GridSearch grid;
            const std::vector<SegmentPair> reference = brute ? BruteSearch{}.pairs(lines, reach) : grid.pairs(lines, reach);
            const double seconds = median_seconds(repeats, [&] { peer(lines, reach); });
            report(scene, "nanoflann by hand", 1, seconds, reference, [&] { return peer(lines, reach); });
            report(scene, "GridSearch", repeats, seconds, reference, [&] { return grid.pairs(lines, reach); });
            report(scene, "KdTreeSearch", repeats, seconds, reference, [&] { return KdTreeSearch{}.pairs(lines, reach); });
            TestPointSearch points({.spacing = 4.0 * scene.radius[0]});
            report(scene, "TestPointSearch h=4r", repeats, seconds, reference, [&] { return points.pairs(lines, reach); });
            VerletSearch<GridSearch> verlet({.base = {}, .skin = scene.radius[0]});
            verlet.pairs(lines, reach);
            report(scene, "VerletSearch listed", repeats, seconds, reference, [&] { return verlet.pairs(lines, reach); });
            std::vector<ProximityZone> zones;
            const double joining = median_seconds(repeats, [&] { zones = zones_from_pairs(lines, reach, reference); });
            std::printf("%s,joining %zu zones,%zu,,,%.3f,%.4f\n", scene.name.c_str(), zones.size(), reference.size(),
                        1e3 * joining, joining / seconds);
        }
    }
}
