// SPDX-License-Identifier: MIT
#pragma once
/// @file VTK's XML PolyData format (.vtp) and collections of such files in time (.pvd), as ParaView reads them.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/observe/observer.hpp>
#include <fibrant/observe/text_file.hpp>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fibrant::observe {

/// Points, polylines, vertices and triangles with named values, written as appended raw binary.
class PolyData {
public:
    Index add_point(const Vec3& point) {
        points_.push_back(point);
        return core::count(points_) - 1;
    }
    /// Points [first, first + count) as a line, which comes back to the first if it is closed. Cells are numbered vertices first,
    /// then lines, each in order.
    void add_line(Index first, Index count, bool closed = false) {
        for (Index k = 0; k < count; ++k) line_points_.push_back(first + k);
        if (closed) line_points_.push_back(first);
        line_ends_.push_back(core::count(line_points_));
    }
    void add_vertex(Index point) { vertex_points_.push_back(point); }
    /// Anticlockwise as seen from outside. Triangles are numbered after lines.
    void add_triangle(Index a, Index b, Index c) {
        for (const Index point : {a, b, c}) triangle_points_.push_back(point);
    }

    /// Values of the points or cells, one for each in their order, in the precision of the file (single).
    void point_scalars(std::string name, std::span<const double> values) { add(point_data_, std::move(name), values); }
    void point_vectors(std::string name, std::span<const Vec3> values) { add(point_data_, std::move(name), values); }
    void cell_scalars(std::string name, std::span<const double> values) { add(cell_data_, std::move(name), values); }

    /// Makes room for so many points and vertices: lists that grow by themselves take up to twice as much.
    void reserve(std::size_t points, std::size_t vertices) { points_.reserve(points), vertex_points_.reserve(vertices); }

