// SPDX-License-Identifier: MIT
#pragma once
/// @file Increments that carry fibres to and fro about where they are to come to.

#include <fibrant/solver/nested_loops.hpp>

namespace fibrant::simulation {

/// An increment of a loose path keeps its normals, and what it leaves over moves in the next: increments are the passes of one
/// iteration. Where normals turn with what slides by more than holds it, that iteration swings about its end for ever, as contact
/// passes do (`solver::NestedLoops`), and no stage ends. The next increment begins where the series of the last two would end.
class Swing {
public:
    /// Where an increment begins.
    /// @param loose  it is one of those, and keeps its normals
    /// @param cuts   attempts at it that have failed: from then on it begins at the state that was accepted last
    template <class Equilibrium>
    Vector begin(Equilibrium& equilibrium, const Vector& state, bool loose, Index cuts) const {
        Vector trial = state;
        if (!loose || cuts > 0 || factor_ == 0.0) return trial;
        trial += factor_ * travel_;
        equilibrium.reset_stresses(trial);
        return trial;
    }

    /// Takes over the motion of an increment from `before` to `after`.
    template <class Equilibrium>
    void learn(const Equilibrium& equilibrium, const Vector& before, const Vector& after, bool loose) {
        if (!loose) {
            *this = {};
            return;
        }
        Vector travel = after - before;
        factor_ = travel_.size() == travel.size() ? solver::swing_end(equilibrium, travel, travel_) : 0.0;
        travel_.swap(travel);
    }

    /// Every number that it keeps, for a file.
    void each(const auto& body) { body(travel_), body(factor_); }
    void each(const auto& body) const { body(travel_), body(factor_); }

private:
    Vector travel_;        ///< of the last increment; empty: none that counts
    double factor_ = 0.0;  ///< multiple of it after which a swing would end, 0 where there is none [1]
};

}  // namespace fibrant::simulation
