// SPDX-License-Identifier: MIT
// A cantilever under an end force P L^2 / EI = 5, L/r = 100, with ours and with CalculiX (Debian's calculix-ccx), quadratic beams
// B32R, side by side: error of the place of the tip over the length, and CPU time of the whole run, of CalculiX in one step and
// in ten. Prints CSV, and last the least time in which either is as good as CalculiX with 20 elements. Without a program `ccx` in
// the path, ours alone. usage: benchmark_accuracy_calculix_bench [folder for CalculiX's files [repeats]]; default . and 5
#include "rods.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

using namespace fibrant;
using namespace fibrant::benchmarks;

namespace {

constexpr double slenderness = 100.0;
struct Sample {
    std::string code;
    Index elements;
    double error, seconds;
};

double error_of(double x,
                double z) {  // end_force.json, reissner: sections of the same bending stiffness differ by 1e-5 of L in shear
    return std::hypot(x - 0.7139748823646269, z - 0.6123354856053732);
}
double children_seconds() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Sample ours(Index elements, int repeats) {
    using M = Policy<beam::DirectorBeam<3>>;
    std::vector<double> times;
    Vec3 tip;
    for (int k = 0; k < repeats; ++k) {
        const double start = processor_time();
        simulation::Simulator<M> simulator(cantilever(slenderness, elements), parameters<M>());
        if (!simulator.run({.increments = 1}).converged) return {"fibrant", elements, NAN, NAN};
        times.push_back(processor_time() - start);
        tip = simulator.value(scene::last_end(0)) / (slenderness * r);
    }
    return {"fibrant", elements, error_of(tip.x(), tip.z()), median(times)};
}

/// A square section of the same bending stiffness: CalculiX's round one is not exact. Lengths in radii.
Sample calculix(const std::filesystem::path& folder, Index elements, double step, int repeats) {
    const double side = std::pow(3.0 * std::numbers::pi, 0.25), inertia = side * side * side * side / 12.0;
    std::ofstream input(folder / "cantilever.inp");
    input.precision(15);
    input << "*NODE, NSET=ALL\n";
    for (Index k = 0; k <= 2 * elements; ++k)
        input << k + 1 << ",0,0," << slenderness * static_cast<double>(k) / static_cast<double>(2 * elements) << '\n';
    input << "*ELEMENT, TYPE=B32R, ELSET=E\n";
    for (Index e = 0; e < elements; ++e) input << e + 1 << ',' << 2 * e + 1 << ',' << 2 * e + 2 << ',' << 2 * e + 3 << '\n';
    input << "*NSET, NSET=TIP\n"
          << 2 * elements + 1 << "\n*MATERIAL, NAME=M\n*ELASTIC\n"
          << young << ",0.3\n*BEAM SECTION, ELSET=E, MATERIAL=M, SECTION=RECT\n"
          << side << ',' << side << "\n1,0,0\n*BOUNDARY\n1,1,6\n*STEP, NLGEOM, INC=1000\n*STATIC\n"
          << step << ",1\n*CLOAD\n"
          << 2 * elements + 1 << ",1," << 5.0 * young * inertia / (slenderness * slenderness)
          << "\n*NODE PRINT, NSET=TIP, FREQUENCY=1000\nU\n*END STEP\n";
    input.close();
    const std::string command = "cd '" + folder.string() + "' && OMP_NUM_THREADS=1 ccx cantilever > cantilever.log 2>&1";
    std::vector<double> times;
    for (int k = 0; k < repeats; ++k) {
        const double start = children_seconds();
        if (std::system(command.c_str()) != 0) return {"ccx", elements, NAN, NAN};
        times.push_back(children_seconds() - start);
    }
    std::ifstream output(folder / "cantilever.dat");
    std::string line, last;
    while (std::getline(output, line))
        if (!line.empty()) last = line;
    std::istringstream row(last);
    double node = 0, x = NAN, y = NAN, z = NAN;
    row >> node >> x >> y >> z;
    return {step < 1.0 ? "ccx, steps of a tenth" : "ccx, one step", elements, error_of(x / slenderness, 1.0 + z / slenderness),
            median(times)};
}

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path folder = benchmarks::folder(argc > 1 ? argv[1] : ".");
    const int repeats = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
    const bool installed = std::system("command -v ccx > /dev/null 2>&1") == 0;
    std::printf("code,elements,error,seconds\n");
    std::vector<Sample> samples;
    const auto take = [&](const Sample& sample) {
        samples.push_back(sample);
        std::printf("%s,%ld,%.3e,%.4e\n", sample.code.c_str(), static_cast<long>(sample.elements), sample.error, sample.seconds);
        std::fflush(stdout);
    };
    for (const Index elements : {2, 3, 4, 8, 16, 32}) take(ours(elements, repeats));
    if (!installed) return 0;
    for (const double step : {0.1, 1.0})
        for (const Index elements : {5, 10, 20, 40, 80}) take(calculix(folder, elements, step, repeats));
    const auto bar = std::find_if(samples.begin(), samples.end(),
                                  [](const Sample& s) { return s.code == "ccx, one step" && s.elements == 20; });
    double best[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (const Sample& s : samples)
        if (s.error <= bar->error) best[s.code == "fibrant" ? 0 : 1] = std::min(best[s.code == "fibrant" ? 0 : 1], s.seconds);
    std::printf("# error %.2e or less: ours %.2e s, CalculiX %.2e s, %.0f times\n", bar->error, best[0], best[1],
                best[1] / best[0]);
    return 0;
}
