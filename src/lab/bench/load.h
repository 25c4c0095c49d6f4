/// \file
/// Benchmark of mesh files: reading them and preparing them for collisions.
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

/// Format of a mesh file.
enum class FileForm { obj, binary_ply, ascii_ply, binary_stl, off };

/// Returns a name such as "OBJ" or "PLY, binary".
[[nodiscard]] std::string_view name_of(FileForm form);
/// Returns the file name extension, with its dot.
[[nodiscard]] std::string_view ending_of(FileForm form);

/// One file.
struct LoadCase {
    std::string_view name;  ///< unique
    FileForm form = FileForm::obj;
    std::size_t triangles = 0;  ///< requested number; the mesh comes near it
};

/// Returns all cases, from few triangles to many.
[[nodiscard]] const std::vector<LoadCase>& load_cases();

/// Creates the mesh of a case's file: a rocky cavity.
[[nodiscard]] TriangleMesh make_mesh(const LoadCase& c);

/// Writes the mesh. Text files have enough digits to read back the same doubles. Throws RunError if the file cannot be
/// written.
void write_form(const TriangleMesh& mesh, const std::filesystem::path& path, FileForm form);

// Measures the time from a mesh file to a world that particles can collide with.

/// Result for one file and one number of threads. Times are the median of the repeats.
struct LoadRow {
    std::string name;
    std::string format;
    std::size_t triangles = 0;
    int threads = 0;  ///< of the build; reading uses one
    std::uint64_t file_bytes = 0;
    double read_seconds = 0.0;   ///< from the file to the checked index list
    double build_seconds = 0.0;  ///< from there to the collision world of a simulation
};

/// Writes the case's file into a temporary folder, and times reading and building separately. The system still has the
/// file in memory, because it has just been written. Returns nothing if the hook has ended it. Throws RunError if the
/// file cannot be written or does not read back as many triangles.
[[nodiscard]] std::optional<std::vector<LoadRow>> measure_load(const LoadCase& c, const MeasurementPlan& plan,
                                                               const Hook& hook = {});

}  // namespace ricochet::bench
