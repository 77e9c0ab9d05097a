// SPDX-License-Identifier: MIT
#pragma once
/// @file A run's last accepted state as a file, from which it resumes to the same bits.

#include <fibrant/core/types.hpp>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>
#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

namespace fibrant::simulation {

namespace detail {
// Of C, since what C++ has for files takes a compiler's memory in every program that runs a simulation.
struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using ReadFile = std::unique_ptr<std::FILE, CloseFile>;
/// Null where there is none.
inline ReadFile open_to_read(const std::string& path) noexcept { return ReadFile(std::fopen(path.c_str(), "rb")); }
/// To a name under which there may be another file, which then is gone. @returns whether it could be done, else errno says why
inline bool rename_file(const std::string& from, const std::string& to) noexcept {
#if !__has_include(<unistd.h>)
    std::remove(to.c_str());  // systems other than those of POSIX rename to no name that is taken
#endif
    return std::rename(from.c_str(), to.c_str()) == 0;
}
}  // namespace detail

/// Writes plain values to a file as they come: a part of it until the file is complete, so that the old one stays until then.
/// Without a path it keeps nothing but their sum.
class CheckpointWriter {
public:
    CheckpointWriter() = default;
    /// What cannot be written is told by `finish`.
    explicit CheckpointWriter(std::string path) : path_{std::move(path)}, part_{path_ + ".part"} {
        file_ = std::fopen(part_.c_str(), "wb");
        note(file_ != nullptr);
        pending_.reserve(most_pending);
    }
    CheckpointWriter(const CheckpointWriter&) = delete;
    CheckpointWriter& operator=(const CheckpointWriter&) = delete;
    /// What was not finished leaves no file.
    ~CheckpointWriter() { discard(); }

