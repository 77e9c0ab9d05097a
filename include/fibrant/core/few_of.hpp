// SPDX-License-Identifier: MIT
#pragma once
/// @file Values that few of many items have, without memory for the others.

#include <fibrant/core/parallel.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fibrant::core {

/// Of items [0, n) those that have a value; the value of any other is T(). Items are in blocks, each with a bit an item and the
/// values in their order.
template <class T>
class FewOf {
public:
    static constexpr std::size_t block = light_items;  ///< items

    /// Items, whether they have a value or not.
    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    const T& operator[](std::size_t k) const noexcept {
        const Block& of = blocks_[k / block];
        const Word& word = of.words[k % block / bits];
        const std::uint64_t bit = std::uint64_t{1} << k % bits;
        return (word.has & bit) == 0 ? none : of.values[word.first + at(std::popcount(word.has & (bit - 1)))];
    }
    /// Values that there are.
    std::size_t values() const noexcept {
        std::size_t sum = 0;
        for (const Block& of : blocks_) sum += of.values.size();
        return sum;
    }

    void clear() noexcept { size_ = 0, blocks_.clear(); }
    /// All anew. @param make  make(k, value) sets the value of item k, T() before, and says whether it has one; from several
    /// threads at once, in the order of a block's items
    template <class Make>
    void fill(std::size_t size, const Make& make) {
        size_ = size;
        blocks_.resize((size + block - 1) / block);
        parallel_for(count(blocks_), [&](Index b) {
            Block& of = blocks_[at(b)];
            of.values.clear();
            std::size_t k = block * at(b);
            for (Word& word : of.words) {
                word = {0, static_cast<std::uint32_t>(of.values.size())};
                for (std::size_t bit = 0; bit < bits && k < size; ++bit, ++k) {
                    T value{};
                    if (!make(static_cast<Index>(k), value)) continue;
                    reserve_for(of.values, of.values.size() + 1);
                    of.values.push_back(value);
                    word.has |= std::uint64_t{1} << bit;
                }
            }
        });
    }
    /// Calls body(value) for each value that there is.
    template <class Body>
    void change(const Body& body) {
        for (Block& of : blocks_)
            for (T& value : of.values) body(value);
    }

private:
    static constexpr std::size_t bits = 64;
    static_assert(block % bits == 0);
    struct Word {
        std::uint64_t has = 0;
        std::uint32_t first = 0;  // value of those that have one
    };
    struct Block {
        std::array<Word, block / bits> words;
        std::vector<T> values;
    };
    inline static const T none{};

    std::vector<Block> blocks_;
    std::size_t size_ = 0;
};

}  // namespace fibrant::core
