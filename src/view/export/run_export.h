/// \file
/// Private to the library: exports of a finished run for other programs. docs/output-files.md lists the data that each
/// format lacks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "run/run_folder.h"

namespace ricochet {

/// Result of an export.
struct ExportReport {
    std::size_t files = 0;
    std::size_t frames = 0;
    std::vector<std::string> notes;  ///< differences from the run, and settings for playing the files
};

/// Receives the completed share of the work, from 0 to 1.
using ExportProgress = std::function<void(double)>;

// All functions below throw InputError if the folder is not a run or the target is unsuitable. They throw RunError if
// writing fails. Files appear under their names only when they are complete.

/// Numbering of files in a series: by the run's steps, or 0, 1, 2, ...
enum class ExportNumbers : std::uint8_t { steps, consecutive };

/// Writes a PLY file of the particles and of each moving collider for every frame, and a PLY file of each static
/// collider.
ExportReport export_ply(const RunFolder& folder, const std::filesystem::path& target, ExportNumbers numbers,
                        const ExportProgress& progress);

/// Writes a mesh (OBJ) for every collider, and a point cache (PC2) for each moving collider. Writes a point cache of
/// the particles if all frames contain the same particles.
ExportReport export_pc2(const RunFolder& folder, const std::filesystem::path& target, const ExportProgress& progress);

/// Writes a table (CSV) of the particles for every frame, and a table of all triangles of the colliders. Adds a table
/// of the contact log if the run has one.
ExportReport export_csv(const RunFolder& folder, const std::filesystem::path& target, const ExportProgress& progress);

/// Writes one frame of the folder as a glTF file.
ExportReport export_gltf(const RunFolder& folder, const FrameFile& frame, const std::filesystem::path& target);

}  // namespace ricochet
