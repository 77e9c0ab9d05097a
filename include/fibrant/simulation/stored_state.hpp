// SPDX-License-Identifier: MIT
#pragma once
/// @file A state as a file that another scene may start from: what is not the run's but the fibres' and the contacts'.

#include <fibrant/simulation/energy_account.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/simulation/state_file.hpp>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace fibrant::simulation {

/// Places and directors of all fibres, and what their contacts remember.
template <Model M>
struct StoredState {
    using Record = contact::ContactRecord<typename M::Normal, typename M::Friction>;
    Vector state;
    std::vector<Record> records{};
    std::vector<contact::Zone> zones{};
    Vector laws{};  ///< SectionLaws::numbers: what the laws of sections remember; empty for those that do not
};

/// The state that a checkpoint holds, without the rest of its run.
/// @throws std::runtime_error if the file cannot be read or has other fibres
template <Model M>
StoredState<M> read_state(const std::string& path, const beam::Mesh<typename M::Beam>& mesh) {
    CheckpointReader file = read_from_state(path, mesh);
    StoredState<M> stored{.state = get_state(file, mesh.rest_state().size())};
    EnergyAccount before;
    before.each([&]<class Value>(Value& value) {
        if constexpr (std::is_same_v<Value, Vector>)
            value = file.get_vector();
        else
            value = file.get<Value>();
    });
    get_memory(file, stored.records, stored.zones, mesh.line_count());
    stored.laws = file.get_vector();
    return stored;
}

/// Writes a file that `Simulator::start_from` takes, but no run resumes from.
template <Model M>
void write_state(const std::string& path, const beam::Mesh<typename M::Beam>& mesh, const StoredState<M>& stored) {
    CheckpointWriter file(path);
    file.put(std::string(checkpoint_format)), file.put(std::string());
    file.put(outline_identity(mesh)), file.put(fibre_identity(mesh));
    for (int k = 0; k < 2; ++k) file.put(std::uint64_t{0});
    file.put(stored.state);
    EnergyAccount().each([&](const auto& value) { file.put(value); });
    put_memory(file, stored.records, stored.zones);
    file.put(stored.laws);
    file.finish();
}

}  // namespace fibrant::simulation
