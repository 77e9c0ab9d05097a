// SPDX-License-Identifier: MIT
#pragma once
/// @file Solids and bonding elements of each increment for ParaView.

#include <fibrant/observe/observer.hpp>
#include <fibrant/observe/poly_data.hpp>
#include <fibrant/observe/text_file.hpp>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace fibrant::observe {

/// sqrt(3/2 s:s) of the deviator s [force / length^2].
inline double von_mises(const Mat3& stress) noexcept {
    const Mat3 deviator = stress - stress.trace() / 3.0 * Mat3::Identity();
    return std::sqrt(1.5 * (deviator * deviator).trace());
}

/// VTK's XML unstructured grid (.vtu), as text: displacement of the nodes; of the cells Cauchy stress and Green-Lagrange strain
/// (xx, yy, zz, xy, yz, xz) and the von Mises stress. Empty if there is no solid.
inline std::string solid_data(const SolidSnapshot& solid) {
    if (solid.cells.empty()) return {};
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
        "<Piece NumberOfPoints=\"" +
        std::to_string(solid.position.size()) + "\" NumberOfCells=\"" + std::to_string(solid.cells.size()) + "\">\n";
    const auto open = [&](const std::string& name, const char* type, int components) {
        text += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                std::to_string(components) + "\" format=\"ascii\">\n";
    };
    const auto number = [&](double value) { text += shortest(static_cast<double>(static_cast<float>(value))) + " "; };
    const auto vectors = [&](const std::string& name, const std::vector<Vec3>& values) {
        open(name, "Float32", 3);
        for (const Vec3& value : values) {
            for (const double component : value) number(component);
            text += "\n";
        }
        text += "</DataArray>\n";
    };
    const auto tensors = [&](const std::string& name, const std::vector<Mat3>& values) {
        open(name, "Float32", 6);
        for (const Mat3& v : values) {
            for (const double component : {v(0, 0), v(1, 1), v(2, 2), v(0, 1), v(1, 2), v(0, 2)}) number(component);
            text += "\n";
        }
        text += "</DataArray>\n";
    };
    text += "<Points>\n";
    vectors("Points", solid.position);
    text += "</Points>\n<Cells>\n";
    open("connectivity", "Int64", 1);
    for (const auto& cell : solid.cells) {
        for (const Index node : cell) text += std::to_string(node) + " ";
        text += "\n";
    }
    text += "</DataArray>\n";
    open("offsets", "Int64", 1);
    for (std::size_t c = 0; c < solid.cells.size(); ++c) text += std::to_string(8 * (c + 1)) + (c % 16 == 15 ? "\n" : " ");
    text += "</DataArray>\n";
    open("types", "UInt8", 1);
    for (std::size_t c = 0; c < solid.cells.size(); ++c) text += c % 32 == 31 ? "12\n" : "12 ";
    text += "</DataArray>\n</Cells>\n<PointData>\n";
    vectors("displacement", solid.displacement);
    text += "</PointData>\n<CellData>\n";
    tensors("stress", solid.stress);
    tensors("strain", solid.strain);
    open("von_mises", "Float32", 1);
    for (const Mat3& stress : solid.stress) number(von_mises(stress));
    return text + "\n</DataArray>\n</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

/// A vertex a bonding element, with its force on the solid, and whether it holds.
inline PolyData bond_data(const SolidSnapshot& solid) {
    PolyData data;
    std::vector<Vec3> force;
    std::vector<double> holds;
    for (const BondSnapshot& bond : solid.bonds) {
        data.add_vertex(data.add_point(bond.position));
        force.push_back(bond.force), holds.push_back(bond.holds ? 1.0 : 0.0);
    }
    data.point_vectors("force", force);
    data.point_scalars("holds", holds);
    return data;
}

/// Writes solid_NNNN.vtu and bonds_NNNN.vtp after each increment, and the series solid.pvd and bonds.pvd.
class SolidWriter {
public:
    explicit SolidWriter(const std::filesystem::path& folder, Start start = Start::anew)
        : solid_{made_folder(folder) / "solid.pvd", start}, bonds_{folder / "bonds.pvd", start} {}

    /// Throws std::runtime_error if a file cannot be written.
    void accepted(const Snapshot& snapshot) {
        if (snapshot.solid.cells.empty()) return;
        solid_.write(snapshot.increment, "vtu", solid_data(snapshot.solid));
        bonds_.write(snapshot.increment, bond_data(snapshot.solid));
    }

private:
    FileSeries solid_, bonds_;
};
static_assert(Observer<SolidWriter>);

}  // namespace fibrant::observe
