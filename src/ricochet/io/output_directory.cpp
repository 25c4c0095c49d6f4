#include "ricochet/io/output_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/io/run_files.h"

namespace ricochet {
namespace {

constexpr std::string_view kMarkerText = "ricochet run: a later run into this folder replaces the files of this one\n";

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, const std::string& reason) {
    throw RunError(fmt::format("{}: cannot {} ({})", path.string(), what, reason));
}

void make_folder(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::exists(path, error) && !std::filesystem::is_directory(path)) {
        throw InputError(fmt::format(
            "{}: is not a folder; give --output a folder that is new, empty or an earlier run's", path.string()));
    }
    std::filesystem::create_directories(path, error);
    if (error) fail(path, "create the output folder", error.message());
}

bool is_empty_folder(const std::filesystem::path& path) {
    std::error_code error;
    const bool empty = std::filesystem::is_empty(path, error);
    if (error) fail(path, "look into the output folder", error.message());
    return empty;
}

int open_marker(const std::filesystem::path& folder) {
    const std::filesystem::path marker = folder / kRunMarkerFile;
    constexpr int kFlags = O_RDWR | O_CLOEXEC | O_NOFOLLOW;
    int descriptor = ::open(marker.c_str(), kFlags);
    if (descriptor < 0 && errno == ENOENT) {
        if (!is_empty_folder(folder)) {
            throw InputError(fmt::format(
                "{}: the folder is not empty and no earlier run's; choose a new or empty folder", folder.string()));
        }
        descriptor = ::open(marker.c_str(), kFlags | O_CREAT, 0644);
    }
    if (descriptor < 0) fail(marker, "open the run's marker", std::strerror(errno));
    return descriptor;
}

bool holds_other_text(int descriptor) {
    std::array<char, kMarkerText.size()> start{};
    const ssize_t count = ::pread(descriptor, start.data(), start.size(), 0);
    if (count <= 0) return count < 0;  // an empty marker is one that is being made
    const std::string_view read{start.data(), static_cast<std::size_t>(count)};
    return !kMarkerText.starts_with(read);
}

void lock_marker(int descriptor, const std::filesystem::path& folder) {
    const std::filesystem::path marker = folder / kRunMarkerFile;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK) fail(marker, "lock the output folder", std::strerror(errno));
        throw RunError(fmt::format("{}: another run is writing into this folder", folder.string()));
    }
    if (holds_other_text(descriptor)) {
        throw InputError(
            fmt::format("{}: not a marker that ricochet wrote; choose another output folder", marker.string()));
    }
    if (::pwrite(descriptor, kMarkerText.data(), kMarkerText.size(), 0) != static_cast<ssize_t>(kMarkerText.size())) {
        fail(marker, "write the run's marker", std::strerror(errno));
    }
}

template <class Wanted>
void remove_files(const std::filesystem::path& folder, Wanted&& is_wanted) {
    std::error_code error;
    std::vector<std::filesystem::path> files;
    for (auto entry = std::filesystem::directory_iterator(folder, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::filesystem::file_type type = entry->symlink_status().type();
        const bool file = type == std::filesystem::file_type::regular || type == std::filesystem::file_type::symlink;
        if (file && is_wanted(entry->path().filename().string())) files.push_back(entry->path());
    }
    if (error) fail(folder, "look into the output folder", error.message());
    for (const std::filesystem::path& file : files) {
        std::filesystem::remove(file, error);
        if (error) fail(file, "remove the earlier run's file", error.message());
    }
}

}  // namespace

OutputDirectory::OutputDirectory(std::filesystem::path path, Earlier earlier) : path_(std::move(path)) {
    std::error_code ignored;
    if (earlier == Earlier::keep && !std::filesystem::exists(path_ / kRunMarkerFile, ignored)) {
        throw InputError(fmt::format("{}: no run was here that could be resumed; leave --resume out", path_.string()));
    }
    make_folder(path_);
    marker_ = open_marker(path_);
    try {
        lock_marker(marker_, path_);
        if (earlier == Earlier::remove) remove_files(path_, [](const std::string& name) { return is_run_file(name); });
    } catch (...) {
        ::close(marker_);
        throw;
    }
}

void OutputDirectory::remove_after(std::uint64_t step) const {
    remove_files(path_, [&](const std::string& name) {
        const auto frame = step_of_frame_file(name);
        const auto contacts = step_of_contact_file(name);
        return (frame && *frame > step) || (contacts && *contacts > step);
    });
}

OutputDirectory::~OutputDirectory() { ::close(marker_); }

}  // namespace ricochet
