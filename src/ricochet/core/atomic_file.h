/// \file
/// Output files that appear under their name only when they are complete.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

#include "ricochet/core/unfinished_file.h"

namespace ricochet {

/// Writes to a temporary name beside the target and renames it in commit(); without commit() nothing is left behind and
/// an older file of that name stays as it was, also when a signal ends the process (core/unfinished_file.h). One thread
/// at a time.
class AtomicFile {
public:
    /// Throws InputError when the target is a folder or a device, RunError when it cannot be created.
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Appends bytes. Throws RunError when the disk does not take them.
    void write(std::string_view bytes);
    /// Closes the file and gives it its name. Throws RunError when that fails. To be called once, at the end.
    void commit();

private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;
    UnfinishedFile unfinished_;
    std::FILE* file_ = nullptr;
    bool is_committed_ = false;
};

/// Writes a whole file in one go; throws like AtomicFile.
void write_file(const std::filesystem::path& target, std::string_view bytes);

}  // namespace ricochet
