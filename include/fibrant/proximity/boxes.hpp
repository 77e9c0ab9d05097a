// SPDX-License-Identifier: MIT
#pragma once
/// @file Single-precision boxes of segments in a frame that suits them: what the grid compares before the exact filter.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/segment_table.hpp>

#include <Eigen/Eigenvalues>

#include <bit>
#include <cstring>

namespace fibrant::proximity::detail {

/// Axis-aligned box, relative to the middle of the scene and widened so that single precision loses nothing.
struct Box {
    float low[3], high[3];
};

/// Orthonormal axes (rows) and middle of the scene.
struct BoxFrame {
    Mat3 axes = Mat3::Identity();
    Vec3 middle = Vec3::Zero();
    double slack = 0.0;  ///< for rounding to single precision [length]

    /// Axes of space, or the principal axes of the directions where one of them holds over 70 % of sum L t t^T: boxes of
    /// oblique bundles would else overlap many times more than their segments do.
    explicit BoxFrame(const SegmentTable& table) {
        struct Moments {
            Mat3 directions = Mat3::Zero();
            Vec3 low = Vec3::Constant(1.0e300), high = Vec3::Constant(-1.0e300);
        };
        constexpr Index block = 4096;
        const Index n = table.size(), blocks = (n + block - 1) / block;
        std::vector<Moments> part(core::at(blocks));
        core::parallel_for(blocks, [&](Index b) {
            Moments sum;
            for (Index k = b * block; k < std::min(n, (b + 1) * block); ++k) {
                const SegmentRecord record = table.record(static_cast<std::int32_t>(k));
                const Vec3 start{record.start.x, record.start.y, record.start.z};
                const Vec3 chord{record.chord.x, record.chord.y, record.chord.z};
                const double length = chord.norm();
                if (length > 0.0) sum.directions += chord * (chord / length).transpose();
                sum.low = sum.low.cwiseMin(start).cwiseMin(start + chord);
                sum.high = sum.high.cwiseMax(start).cwiseMax(start + chord);
            }
            part[core::at(b)] = sum;
        });
        Moments all;
        for (const Moments& sum : part) {
            all.directions += sum.directions;
            all.low = all.low.cwiseMin(sum.low);
            all.high = all.high.cwiseMax(sum.high);
        }
        const Eigen::SelfAdjointEigenSolver<Mat3> principal(all.directions);
        if (principal.eigenvalues()[2] > 0.7 * principal.eigenvalues().sum()) axes = principal.eigenvectors().transpose();
        middle = 0.5 * all.low + 0.5 * all.high;
        slack = 3.0e-7 * 0.5 * (all.high - all.low).norm();
    }

    /// Box of the part [from, to] of a segment, widened by `margin`.
    Box box(const SegmentRecord& record, double from, double to, double margin) const noexcept {
        const Vec3 start{record.start.x - middle[0], record.start.y - middle[1], record.start.z - middle[2]};
        const Vec3 chord{record.chord.x, record.chord.y, record.chord.z};
        const Vec3 a = axes * (start + from * chord), b = axes * (start + to * chord);
        const double wide = margin * (1.0 + 1.0e-6) + slack;
        Box made;
        for (int axis = 0; axis < 3; ++axis) {
            made.low[axis] = static_cast<float>(std::min(a[axis], b[axis]) - wide);
            made.high[axis] = static_cast<float>(std::max(a[axis], b[axis]) + wide);
        }
        return made;
    }
};

/// Boxes as six columns, which end with some that meet nothing so that whole vectors may be read from any place.
class BoxColumns {
public:
    static constexpr std::int32_t width = 16;

    void resize(std::int32_t n) {
        for (auto& column : column_) {
            column.resize(core::at(n + width));
            std::fill(column.end() - width, column.end(), 0.0F);
        }
    }
    void set(std::int32_t k, const Box& box) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            column_[2 * axis][core::at(k)] = box.low[axis];
            column_[2 * axis + 1][core::at(k)] = box.high[axis];
        }
    }
    Box operator[](std::int32_t k) const noexcept {
        Box box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.low[axis] = column_[2 * axis][core::at(k)];
            box.high[axis] = column_[2 * axis + 1][core::at(k)];
        }
        return box;
    }

    /// Calls meets(k) for the boxes k in [first, last) that overlap `box`: 16 comparisons into a mask of bytes, a loop
    /// that compilers turn into vector instructions of whatever width there is.
    template <class Meets>
    void overlaps(const Box& box, std::int32_t first, std::int32_t last, const Meets& meets) const {
        const float *x0 = column_[0].data(), *x1 = column_[1].data(), *y0 = column_[2].data(), *y1 = column_[3].data(),
                    *z0 = column_[4].data(), *z1 = column_[5].data();
        for (std::int32_t k = first; k < last; k += width) {
            alignas(16) unsigned char hit[width];
            for (std::int32_t lane = 0; lane < width; ++lane)
                hit[lane] = static_cast<unsigned char>(
                    static_cast<int>(x0[k + lane] <= box.high[0]) & static_cast<int>(x1[k + lane] >= box.low[0]) &
                    static_cast<int>(y0[k + lane] <= box.high[1]) & static_cast<int>(y1[k + lane] >= box.low[1]) &
                    static_cast<int>(z0[k + lane] <= box.high[2]) & static_cast<int>(z1[k + lane] >= box.low[2]));
            const std::int32_t lanes = std::min(width, last - k);
            if constexpr (std::endian::native == std::endian::little) {
                std::uint64_t half[2];
                std::memcpy(half, hit, sizeof half);
                if (lanes <= 8) half[1] = 0;
                if (lanes < 8) half[0] &= (std::uint64_t{1} << (8 * lanes)) - 1;
                if (lanes > 8 && lanes < 16) half[1] &= (std::uint64_t{1} << (8 * (lanes - 8))) - 1;
                for (std::int32_t part = 0; part < 2; ++part)
                    for (std::uint64_t left = half[part]; left != 0; left &= left - 1)
                        meets(k + 8 * part + (std::countr_zero(left) >> 3));
            } else {
                for (std::int32_t lane = 0; lane < lanes; ++lane)
                    if (hit[lane] != 0) meets(k + lane);
            }
        }
    }

private:
    std::vector<float> column_[6];
};

}  // namespace fibrant::proximity::detail
