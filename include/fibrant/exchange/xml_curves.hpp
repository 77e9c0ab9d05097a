// SPDX-License-Identifier: MIT
#pragma once
/// @file Curves in files of XML: VTK's .vtp and TexGen's .tg3. Needs pugixml, which who uses them links.

#if !__has_include(<pugixml.hpp>)
#error "fibrant/exchange/xml_curves.hpp needs pugixml (Debian: libpugixml-dev)"
#endif

#include <fibrant/exchange/curves.hpp>
#include <fibrant/observe/text_file.hpp>

#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace fibrant::exchange {

namespace detail {

inline void parse_xml(pugi::xml_document& document, std::string_view text, const std::string& file) {
    const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
    if (!result) refuse_file(file, "byte " + std::to_string(result.offset), std::string("is no XML: ") + result.description());
}

/// Bytes of a text in base 64. @throws std::invalid_argument naming the file, for what is none
inline std::string from_base64(std::string_view text, const std::string& file) {
    std::string bytes;
    std::uint32_t bits = 0;
    int held = 0;
    for (const char c : text) {
        if (c == '=') {  // the length may be encoded by itself: what follows begins anew
            bits = 0, held = 0;
            continue;
        }
        const int value = c >= 'A' && c <= 'Z'                              ? c - 'A'
                          : c >= 'a' && c <= 'z'                            ? c - 'a' + 26
                          : c >= '0' && c <= '9'                            ? c - '0' + 52
                          : c == '+'                                        ? 62
                          : c == '/'                                        ? 63
                          : c == ' ' || c == '\n' || c == '\r' || c == '\t' ? -1
                                                                            : -2;
        if (value == -2) refuse_file(file, "", "a letter that is not of base64");
        if (value < 0) continue;
        bits = (bits << 6) | static_cast<std::uint32_t>(value), held += 6;
        if (held >= 8) held -= 8, bytes += static_cast<char>((bits >> held) & 0xffu);
    }
    return bytes;
}

/// Arrays of a .vtp file as numbers.
class VtpArrays {
public:
    VtpArrays(std::string_view bytes, std::string file) : file_{std::move(file)} {
        std::string head(bytes);
        if (const std::size_t begin = bytes.find("<AppendedData"); begin != std::string_view::npos) {
            const std::size_t end = bytes.find('>', begin), mark = bytes.find('_', end);
            if (mark == std::string_view::npos)
                refuse_file(file_, "byte " + std::to_string(begin), "AppendedData without its mark _");
            const std::string_view tag = bytes.substr(begin, end - begin);
            if (bytes.find("</VTKFile>", mark) == std::string_view::npos)
                refuse_file(file_, "byte " + std::to_string(bytes.size()), "the file ends early, before </VTKFile>");
            base64_ = tag.find("base64") != std::string_view::npos;
            appended_ = bytes.substr(mark + 1);
            head = std::string(bytes.substr(0, begin)) + "</VTKFile>";
        }
        parse_xml(document_, head, file_);
        const pugi::xml_node root = document_.child("VTKFile");
        if (std::string(root.attribute("type").value()) != "PolyData")
            refuse_file(file_, "", "VTKFile type = " + std::string(root.attribute("type").value()) + ", but it must be PolyData");
        if (!root.attribute("compressor").empty())
            refuse_file(file_, "",
                        "compressor = " + std::string(root.attribute("compressor").value()) +
                            ", but it must be none: save it without compression");
        if (std::string(root.attribute("byte_order").value()) == "BigEndian")
            refuse_file(file_, "", "byte_order = BigEndian, but it must be LittleEndian");
        header_ = std::string(root.attribute("header_type").value()) == "UInt64" ? 8 : 4;
    }
    pugi::xml_node data() const { return document_.child("VTKFile").child("PolyData"); }

