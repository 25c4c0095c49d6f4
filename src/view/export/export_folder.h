/// \file
/// Private to the library: the folder that files for other programs go to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ricochet {

inline constexpr const char* kExportMarkerFile = ".ricochet-export";  ///< says which files of a folder are an export's

/// A folder that is new, empty, or holds an earlier export, whose files (and nothing else) are replaced. A run's folder
/// is none: exporting a run into itself is refused.
class ExportFolder {
public:
    /// Only looks. Throws InputError where the path is no such folder.
    explicit ExportFolder(std::filesystem::path path);

    /// Makes the folder, removes the files of an earlier export and notes the names of those that will be written.
    /// Throws RunError when the system refuses.
    void begin(const std::vector<std::string>& files);
    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
    std::vector<std::string> earlier_;
};

}  // namespace ricochet
