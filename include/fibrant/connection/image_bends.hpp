// SPDX-License-Identifier: MIT
#pragma once
/// @file What a curvature of a cell adds to images of fibres beside it, and the moment that contact with them makes.

#include <fibrant/connection/body_motion.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <vector>

namespace fibrant::connection {

/// A plate's displacement over a period goes as the place from which it leads (scene::PeriodicCell::curvature), so that images
/// are moved by more than the ends of the pairs that shift them; their directors turn. Nothing where no cell has curvatures.
class ImageBends {
public:
    explicit ImageBends(const scene::Assembly& assembly) {
        const bool bent = std::any_of(assembly.cells().begin(), assembly.cells().end(), [](const scene::PeriodicCell& cell) {
            return std::any_of(cell.curvature.begin(), cell.curvature.end(), [](const auto& one) { return one.value != 0.0; });
        });
        for (const scene::FibreImage& image : assembly.images()) {
            if (!bent) break;
            shifts_.emplace_back();
            cell_.push_back(assembly.pairs()[core::at(image.shifts.front().pair)].cell);
            for (const scene::FibreImage::Shift& one : image.shifts)
                shifts_.back().push_back(one.times * assembly.pairs()[core::at(one.pair)].period);
        }
    }
    bool none() const noexcept { return shifts_.empty(); }

    /// Curvatures count from this state.
    void anchor(const scene::DofLayout& layout, const Vector& state) {
        if (none()) return;
        bends_.clear(), wholes_.clear();
        Index shift = -1;
        for (const scene::ImageVector& one : layout.images) {
            if (one.shift < 0 && shift < 0) {  // of a closed chain
                bends_.push_back(Mat3::Zero()), wholes_.push_back(Vec3::Zero());
                continue;
            }
            const bool director = one.shift < 0;  // of the same fibre: its nodes begin with a position
            if (!director) shift = one.shift;
            const auto& periods = shifts_[core::at(shift)];
            Vec3 whole = Vec3::Zero();
            for (const Vec3& period : periods) whole += period;
            Mat3 bend = bend_jump(state.segment<3>(3 * one.source), whole, director);
            for (std::size_t k = 0; k < periods.size() && !director; ++k) {
                const scene::ImageShift::Pair& pair = layout.shifts[core::at(shift)].pairs[k];
                const Vec3 period = periods[k] / pair.times;
                bend -= pair.times * bend_jump(state.segment<3>(3 * pair.first), period, false);
            }
            bends_.push_back(bend), wholes_.push_back(whole);
            of_.resize(bends_.size(), 0), of_.back() = cell_[core::at(shift)];
        }
        of_.resize(bends_.size(), 0);
    }
    void place(const BodyMotion& motion, scene::DofLayout& layout) const {
        for (std::size_t k = 0; k < bends_.size(); ++k) layout.images[k].more = bends_[k] * motion.curvature(of_[k]);
    }
    /// Keeps the moments of forces on images. @param forces  before they are taken to where they act
    void see(const scene::DofLayout& layout, const Vector& forces) {
        if (none()) return;
        moments_.assign(core::at(*std::max_element(cell_.begin(), cell_.end())) + 1, Vec3::Zero());
        forces_.resize(bends_.size());
        for (std::size_t k = 0; k < bends_.size(); ++k) {
            forces_[k] = forces.segment<3>(3 * layout.images[k].image);
            moments_[core::at(of_[k])] += bends_[k].transpose() * forces_[k];
        }
    }
    /// Calls see(image vector, period from its source, force on it) for the images beside a cell.
    template <class See>
    void each(const scene::DofLayout& layout, Index cell, const See& see) const {
        for (std::size_t k = 0; k < forces_.size(); ++k)
            if (of_[k] == cell) see(layout.images[k], wholes_[k], forces_[k]);
    }
    /// Work of contact with images for each curvature of a cell, beside that of its ties [force * length^2].
    Vec3 moment(Index cell) const noexcept {
        return core::at(cell) < moments_.size() ? moments_[core::at(cell)] : Vec3(Vec3::Zero());
    }

private:
    std::vector<std::vector<Vec3>> shifts_;  // of each image of a fibre
    std::vector<Index> cell_, of_;           // of each image, and of each image vector
    std::vector<Mat3> bends_;                // of each image vector: what a curvature of 1 adds, a column each
    std::vector<Vec3> wholes_, forces_;      // of each image vector: its period, and what contact exerts on it
    std::vector<Vec3> moments_;              // of each cell
};

}  // namespace fibrant::connection
