/// \file
/// Private to the library: the target folder of an export.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ricochet {

inline constexpr const char* kExportMarkerFile = ".ricochet-export";  ///< lists the files of an export

/// Target folder that is new, empty, or contains an earlier export. Only the files of the earlier export are replaced.
/// The folder of a run is refused, so that an export never overwrites a run.
class ExportFolder {
public:
    /// Checks the folder without changing it. Throws InputError if the path cannot be the target of an export.
    explicit ExportFolder(std::filesystem::path path);

    /// Creates the folder, removes the files of an earlier export, and records the names of the files to be written.
    /// Throws RunError if the file system reports an error.
    void begin(const std::vector<std::string>& files);
    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
    std::vector<std::string> earlier_;
};

}  // namespace ricochet
