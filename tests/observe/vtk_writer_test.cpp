// SPDX-License-Identifier: MIT
#include "observe/snapshot_samples.hpp"
#include "observe/vtk_arrays.hpp"
#include "refusal.hpp"

#include <fibrant/observe/vtk_writer.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

using namespace fibrant;

namespace vtk_writer_test {

using namespace fibrant::observe;

using test::array_of;

std::vector<std::string> entries(const std::filesystem::path& series) {
    const std::string text = read_file(series);
    std::vector<std::string> files;
    for (std::size_t at = text.find("file=\""); at != std::string::npos; at = text.find("file=\"", at + 1))
        files.push_back(text.substr(at + 6, text.find('"', at + 6) - at - 6));
    return files;
}

TEST_CASE("a fibre becomes one polyline with its values at the nodes") {
    const std::string file = fibre_data(crossing_pair()).text();
    CHECK(file.find("NumberOfPoints=\"8\" NumberOfVerts=\"0\" NumberOfLines=\"2\"") != std::string::npos);
    const auto points = array_of<double>(file, "Points");
    REQUIRE(points.size() == 24);
    CHECK(points[0] == -1.0);
    CHECK(points[9 + 2] == 0.3);  // first node of the second fibre
    CHECK(array_of<float>(file, "radius") == std::vector<float>{0.1f, 0.1f, 0.1f, 0.2f, 0.2f, 0.2f, 0.2f, 0.2f});
    CHECK(array_of<float>(file, "curvature") == std::vector<float>{0, 1, 2, 0, 1, 2, 3, 4});
    CHECK(array_of<float>(file, "displacement")[5] == -1.0f);
    CHECK(array_of<float>(file, "director_1").size() == 24);
    CHECK(array_of<float>(file, "director_2").size() == 24);
    CHECK(array_of<float>(file, "fibre") == std::vector<float>{0, 1});
    CHECK(array_of<float>(file, "group") == std::vector<float>{0, 1});
    CHECK(array_of<std::int64_t>(file, "connectivity", "<Lines") == std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7});
    CHECK(array_of<std::int64_t>(file, "offsets", "<Lines") == std::vector<std::int64_t>{3, 8});
    CHECK(array_of<std::int64_t>(file, "offsets", "<Verts").empty());
}

TEST_CASE("a contact becomes a vertex whose normal force is its reaction along the normal") {
    const std::string file = contact_data(crossing_pair()).text();
    CHECK(file.find("NumberOfPoints=\"2\" NumberOfVerts=\"2\" NumberOfLines=\"0\"") != std::string::npos);
    CHECK(array_of<float>(file, "reaction") == std::vector<float>{2, 0});
    CHECK(array_of<float>(file, "penetration") == std::vector<float>{0.005f, 0});
    CHECK(array_of<float>(file, "gap") == std::vector<float>{-0.005f, 0.25f});
    CHECK(array_of<float>(file, "normal") == std::vector<float>{0, 0, 1, 1, 0, 0});
    CHECK(array_of<float>(file, "normal_force") == std::vector<float>{0, 0, 2, 0, 0, 0});
    CHECK(array_of<float>(file, "friction") == std::vector<float>{0.3f, 0.4f, 0, 0, 0, 0});
    CHECK(array_of<float>(file, "stiffness") == std::vector<float>{400, 400});
    CHECK(array_of<float>(file, "crossing") == std::vector<float>{1, 0});
    CHECK(array_of<std::int64_t>(file, "connectivity", "<Verts") == std::vector<std::int64_t>{0, 1});
    CHECK(array_of<std::int64_t>(file, "offsets", "<Verts") == std::vector<std::int64_t>{1, 2});
}

TEST_CASE("a contact with a tool has the tool in the place of its first fibre, below all numbers of fibres") {
    Snapshot snapshot = crossing_pair();
    ToolContactSnapshot held;
    held.fibre = 1, held.tool = 0;
    held.normal = Vec3::UnitY(), held.gap = -0.01, held.reaction = 3.0, held.friction = {0.5, 0, 0};
    snapshot.tool_contacts = {held, held};
    snapshot.tool_contacts.back().tool = 2;
    const std::string file = contact_data(snapshot).text();
    CHECK(array_of<float>(file, "fibre_i") == std::vector<float>{0, 0, -1, -3});
    CHECK(array_of<float>(file, "fibre_j") == std::vector<float>{1, 1, 1, 1});
    CHECK(array_of<float>(file, "normal_force") == std::vector<float>{0, 0, 2, 0, 0, 0, 0, 3, 0, 0, 3, 0});
    CHECK(array_of<float>(file, "friction") == std::vector<float>{0.3f, 0.4f, 0, 0, 0, 0, 0.5f, 0, 0, 0.5f, 0, 0});
}

