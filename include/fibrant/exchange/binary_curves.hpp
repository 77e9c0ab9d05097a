// SPDX-License-Identifier: MIT
#pragma once
/// @file Curves in VTK's legacy files (.vtk, text and binary) and in binary curve collections (.bcc).

#include <fibrant/exchange/curves.hpp>
#include <fibrant/observe/text_file.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace fibrant::exchange {

namespace detail {

/// @throws std::invalid_argument where there is no file that can be read
inline std::string bytes_of_file(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) refuse_file(path.string(), "", "is no file that can be read");
    return observe::read_file(path);
}

/// Reads a file of words, and of numbers that stand in it as bytes.
class ByteReader {
public:
    ByteReader(std::string_view bytes, std::string file) : bytes_{bytes}, file_{std::move(file)} {}
    bool done() const noexcept { return at_ >= bytes_.size(); }
    std::size_t place() const noexcept { return at_; }
    [[noreturn]] void refuse(const std::string& what) const { refuse_file(file_, "byte " + std::to_string(at_), what); }
    std::string_view line() {
        const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
        std::string_view answer = bytes_.substr(at_, end - at_);
        at_ = std::min(end + 1, bytes_.size());
        if (!answer.empty() && answer.back() == '\r') answer.remove_suffix(1);
        return answer;
    }
    std::string_view word() {
        const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
        while (at_ < bytes_.size() && blank(bytes_[at_])) ++at_;
        const std::size_t first = at_;
        while (at_ < bytes_.size() && !blank(bytes_[at_])) ++at_;
        return bytes_.substr(first, at_ - first);
    }
    template <class Number>
    Number text_number(const std::string& field) {
        const std::string place = "byte " + std::to_string(at_);
        return number<Number>(word(), file_, place, field);
    }
    /// A number as it stands, the bytes in this machine's order or the other way round.
    template <class Number>
    Number raw(bool swapped = false) {
        if (at_ + sizeof(Number) > bytes_.size()) refuse("the file ends early");
        char buffer[sizeof(Number)];
        std::memcpy(buffer, bytes_.data() + at_, sizeof(Number));
        if (swapped)
            for (std::size_t k = 0; k < sizeof(Number) / 2; ++k) std::swap(buffer[k], buffer[sizeof(Number) - 1 - k]);
        at_ += sizeof(Number);
        Number value;
        std::memcpy(&value, buffer, sizeof(Number));
        return value;
    }
    /// A count of things of `size` bytes each that must still be in the file.
    Index counted(Index count, std::size_t size, const std::string& field) const {
        if (count < 0 || static_cast<std::uint64_t>(count) > (bytes_.size() - at_) / std::max<std::size_t>(size, 1))
            refuse(field + " = " + std::to_string(count) + ", but it must be >= 0 and no more than the file has");
        return count;
    }

private:
    std::string_view bytes_;
    std::string file_;
    std::size_t at_ = 0;
};

}  // namespace detail

