// SPDX-License-Identifier: MIT
#pragma once
/// @file The report of an increment in a checkpoint.

#include <fibrant/simulation/checkpoint.hpp>
#include <fibrant/simulation/report.hpp>

namespace fibrant::simulation {

/// Writes what is told of an increment to a checkpoint.
inline void put_increment(CheckpointWriter& file, const IncrementReport& plain) {
    file.put(plain.stage);
    file.put(plain.number), file.put(plain.stage_progress), file.put(plain.progress), file.put(plain.fraction);
    file.put(plain.cuts), file.put(plain.counts), file.put(plain.residual), file.put(plain.displacement), file.put(plain.damping);
    file.put(plain.use), file.put(plain.unstable);
    file.put(plain.contact), file.put(plain.energy), file.put(plain.seconds);
}

/// Reads it back, in the same order.
inline void get_increment(CheckpointReader& file, IncrementReport& increment) {
    increment.stage = file.get_text();
    increment.number = file.get<Index>(), increment.stage_progress = file.get<double>();
    increment.progress = file.get<double>(), increment.fraction = file.get<double>();
    increment.cuts = file.get<Index>(), increment.counts = file.get<solver::IterationCounts>();
    increment.residual = file.get<double>(), increment.displacement = file.get<double>();
    increment.damping = file.get<double>();
    increment.use = file.get<solver::ToleranceUse>(), increment.unstable = file.get<bool>();
    increment.contact = file.get<contact::ContactFigures>(), increment.energy = file.get<EnergyBalance>();
    increment.seconds = file.get<double>();
}

}  // namespace fibrant::simulation
