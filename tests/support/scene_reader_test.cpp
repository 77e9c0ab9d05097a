// SPDX-License-Identifier: MIT
// A key that is told once is read, refused, explained and echoed from that.
#include <doctest/doctest.h>

#if __has_include(<toml++/toml.h>)

#include "../../examples/support/scene_reader.hpp"
#include "observe/snapshot_samples.hpp"
#include "refusal.hpp"

#include <filesystem>
#include <string>
#include <vector>

using namespace fibrant;

namespace scene_reader_test {

struct Rod {
    double radius = core::unset, depth = 0.1;
    Index elements = 8;
    bool bent = false;
    std::string name = "rod";
    std::vector<std::string> ramps{"a = 1"};

    void read(example::SceneReader& file) {
        file.require("rod", "radius", radius, example::positive(), "length", "of the rod");
        file.read("rod", "depth", depth, example::above(0.0, 0.5), "radius", "that is allowed");
        file.read("rod", "elements", elements, example::between(1, 1000), "along the rod");
        file.read("rod", "bent", bent, "at rest");
        file.read("rod", "name", name, example::any_text(), "of the rod");
        file.read("load", "ramps", ramps, "what is done");
        file.complete();
        file.check(depth <= radius, "rod", "depth", "<= rod.radius = " + core::text(radius));
    }
};

std::filesystem::path written(const std::string& text) {
    const std::filesystem::path path = observe::empty_folder("scene_reader") / "scene.toml";
    observe::write_file(path, text);
    return path;
}
Rod read(const std::string& text, const std::vector<std::string>& overrides = {}) {
    example::SceneReader file(written(text).string(), overrides);
    Rod rod;
    rod.read(file);
    return rod;
}
/// Message without the name of the file.
std::string refused(const std::string& text, const std::vector<std::string>& overrides = {}) {
    const std::string message = test::refusal([&] { read(text, overrides); });
    const std::size_t name = message.find("scene.toml: ");
    return name == std::string::npos ? message : message.substr(name + 12);
}

const std::string sound = "[rod]\nradius = 2\n";

TEST_CASE("values are taken from the file, from the command line, or as they were") {
    const Rod rod = read("[rod]\nradius = 2\nelements = 9\n", {"rod.elements=10", "rod.name=thin one", "rod.depth = 5e-1"});
    CHECK(rod.radius == 2.0);
    CHECK(rod.elements == 10);
    CHECK(rod.name == "thin one");
    CHECK(rod.depth == 0.5);
    CHECK(!rod.bent);
}

TEST_CASE("that a file is read is told once, and only of a file whose keys are those of the program") {
    const auto told = [](const std::string& text) {
        example::SceneReader file(written(text).string(), {});
        int times = 0;
        file.when_read([&] { ++times; });
        test::refusal([&] {
            Rod().read(file);
            Rod().read(file);
        });
        return times;
    };
    CHECK(told(sound) == 1);
    CHECK(told("[rod]\nradius = 2\ncolour = 1\n") == 0);
    CHECK(told("[rod]\nelements = 2\n") == 0);
}

TEST_CASE("a number is read whole, is one, and lies within its bound") {
    for (const char* text : {"0,5", "0.02 rad", "0.02 0.03", "\"0.2\"", "true", "[0.2]", "{a = 1}", "", "0.1\n[load]"})
        CHECK(!refused(sound, {std::string("rod.depth=") + text}).empty());
    CHECK(refused(sound, {"rod.depth=0,5"}) ==
          "rod.depth = '0,5', but it must be a number > 0 and <= 0.5, written as 0.5 or 5e-1 without quotes");
    for (const char* text : {".5", "5.", "1_", "'0.2'", "\"1e-1\"", "0.02 0.03"})  // a number was meant
        CHECK(refused(sound, {std::string("rod.depth=") + text}).ends_with("written as 0.5 or 5e-1 without quotes"));
    CHECK(refused(sound, {"rod.elements='7'"}).ends_with(", written as 1000 without quotes"));
    for (const char* text : {"thick", "0.02 rad", "e", "[0.2]"})
        CHECK(refused(sound, {std::string("rod.depth=") + text}).ends_with("a number > 0 and <= 0.5"));
    for (const char* text : {"rod..depth=1", "rod. =1", " .depth=1", ".rod.depth=1", "rod.. =1"})
        CHECK(refused(sound, {text}).ends_with("but it must be section.key=value"));
    for (const char* text : {"nan", "inf", "-inf", "0", "-0.0", "0.6", "1e400"})
        CHECK(refused(sound, {std::string("rod.depth=") + text}).starts_with("rod.depth = "));
    for (const char* text :
         {"0", "1001", "1.5", "1e2", "9223372036854775807", "-9223372036854775808", "99999999999999999999", "7x"})
        CHECK(refused(sound, {std::string("rod.elements=") + text}).starts_with("rod.elements = "));
    CHECK(refused(sound, {"rod.elements=1001"}) == "rod.elements = 1001, but it must be >= 1 and <= 1000");
    CHECK(refused(sound, {"rod.elements=10.0"}) ==
          "rod.elements = 10, but it must be a whole number >= 1 and <= 1000, without a point or an exponent");
    for (const char* text : {"\"a", "'''a", "[\"a\"", "{a = 1"})  // begun and not ended: no text without quotes
        CHECK(refused(sound, {std::string("rod.name=") + text}).starts_with("--set rod.name = "));
    CHECK(refused(sound, {"rod.name=a\nrod.bent=true"}).ends_with("but it must be section.key=value in one line"));
    CHECK(refused("[rod]\nradius = 0.05\n") == "rod.depth = 0.1 (not given), but it must be <= rod.radius = 0.05");
}

TEST_CASE("a key that nobody knows is told before one that is missing: it may be that") {
    CHECK(refused("[rod]\nradios = 2\n") ==
          "rod.radios = 2, but it must be one of the keys radius, depth, elements, bent, name: perhaps radius is meant");
    CHECK(refused("[rod]\ndepth = 0.2\n") ==
          "rod.radius is missing, but it must be given: of the rod, a number finite and > 0, in any unit from 1e-30 to 1e+30");
    CHECK(refused("[[rod]]\nradius = 2\n") == "rod is a list, but it must be a section, [rod]");
    CHECK(refused("[rod.rod]\nradius = 2\n").starts_with("rod.rod = [section], but it must be one of the keys"));
    CHECK(refused("[rod.radius]\na = 2\n").starts_with("rod.radius = [section], but it must be a number"));
    CHECK(refused("[rods]\nradius = 2\n") ==
          "rods = [section], but it must be one of the sections rod, load: perhaps rod is meant");
}

TEST_CASE("what is misspelt is told with the name that it is like, and what is in the wrong section with the right one") {
    const auto ends = [&](const std::string& text, const std::string& end) { return refused(text).ends_with(end); };
    CHECK(ends(sound + "elemnets = 9\n", "bent, name: perhaps elements is meant"));  // swapped
    CHECK(ends(sound + "Depth = 0.1\n", "bent, name: perhaps depth is meant"));      // a capital
    CHECK(ends(sound + "ramps = []\n", "bent, name: perhaps it belongs to [load]"));
    CHECK(ends(sound + "colour = 1\n", "bent, name"));  // like none
    CHECK(ends(sound + "[laod]\nramps = []\n", "rod, load: perhaps load is meant"));
    CHECK(ends(sound + "[surroundings]\n", "rod, load"));
    CHECK(example::nearest_name(std::string(100000, 'a'), {std::string(100001, 'a')}).empty());
    CHECK(example::misprints("depth", "depth") == 0);
    CHECK(example::misprints("abcd", "") == 4);
    CHECK(example::misprints("radius", "raduis") == 1);
    CHECK(example::misprints("kitten", "sitting") == 3);
}

TEST_CASE("what would run out of stack or memory is refused as text") {
    std::string dots;
    for (int k = 0; k < 100000; ++k) dots += "a.";
    for (const std::string& text : {dots + "a = 1", "[" + dots + "a]", "[rod]\nname = {" + dots + "a = 1}"})
        CHECK(refused(text).find("a key of more than 8 parts") != std::string::npos);
    for (const char bracket : {'[', '{'})
        CHECK(refused("[rod]\nname = " + std::string(100000, bracket)).find("brackets are nested") != std::string::npos);
    CHECK(refused(sound + "#" + std::string(1000000, 'x')).find("more than 1,000,000 characters") != std::string::npos);
    CHECK(refused(sound + "name = \"a.b.c.d.e.f.g.h.i.j.k # [[[\"  # a.b.c.d.e.f.g.h.i.j.k\n").empty());
    CHECK(refused(sound + "[load]\nramps = [\"a.b = 0.1\", 'c.d = 0.2',\n'''e.f''', \"\"\"g.h\"\"\"]\n").empty());
    CHECK(test::refusal([] { example::SceneReader(std::filesystem::temp_directory_path().string(), {}); }).find("is a folder") !=
          std::string::npos);
    CHECK(test::refusal([] {
              example::SceneReader("no/such.toml", {});
          }).find("no/such.toml: cannot be read as a scene file: No such file") == 0);
}

TEST_CASE("the echo is a scene that says the same, and what the scene is leaves out how it is solved") {
    const std::string text = "[rod]\nradius = 2.5e-3\nname = \"a 'b' \\\"c\\\"\"\ndepth = 1e-3\n[load]\nramps = []\n";
    example::SceneReader file(written(text).string(), {});
    Rod rod;
    rod.read(file);
    CHECK(file.echo().find("[rod]\nradius = 0.0025\ndepth = 0.001\nelements = 8\nbent = false\n") == 0);
    const Rod again = read(file.echo());
    CHECK(again.radius == rod.radius);
    CHECK(again.name == rod.name);
    CHECK(again.ramps.empty());
    CHECK(file.scene({"load"}) == "load.ramps = []\n");
    CHECK(file.scene().find("rod.radius = 0.0025\n") == 0);
}

TEST_CASE("all keys are explained without a file") {
    example::SceneReader keys = example::SceneReader::of_keys();
    Rod rod;
    CHECK_THROWS_AS(rod.read(keys), example::Described);
    CHECK(
        keys.help().find(
            "  radius: must be given  (number finite and > 0, in any unit from 1e-30 to 1e+30; [length])\n      of the rod\n") !=
        std::string::npos);
    CHECK(keys.help().find("  elements = 8  (whole number >= 1 and <= 1000)\n      along the rod\n") != std::string::npos);
}

}  // namespace scene_reader_test

#endif
