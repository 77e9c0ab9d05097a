// SPDX-License-Identifier: MIT
// A small fabric on its way from flat tows: the same bits for any number of threads, and after an interruption.
#include "small_weave.hpp"
#include "support/threads.hpp"

#include <doctest/doctest.h>

#include <cstdio>
#include <cstring>
#include <filesystem>

using namespace fibrant;

namespace same_bits_test {

namespace cloth = fibrant::compositions::weave;

using Model = test::SmallWeave;
using test::small_fabric;

struct Interruption {};

/// Tension, and the first increments in which the tows part.
struct Run {
    std::vector<Vector> states;
    simulation::Report report;

    Run(const std::string& checkpoint, bool resume, Index interrupt_at) {
        const cloth::SettleParameters settle;
        simulation::Simulator<Model> simulator(cloth::flat_fabric(small_fabric(), settle.tension_strain),
                                               cloth::model_parameters<Model>(small_fabric(), settle));
        simulation::Loading<Model> loading = cloth::settling<Model>(small_fabric(), settle);
        loading.stages.resize(2);
        loading.stages[1].until = [](const simulation::IncrementReport& increment) { return increment.number >= 4; };
        loading.checkpoint = checkpoint, loading.resume = resume;
        struct Watch {
            const simulation::Simulator<Model>& simulator;
            std::vector<Vector>& states;
            Index interrupt_at;
            void reported(const simulation::IncrementReport& increment) const {
                states.push_back(simulator.state());
                if (increment.number == interrupt_at) throw Interruption{};
            }
        } watch{simulator, states, interrupt_at};
        try {
            report = simulator.run(loading, watch);
        } catch (const Interruption&) {
        }
    }
};

bool same_bits(const Vector& a, const Vector& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

TEST_CASE("tows that part go through the same bits on one thread and on two, and after an interruption") {
    const Run one = test::with_threads(1, [] { return Run("", false, -1); });
    const Run two = test::with_threads(2, [] { return Run("", false, -1); });
    CAPTURE(one.report.reason);
    REQUIRE(one.report.converged);
    REQUIRE(one.states.size() >= 4);
    // 10 warp fibres cross 10 weft fibres: where at least half of the crossings bear, threads share real contact work.
    CHECK(one.report.increments.back().contact.active >= 50);
    REQUIRE(two.states.size() == one.states.size());
    for (std::size_t k = 0; k < one.states.size(); ++k) CHECK(same_bits(one.states[k], two.states[k]));
    CHECK(one.report.counts.linear_iterations == two.report.counts.linear_iterations);

    const std::string file = (std::filesystem::temp_directory_path() / "fibrant_same_bits_test").string();
    std::filesystem::remove(file);
    Run(file, false, 3);
    const Run resumed(file, true, -1);
    std::filesystem::remove(file);
    REQUIRE(resumed.report.converged);
    REQUIRE(resumed.states.size() + 2 == one.states.size());
    for (std::size_t k = 0; k < resumed.states.size(); ++k) CHECK(same_bits(resumed.states[k], one.states[k + 2]));
    std::printf("%td contact elements, %td active, %td Newton iterations\n", one.report.contact.elements,
                one.report.contact.active, one.report.counts.newton);
}

}  // namespace same_bits_test