TEST_CASE("an array that is not of the length of the points is refused by name") {
    PolyData data;
    data.add_point(Vec3::Zero());
    data.point_scalars("radius", std::vector<double>{1.0, 2.0});
    CHECK(test::refusal([&] { return data.text(); }) == "PolyData.radius = 2, but it must be one value for each of 1");
}

TEST_CASE("a resumed series keeps earlier increments and drops those that are repeated") {
    const auto folder = empty_folder("vtk_series");
    VtkWriter first(folder / "deep" / "run");
    for (const Index increment : {1, 2, 3}) first.accepted(crossing_pair(increment));
    const auto run = folder / "deep" / "run";
    CHECK(read_file(run / "fibres_0002.vtp") == fibre_data(crossing_pair(2)).text());
    CHECK(read_file(run / "contacts_0002.vtp") == contact_data(crossing_pair(2)).text());
    CHECK(entries(run / "fibres.pvd") == std::vector<std::string>{"fibres_0001.vtp", "fibres_0002.vtp", "fibres_0003.vtp"});

    VtkWriter resumed(run, Start::resumed);
    resumed.accepted(crossing_pair(3));
    resumed.accepted(crossing_pair(4));
    const std::vector<std::string> all{"contacts_0001.vtp", "contacts_0002.vtp", "contacts_0003.vtp", "contacts_0004.vtp"};
    CHECK(entries(run / "contacts.pvd") == all);
    CHECK(entries(run / "fibres.pvd").size() == 4);
    for (const std::string& file : all) CHECK(std::filesystem::exists(run / file));
    for (const auto& entry : std::filesystem::directory_iterator(run)) CHECK(entry.path().extension() != ".partial");

    VtkWriter anew(run);
    anew.accepted(crossing_pair(12345));
    CHECK(entries(run / "fibres.pvd") == std::vector<std::string>{"fibres_12345.vtp"});
}

TEST_CASE("a folder that cannot be written is reported by the file's name") {
    const auto folder = empty_folder("vtk_refused");
    write_file(folder / "taken", "a file, not a folder");
    CHECK_THROWS_WITH_AS(write_file(folder / "taken" / "inside", "x"), doctest::Contains("cannot write the file"),
                         std::runtime_error);
}

TEST_CASE("VTK itself reads what was written, also an increment without contacts") {
    const auto folder = empty_folder("vtk_read");
    VtkWriter writer(folder);
    Snapshot snapshot = crossing_pair(1);
    writer.accepted(snapshot);
    snapshot.increment = 2;
    snapshot.contacts.clear();
    writer.accepted(snapshot);
    write_file(folder / "read.py", R"(import sys, vtk
def read(name):
    reader = vtk.vtkXMLPolyDataReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append(name))
    reader.SetFileName(sys.argv[1] + "/" + name)
    reader.Update()
    assert not errors, errors
    return reader.GetOutput()
fibres = read("fibres_0001.vtp")
assert (fibres.GetNumberOfPoints(), fibres.GetNumberOfLines()) == (8, 2)
assert fibres.GetCell(1).GetNumberOfPoints() == 5
assert fibres.GetPoint(7) == (0.0, 1.0, 0.3)
assert abs(fibres.GetPointData().GetArray("radius").GetValue(3) - 0.2) < 1e-7
assert fibres.GetPointData().GetArray("displacement").GetTuple3(4) == (0.25, 0.5, -1.0)
assert fibres.GetCellData().GetArray("group").GetValue(1) == 1
contacts = read("contacts_0001.vtp")
assert contacts.GetNumberOfVerts() == 2
assert contacts.GetPointData().GetArray("normal_force").GetTuple3(0) == (0.0, 0.0, 2.0)
assert read("contacts_0002.vtp").GetNumberOfPoints() == 0
import xml.dom.minidom
series = xml.dom.minidom.parse(sys.argv[1] + "/fibres.pvd").getElementsByTagName("DataSet")
assert [(s.getAttribute("timestep"), s.getAttribute("file")) for s in series] == [
    ("1", "fibres_0001.vtp"), ("2", "fibres_0002.vtp")]
)");
    // Debian's VTK is a module of Debian's Python, which need not be the first one on the path.
    std::string python;
    for (const char* candidate : {"python3", "/usr/bin/python3"})
        if (python.empty() && std::system((std::string(candidate) + " -c 'import vtk' 2>/dev/null").c_str()) == 0)
            python = candidate;
    if (python.empty()) {
        MESSAGE("left out: no Python with VTK (Debian's python3-vtk9)");
        return;
    }
    CHECK(std::system((python + " '" + (folder / "read.py").string() + "' '" + folder.string() + "'").c_str()) == 0);
}

}  // namespace vtk_writer_test
