// SPDX-License-Identifier: MIT
#pragma once
/// @file What of a checkpoint belongs to fibres and contacts, and what tells one scene from another.

#include <fibrant/simulation/checkpoint.hpp>
#include <fibrant/simulation/loading.hpp>
#include <fibrant/simulation/scene_difference.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace fibrant::simulation {

/// First line of a checkpoint; its number changes with what is in the file.
inline constexpr const char* checkpoint_format = "fibrant checkpoint 23";

/// Tells how fibres are cut and grouped: the same in programs whose compilers round differently.
template <beam::BeamElement B>
std::uint64_t outline_identity(const beam::Mesh<B>& mesh) {
    CheckpointWriter scene;
    for (const beam::MeshFibre& fibre : mesh.fibres()) {
        scene.put(fibre.first_vector), scene.put(fibre.elements), scene.put(fibre.group);
        if (fibre.closed) scene.put(fibre.closed);
    }
    return scene.identity();
}
/// Tells the fibres of a scene from others, to the bit.
template <beam::BeamElement B>
std::uint64_t fibre_identity(const beam::Mesh<B>& mesh) {
    CheckpointWriter scene;
    scene.put(mesh.rest_state()), scene.put(mesh.start_state());
    for (const beam::MeshFibre& fibre : mesh.fibres()) {
        scene.put(fibre.first_vector), scene.put(fibre.group);
        scene.put(fibre.section.semi_axis_1), scene.put(fibre.section.semi_axis_2), scene.put(fibre.section.inertia_factor);
        scene.put(fibre.material.young_modulus), scene.put(fibre.material.poisson_ratio);
        if (fibre.material.law != 0) scene.put(fibre.material.law);
        if (const scene::TransverseConstants& t = fibre.material.transverse; t.given())
            scene.put(t.young_modulus), scene.put(t.poisson_ratio), scene.put(t.shear_modulus);
    }
    return scene.identity();
}
inline std::uint64_t channel_identity(const connection::Channels& channels) {
    CheckpointWriter scene;
    for (const std::string& name : channels.names()) scene.put(name);
    return scene.identity();
}
/// Stages, but for what ends or relaxes them.
template <Model M>
std::uint64_t loading_identity(const std::vector<Stage<M>>& stages) {
    CheckpointWriter loading;
    for (const Stage<M>& stage : stages) {
        loading.put(stage.name), loading.put(stage.increments), loading.put(stage.forced_orders);
        loading.put(stage.gap_limit.value_or(-1.0));
        if (stage.duration > 0.0) loading.put(stage.duration);
        for (const Ramp& ramp : stage.ramps) loading.put(ramp.channel), loading.put(ramp.to), loading.put(ramp.geometric);
    }
    return loading.identity();
}

/// What a checkpoint begins with: its format, what the run was of, and what tells one scene from another.
template <Model M>
void put_identity(CheckpointWriter& file, const beam::Mesh<typename M::Beam>& mesh, const connection::Channels& channels,
                  const std::vector<Stage<M>>& stages, const std::string& scene) {
    file.put(std::string(checkpoint_format)), file.put(scene);
    file.put(outline_identity(mesh)), file.put(fibre_identity(mesh)), file.put(channel_identity(channels)),
        file.put(loading_identity(stages));
}
/// Reads that, and compares all of it with the run that goes on.
/// @throws std::runtime_error if it is another one
template <Model M>
void expect_identity(CheckpointReader& file, const beam::Mesh<typename M::Beam>& mesh, const connection::Channels& channels,
                     const std::vector<Stage<M>>& stages, const Loading<M>& loading) {
    file.expect(file.get_text() == checkpoint_format, "the format");
    const std::string difference = scene_difference(file.get_text(), loading.scene);
    file.expect(difference.empty() || loading.other_scene, difference);
    file.expect(file.get<std::uint64_t>() == outline_identity(mesh), "the set of fibres and channels");
    const bool fibres = file.get<std::uint64_t>() == fibre_identity(mesh),
               same = file.get<std::uint64_t>() == channel_identity(channels);
    file.expect(fibres && same, "the set of fibres and channels");
    file.expect(file.get<std::uint64_t>() == loading_identity(stages), "the loading");
}
/// What the run was of that left a checkpoint; empty where nobody said so.
/// @throws std::runtime_error if the file cannot be read
inline std::string checkpoint_scene(const std::string& path) {
    CheckpointReader file(path);
    file.expect(file.get_text() == checkpoint_format, "the format");
    return file.get_text();
}

