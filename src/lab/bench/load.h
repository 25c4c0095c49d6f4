/// \file
/// The benchmark's table of mesh files that are read and made ready to collide with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/bench/measurement.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::bench {

/// How a mesh is written down.
enum class FileForm { obj, binary_ply, ascii_ply, binary_stl, off };

/// "OBJ", "PLY, binary" and so on.
[[nodiscard]] std::string_view name_of(FileForm form);
/// The ending of such files, with its dot.
[[nodiscard]] std::string_view ending_of(FileForm form);

/// One file.
struct LoadCase {
    std::string_view name;  ///< unique
    FileForm form = FileForm::obj;
    std::size_t triangles = 0;  ///< wanted; the mesh comes near it
};

/// All cases, from few triangles to many.
[[nodiscard]] const std::vector<LoadCase>& load_cases();

/// The mesh that the file of a case holds: a rocky cavity.
[[nodiscard]] TriangleMesh make_mesh(const LoadCase& c);

/// Writes the mesh; text with as many digits as bring back the same double. Throws RunError when the disk refuses.
void write_form(const TriangleMesh& mesh, const std::filesystem::path& path, FileForm form);

// Measures how long it takes from a mesh file to a world that particles can collide with.

/// A file with a number of threads, measured. Times are the median of the repeats.
struct LoadRow {
    std::string name;
    std::string format;
    std::size_t triangles = 0;
    int threads = 0;  ///< of the build; reading takes one
    std::uint64_t file_bytes = 0;
    double read_seconds = 0.0;   ///< from the file to the checked index list
    double build_seconds = 0.0;  ///< from there to the collision world as a simulation has it
};

/// Writes the case's file into a folder of its own that goes away again, and times reading and building, separately.
/// The file has just been written, so that the system has it in memory. Nothing when the hook has ended it. Throws
/// RunError when the file cannot be written or does not bring back as many triangles.
[[nodiscard]] std::optional<std::vector<LoadRow>> measure_load(const LoadCase& c, const MeasurementPlan& plan,
                                                               const Hook& hook = {});

}  // namespace ricochet::bench