/// `DATASET POLYDATA` with `POINTS` and `LINES`, as versions below and from 5 on write them, as text or as bytes (big-endian).
/// Point data with the name radius is taken, all else is left.
inline std::vector<FileCurve> curves_of_vtk(std::string_view bytes, const std::string& file) {
    detail::ByteReader reader(bytes, file);
    if (reader.line().rfind("# vtk DataFile Version", 0) != 0)
        refuse_file(file, "1", "does not begin with # vtk DataFile Version");
    reader.line();
    const std::string format(reader.word());
    if (format != "ASCII" && format != "BINARY")
        reader.refuse("format = " + format.substr(0, 40) + ", but it must be ASCII or BINARY");
    const bool binary = format == "BINARY", swap = std::endian::native == std::endian::little;
    std::vector<Vec3> points;
    std::vector<std::vector<Index>> lines;
    std::vector<double> radii;
    const auto read_one = [&](std::string_view type, const std::string& field) -> double {
        if (!binary) return reader.text_number<double>(field);
        if (type == "float") return static_cast<double>(reader.raw<float>(swap));
        if (type == "double") return reader.raw<double>(swap);
        if (type == "int") return static_cast<double>(reader.raw<std::int32_t>(swap));
        if (type == "long" || type == "vtktypeint64") return static_cast<double>(reader.raw<std::int64_t>(swap));
        reader.refuse("type = " + std::string(type.substr(0, 40)) + ", but it must be float, double, int, long or vtktypeint64");
    };
    const auto begin = [&] {
        if (binary) reader.line();
    };
    const auto whole = [&](double value, const std::string& field) {
        constexpr double exact = 9007199254740992.0;  // 2^53: every whole number below it is a double
        if (!(std::abs(value) < exact) || value != std::floor(value))
            reader.refuse(field + " = " + core::text(value) + ", but it must be a whole number");
        return static_cast<Index>(value);
    };
    const auto index = [&](double value) {
        if (!(value >= 0.0) || value != std::floor(value) || value >= static_cast<double>(points.size()))
            reader.refuse("point = " + core::text(value) + ", but it must be one of " + std::to_string(points.size()));
        return static_cast<Index>(value);
    };
    std::string section;
    while (!reader.done()) {
        const std::string word(reader.word());
        if (word.empty()) break;
        if (word == "DATASET") {
            const std::string kind(reader.word());
            if (kind != "POLYDATA") reader.refuse("DATASET = " + kind.substr(0, 40) + ", but it must be POLYDATA");
        } else if (word == "POINTS") {
            const Index count = reader.counted(reader.text_number<Index>("POINTS"), binary ? 12 : 5, "POINTS");
            const std::string type(reader.word());
            begin();
            for (Index k = 0; k < count; ++k) {
                Vec3 point;
                for (double& x : point) x = read_one(type, "point " + std::to_string(k));
                points.push_back(point);
            }
        } else if (word == "LINES") {
            const Index count = reader.text_number<Index>("LINES"),
                        size = reader.counted(reader.text_number<Index>("size of LINES"), binary ? 4 : 2, "size of LINES");
            const std::size_t mark = reader.place();
            if (const std::string next(reader.word()); next == "OFFSETS") {
                const std::string type(reader.word());
                begin();
                std::vector<Index> offsets;
                for (Index k = 0; k < count; ++k) offsets.push_back(whole(read_one(type, "offset"), "offset"));
                if (std::string(reader.word()) != "CONNECTIVITY") reader.refuse("OFFSETS without CONNECTIVITY");
                const std::string second(reader.word());
                begin();
                std::vector<Index> all;
                for (Index k = 0; k < size; ++k) all.push_back(index(read_one(second, "connectivity")));
                for (std::size_t k = 0; k + 1 < offsets.size(); ++k) {
                    if (offsets[k] < 0 || offsets[k + 1] < offsets[k] || offsets[k + 1] > size)
                        reader.refuse("offset = " + std::to_string(offsets[k + 1]) +
                                      ", but it must rise and be <= " + std::to_string(size));
                    lines.emplace_back(all.begin() + offsets[k], all.begin() + offsets[k + 1]);
                }
            } else {
                reader = detail::ByteReader(bytes, file);
                while (reader.place() < mark) reader.raw<char>();
                begin();
                for (Index read = 0; read < size;) {
                    const Index n = whole(read_one("int", "points of a line"), "points of a line");
                    if (n < 0 || read + n + 1 > size)
                        reader.refuse("points of a line = " + std::to_string(n) + ", but it must fit the size of LINES");
                    lines.emplace_back();
                    for (Index k = 0; k < n; ++k) lines.back().push_back(index(read_one("int", "point of a line")));
                    read += n + 1;
                }
                if (core::count(lines) != count)
                    reader.refuse("LINES = " + std::to_string(count) + ", but it must be " + std::to_string(lines.size()) +
                                  ", as many as follow");
            }
        } else if (word == "POINT_DATA" || word == "CELL_DATA") {
            section = word;
            if (const Index told = reader.text_number<Index>(word); word == "POINT_DATA" && told != core::count(points))
                reader.refuse("POINT_DATA = " + std::to_string(told) + ", but it must be " + std::to_string(points.size()) +
                              ", as many as there are points");
        } else if (word == "SCALARS") {
            const std::string name(reader.word()), type(reader.word());
            const std::string_view rest = reader.line();
            Index components = 1;
            if (!detail::words(rest, "").empty())
                components = detail::number<Index>(detail::words(rest, "")[0], file, "SCALARS", "components");
            const std::size_t mark = reader.place();
            if (std::string(reader.word()) == "LOOKUP_TABLE") {
                reader.line();
            } else {
                reader = detail::ByteReader(bytes, file);
                while (reader.place() < mark) reader.raw<char>();
            }
            if (section != "POINT_DATA" || components != 1) break;  // of cells: nothing that is needed follows
            for (std::size_t k = 0; k < points.size(); ++k) {
                const double value = read_one(type, name);
                if (name == "radius") radii.push_back(value);
            }
        } else if (word == "METADATA" || word == "FIELD" || word == "VECTORS" || word == "NORMALS") {
            break;
        }
    }
    std::vector<FileCurve> curves;
    for (const std::vector<Index>& line : lines) {
        FileCurve curve;
        for (const Index k : line) {
            curve.points.push_back(points[core::at(k)]);
            if (!radii.empty()) curve.radii.push_back(radii[core::at(k)]);
        }
        if (!curve.radii.empty()) {
            curve.radius = curve.radii.front();
            if (std::all_of(curve.radii.begin(), curve.radii.end(), [&](double r) { return r == curve.radius; }))
                curve.radii.clear();
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

/// The same as text, version 3.0, with the digits that identify each number.
inline std::string vtk_of(const std::vector<FileCurve>& curves) {
    std::string points, lines, radii;
    Index first = 0, size = 0;
    for (const FileCurve& curve : curves) {
        const Index count = core::count(curve.points), all = count + (curve.closed ? 1 : 0);
        for (Index k = 0; k < count; ++k) {
            const Vec3& point = curve.points[core::at(k)];
            points +=
                observe::shortest(point.x()) + " " + observe::shortest(point.y()) + " " + observe::shortest(point.z()) + "\n";
            const double radius = curve.radii.empty() ? curve.radius : curve.radii[core::at(k)];
            radii += observe::shortest(std::isnan(radius) ? 1.0 : radius) + "\n";
        }
        lines += std::to_string(all);
        for (Index k = 0; k < all; ++k) lines += " " + std::to_string(first + k % count);
        lines += "\n";
        first += count, size += all + 1;
    }
    return "# vtk DataFile Version 3.0\ncurves\nASCII\nDATASET POLYDATA\nPOINTS " + std::to_string(first) + " double\n" + points +
           "LINES " + std::to_string(curves.size()) + " " + std::to_string(size) + "\n" + lines + "POINT_DATA " +
           std::to_string(first) + "\nSCALARS radius double 1\nLOOKUP_TABLE default\n" + radii;
}

/// Binary curve collections (Yuksel, yarn-level cloth models): a head of 64 bytes, then of each curve the count of its points,
/// negative where it is closed, and these as single precision.
inline std::vector<FileCurve> curves_of_bcc(std::string_view bytes, const std::string& file) {
    static_assert(std::endian::native == std::endian::little, "the numbers of the file are little-endian");
    detail::ByteReader reader(bytes, file);
    if (bytes.size() < 64 || bytes.substr(0, 3) != "BCC")
        refuse_file(file, "byte 0", "does not begin with BCC and a head of 64 bytes");
    if (static_cast<unsigned char>(bytes[3]) != 0x44) refuse_file(file, "byte 3", "numbers are not of four bytes (0x44)");
    if (bytes[6] != 3)
        refuse_file(file, "byte 6", "dimensions = " + std::to_string(static_cast<int>(bytes[6])) + ", but it must be 3");
    for (int k = 0; k < 8; ++k) reader.raw<char>();
    const auto count = static_cast<std::int64_t>(reader.raw<std::uint64_t>()),
               total = static_cast<std::int64_t>(reader.raw<std::uint64_t>());
    for (int k = 0; k < 40; ++k) reader.raw<char>();
    reader.counted(count, 4, "curves");
    std::vector<FileCurve> curves;
    std::int64_t points = 0;
    for (std::int64_t c = 0; c < count; ++c) {
        const auto n = static_cast<std::int64_t>(reader.raw<std::int32_t>());
        FileCurve curve;
        curve.closed = n < 0;
        const Index all = reader.counted(n < 0 ? -n : n, 12, "points of curve " + std::to_string(c));
        for (Index k = 0; k < all; ++k) {
            Vec3 point;
            for (double& x : point) x = static_cast<double>(reader.raw<float>());
            curve.points.push_back(point);
        }
        points += all;
        curves.push_back(std::move(curve));
    }
    if (points != total)
        refuse_file(
            file, "byte 16",
            "points in all = " + std::to_string(total) + ", but it must be " + std::to_string(points) + ", as many as there are");
    return curves;
}
inline std::string bcc_of(const std::vector<FileCurve>& curves) {
    std::string bytes = "BCC";
    const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    bytes += static_cast<char>(0x44);
    bytes += "PL";
    bytes += static_cast<char>(3), bytes += static_cast<char>(2);
    std::uint64_t total = 0;
    for (const FileCurve& curve : curves) total += curve.points.size();
    put(static_cast<std::uint64_t>(curves.size())), put(total);
    bytes.resize(64, '\0');
    for (const FileCurve& curve : curves) {
        const auto n = static_cast<std::int32_t>(curve.points.size());
        put(curve.closed ? -n : n);
        for (const Vec3& point : curve.points)
            for (const double x : point) put(static_cast<float>(x));
    }
    return bytes;
}

}  // namespace fibrant::exchange
