// SPDX-License-Identifier: MIT
#pragma once
/// @file A list of large values that grows without being in memory twice.

#include <fibrant/core/parallel.hpp>

#include <cstddef>
#include <iterator>
#include <vector>

namespace fibrant::core {

/// Values in blocks of equal size: a vector that grows is there twice while it moves, and takes a piece of memory that no other
/// has left.
template <class T>
class Blocks {
    template <class Self, class Value>
    struct Iterator {
        using iterator_category = std::forward_iterator_tag;
        using value_type = T;
        using difference_type = std::ptrdiff_t;
        using pointer = Value*;
        using reference = Value&;
        Self* of = nullptr;
        std::size_t k = 0;
        Value& operator*() const noexcept { return (*of)[k]; }
        Value* operator->() const noexcept { return &(*of)[k]; }
        Iterator& operator++() noexcept { return ++k, *this; }
        Iterator operator++(int) noexcept { return {of, k++}; }
        bool operator==(const Iterator& other) const noexcept { return k == other.k; }
    };

public:
    static constexpr std::size_t block = 1024;  ///< values

    std::size_t size() const noexcept { return size_; }
    bool empty() const noexcept { return size_ == 0; }
    /// Values that it has memory for.
    std::size_t room() const noexcept { return blocks_.size() * block; }
    T& operator[](std::size_t k) noexcept { return blocks_[k / block][k % block]; }
    const T& operator[](std::size_t k) const noexcept { return blocks_[k / block][k % block]; }
    const T& front() const noexcept { return (*this)[0]; }
    const T& back() const noexcept { return (*this)[size_ - 1]; }
    auto begin() noexcept { return Iterator<Blocks, T>{this, 0}; }
    auto end() noexcept { return Iterator<Blocks, T>{this, size_}; }
    auto begin() const noexcept { return Iterator<const Blocks, const T>{this, 0}; }
    auto end() const noexcept { return Iterator<const Blocks, const T>{this, size_}; }
    /// Values [first, last).
    auto part(std::size_t first, std::size_t last) const noexcept {
        using Place = Iterator<const Blocks, const T>;
        struct Part {
            Place from, to;
            Place begin() const noexcept { return from; }
            Place end() const noexcept { return to; }
        };
        return Part{{this, first}, {this, last}};
    }

    /// Keeps its memory for what comes.
    void clear() noexcept { size_ = 0; }
    /// Puts all parts behind what there is, one behind the other.
    void append(const std::vector<std::vector<T>>& parts) {
        std::vector<std::size_t> first{size_};
        for (const auto& part : parts) first.push_back(first.back() + part.size());
        size_ = first.back();
        while (room() < size_) blocks_.emplace_back(block);
        parallel_for(
            count(parts),
            [&](Index p) {
                for (std::size_t k = 0; k < parts[at(p)].size(); ++k) (*this)[first[at(p)] + k] = parts[at(p)][k];
            },
            light_items / 8);
    }
    /// Gives back what is beyond an eighth more than there is.
    void trim() {
        const std::size_t most = (size_ + size_ / 8) / block + 1;
        if (blocks_.size() > most) blocks_.resize(most);
    }

private:
    std::vector<std::vector<T>> blocks_;
    std::size_t size_ = 0;
};

}  // namespace fibrant::core
