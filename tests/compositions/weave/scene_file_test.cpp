// SPDX-License-Identifier: MIT
#include <near.hpp>

#include <doctest/doctest.h>

#if __has_include(<toml++/toml.h>)

#include "../../../examples/weave/output.hpp"
#include "../../../examples/weave/scene_file.hpp"
#include "compositions/weave/woven_snapshot.hpp"
#include "observe/snapshot_samples.hpp"
#include "refusal.hpp"

#include <fibrant/proximity/grid_search.hpp>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

using namespace fibrant;

namespace scene_file_test {

using weave::read_scene;
using weave::Scene;

const std::filesystem::path scenes = std::filesystem::path(__FILE__).parent_path() / ".." / ".." / ".." / "examples" / "weave";

/// What the plain scene says when it is changed, without the name of its file.
std::string refused(const std::vector<std::string>& changes) {
    const std::string path = (scenes / "plain.toml").string();
    const std::string message = test::refusal([&] { read_scene(path, changes); });
    CHECK((message.empty() || message.compare(0, path.size() + 2, path + ": ") == 0));
    return message.empty() ? message : message.substr(path.size() + 2);
}

std::string refused_text(const std::string& text) {
    const std::filesystem::path path = observe::empty_folder("scene_text") / "scene.toml";
    observe::write_file(path, text);
    return test::refusal([&] { read_scene(path.string()); });
}

TEST_CASE("the scenes hold the chapter's tables, with 19, 76 and all 380 fibres a tow") {
    for (const std::string name : {"plain", "twill", "plain_76", "twill_76", "plain_380", "twill_380"}) {
        const Scene scene = read_scene((scenes / (name + ".toml")).string());
        const auto& fabric = scene.fabric;
        const Index tow = name.find("380") != std::string::npos ? 380 : name.find("76") != std::string::npos ? 76 : 19;
        CHECK(fabric.pattern.name() == (name.find("plain") == 0 ? "plain" : "twill22"));
        CHECK(fabric.fibres() == 8 * tow);
        CHECK(9 * fabric.fibres() * fabric.nodes_per_fibre() == 9 * 8 * 65 * tow);
        // Tows have the area of 380 filaments and their stiffness in bending; the tables have three digits.
        CHECK(fabric.warp.fibre_radius == test::near(0.009 * std::sqrt(380.0 / static_cast<double>(tow)), 2e-3));
        CHECK(fabric.weft.inertia_factor == test::near(static_cast<double>(tow) / 380.0, 1e-12));
        CHECK(fabric.warp_spacing == 0.88);
        CHECK(fabric.fibre_length(compositions::weave::Family::weft) == test::near(4.4, 1e-12));
        CHECK(fabric.weft.material.young_modulus == 7300.0);
        CHECK(fabric.warp.material.poisson_ratio == 0.3);
        CHECK(scene.settle.friction_coefficient == 0.15);
    }
}

TEST_CASE("values from the command line replace those of the file") {
    const std::string path = (scenes / "plain.toml").string();
    const Scene scene =
        read_scene(path, {"fabric.pattern=twill31", "warp.aspect=2", "weft.fibres=7", "fabric.elements=16", "fabric.elements=24",
                          "output.paraview=false", "material.young_modulus=73e3", "weft.young_modulus = 200000.0"});
    CHECK(scene.fabric.pattern.name() == "twill31");
    CHECK(scene.fabric.warp.aspect == 2.0);
    CHECK(scene.fabric.weft.aspect == 2.0);  // as the warp
    CHECK(scene.fabric.weft.fibres == 7);
    CHECK(scene.fabric.warp.fibres == 19);
    CHECK(scene.fabric.elements == 24);  // the later one
    CHECK_FALSE(scene.paraview);
    CHECK(scene.fabric.warp.material.young_modulus == 73e3);
    CHECK(scene.fabric.weft.material.young_modulus == 200000.0);
    const Scene drawn = read_scene(path, {R"(fabric.pattern=["1010", "0101", "1010", "0101"])"});
    CHECK(drawn.fabric.pattern.over(0, 0));
}

TEST_CASE("a wrong scene is refused by section, key, value and bound") {
    CHECK(refused({}).empty());
    CHECK(refused({"fabric.wrap_tows=4"}).find("fabric.wrap_tows = 4, but it must be one of the keys pattern, warp_tows") == 0);
    CHECK(refused({"fabrics.warp_tows=4"}).find("fabrics = [section], but it must be one of the sections fabric,") == 0);
    CHECK(refused({"fabric.warp_tows=four"}) == "fabric.warp_tows = 'four', but it must be a whole number >= 1 and <= 1000");
    CHECK(refused({"fabric.warp_tows=4.5"}) ==
          "fabric.warp_tows = 4.5, but it must be a whole number >= 1 and <= 1000, without a point or an exponent");
    CHECK(refused({"fabric.warp_spacing=true"}).find("fabric.warp_spacing = true, but it must be a number finite and > 0") == 0);
    CHECK(refused({"output.pictures=1"}) == "output.pictures = 1, but it must be true or false");
    CHECK(refused({"fabric.pattern=3"}) == "fabric.pattern = 3, but it must be a text");
    CHECK(refused({"fabric.pattern=[1, 2]"}) == "fabric.pattern = [ 1, 2 ], but it must be a list of texts");
    CHECK(refused({"warp.real_diameter=-0.018"}).find("warp.real_diameter = -0.018, but it must be finite and > 0") == 0);
    CHECK(refused({"warp.real_fibres=nan"}) == "warp.real_fibres = nan, but it must be >= 1 and <= 1000000000");
    CHECK(refused({"warp.real_fibres=18"}) == "warp.real_fibres = 18, but it must be >= warp.fibres = 19");
    CHECK(refused({"warp.fibres=0"}).find("warp.fibres = 0, but it must be >= 1") == 0);
    CHECK(refused({"material.young_modulus=nan"}).find("material.young_modulus = nan, but it must be finite and > 0") == 0);
    CHECK(refused({"contact.friction_coefficient=-0.1"}) ==
          "contact.friction_coefficient = -0.1, but it must be >= 0 and <= 1000");
    CHECK(refused({"settle.release_increments=0"}) == "settle.release_increments = 0, but it must be >= 1 and <= 100000");
    CHECK(refused({"settle.overshoot=0.0"}) == "settle.overshoot = 0, but it must be > 0 and <= 1000000, or inf");
    CHECK(refused({"solver.newton_limit=0"}) == "solver.newton_limit = 0, but it must be >= 1 and <= 10000");
    CHECK(refused({"solver.linear_solver=lu"}) ==
          "solver.linear_solver = 'lu', but it must be one of automatic, two_level_pcg, fibre_block_pcg, "
          "float_block_cholesky, double_block_cholesky, sparse_cholesky");
    CHECK(refused({"solver.threads=-1"}) == "solver.threads = -1, but it must be >= 0 and <= 100000");
    CHECK(refused({"output.paraview_every=0"}) == "output.paraview_every = 0, but it must be >= 1 and <= 100000");
    CHECK(refused({"fabric.elements=60"}).find("fabric.elements = 60, but it must be <= 54") == 0);
    CHECK(refused({R"(fabric.pattern=["10", "01", "10"])"}) ==
          "fabric.pattern.size = 3 x 2, but it must be a divisor of the tow counts, 4 warp x 4 weft");
    CHECK(refused({R"(fabric.pattern=["1111", "0101", "1010", "0101"])"}).find("warp 0 (above)") != std::string::npos);
    CHECK(refused({"warp.radius=0.04"}).find("but it must be left out where real_fibres and real_diameter are given") !=
          std::string::npos);
}

TEST_CASE("what is missing, and a file that is none, are told by name and place") {
    CHECK(refused_text("[fabric]\npattern = \"plain\"\n")
              .find("fabric.warp_tows is missing, but it must be given: number of tows along x, a whole number >= 1 and <= 1000; "
                    "so must "
                    "fabric.weft_tows") != std::string::npos);
    CHECK(refused_text("[fabric]\npattern = \n").find("scene.toml:2:") != std::string::npos);
    CHECK(refused_text("threads = 4\n[fabric]\npattern = \"plain\"").find("threads, but it must be one of the sections") !=
          std::string::npos);
    CHECK(test::refusal([] { read_scene("no_such_scene.toml"); }).find("no_such_scene.toml") == 0);
    CHECK(test::refusal([] { read_scene((scenes / "plain.toml").string(), {"fabric=3"}); }) ==
          "--set = fabric=3, but it must be section.key=value");
}

TEST_CASE("a key beside the sections is refused") {
    const std::string plain = observe::read_file(scenes / "plain.toml");
    CHECK(refused_text("threads = 4\n" + plain).find("threads, but it must be one of the sections") != std::string::npos);
}

TEST_CASE("the summary has every key that scripts rely on, and NaN is null") {
    const auto folder = observe::empty_folder("summary");
    weave::write_summary(folder, weave::Summary{});
    const std::string json = observe::read_file(folder / "summary.json");
    for (const char* key : {"converged",
                            "fibres",
                            "nodes",
                            "dofs",
                            "contact_elements",
                            "increments",
                            "rejected_increments",
                            "newton_iterations",
                            "linear_solves",
                            "linear_iterations",
                            "wrong_crossings",
                            "greatest_penetration_over_radius",
                            "least_gap_over_radius",
                            "crimp_warp",
                            "crimp_weft",
                            "thickness",
                            "wall_seconds",
                            "cpu_seconds",
                            "peak_memory_bytes",
                            "seconds_by_stage",
                            "solver",
                            "threads",
                            "version"})
        CHECK(json.find("\n  \"" + std::string(key) + "\": ") != std::string::npos);
    CHECK(json.find("\"crimp_warp\": null") != std::string::npos);
}

TEST_CASE("a settled fabric leaves its measures and pictures in files of a reasonable size") {
    using namespace compositions::weave;
    const FabricParameters fabric = small_fabric(4, 19);
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.55 * fabric.warp.packing().thickness);
    const auto folder = observe::empty_folder("weave_output");
    weave::write_measures(folder, snapshot, fabric, crimp_measures(snapshot, fabric));
    weave::write_pictures(folder, snapshot, fabric, "mm");
    const auto lines = [&](const char* name) {
        const std::string text = observe::read_file(folder / name);
        return std::count(text.begin(), text.end(), '\n');
    };
    CHECK(lines("fibres.csv") == 1 + 152);
    CHECK(lines("tows.csv") == 1 + 8);
    CHECK(lines("sections.csv") == 1 + 8 * 7);  // four crossings of each tow and three places between them
    for (const char* name : {"view.svg", "top.svg", "slice_warp_0.svg", "slice_weft_3.svg"}) {
        const std::string picture = observe::read_file(folder / name);
        CHECK(picture.find("<svg") == 0);
        CHECK(picture.size() < 1'500'000);
    }
}

#endif

}  // namespace scene_file_test
