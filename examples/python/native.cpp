// SPDX-License-Identifier: MIT
// The programs for Python: runs one, and hands back its end as arrays that look into it, without copies.
#include "../support/example.hpp"
#include "../support/program.hpp"

#include <fibrant/exchange/files.hpp>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;
namespace observe = fibrant::observe;

PYBIND11_MAKE_OPAQUE(std::vector<observe::ContactSnapshot>)

// FIBRANT_PROGRAMS is PROGRAM(weave) PROGRAM(textile) ..., those that were built.
#define PROGRAM(name) example::Program name##_program();
FIBRANT_PROGRAMS
#undef PROGRAM

namespace {

std::vector<example::Program> programs() {
#define PROGRAM(name) name##_program(),
    return {FIBRANT_PROGRAMS};
#undef PROGRAM
}

/// The program of a name.
/// @throws std::invalid_argument
example::Program program_of(const std::string& name) {
    std::string names;
    for (const example::Program& program : programs()) {
        if (name == program.name) return program;
        names += (names.empty() ? "" : ", ") + std::string(program.name);
    }
    throw std::invalid_argument("program = " + example::clipped(name) +
                                ", but it must be one of those that were built: " + names);
}

/// The end of a run.
struct End {
    bool sound = false, stopped = false;
    observe::Snapshot snapshot;
    std::string summary;  ///< as summary.json
};

/// An array that looks at numbers of `owner`, which it keeps alive.
/// @param first       of the first row
/// @param step        from row to row [bytes]
/// @param components  of a row; 1: the array has one dimension
template <class Number>
py::array looking_at(const Number* first, std::size_t rows, std::size_t step, py::ssize_t components, const py::handle& owner) {
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows)}, strides{static_cast<py::ssize_t>(step)};
    if (components > 1) shape.push_back(components), strides.push_back(sizeof(Number));
    py::array answer(py::dtype::of<Number>(), shape, strides, first, owner);
    answer.attr("flags").attr("writeable") = false;
    return answer;
}

template <class Value>
struct Row {
    using Number = Value;
    static constexpr py::ssize_t components = 1;
    static const Number* first(const Value& value) { return &value; }
};
template <>
struct Row<fibrant::Vec3> {
    using Number = double;
    static constexpr py::ssize_t components = 3;
    static const Number* first(const fibrant::Vec3& value) { return value.data(); }
};

/// Property: all values of a list that is a member.
template <class Owner, class Value>
auto values(std::vector<Value> Owner::*list) {
    return [list](const py::object& self) {
        const std::vector<Value>& of = self.cast<const Owner&>().*list;
        return looking_at(of.empty() ? nullptr : Row<Value>::first(of.front()), of.size(), sizeof(Value), Row<Value>::components,
                          self);
    };
}
/// Property: a member of all elements of a list.
template <class Element, class Value>
auto values(Value Element::*member) {
    return [member](const py::object& self) {
        const auto& of = self.cast<const std::vector<Element>&>();
        return looking_at(of.empty() ? nullptr : Row<Value>::first(of.front().*member), of.size(), sizeof(Element),
                          Row<Value>::components, self);
    };
}

/// Runs a program. Ctrl-C ends it after the increment that it is in.
/// @param name  of the scene's file; where a text is given, that messages call it
std::unique_ptr<End> run(const std::string& program, const std::string& name, const std::optional<std::string>& text,
                         const std::vector<std::string>& set, const std::string& folder, const std::string& threads, bool resume,
                         bool overwrite, bool quiet) {
    const example::Program chosen = program_of(program);
    auto end = std::make_unique<End>();
    const py::gil_scoped_release others_may_run;
    example::require_folder(folder);
    example::SceneReader scene(name, text ? *text : example::scene_text(name), set);
    example::Output output;
    output.folder = folder, output.scene = name;
    output.resume = resume, output.overwrite = overwrite, output.quiet = quiet;
    output.ended = [&](const observe::Snapshot& snapshot, const observe::JsonObject& summary) {
        end->snapshot = snapshot, end->summary = summary.text();
    };
    const example::ListeningForStops listening;
    end->sound = example::solve(chosen, scene, output, threads, "threads");
    end->stopped = example::stopped();
    return end;
}

