/// \file
/// The folder that a run writes into: whose it is, and that only one run at a time has it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

namespace ricochet {

/// Takes a folder for one run. The folder must be new, empty, or carry an earlier run's marker; of an earlier run only
/// the files that a run writes are removed (run_files.h), everything else stays. The folder is locked while this object
/// lives; the lock goes with the process, however that ends.
class OutputDirectory {
public:
    /// Creates the folder (and its parents) where missing, marks and locks it, and removes an earlier run's files.
    /// Throws InputError when the folder holds anything else or the path is not a folder; RunError when it is in use by
    /// another run or the system refuses.
    explicit OutputDirectory(std::filesystem::path path) : OutputDirectory(std::move(path), Earlier::remove) {}
    /// What is to become of an earlier run's files. Kept ones must be there: InputError where the folder is no run's.
    enum class Earlier { remove, keep };
    OutputDirectory(std::filesystem::path path, Earlier earlier);
    ~OutputDirectory();
    OutputDirectory(const OutputDirectory&) = delete;
    OutputDirectory& operator=(const OutputDirectory&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// Removes frames and contact files of steps after this one: an interrupted run goes on there.
    void remove_after(std::uint64_t step) const;

private:
    std::filesystem::path path_;
    int marker_ = -1;  // file descriptor that holds the lock
};

}  // namespace ricochet