    std::vector<double> numbers(const pugi::xml_node& array) const {
        const std::string name = array.attribute("Name").value(), format = array.attribute("format").value(),
                          type = array.attribute("type").value();
        std::vector<double> values;
        if (format == "ascii") {
            std::string text = array.text().get();
            std::replace(text.begin(), text.end(), '\n', ' ');
            for (const std::string_view word : words(text, "")) values.push_back(number<double>(word, file_, "", name));
            return values;
        }
        std::string block;
        if (format == "binary") {
            block = from_base64(array.text().get(), file_);
        } else if (format == "appended") {
            const auto offset = number<std::uint64_t>(array.attribute("offset").value(), file_, "", name + ": offset");
            if (offset > appended_.size())
                refuse_file(file_, "", name + ": offset = " + std::to_string(offset) + ", but it must be within the data");
            std::string_view rest = appended_.substr(offset);
            block = base64_ ? from_base64(rest.substr(0, rest.find('<')), file_) : std::string(rest);
        } else {
            refuse_file(file_, "", name + ": format = " + format + ", but it must be ascii, binary or appended");
        }
        std::uint64_t size = 0;
        if (block.size() < header_) refuse_file(file_, "", name + ": the data end early");
        std::memcpy(&size, block.data(), header_);
        if (size > block.size() - header_)
            refuse_file(file_, "", name + ": " + std::to_string(size) + " bytes, but it must be no more than the data have");
        const char* at = block.data() + header_;
        const auto take = [&]<class Number>(Number) {
            for (std::uint64_t k = 0; k + sizeof(Number) <= size; k += sizeof(Number)) {
                Number value;
                std::memcpy(&value, at + k, sizeof value);
                values.push_back(static_cast<double>(value));
            }
        };
        if (type == "Float64")
            take(double{});
        else if (type == "Float32")
            take(float{});
        else if (type == "Int64" || type == "UInt64")
            take(std::int64_t{});
        else if (type == "Int32" || type == "UInt32")
            take(std::int32_t{});
        else
            refuse_file(file_, "", name + ": type = " + type + ", but it must be Float32, Float64, Int32 or Int64");
        return values;
    }
    const std::string& file() const noexcept { return file_; }

private:
    std::string file_;
    pugi::xml_document document_;
    std::string_view appended_;
    bool base64_ = false;
    std::size_t header_ = 4;
};

/// "x, y, z".
inline Vec3 triple(const char* text, const std::string& file, const std::string& place) {
    const std::vector<std::string_view> parts = words(text, ",");
    if (parts.size() != 3) refuse_file(file, place, std::string(text).substr(0, 60) + ", but it must be three numbers");
    return {number<double>(parts[0], file, place, "x"), number<double>(parts[1], file, place, "y"),
            number<double>(parts[2], file, place, "z")};
}

}  // namespace detail

/// Lines of a .vtp file, their points in text, base64 or raw bytes, not compressed; point data of the name radius, and cell data
/// of the name group.
inline std::vector<FileCurve> curves_of_vtp(std::string_view bytes, const std::string& file) {
    const detail::VtpArrays arrays(bytes, file);
    std::vector<FileCurve> curves;
    for (const pugi::xml_node& piece : arrays.data().children("Piece")) {
        const pugi::xml_node places = piece.child("Points").child("DataArray");
        const std::vector<double> points = arrays.numbers(places);
        const auto require_count = [&](const char* field, std::size_t found) {  // where the piece tells it
            const std::string told = piece.attribute(field).value();
            if (!told.empty() && told != std::to_string(found))
                refuse_file(file, "",
                            field + (" = " + told.substr(0, 60)) + ", but it must be " + std::to_string(found) +
                                ", as many as there are");
        };
        if (const std::string components = places.attribute("NumberOfComponents").as_string("3"); components != "3")
            refuse_file(file, "", "Points: NumberOfComponents = " + components.substr(0, 60) + ", but it must be 3");
        if (points.size() % 3 != 0)
            refuse_file(file, "", "Points: " + std::to_string(points.size()) + " numbers, but it must be three a point");
        require_count("NumberOfPoints", points.size() / 3);
        std::vector<double> connectivity, offsets, radii;
        for (const pugi::xml_node& array : piece.child("Lines").children("DataArray"))
            (std::string(array.attribute("Name").value()) == "offsets" ? offsets : connectivity) = arrays.numbers(array);
        for (const pugi::xml_node& array : piece.child("PointData").children("DataArray"))
            if (std::string(array.attribute("Name").value()) == "radius") radii = arrays.numbers(array);
        require_count("NumberOfLines", offsets.size());
        if (!radii.empty() && 3 * radii.size() != points.size())
            refuse_file(file, "",
                        "radius: " + std::to_string(radii.size()) + " numbers, but it must be " +
                            std::to_string(points.size() / 3) + ", one a point");
        std::size_t first = 0;
        for (const double end : offsets) {
            if (!(end >= static_cast<double>(first)) || end != std::floor(end) || end > static_cast<double>(connectivity.size()))
                refuse_file(file, "", "offset = " + core::text(end) + ", but it must rise and be within the lines");
            FileCurve curve;
            for (; first < static_cast<std::size_t>(end); ++first) {
                const double k = connectivity[first];
                if (!(k >= 0.0) || k != std::floor(k) || 3.0 * k + 2.0 >= static_cast<double>(points.size()))
                    refuse_file(
                        file, "",
                        "point = " + core::text(k) + " of a line, but it must be one of " + std::to_string(points.size() / 3));
                const auto at = static_cast<std::size_t>(k);
                curve.points.emplace_back(points[3 * at], points[3 * at + 1], points[3 * at + 2]);
                if (!radii.empty()) curve.radii.push_back(radii[at]);
            }
            if (!curve.radii.empty()) {
                curve.radius = curve.radii.front();
                if (std::all_of(curve.radii.begin(), curve.radii.end(), [&](double r) { return r == curve.radius; }))
                    curve.radii.clear();
            }
            curves.push_back(std::move(curve));
        }
    }
    return curves;
}