    template <class T>
        requires std::is_trivially_copyable_v<T>
    void put(const T& value) { put_bytes(reinterpret_cast<const char*>(&value), sizeof(T)); }
    void put(const std::string& text) {
        put(static_cast<std::uint64_t>(text.size()));
        put_bytes(text.data(), text.size());
    }
    void put(const Vector& vector) {
        put(static_cast<std::uint64_t>(vector.size()));
        for (Index k = 0; k < vector.size(); ++k) put(vector[k]);
    }
    void put_bytes(const char* bytes, std::size_t size) {
        sum_ = hash(bytes, size, sum_);
        if (file_ == nullptr) return;
        if (pending_.size() + size > most_pending) flush();
        if (size > most_pending)
            note(std::fwrite(bytes, 1, size, file_) == size);
        else
            pending_.insert(pending_.end(), bytes, bytes + size);
    }
    /// Puts all that another writer put into a file, before this one puts anything.
    /// @throws std::runtime_error if it cannot be read or is damaged
    void put_file(const std::string& path) {
        const detail::ReadFile file = detail::open_to_read(path);
        std::uint64_t sum = 0;
        std::vector<char> piece(most_pending + sizeof sum);
        std::size_t kept = 0;  // bytes that may be the sum, which comes last
        for (std::size_t read = 1; file && read > 0;) {
            read = std::fread(piece.data() + kept, 1, most_pending, file.get());
            const std::size_t all = kept + read, some = all > sizeof sum ? all - sizeof sum : 0;
            put_bytes(piece.data(), some);
            kept = all - some;
            std::memmove(piece.data(), piece.data() + some, kept);
        }
        std::memcpy(&sum, piece.data(), sizeof sum);
        if (!file || std::ferror(file.get()) != 0 || kept < sizeof sum || sum != sum_)
            throw std::runtime_error("checkpoint " + path + " is damaged");
    }
    /// The file is complete, and takes the place of the one before.
    /// @throws std::runtime_error if it cannot be written
    void finish() {
        const std::uint64_t sum = sum_;
        put(sum);
        flush();
        if (file_ != nullptr && reason_ == 0) note(std::fflush(file_) == 0 && on_the_disk(file_));
        if (file_ != nullptr) note(std::fclose(file_) == 0);
        if (file_ != nullptr && reason_ == 0) note(detail::rename_file(part_, path_));
        if (file_ != nullptr && reason_ != 0) std::remove(part_.c_str());
        file_ = nullptr;
        if (reason_ != 0)
            throw std::runtime_error("cannot write checkpoint " + path_ + ": " + std::generic_category().message(reason_));
    }
    /// Of what was put: two scenes with the same identity are taken for the same.
    std::uint64_t identity() const noexcept { return sum_; }
    /// FNV-1a: tells a damaged file from a whole one. @param sum  of what stands before
    static std::uint64_t hash(const char* data, std::size_t size, std::uint64_t sum = 14695981039346656037ull) noexcept {
        for (std::size_t k = 0; k < size; ++k) sum = (sum ^ static_cast<unsigned char>(data[k])) * 1099511628211ull;
        return sum;
    }

private:
    static constexpr std::size_t most_pending = std::size_t{1} << 16;  // bytes a call to the system: its cost is then none
    /// The first reason is the one that is told.
    void note(bool written) noexcept {
        if (!written && reason_ == 0) reason_ = errno != 0 ? errno : EIO;
    }
    void flush() {
        if (file_ != nullptr && reason_ == 0) note(std::fwrite(pending_.data(), 1, pending_.size(), file_) == pending_.size());
        pending_.clear();
    }
    void discard() noexcept {
        if (file_ == nullptr) return;
        std::fclose(file_);
        std::remove(part_.c_str());
    }
    /// The name is given to a file only once its bytes are on the disk: where power fails in between, the old one is still there.
    static bool on_the_disk([[maybe_unused]] std::FILE* file) noexcept {
#if __has_include(<unistd.h>)
        return fsync(fileno(file)) == 0 || errno == EINVAL || errno == ENOTSUP;  // what is no disk has nothing to wait for
#else
        return true;
#endif
    }
    std::string path_, part_;
    std::FILE* file_ = nullptr;
    std::vector<char> pending_;
    std::uint64_t sum_ = hash(nullptr, 0);
    int reason_ = 0;
};

/// Reads what a CheckpointWriter wrote, in the same order.
class CheckpointReader {
public:
    /// @throws std::runtime_error if the file cannot be read or is damaged
    explicit CheckpointReader(std::string path) : name_{std::move(path)} {
        const detail::ReadFile file = detail::open_to_read(name_);
        if (!file) refuse(errno);
        constexpr std::size_t piece = std::size_t{1} << 20;
        std::size_t size = 0;
        for (std::size_t read = piece; read == piece; size += read) {
            data_.resize(size + piece);
            read = std::fread(data_.data() + size, 1, piece, file.get());
        }
        if (std::ferror(file.get()) != 0) refuse(errno);
        data_.resize(size);
        std::uint64_t sum = 0;
        if (data_.size() < sizeof sum) fail();
        std::memcpy(&sum, data_.data() + data_.size() - sizeof sum, sizeof sum);
        data_.resize(data_.size() - sizeof sum);
        if (sum != CheckpointWriter::hash(data_.data(), data_.size())) fail();
    }
    /// All that was put, without the sum.
    const std::vector<char>& bytes() const noexcept { return data_; }
    template <class T>
        requires std::is_trivially_copyable_v<T> T get() {
            if (sizeof(T) > left()) fail();
            const char* from = data_.data() + position_;
            position_ += sizeof(T);
            if constexpr (std::is_same_v<T, bool>) {
                return *from != 0;
            } else {
                T value;
                std::memcpy(static_cast<void*>(&value), from, sizeof(T));
                return value;
            }
        }
    /// How many items follow, of at least so many bytes each: never more than the file still has.
    Index get_count(std::size_t bytes_each) {
        const auto size = get<std::uint64_t>();
        if (size > left() / bytes_each) fail();
        return static_cast<Index>(size);
    }
    std::string get_text() {
        const auto size = static_cast<std::size_t>(get_count(1));
        position_ += size;
        return std::string(data_.data() + position_ - size, size);
    }
    Vector get_vector() {
        Vector vector(get_count(sizeof(double)));
        for (Index k = 0; k < vector.size(); ++k) vector[k] = get<double>();
        return vector;
    }
    /// @throws std::runtime_error "... is damaged" unless `holds`: what no run can have written
    void require(bool holds) const {
        if (!holds) fail();
    }
    /// Everything has been read.
    void require_end() const { require(left() == 0); }
    /// @throws std::runtime_error unless `holds`
    void expect(bool holds, const std::string& what) const {
        if (!holds) throw std::runtime_error("checkpoint " + name_ + " belongs to another scene: " + what + " differs");
    }

private:
    std::size_t left() const noexcept { return data_.size() - position_; }
    [[noreturn]] void refuse(int reason) const {
        throw std::runtime_error("cannot read checkpoint " + name_ + ": " +
                                 (reason == EISDIR ? "it is a folder" : std::generic_category().message(reason)));
    }
    [[noreturn]] void fail() const { throw std::runtime_error("checkpoint " + name_ + " is damaged"); }
    std::string name_;
    std::vector<char> data_;
    std::size_t position_ = 0;
};

}  // namespace fibrant::simulation