/// A checkpoint from its state on, of fibres that are cut and grouped alike.
/// @throws std::runtime_error if the file cannot be read or has other fibres
template <beam::BeamElement B>
CheckpointReader read_from_state(const std::string& path, const beam::Mesh<B>& mesh) {
    CheckpointReader file(path);
    file.expect(file.get_text() == checkpoint_format, "the format");
    file.get_text();  // what the run was of
    file.expect(file.get<std::uint64_t>() == outline_identity(mesh), "the set of fibres");
    for (int k = 0; k < 3; ++k) file.get<std::uint64_t>();  // of the scene and the loading
    return file;
}
/// The next vector of numbers, all finite, as are powers of them that lengths and curvatures are made of.
/// @param size   that it must have
/// @param empty  or none
inline Vector get_state(CheckpointReader& file, Index size, bool empty = false) {
    Vector state = file.get_vector();
    const double square = state.squaredNorm();
    file.require((state.size() == size || (empty && state.size() == 0)) && std::isfinite(square * square));
    return state;
}
/// The state alone; throws as `read_from_state`.
template <beam::BeamElement B>
Vector checkpoint_state(const std::string& path, const beam::Mesh<B>& mesh) {
    CheckpointReader file = read_from_state(path, mesh);
    Vector state = file.get_vector();
    file.require(state.size() >= mesh.rest_state().size() && state.allFinite());
    return state;
}

/// What contacts remember.
template <class Record>
void put_memory(CheckpointWriter& file, const std::vector<Record>& records, const std::vector<contact::Zone>& zones) {
    file.put(core::count(records));
    for (const Record& record : records) record.each([&](const auto& value) { file.put(value); });
    file.put(core::count(zones));
    for (const contact::Zone& zone : zones) file.put(zone);
}
/// Reads what contacts remember from a checkpoint.
/// @param fibres  of the scene: what is remembered of others is damage
template <class Record>
void get_memory(CheckpointReader& file, std::vector<Record>& records, std::vector<contact::Zone>& zones, Index fibres) {
    const auto known = [fibres](Index fibre) { return fibre >= 0 && fibre < fibres; };
    records.resize(core::at(file.get_count(sizeof(double))));
    for (Record& record : records) {
        record.each([&](auto& value) {
            value = file.template get<std::decay_t<decltype(value)>>();
            file.require(std::isfinite(static_cast<double>(value)));
        });
        file.require(known(record.fibre_i) && known(record.fibre_j));
    }
    zones.resize(core::at(file.get_count(sizeof(contact::Zone))));
    for (contact::Zone& zone : zones) {
        auto bytes = file.get<std::array<char, sizeof(contact::Zone)>>();
        for (const std::size_t flag :
             {offsetof(contact::Zone, crossing), offsetof(contact::Zone, followed), offsetof(contact::Zone, forced),
              offsetof(contact::Zone, settled), offsetof(contact::Zone, joined)})
            bytes[flag] = static_cast<char>(bytes[flag] != 0);
        for (std::size_t k = 0; k < contact::Zone::most_crossings; ++k) {
            char& flag = bytes[offsetof(contact::Zone, slanting) + k];
            flag = static_cast<char>(flag != 0);
        }
        std::memcpy(static_cast<void*>(&zone), bytes.data(), bytes.size());
        const proximity::ProximityZone& span = zone.span;
        file.require(known(span.fibre_i) && known(span.fibre_j) && zone.stiffness >= 0.0 && !std::isnan(zone.deepest));
        file.require(zone.narrowed > 0.0 && zone.narrowed <= 1.0 && zone.watched.count >= 0 && zone.unseen >= 0.0 &&
                     std::isfinite(zone.unseen));
        for (const auto& place : zone.watched.at) file.require(std::isfinite(place[0]) && std::isfinite(place[1]));
        for (const double place : {span.a_i, span.b_i, span.a_j, span.b_j, span.closest_i, span.closest_j, zone.stiffness})
            file.require(std::isfinite(place));
    }
}

/// What tools remember.
template <class Tools>
void get_tools(CheckpointReader& file, Tools& tools) {
    bool counted = false;
    tools.resume([&](auto& value) {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, Index>) {
            if (!std::exchange(counted, true)) {
                value = file.get_count(sizeof(double));
                return;
            }
        }
        value = file.get<Value>();
    });
}

/// Which solids they are, and which of their bonds are broken.
template <class Solid>
void put_solid(CheckpointWriter& file, const Solid& solid) {
    CheckpointWriter rest;
    rest.put(solid.with_rest(Vector()));
    file.put(rest.identity());
    for (const bool broken : solid.broken()) file.put(broken);
}
/// Reads the state of a solid from a checkpoint.
/// @throws std::runtime_error if the file has other solids
template <class Solid>
void get_solid(CheckpointReader& file, Solid& solid) {
    CheckpointWriter rest;
    rest.put(solid.with_rest(Vector()));
    file.expect(file.get<std::uint64_t>() == rest.identity(), "the set of solids");
    std::vector<bool> broken(solid.broken().size());
    for (std::size_t b = 0; b < broken.size(); ++b) broken[b] = file.get<bool>();
    solid.set_broken(std::move(broken));
}

/// Small fixed matrices, number by number.
template <class Fixed>
void put_value(CheckpointWriter& file, const Fixed& value) {
    for (Index k = 0; k < value.size(); ++k) file.put(value.data()[k]);
}
template <class Fixed>
void get_value(CheckpointReader& file, Fixed& value) {
    for (Index k = 0; k < value.size(); ++k) value.data()[k] = file.get<double>();
}

}  // namespace fibrant::simulation