/// Yarns of a TexGen model saved with its explicit yarns (type CTextile): master nodes, a period where the interpolation is
/// periodic, and as radius that of the circle of the section's area, for Ellipse, PowerEllipse and Lenticular taken as ellipses
/// of their width and height.
inline std::vector<FileCurve> curves_of_tg3(std::string_view bytes, const std::string& file) {
    pugi::xml_document document;
    detail::parse_xml(document, bytes, file);
    const pugi::xml_node model = document.child("TexGenModel");
    if (model.empty()) refuse_file(file, "", "has no TexGenModel");
    std::vector<FileCurve> curves;
    for (const pugi::xml_node& textile : model.children("Textile")) {
        const std::string type = textile.attribute("type").value();
        if (type != "CTextile")
            refuse_file(file, "", "Textile type = " + type + ", but it must be CTextile: save the model with its yarns");
        for (const pugi::xml_node& yarn : textile.children("Yarn")) {
            const std::string place = "Yarn " + std::string(yarn.attribute("index").value());
            FileCurve curve;
            curve.name = "yarn_" + std::string(yarn.attribute("index").value());
            curve.group = core::count(curves);
            for (const pugi::xml_node& node : yarn.children("MasterNode"))
                curve.points.push_back(detail::triple(node.attribute("Position").value(), file,
                                                      place + ", MasterNode " + node.attribute("index").value()));
            if (curve.points.size() < 2)
                refuse_file(file, place, std::to_string(curve.points.size()) + " MasterNodes, but it must have at least two");
            const std::string periodic = yarn.child("Interpolation").attribute("Periodic").value();
            if (periodic == "1" || periodic == "true") curve.period = curve.points.back() - curve.points.front();
            pugi::xml_node section = yarn.child("YarnSection").child("Section");
            if (section.empty()) section = yarn.child("YarnSection").child("NodeSection").child("Section");
            if (!section.attribute("Width").empty() && !section.attribute("Height").empty()) {
                const double width = detail::number<double>(section.attribute("Width").value(), file, place, "Width"),
                             height = detail::number<double>(section.attribute("Height").value(), file, place, "Height");
                if (!(width > 0.0 && height > 0.0))
                    refuse_file(file, place,
                                "Width and Height = " + core::text(width) + ", " + core::text(height) + ", but they must be > 0");
                curve.radius = 0.5 * std::sqrt(width * height);
            }
            curves.push_back(std::move(curve));
        }
    }
    return curves;
}

/// A TexGen model of explicit yarns of circular section.
inline std::string tg3_of(const std::vector<FileCurve>& curves, const std::string& name = "fibrant") {
    pugi::xml_document document;
    pugi::xml_node model = document.append_child("TexGenModel");
    model.append_attribute("version") = "3.12.0";
    pugi::xml_node textile = model.append_child("Textile");
    textile.append_attribute("name") = name.c_str(), textile.append_attribute("type") = "CTextile",
    textile.append_attribute("NeedsBuilding") = "1";
    const auto triple = [](const Vec3& v) {
        return observe::shortest(v.x()) + ", " + observe::shortest(v.y()) + ", " + observe::shortest(v.z());
    };
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const FileCurve& curve = curves[c];
        const bool periodic = curve.closed || curve.period.norm() > 0.0;
        pugi::xml_node yarn = textile.append_child("Yarn");
        yarn.append_attribute("index") = std::to_string(c).c_str(), yarn.append_attribute("NumSlaveNodes") = "50",
        yarn.append_attribute("NumSectionPoints") = "20";
        pugi::xml_node interpolation = yarn.append_child("Interpolation");
        interpolation.append_attribute("Periodic") = periodic ? "1" : "0",
        interpolation.append_attribute("ForceInPlaneTangent") = "0";
        interpolation.append_attribute("ForceMasterNodeTangent") = "0",
        interpolation.append_attribute("type") = "CInterpolationCubic";
        pugi::xml_node outline = yarn.append_child("YarnSection");
        outline.append_attribute("type") = "CYarnSectionConstant";
        pugi::xml_node section = outline.append_child("Section");
        const std::string width = observe::shortest(2.0 * (std::isnan(curve.radius) ? 0.5 : curve.radius));
        section.append_attribute("type") = "CSectionEllipse", section.append_attribute("Width") = width.c_str(),
        section.append_attribute("Height") = width.c_str();
        if (curve.period.norm() > 0.0) yarn.append_child("Repeat").append_attribute("value") = triple(curve.period).c_str();
        const std::size_t count = curve.points.size() + (curve.closed ? 1 : 0);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t n = curve.points.size();
            pugi::xml_node node = yarn.append_child("MasterNode");
            const Vec3 along =
                (k == 0 ? curve.points[1] - curve.points[0] : curve.points[k % n] - curve.points[k - 1]).normalized();
            Index axis = 0;
            along.cwiseAbs().minCoeff(&axis);
            node.append_attribute("index") = std::to_string(k).c_str(),
            node.append_attribute("Position") = triple(curve.points[k % n]).c_str();
            node.append_attribute("Tangent") = triple(along).c_str(),
            node.append_attribute("Up") = triple((Vec3::Unit(axis) - along[axis] * along).normalized()).c_str();
            node.append_attribute("Angle") = "0";
        }
    }
    struct Writer : pugi::xml_writer {
        std::string text;
        void write(const void* data, std::size_t size) override { text.append(static_cast<const char*>(data), size); }
    } writer;
    document.save(writer, "  ");
    return writer.text;
}

}  // namespace fibrant::exchange
