// SPDX-License-Identifier: MIT
#pragma once
/// @file A run's last accepted state as a file, from which it resumes to the same bits.

#include <fibrant/core/types.hpp>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

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
        data_.insert(data_.end(), text.begin(), text.end());
    }
    void put(const Vector& vector) {
        put(static_cast<std::uint64_t>(vector.size()));
        for (Index k = 0; k < vector.size(); ++k) put(vector[k]);
    }
    /// @throws std::runtime_error if the file cannot be written
    void write(const std::filesystem::path& path) const {
        std::filesystem::path part = path;
        part += ".part";
        {
            std::ofstream file(part, std::ios::binary);
            const std::uint64_t sum = hash(data_.data(), data_.size());
            file.write(data_.data(), static_cast<std::streamsize>(data_.size()));
            file.write(reinterpret_cast<const char*>(&sum), sizeof sum);
            if (!file.flush()) throw std::runtime_error("cannot write checkpoint " + path.string());
        }
        std::filesystem::rename(part, path);
    }
    /// Of what was put: two scenes with the same identity are taken for the same.
    std::uint64_t identity() const noexcept { return hash(data_.data(), data_.size()); }
    /// FNV-1a: tells a damaged file from a whole one.
    static std::uint64_t hash(const char* data, std::size_t size) noexcept {
        std::uint64_t sum = 14695981039346656037ull;
        for (std::size_t k = 0; k < size; ++k) sum = (sum ^ static_cast<unsigned char>(data[k])) * 1099511628211ull;
        return sum;
    }

private:
    std::vector<char> data_;
};

/// Reads what a CheckpointWriter wrote, in the same order.
class CheckpointReader {
public:
    /// @throws std::runtime_error if the file cannot be read or is damaged
    explicit CheckpointReader(const std::filesystem::path& path) : name_{path.string()} {
        std::ifstream file(path, std::ios::binary | std::ios::ate);
        if (!file) throw std::runtime_error("cannot read checkpoint " + name_);
        data_.resize(static_cast<std::size_t>(file.tellg()));
        file.seekg(0);
        file.read(data_.data(), static_cast<std::streamsize>(data_.size()));
        std::uint64_t sum = 0;
        if (!file || data_.size() < sizeof sum) fail();
        std::memcpy(&sum, data_.data() + data_.size() - sizeof sum, sizeof sum);
        data_.resize(data_.size() - sizeof sum);
        if (sum != CheckpointWriter::hash(data_.data(), data_.size())) fail();
    }
    template <class T>
        requires std::is_trivially_copyable_v<T>
    T get() {
        T value;
        if (position_ + sizeof(T) > data_.size()) fail();
        std::memcpy(static_cast<void*>(&value), data_.data() + position_, sizeof(T));
        position_ += sizeof(T);
        return value;
    }
    std::string get_text() {
        const std::size_t size = get<std::uint64_t>();
        if (position_ + size > data_.size()) fail();
        position_ += size;
        return std::string(data_.data() + position_ - size, size);
    }
    Vector get_vector() {
        const std::uint64_t size = get<std::uint64_t>();
        if (position_ + size * sizeof(double) > data_.size()) fail();
        Vector vector(static_cast<Index>(size));
        for (Index k = 0; k < vector.size(); ++k) vector[k] = get<double>();
        return vector;
    }
    /// @throws std::runtime_error unless `holds`
    void expect(bool holds, const std::string& what) const {
        if (!holds) throw std::runtime_error("checkpoint " + name_ + " belongs to another scene: " + what + " differs");
    }

private:
    [[noreturn]] void fail() const { throw std::runtime_error("checkpoint " + name_ + " is damaged"); }
    std::string name_;
    std::vector<char> data_;
    std::size_t position_ = 0;
};

}  // namespace fibrant::simulation
