#include "ricochet/io/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "ricochet/core/error.h"
#include "ricochet/io/run_files.h"

namespace ricochet {

RunFolder open_run_folder(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error)) {
        throw InputError(fmt::format("{}: no such folder; give the --output folder of a ricochet run", path.string()));
    }
    RunFolder folder;
    std::map<std::size_t, std::filesystem::path> colliders;
    for (auto entry = std::filesystem::directory_iterator(path, error);
         !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (const auto step = step_of_frame_file(name)) folder.frames.push_back({*step, entry->path()});
        if (const auto index = index_of_collider_file(name)) colliders.emplace(*index, entry->path());
        if (name == kRunInfoFile) folder.info = read_run_info(entry->path());
    }
    if (error) throw InputError(fmt::format("{}: cannot be read ({})", path.string(), error.message()));
    if (folder.frames.empty()) {
        throw InputError(fmt::format("{}: holds no frames (particles_NNNNNN.vtp); give the --output folder of a run",
                                     path.string()));
    }
    std::sort(folder.frames.begin(), folder.frames.end(),
              [](const FrameFile& a, const FrameFile& b) { return a.step < b.step; });
    for (const auto& [index, file] : colliders) folder.colliders.push_back(file);
    return folder;
}

}  // namespace ricochet
