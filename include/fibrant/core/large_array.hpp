// SPDX-License-Identifier: MIT
#pragma once
/// @file Memory for many numbers that are written before they are read.

#include <fibrant/core/types.hpp>

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace fibrant::core {

/// Gives a vector's memory back, which `values = {}` does not.
template <class T>
void release(std::vector<T>& values) noexcept {
    std::vector<T>().swap(values);
}

/// Makes room for so many values, and an eighth more: a vector that grows by itself has room for twice as many.
template <class T>
void reserve_for(std::vector<T>& values, std::size_t size) {
    if (size > values.capacity()) values.reserve(size + size / 8);
}

/// A vector of so many values, all to be written before they are read: what was there may be lost.
template <class T>
void resize_anew(std::vector<T>& values, std::size_t size) {
    if (size > values.capacity()) release(values);  // before there is more
    reserve_for(values, size);
    values.resize(size);
}

/// An array that is not set to anything. From a few MiB on it asks the system for large pages: a dense product that goes across
/// the columns of a tall matrix meets another page in each of them, and pages are cleared one by one when they are first written.
template <class T>
class LargeArray {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    Index size() const noexcept { return size_; }
    T* data() noexcept { return data_.get(); }
    const T* data() const noexcept { return data_.get(); }

    /// What was there is lost, unless the size is the same.
    void resize(Index size) {
        if (size == size_) return;
        data_.reset();  // before there is more
        size_ = size;
        const std::size_t bytes = at(size) * sizeof(T);
        const std::align_val_t alignment{bytes < 2 * page ? std::size_t{64} : page};
        data_ = {static_cast<T*>(::operator new(bytes, alignment)), Free{alignment}};
#if defined(__linux__) && defined(MADV_HUGEPAGE)
        if (bytes >= 2 * page) madvise(data_.get(), bytes, MADV_HUGEPAGE);  // if it cannot, small ones serve
#endif
    }

private:
    static constexpr std::size_t page = std::size_t{1} << 21;
    struct Free {
        std::align_val_t alignment{};
        void operator()(T* data) const { ::operator delete(data, alignment); }
    };

    Index size_ = 0;
    std::unique_ptr<T, Free> data_;
};

}  // namespace fibrant::core
