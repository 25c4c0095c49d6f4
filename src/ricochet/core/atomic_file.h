/// \file
/// Output files that appear under their name only when they are complete.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

#include "ricochet/core/unfinished_file.h"

namespace ricochet {

/// Writer that uses a temporary name beside the target and renames the file in commit(). Without commit() the temporary
/// file is removed and an older file of that name is unchanged. This also holds if a signal ends the process
/// (core/unfinished_file.h). For one thread at a time.
class AtomicFile {
public:
    /// Throws InputError if the target is a folder or a device, and RunError if it cannot be created.
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Appends bytes. Throws RunError if they cannot be written.
    void write(std::string_view bytes);
    /// Closes the file and gives it its name. Throws RunError if that fails. Call it once, at the end.
    void commit();

private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;
    UnfinishedFile unfinished_;
    std::FILE* file_ = nullptr;
    bool is_committed_ = false;
};

/// Writes a whole file at once. Throws like AtomicFile.
void write_file(const std::filesystem::path& target, std::string_view bytes);

}  // namespace ricochet
