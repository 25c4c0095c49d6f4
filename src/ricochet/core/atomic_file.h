/// \file
/// Output files that appear under their name only when they are complete.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

#include "ricochet/core/unfinished_file.h"

namespace ricochet {

/// Writer that uses a temporary name beside the target and renames the file in commit(). If commit() is not called, the
/// destructor removes the temporary file, and an existing target file stays unchanged. A signal that ends the process
/// has the same effect (core/unfinished_file.h). An object must be used by one thread at a time.
class AtomicFile {
public:
    /// Throws InputError if the target is a folder or a device, and RunError if the file cannot be created.
    explicit AtomicFile(std::filesystem::path target);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Appends bytes. Throws RunError if they cannot be written.
    void write(std::string_view bytes);
    /// Closes the file and renames it to the target. Throws RunError if that fails. Call commit() once, at the end.
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
