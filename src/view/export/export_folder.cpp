#include "view/export/export_folder.h"

#include <fmt/format.h>

#include <fstream>
#include <system_error>
#include <utility>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTitle = "ricochet export: a later export into this folder replaces these files";

// Returns true if the name has no path, so that it names a file directly in the folder.
bool is_file_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

std::vector<std::string> files_of_marker(const fs::path& marker) {
    std::error_code ignored;
    std::ifstream in;
    if (fs::is_regular_file(fs::symlink_status(marker, ignored))) in.open(marker, std::ios::binary);
    std::string line;
    if (!in.is_open() || !std::getline(in, line) || line != kTitle) {
        throw InputError(
            fmt::format("{}: not a marker that ricochet wrote; choose another output folder", marker.string()));
    }
    std::vector<std::string> files;
    while (std::getline(in, line)) {
        if (is_file_name(line)) files.push_back(line);
    }
    return files;
}

}  // namespace

ExportFolder::ExportFolder(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    const fs::file_status status = fs::status(path_, error);
    if (!fs::exists(status)) return;
    if (!fs::is_directory(status)) {
        throw InputError(fmt::format(
            "--output {}: is not a folder, expected one that is new, empty or an earlier export's", path_.string()));
    }
    const fs::path marker = path_ / kExportMarkerFile;
    if (fs::exists(fs::symlink_status(marker, error))) {
        earlier_ = files_of_marker(marker);
        return;
    }
    const bool is_empty = fs::is_empty(path_, error);
    if (error) throw RunError(fmt::format("{}: cannot list the folder ({})", path_.string(), error.message()));
    if (!is_empty) {
        throw InputError(
            fmt::format("--output {}: the folder is not empty and no earlier export's; choose a new or empty folder",
                        path_.string()));
    }
}

void ExportFolder::begin(const std::vector<std::string>& files) {
    std::error_code error;
    fs::create_directories(path_, error);
    if (error) throw RunError(fmt::format("{}: cannot create the folder ({})", path_.string(), error.message()));
    for (const std::string& name : earlier_) {
        const fs::file_type type = fs::symlink_status(file(name), error).type();
        if (type != fs::file_type::regular && type != fs::file_type::symlink) continue;
        fs::remove(file(name), error);
        if (error) {
            throw RunError(
                fmt::format("{}: cannot remove the earlier export's file ({})", file(name).string(), error.message()));
        }
    }
    std::string text(kTitle);
    text += '\n';
    for (const std::string& name : files) text += name + '\n';
    write_file(path_ / kExportMarkerFile, text);
}

}  // namespace ricochet
