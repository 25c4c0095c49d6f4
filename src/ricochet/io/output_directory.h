/// \file
/// The folder that a run writes into: whose it is, and that only one run at a time has it.
#pragma once

#include <filesystem>

namespace ricochet {

/// Takes a folder for one run. The folder must be new, empty, or carry an earlier run's marker; of an earlier run only
/// the files that a run writes are removed (run_files.h), everything else stays. The folder is locked while this object
/// lives; the lock goes with the process, however that ends.
class OutputDirectory {
public:
    /// Creates the folder (and its parents) where missing, marks and locks it, and removes an earlier run's files.
    /// Throws InputError when the folder holds anything else or the path is not a folder; RunError when it is in use by
    /// another run or the system refuses.
    explicit OutputDirectory(std::filesystem::path path);
    ~OutputDirectory();
    OutputDirectory(const OutputDirectory&) = delete;
    OutputDirectory& operator=(const OutputDirectory&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    int marker_ = -1;  // file descriptor that holds the lock
};

}  // namespace ricochet