    /// The file's content in pieces, so that it is in memory but once: put(std::string_view) is called with each in its turn.
    /// Throws std::invalid_argument, before that, if an array's length is not that of the points or cells.
    template <class Put>
    void write(const Put& put) const {
        static_assert(std::endian::native == std::endian::little, "the header states little endian");
        const std::size_t cells = vertex_points_.size() + line_ends_.size() + triangle_points_.size() / 3;
        std::string head =
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
            "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
            std::to_string(points_.size()) + "\" NumberOfVerts=\"" + std::to_string(vertex_points_.size()) +
            "\" NumberOfLines=\"" + std::to_string(line_ends_.size()) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
            std::to_string(triangle_points_.size() / 3) + "\">\n";
        std::vector<std::string_view> data;
        list_arrays(head, data, "PointData", point_data_, points_.size());
        list_arrays(head, data, "CellData", cell_data_, cells);
        head += "<Points>\n";
        static_assert(sizeof(Vec3) == 3 * sizeof(double));
        list_array<double>(head, data, "Points", "Float64", 3,
                           {reinterpret_cast<const double*>(points_.data()), 3 * points_.size()});
        head += "</Points>\n";
        std::vector<std::int64_t> vertex_ends, triangle_ends;
        for (std::size_t k = 0; k < vertex_points_.size(); ++k) vertex_ends.push_back(static_cast<std::int64_t>(k + 1));
        list_cells(head, data, "Verts", vertex_points_, vertex_ends);
        list_cells(head, data, "Lines", line_points_, line_ends_);
        if (!triangle_points_.empty()) {
            for (std::size_t k = 3; k <= triangle_points_.size(); k += 3) triangle_ends.push_back(static_cast<std::int64_t>(k));
            list_cells(head, data, "Polys", triangle_points_, triangle_ends);
        }
        put(std::string_view(head += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_"));
        for (const std::string_view array : data) {
            const std::uint64_t bytes = array.size();
            put(std::string_view(reinterpret_cast<const char*>(&bytes), sizeof bytes));
            put(array);
        }
        put(std::string_view("\n</AppendedData>\n</VTKFile>\n"));
    }
    /// All of it; throws as `write`.
    std::string text() const {
        std::string text;
        write([&](std::string_view piece) { text += piece; });
        return text;
    }

private:
    struct Array {
        std::string name;
        std::size_t components;
        std::vector<float> values;
    };

    static void add(std::vector<Array>& arrays, std::string&& name, std::span<const double> values) {
        Array array{std::move(name), 1, {}};
        array.values.reserve(values.size());
        for (const double value : values) array.values.push_back(static_cast<float>(value));
        arrays.push_back(std::move(array));
    }
    static void add(std::vector<Array>& arrays, std::string&& name, std::span<const Vec3> values) {
        Array array{std::move(name), 3, {}};
        array.values.reserve(3 * values.size());
        for (const Vec3& value : values)
            for (const double component : value) array.values.push_back(static_cast<float>(component));
        arrays.push_back(std::move(array));
    }

    /// Tells of an array in the head, and adds its bytes to the data, whose place is that behind all before them and their sizes.
    template <class Number>
    static void list_array(std::string& head, std::vector<std::string_view>& data, const std::string& name, const char* type,
                           std::size_t components, std::span<const Number> values) {
        std::size_t offset = 0;
        for (const std::string_view before : data) offset += sizeof(std::uint64_t) + before.size();
        head += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + xml_escaped(name) + "\" NumberOfComponents=\"" +
                std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
        data.emplace_back(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    }

    static void list_arrays(std::string& head, std::vector<std::string_view>& data, const std::string& kind,
                            const std::vector<Array>& arrays, std::size_t count) {
        head += "<" + kind + ">\n";
        for (const Array& array : arrays) {
            if (array.values.size() != count * array.components)
                core::refuse("PolyData." + array.name, std::to_string(array.values.size() / array.components),
                             "one value for each of " + std::to_string(count));
            list_array<float>(head, data, array.name, "Float32", array.components, array.values);
        }
        head += "</" + kind + ">\n";
    }

    static void list_cells(std::string& head, std::vector<std::string_view>& data, const std::string& kind,
                           const std::vector<std::int64_t>& points, const std::vector<std::int64_t>& ends) {
        head += "<" + kind + ">\n";
        list_array<std::int64_t>(head, data, "connectivity", "Int64", 1, points);
        list_array<std::int64_t>(head, data, "offsets", "Int64", 1, ends);
        head += "</" + kind + ">\n";
    }

    std::vector<Vec3> points_;
    std::vector<std::int64_t> vertex_points_, line_points_, line_ends_, triangle_points_;
    std::vector<Array> point_data_, cell_data_;
};

/// A .pvd collection: the files of a series and their times, rewritten whole after each one.
class FileSeries {
public:
    /// @param path  of the collection; resumed, the entries that it holds are kept
    FileSeries(std::filesystem::path path, Start start) : path_{std::move(path)} {
        if (start == Start::anew) return;
        const std::string text = read_file(path_);
        for (std::size_t at = text.find("<DataSet "); at != std::string::npos; at = text.find("<DataSet ", at + 1)) {
            const std::string time = attribute(text, at, "timestep"), file = attribute(text, at, "file");
            double value = 0.0;
            const auto [end, error] = std::from_chars(time.data(), time.data() + time.size(), value);
            static_cast<void>(end);
            if (error == std::errc{} && !file.empty()) entries_.push_back({value, file});
        }
    }

    /// Writes <stem of the collection>_<increment, four digits>.EXTENSION beside the collection, and adds it.
    void write(Index increment, const std::string& extension, const std::string& text) {
        const std::string file = name(increment, extension);
        write_file(path_.parent_path() / file, text);
        add(static_cast<double>(increment), file);
    }
    /// The same of a file .vtp, which is in memory but once.
    void write(Index increment, const PolyData& data) {
        const std::string file = name(increment, "vtp");
        write_pieces(path_.parent_path() / file, [&](const auto& put) { data.write(put); });
        add(static_cast<double>(increment), file);
    }

    /// Adds a file (its name within the folder of the collection) and drops entries that are not earlier: they are
    /// from increments that a resumed run repeats.
    void add(double time, const std::string& file) {
        std::erase_if(entries_, [&](const Entry& entry) { return entry.time >= time; });
        entries_.push_back({time, xml_escaped(file)});
        std::string text =
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
            "byte_order=\"LittleEndian\">\n<Collection>\n";
        for (const Entry& entry : entries_)
            text += "<DataSet timestep=\"" + shortest(entry.time) + "\" group=\"\" part=\"0\" file=\"" + entry.file + "\"/>\n";
        write_file(path_, text + "</Collection>\n</VTKFile>\n");
    }

private:
    struct Entry {
        double time;
        std::string file;  ///< escaped
    };
    std::string name(Index increment, const std::string& extension) const {
        std::string number = std::to_string(increment);
        if (number.size() < 4) number.insert(0, 4 - number.size(), '0');
        return path_.stem().string() + "_" + number + "." + extension;
    }
    static std::string attribute(const std::string& text, std::size_t from, const std::string& name) {
        const std::size_t end = text.find('>', from), at = text.find(" " + name + "=\"", from);
        if (end == std::string::npos || at == std::string::npos || at > end) return {};
        const std::size_t first = at + name.size() + 3;
        return text.substr(first, text.find('"', first) - first);
    }

    std::filesystem::path path_;
    std::vector<Entry> entries_;
};

}  // namespace fibrant::observe
