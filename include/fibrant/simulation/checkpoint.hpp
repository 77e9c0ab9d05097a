// SPDX-License-Identifier: MIT
#pragma once
/// @file A run's last accepted state as a file, from which it resumes to the same bits.

#include <fibrant/core/types.hpp>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <type_traits>
#include <vector>
#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

namespace fibrant::simulation {

/// Writes plain values to memory, then to a file in one step: the old file stays until the new one is complete.
class CheckpointWriter {
public:
    template <class T>
        requires std::is_trivially_copyable_v<T>
    void put(const T& value) {
        const char* bytes = reinterpret_cast<const char*>(&value);
        data_.insert(data_.end(), bytes, bytes + sizeof(T));
    }
    void put(const std::string& text) {
        put(static_cast<std::uint64_t>(text.size()));
        data_.insert(data_.end(), text.data(), text.data() + text.size());
    }
    void put(const Vector& vector) {
        put(static_cast<std::uint64_t>(vector.size()));
        for (Index k = 0; k < vector.size(); ++k) put(vector[k]);
    }
    /// What another writer wrote, as it is.
    void put_all(const std::vector<char>& bytes) { data_.insert(data_.end(), bytes.begin(), bytes.end()); }
    /// @throws std::runtime_error if the file cannot be written
    void write(const std::filesystem::path& path) const {
        std::filesystem::path part = path;
        part += ".part";
        const std::uint64_t sum = hash(data_.data(), data_.size());
        std::FILE* file = std::fopen(part.string().c_str(), "wb");
        bool written = file != nullptr && std::fwrite(data_.data(), 1, data_.size(), file) == data_.size() &&
                       std::fwrite(&sum, sizeof sum, 1, file) == 1 && std::fflush(file) == 0 && on_the_disk(file);
        int reason = errno;
        if (file != nullptr && std::fclose(file) != 0 && written) written = false, reason = errno;
        std::error_code error;
        if (written) {
            std::filesystem::rename(part, path, error);
            if (!error) return;
            reason = error.value();
        }
        if (file != nullptr) std::filesystem::remove(part, error);
        throw std::runtime_error("cannot write checkpoint " + path.string() + ": " + std::generic_category().message(reason));
    }
    /// All that was put, without the sum.
    const std::vector<char>& bytes() const noexcept { return data_; }
    /// Of what was put: two scenes with the same identity are taken for the same.
    std::uint64_t identity() const noexcept { return hash(data_.data(), data_.size()); }
    /// FNV-1a: tells a damaged file from a whole one.
    static std::uint64_t hash(const char* data, std::size_t size) noexcept {
        std::uint64_t sum = 14695981039346656037ull;
        for (std::size_t k = 0; k < size; ++k) sum = (sum ^ static_cast<unsigned char>(data[k])) * 1099511628211ull;
        return sum;
    }

private:
    /// The name is given to a file only once its bytes are on the disk: where power fails in between, the old one is still there.
    static bool on_the_disk([[maybe_unused]] std::FILE* file) noexcept {
#if __has_include(<unistd.h>)
        return fsync(fileno(file)) == 0 || errno == EINVAL || errno == ENOTSUP;  // what is no disk has nothing to wait for
#else
        return true;
#endif
    }
    std::vector<char> data_;
};

/// Reads what a CheckpointWriter wrote, in the same order.
class CheckpointReader {
public:
    /// @throws std::runtime_error if the file cannot be read or is damaged
    explicit CheckpointReader(const std::filesystem::path& path) : name_{path.string()} {
        std::ifstream file(path, std::ios::binary | std::ios::ate);
        std::error_code error;
        if (!file) throw std::runtime_error("cannot read checkpoint " + name_ + ": " + std::generic_category().message(errno));
        if (std::filesystem::is_directory(path, error))
            throw std::runtime_error("cannot read checkpoint " + name_ + ": it is a folder");
        const std::streamoff size = file.tellg();
        if (size < 0) fail();
        data_.resize(static_cast<std::size_t>(size));
        file.seekg(0);
        file.read(data_.data(), static_cast<std::streamsize>(data_.size()));
        std::uint64_t sum = 0;
        if (!file || data_.size() < sizeof sum) fail();
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
    [[noreturn]] void fail() const { throw std::runtime_error("checkpoint " + name_ + " is damaged"); }
    std::string name_;
    std::vector<char> data_;
    std::size_t position_ = 0;
};

}  // namespace fibrant::simulation