std::string keys_of(const std::string& program) {
    example::SceneReader scene = example::SceneReader::of_keys();
    example::Output output;
    try {
        example::solve(program_of(program), scene, output);
    } catch (const example::Described&) {
    }
    return scene.help();
}

}  // namespace

PYBIND11_MODULE(native, module) {
    using observe::ContactSnapshot, observe::FibreSnapshot, fibrant::exchange::FileCurve;
    using Contacts = std::vector<ContactSnapshot>;
    module.attr("version") = FIBRANT_VERSION;
    py::class_<FibreSnapshot>(module, "Fibre", "A fibre: rows of arrays are its nodes.")
        .def_property_readonly("centreline", values(&FibreSnapshot::position), "(nodes, 3) [length]")
        .def_property_readonly("displacement", values(&FibreSnapshot::displacement), "(nodes, 3), since the rest shape [length]")
        .def_property_readonly("director_1", values(&FibreSnapshot::director_1), "(nodes, 3), of the section [1]")
        .def_property_readonly("director_2", values(&FibreSnapshot::director_2), "(nodes, 3), of the section [1]")
        .def_property_readonly("curvature", values(&FibreSnapshot::curvature), "(nodes,) [1 / length]")
        .def_property_readonly(
            "semi_axes",
            [](const FibreSnapshot& fibre) {
                return std::pair{fibre.section.semi_axis_1, fibre.section.semi_axis_2};
            },
            "of the section at rest, along its directors [length]")
        .def_readonly("group", &FibreSnapshot::group, "number of its tow or yarn family; -1: none")
        .def_readonly("closed", &FibreSnapshot::closed, "its last node is its first one");
    py::class_<Contacts>(module, "Contacts", "Contact elements: rows of arrays. Normals point from fibre i to fibre j.")
        .def("__len__", &Contacts::size)
        .def_property_readonly("fibre_i", values(&ContactSnapshot::fibre_i), "(n,)")
        .def_property_readonly("fibre_j", values(&ContactSnapshot::fibre_j), "(n,)")
        .def_property_readonly("abscissa_i", values(&ContactSnapshot::abscissa_i), "(n,), arc at rest [length]")
        .def_property_readonly("abscissa_j", values(&ContactSnapshot::abscissa_j), "(n,), arc at rest [length]")
        .def_property_readonly("position", values(&ContactSnapshot::position), "(n, 3), middle of the two particles [length]")
        .def_property_readonly("normal", values(&ContactSnapshot::normal), "(n, 3) [1]")
        .def_property_readonly("gap", values(&ContactSnapshot::gap), "(n,), < 0 in penetration [length]")
        .def_property_readonly("reaction", values(&ContactSnapshot::reaction), "(n,), on fibre j along the normal [force]")
        .def_property_readonly("friction", values(&ContactSnapshot::friction), "(n, 3), on fibre i [force]");
    py::class_<End>(module, "End")
        .def_readonly("sound", &End::sound)
        .def_readonly("stopped", &End::stopped)
        .def_readonly("summary", &End::summary)
        .def_property_readonly(
            "contacts", [](const End& end) -> const Contacts& { return end.snapshot.contacts; },
            py::return_value_policy::reference_internal)
        .def_property_readonly("fibres", [](const py::object& self) {
            const End& end = self.cast<const End&>();
            py::list fibres;
            for (const FibreSnapshot& fibre : end.snapshot.fibres)
                fibres.append(py::cast(&fibre, py::return_value_policy::reference_internal, self));
            return fibres;
        });
    py::class_<FileCurve>(module, "Curve", "A centreline of a file.")
        .def_property_readonly("points", values(&FileCurve::points), "(n, 3) [length]")
        .def_readonly("radius", &FileCurve::radius, "nan where the file has none [length]")
        .def_readonly("closed", &FileCurve::closed)
        .def_readonly("group", &FileCurve::group, "number of the yarn; -1: none")
        .def_readonly("name", &FileCurve::name);
    module.def("run", &run);
    module.def("keys", &keys_of);
    module.def(
        "read_curves", [](const std::string& path) { return fibrant::exchange::read_curves(path); },
        "Centrelines of a file: .csv, .txt, .vtk, .vtp, .obj, .bcc, .inp or .tg3.");
}
