// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres and contacts of each increment for ParaView.

#include <fibrant/core/parallel.hpp>
#include <fibrant/observe/poly_data.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace fibrant::observe {

/// A polyline a fibre, that comes back to its first point where the fibre is closed; at the nodes radius, director_1, director_2,
/// displacement, curvature; of the lines fibre, group.
inline PolyData fibre_data(const Snapshot& snapshot) {
    PolyData data;
    std::vector<double> radius, curvature, number, group;
    std::vector<Vec3> director_1, director_2, displacement;
    for (std::size_t k = 0; k < snapshot.fibres.size(); ++k) {
        const FibreSnapshot& fibre = snapshot.fibres[k];
        Index first = 0;
        const Index nodes = core::count(fibre.position) - (fibre.closed ? 1 : 0);
        for (std::size_t node = 0; node < core::at(nodes); ++node) {
            const Index point = data.add_point(fibre.position[node]);
            if (node == 0) first = point;
            radius.push_back(fibre.section.radius());
        }
        data.add_line(first, nodes, fibre.closed);
        director_1.insert(director_1.end(), fibre.director_1.begin(), fibre.director_1.begin() + nodes);
        director_2.insert(director_2.end(), fibre.director_2.begin(), fibre.director_2.begin() + nodes);
        displacement.insert(displacement.end(), fibre.displacement.begin(), fibre.displacement.begin() + nodes);
        curvature.insert(curvature.end(), fibre.curvature.begin(), fibre.curvature.begin() + nodes);
        number.push_back(static_cast<double>(k));
        group.push_back(static_cast<double>(fibre.group));
    }
    data.point_scalars("radius", radius);
    data.point_vectors("director_1", director_1);
    data.point_vectors("director_2", director_2);
    data.point_vectors("displacement", displacement);
    data.point_scalars("curvature", curvature);
    data.cell_scalars("fibre", number);
    data.cell_scalars("group", group);
    return data;
}

/// A vertex a contact element, with reaction, penetration (0 where open), gap, stiffness, crossing (1 or 0), the two
/// fibres, and the vectors normal, normal_force (on fibre_j) and friction (on fibre_i). Of a contact with tool t, fibre_i is -1 -
/// t.
inline PolyData contact_data(const Snapshot& snapshot) {
    PolyData data;
    const std::size_t count = snapshot.contacts.size() + snapshot.tool_contacts.size();
    data.reserve(count, count);
    const auto each = [&](const auto& see) {
        for (const ContactSnapshot& contact : snapshot.contacts) see(contact);
        for (const ToolContactSnapshot& contact : snapshot.tool_contacts) see(contact);
    };
    each([&](const auto& contact) { data.add_vertex(data.add_point(contact.position)); });
    // One array at a time: there are many contacts, and all that is known of them is in the snapshot as well.
    const auto scalars = [&](const char* name, const auto& value) {
        std::vector<double> values;
        values.reserve(count);
        each([&](const auto& contact) { values.push_back(value(contact)); });
        data.point_scalars(name, values);
    };
    const auto vectors = [&](const char* name, const auto& value) {
        std::vector<Vec3> values;
        values.reserve(count);
        each([&](const auto& contact) { values.push_back(value(contact)); });
        data.point_vectors(name, values);
    };
    scalars("reaction", [](const auto& contact) { return contact.reaction; });
    scalars("penetration", [](const auto& contact) { return contact.gap < 0.0 ? -contact.gap : 0.0; });
    scalars("gap", [](const auto& contact) { return contact.gap; });
    vectors("normal", [](const auto& contact) { return contact.normal; });
    vectors("normal_force", [](const auto& contact) { return Vec3(contact.reaction * contact.normal); });
    vectors("friction", [](const auto& contact) { return contact.friction; });
    scalars("stiffness", [](const auto& contact) { return contact.stiffness; });
    scalars("crossing", [](const auto& contact) {
        if constexpr (requires { contact.crossing; })
            return contact.crossing ? 1.0 : 0.0;
        else
            return 0.0;
    });
    scalars("fibre_i", [](const auto& contact) {
        if constexpr (requires { contact.tool; })
            return static_cast<double>(-1 - contact.tool);
        else
            return static_cast<double>(contact.fibre_i);
    });
    scalars("fibre_j", [](const auto& contact) {
        if constexpr (requires { contact.tool; })
            return static_cast<double>(contact.fibre);
        else
            return static_cast<double>(contact.fibre_j);
    });
    return data;
}

/// Writes fibres_NNNN.vtp and contacts_NNNN.vtp after each increment, and the series fibres.pvd and contacts.pvd, whose
/// times are the increments. Every file is complete whenever it is seen.
class VtkWriter {
public:
    /// @param folder  is made if need be
    /// @param start   resumed, the series keep the entries of earlier increments
    explicit VtkWriter(const std::filesystem::path& folder, Start start = Start::anew)
        : fibres_{made_folder(folder) / "fibres.pvd", start}, contacts_{folder / "contacts.pvd", start} {}

    /// Throws std::runtime_error if a file cannot be written.
    void accepted(const Snapshot& snapshot) {
        core::parallel_for(2, [&](Index k) {
            if (k == 0) {
                fibres_.write(snapshot.increment, fibre_data(snapshot));
            } else {
                contacts_.write(snapshot.increment, contact_data(snapshot));
            }
        });
    }

private:
    FileSeries fibres_, contacts_;
};
static_assert(Observer<VtkWriter>);

}  // namespace fibrant::observe
