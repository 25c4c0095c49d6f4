/// \file
/// A run's output folder, looked at from outside: which frames and colliders it holds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "ricochet/io/run_info.h"

namespace ricochet {

/// One frame of a run.
struct FrameFile {
    std::uint64_t step = 0;
    std::filesystem::path path;
};

/// What a run has written so far.
struct RunFolder {
    RunInfo info;                                  ///< defaults where the folder has no run.json
    std::vector<FrameFile> frames;                 ///< by step
    std::vector<std::filesystem::path> colliders;  ///< by index
};

/// Looks into a run's folder; a run that still writes or was cut off is fine. Throws InputError when there is no such
/// folder or it holds no frame.
[[nodiscard]] RunFolder open_run_folder(const std::filesystem::path& path);

}  // namespace ricochet
