// SPDX-License-Identifier: MIT
// Any bytes with a right sum are a checkpoint of a scene, or are refused: by std::runtime_error alone.
#include "scratch.hpp"

#include <fibrant/compiled/rough_fibres.hpp>

#include <cstring>
#include <stdexcept>
#include <vector>

using namespace fibrant;

namespace {

scene::Assembly two_fibres() {
    const scene::CrossSection section = scene::circular(0.02);
    const scene::ElasticMaterial material{.young_modulus = 7300.0, .poisson_ratio = 0.3};
    scene::Assembly assembly;
    for (const double z : {0.0, 0.0399}) {
        const Vec3 half = z > 0.0 ? Vec3(0.3, 0, 0) : Vec3(0, 0.3, 0), middle(0, 0, z);
        const Index fibre =
            assembly.add({.from = middle - half, .to = middle + half, .section = section, .material = material, .elements = 4});
        assembly.clamp(scene::first_end(fibre)), assembly.clamp(scene::last_end(fibre));
    }
    return assembly;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const scene::Assembly assembly = two_fibres();
    simulation::ModelParameters<compiled::RoughFibres> parameters;
    parameters.normal.regularisation_depth = 2e-5;
    parameters.friction = {.friction_coefficient = 0.1, .reversible_displacement = 4e-4};
    parameters.contact.stiffness.allowed_penetration = 2e-4;
    simulation::Simulator<compiled::RoughFibres> simulator(assembly, parameters);
    // What a run begins its file with is put first, so that inputs get beyond it.
    static const std::vector<char> start = [&] {
        const std::string path = fuzz::file_of(nullptr, 0);
        simulation::CheckpointWriter file(path);
        file.put(std::string(simulation::checkpoint_format)), file.put(std::string());
        file.put(simulation::outline_identity(simulator.mesh()));
        for (int k = 0; k < 3; ++k) file.put(std::uint64_t{0});
        file.finish();
        return simulation::CheckpointReader(path).bytes();
    }();
    std::vector<char> bytes = start;
    bytes.insert(bytes.end(), data, data + size);
    const std::uint64_t sum = simulation::CheckpointWriter::hash(bytes.data(), bytes.size());
    try {
        simulator.start_from(fuzz::file_of(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), &sum, sizeof sum));
    } catch (const std::runtime_error&) {
    }
    return 0;
}
