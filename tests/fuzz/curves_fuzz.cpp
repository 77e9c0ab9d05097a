// SPDX-License-Identifier: MIT
// Any bytes are a file of centrelines, or are refused: by std::invalid_argument alone. The first byte of an input chooses the
// kind of file and whether the others are its bytes or changes of single ones in a sound file, since few bytes alone come past
// the head of one.
#include <fibrant/exchange/files.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace fibrant;

/// An open curve whose radius varies and a closed one, in each kind of file.
const std::vector<std::pair<std::string, std::string>>& sound_files() {
    static const auto files = [] {
        std::vector<exchange::FileCurve> curves(2);
        for (int k = 0; k < 9; ++k) {
            curves[0].points.emplace_back(0.1 * k, 0.01 * k * k, 0.2);
            curves[0].radii.push_back(0.02 + 0.001 * k);
            const double angle = 2.0 * 3.14159265 * k / 9.0;
            curves[1].points.emplace_back(std::cos(angle), std::sin(angle), 0.0);
        }
        curves[0].radius = 0.02, curves[1].radius = 0.03, curves[1].closed = true;
        std::vector<std::pair<std::string, std::string>> texts;
        for (const char* kind : {"csv", "vtk", "obj", "bcc", "inp", "vtp", "tg3"}) {
            if (!exchange::is_one_of(kind, exchange::curve_kinds())) continue;
#if !defined(FIBRANT_WITH_PUGIXML)
            if (std::string(kind) == "vtp") continue;  // is written, and not read
#endif
            texts.emplace_back(kind, exchange::file_of(curves, kind));
        }
        return texts;
    }();
    return files;
}

std::vector<exchange::FileCurve> read(const std::string& kind, const std::string& bytes) {
    if (kind == "csv") return exchange::curves_of_csv(bytes, "f.csv");
    if (kind == "vtk") return exchange::curves_of_vtk(bytes, "f.vtk");
    if (kind == "obj") return exchange::curves_of_obj(bytes, "f.obj");
    if (kind == "bcc") return exchange::curves_of_bcc(bytes, "f.bcc");
#if defined(FIBRANT_WITH_PUGIXML)
    if (kind == "vtp") return exchange::curves_of_vtp(bytes, "f.vtp");
    if (kind == "tg3") return exchange::curves_of_tg3(bytes, "f.tg3");
#endif
    return exchange::curves_of_inp(bytes, "f.inp");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const auto& [kind, sound] = sound_files()[data[0] % sound_files().size()];
    std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (data[0] < 128) {
        const std::string changes = std::move(bytes);
        bytes = sound;
        for (std::size_t k = 0; k + 3 <= changes.size(); k += 3) {  // where, in two bytes, and what
            const std::size_t at =
                static_cast<unsigned char>(changes[k]) * std::size_t{256} + static_cast<unsigned char>(changes[k + 1]);
            bytes[at % bytes.size()] = changes[k + 2];
        }
        if (changes.size() % 3 == 1) bytes.resize(bytes.size() * static_cast<unsigned char>(changes.back()) / 256);  // cut short
    }
    try {
        exchange::cleaned(read(kind, bytes), "f." + kind);
    } catch (const std::invalid_argument&) {
    }
    return 0;
}
