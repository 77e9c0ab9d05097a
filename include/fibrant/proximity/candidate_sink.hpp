// SPDX-License-Identifier: MIT
#pragma once
/// @file Candidates on their way from boxes that overlap to the exact filter.

#include <fibrant/proximity/exact_filter.hpp>

namespace fibrant::proximity::detail {

/// Collects candidates and filters them by the thousand.
class CandidateSink {
public:
    /// @param records       of segments
    /// @param map_a, map_b  places of the first and second of a candidate to places of records; null where they are these
    CandidateSink(const SegmentTable& table, const SegmentRecord* records, const std::int32_t* map_a, const std::int32_t* map_b,
                  std::vector<SegmentPair>& close)
        : table_(table), records_(records), map_a_(map_a), map_b_(map_b), close_(close), batch_(least) {}

    Candidate* room(std::int32_t n) {
        if (filled_ + core::at(n) > batch_.size()) {
            flush();
            if (core::at(n) > batch_.size()) batch_.resize(core::at(n));
        }
        return batch_.data() + filled_;
    }
    void take(const Candidate* end) noexcept { filled_ = core::at(end - batch_.data()); }
    void flush() {
        if (map_a_ != nullptr) {
            std::size_t kept = 0;
            for (std::size_t k = 0; k < filled_; ++k) {
                const Candidate mapped{map_a_[batch_[k].a], map_b_[batch_[k].b]};
                batch_[kept] = mapped;
                kept += mapped.a != mapped.b ? 1 : 0;
            }
            filled_ = kept;
        }
        keep_close(table_, records_, {batch_.data(), filled_}, close_);
        filled_ = 0;
    }

private:
    static constexpr std::size_t least = 4096;
    const SegmentTable& table_;
    const SegmentRecord* records_;
    const std::int32_t *map_a_, *map_b_;
    std::vector<SegmentPair>& close_;
    std::vector<Candidate> batch_;
    std::size_t filled_ = 0;
};

}  // namespace fibrant::proximity::detail
