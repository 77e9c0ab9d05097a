// SPDX-License-Identifier: MIT
#pragma once
/// @file The folder that results go to: one run at a time is in it, and what an earlier run left is not written over without a
/// word.

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace example {

/// What is done with results that are in the folder already.
enum class Earlier {
    refused,      ///< there may be none
    resumed,      ///< the run goes on from the last increment that they hold
    overwritten,  ///< the run begins anew
};

/// Refuses a name that no folder can have, before anything is read: that of a file, or of something within a file.
/// @throws std::invalid_argument
inline void require_folder(const std::filesystem::path& folder) {
    const std::string name = "--output " + folder.string();
    if (folder.empty()) throw std::invalid_argument("--output is empty, but it must be a folder");
    std::error_code error;
    if (std::filesystem::status(folder, error).type() == std::filesystem::file_type::none)  // such as a name that is too long
        throw std::invalid_argument("--output " + folder.string().substr(0, 80) + ": cannot be made: " + error.message());
    if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error))
        throw std::invalid_argument(name + ": is a file, but it must be a folder");
    for (std::filesystem::path above = folder.parent_path(); !above.empty(); above = above.parent_path()) {
        if (std::filesystem::is_directory(above, error)) break;
        if (std::filesystem::exists(above, error))
            throw std::invalid_argument(name + ": cannot be made: " + above.string() + " is a file");
        if (above == above.parent_path()) break;
    }
}

/// Holds a folder while it lives: another run that wants it is refused. The lock goes with the process, however it ends.
class ResultsFolder {
public:
    ResultsFolder() = default;
    /// @throws std::invalid_argument if the folder cannot be made or written, or another run is in it
    explicit ResultsFolder(const std::filesystem::path& folder) : lock_{folder / ".lock"} {
        const std::string name = "--output " + folder.string();
        require_folder(folder);
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        if (!std::filesystem::is_directory(folder)) throw std::invalid_argument(name + ": cannot be made: " + error.message());
        while (true) {
            file_ = open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
            if (file_ < 0) throw std::invalid_argument(name + ": cannot be written to: " + std::strerror(errno));
            if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
                if (errno != EWOULDBLOCK) return;  // a file system without locks
                std::array<char, 32> owner{};
                const auto size = read(file_, owner.data(), owner.size() - 1);
                close(std::exchange(file_, -1));
                throw std::invalid_argument(name + ": another run is in this folder (process " +
                                            (size > 0 ? std::string(owner.data()) : "unknown") +
                                            "): wait for its end, or name another folder");
            }
            // A run that has just ended may have taken the name away from what is locked here.
            struct stat held {
            }, named{};
            if (fstat(file_, &held) == 0 && stat(lock_.c_str(), &named) == 0 && held.st_ino == named.st_ino) break;
            close(std::exchange(file_, -1));
        }
        const std::string own = std::to_string(getpid());
        if (ftruncate(file_, 0) != 0 || write(file_, own.data(), own.size()) != static_cast<ssize_t>(own.size())) {
            const std::string reason = std::strerror(errno);
            release();
            throw std::invalid_argument(name + ": cannot be written to: " + reason);
        }
    }
    ResultsFolder(ResultsFolder&& other) noexcept : lock_{other.lock_}, file_{std::exchange(other.file_, -1)} {}
    ResultsFolder& operator=(ResultsFolder&& other) noexcept {
        std::swap(lock_, other.lock_), std::swap(file_, other.file_);
        return *this;
    }
    ~ResultsFolder() { release(); }

private:
    void release() noexcept {
        if (file_ < 0) return;
        unlink(lock_.c_str());
        close(std::exchange(file_, -1));
    }
    std::filesystem::path lock_;
    int file_ = -1;
};

/// Files of an earlier run in the folder, by name, a few of them; empty: none.
inline std::string earlier_results(const std::filesystem::path& folder) {
    std::string names;
    for (const char* name : {"checkpoint.bin", "settled.bin", "increments.csv", "summary.json", "levels.csv", "paraview"})
        if (std::filesystem::exists(folder / name)) names += (names.empty() ? "" : ", ") + std::string(name);
    return names;
}

/// Refuses a folder in which something is in the way of results, some of which are written at the end of the work: a folder that
/// is named as one of their files may be, a file by the name of one of their folders.
/// @param parts  folders in it that results go to as well
/// @throws std::invalid_argument
inline void require_free_names(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& parts = {}) {
    // A folder of one of these endings is hardly ever a user's, and each program has names of its own.
    static constexpr std::array<std::string_view, 15> endings{".bin", ".before", ".csv",     ".json", ".toml",
                                                              ".svg", ".html",   ".partial", ".part", ".glb",
                                                              ".inp", ".raw",    ".stl",     ".vti",  ".vtp"};
    const std::string name = "--output " + folder.string() + ": ";
    std::error_code error;
    for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string ending = entry.path().extension().string();
        if (std::find(endings.begin(), endings.end(), ending) != endings.end() && entry.is_directory(error))
            throw std::invalid_argument(name + entry.path().filename().string() +
                                        " in it is a folder, but results have files of such names");
    }
    std::vector<std::filesystem::path> folders = parts;
    folders.push_back(folder / "paraview");
    for (const std::filesystem::path& own : folders)
        if (std::filesystem::exists(own, error) && !std::filesystem::is_directory(own, error))
            throw std::invalid_argument(name + own.filename().string() +
                                        " in it is a file, but results have a folder of that name");
    for (const std::filesystem::path& part : parts)
        if (std::filesystem::is_directory(part, error)) require_free_names(part);
}

}  // namespace example
