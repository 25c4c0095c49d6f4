/// \file
/// Private to the library: a finished run as files for other programs. What each format loses stands in
/// docs/output-files.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ricochet/io/run_folder.h"

namespace ricochet {

/// What an export came to be.
struct ExportReport {
    std::size_t files = 0;
    std::size_t frames = 0;
    std::vector<std::string> notes;  ///< what is not as in the run, and how to play what was written
};

/// Told the part that is done.
using ExportProgress = std::function<void(double)>;

// All of them throw InputError for what is no run and for a target that is not what it should be, RunError when the
// disk does not take it. Files appear under their names when they are complete.

/// How files of a series are numbered: by the run's steps, or 0, 1, 2, ...
enum class ExportNumbers : std::uint8_t { steps, consecutive };

/// A PLY file of the particles for every frame, of colliders that move too, and one of each that is at rest.
ExportReport export_ply(const RunFolder& folder, const std::filesystem::path& target, ExportNumbers numbers,
                        const ExportProgress& progress);

/// A mesh (OBJ) for every collider and a point cache (PC2) of each that moves; of the particles too where they are the
/// same in all frames.
ExportReport export_pc2(const RunFolder& folder, const std::filesystem::path& target, const ExportProgress& progress);

/// A table (CSV) of the particles of every frame, one of the contact log where there is one, and one of all triangles
/// of the colliders.
ExportReport export_csv(const RunFolder& folder, const std::filesystem::path& target, const ExportProgress& progress);

/// One frame of the run as a glTF file. The frame: one of the folder's.
ExportReport export_gltf(const RunFolder& folder, const FrameFile& frame, const std::filesystem::path& target);

}  // namespace ricochet
