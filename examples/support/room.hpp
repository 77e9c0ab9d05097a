// SPDX-License-Identifier: MIT
#pragma once
/// @file What a scene would take of memory, told before it is begun.

#include "scene_reader.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace example {

inline std::string memory_text(double bytes) {
    if (bytes < 1e9) return fibrant::observe::rounded(bytes / 1e6, 0) + " MB";
    return fibrant::observe::rounded(bytes / 1e9, bytes < 1e10 ? 1 : 0) + " GB";
}
/// Memory that a run may take [byte], and what says so.
struct Room {
    double bytes;
    const char* said;
    std::string text() const { return said + (" " + memory_text(bytes)); }
};
/// The memory of this machine, or less where the process is allowed less; endless where neither is told.
inline Room memory_room() {
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
    const double there = pages > 0 && size > 0 ? static_cast<double>(pages) * static_cast<double>(size) : 1e300;
    rlimit allowed{};
    if (getrlimit(RLIMIT_AS, &allowed) == 0 && allowed.rlim_cur != RLIM_INFINITY && static_cast<double>(allowed.rlim_cur) < there)
        return {static_cast<double>(allowed.rlim_cur), "this process may take (ulimit -v)"};
    return {there, "this machine has"};
}

/// Unknowns of so many fibres of quadratic elements, nine a node.
inline double unknowns_of(Index fibres, Index elements) {
    return 9.0 * static_cast<double>(fibres) * (2.0 * static_cast<double>(elements) + 1.0);
}

/// Unknowns that a scene may have.
constexpr double most_unknowns = 5e7;
/// Of these, what there is memory for.
/// @param bytes_each  that a run takes an unknown
inline double unknowns_in_room(double bytes_each) { return std::min(most_unknowns, memory_room().bytes / bytes_each); }

/// Refuses a count of which a scene has more unknowns than there is memory for, or than 50 million.
/// @param section,key  of the count that is to blame
/// @param bytes_each   that a run takes an unknown, contacts and solver included: 2600 were measured on woven fabrics of 89 and
/// 356 thousand
/// @param way         that the count has to go
inline void require_room(const SceneReader& file, const std::string& section, const std::string& key, double unknowns,
                         double bytes_each = 2600.0, const std::string& way = "less") {
    if (unknowns <= unknowns_in_room(bytes_each)) return;
    const double taken = unknowns * bytes_each;
    const Room there = memory_room();
    file.refuse(section, key,
                way + ": the scene has " + fibrant::observe::rounded(unknowns, 0) + " unknowns, which take some " +
                    memory_text(taken) + " of memory, and may have " + fibrant::observe::rounded(most_unknowns, 0) + " and " +
                    memory_text(there.bytes) + ", which is what " + there.said);
}

/// Refuses elements that are far shorter than a fibre is thick, or so long that a fibre is a thread without bending: their count
/// or the length of the fibre is a slip of the pen.
/// @param least  length of an element that is allowed [radius]
inline void require_element(const SceneReader& file, const std::string& section, Index elements, double length, double radius,
                            double least = 0.1) {
    const double most = std::floor(length / (least * radius));
    file.check(most >= 1.0, section, "elements",
               "in fibres that are longer: " + fibrant::core::text(length) + " is shorter than " + fibrant::core::text(least) +
                   " radii = " + fibrant::core::text(least * radius));
    constexpr double longest = 1e7;  // radii: (r / L)^2 = 1e-14, bending is lost in the last digits of stretching
    const double fewest = std::ceil(length / (longest * radius));
    file.check(static_cast<double>(elements) >= fewest, section, "elements",
               ">= " + fibrant::core::text(fewest) + ", or elements are longer than 1e7 radii");
    file.check(static_cast<double>(elements) <= most, section, "elements",
               "<= " + fibrant::core::text(most) + ", or elements are shorter than " + fibrant::core::text(least) + " radii");
}

}  // namespace example
