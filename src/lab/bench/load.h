/// \file
/// Benchmark of mesh files: reading the file, and building the collision structures of its mesh.
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

/// Benchmark case of one mesh file.
struct LoadCase {
    std::string_view name;  ///< unique
    FileForm form = FileForm::obj;
    std::size_t triangles = 0;  ///< requested number; the mesh has approximately this number
};

/// Returns all cases, in order of increasing numbers of triangles.
[[nodiscard]] const std::vector<LoadCase>& load_cases();

/// Creates the mesh of a case's file: a rocky cavity.
[[nodiscard]] TriangleMesh make_mesh(const LoadCase& c);

/// Writes the mesh in the given format. Numbers in text files have enough digits to read back the same doubles. Throws
/// RunError if the file cannot be written.
void write_form(const TriangleMesh& mesh, const std::filesystem::path& path, FileForm form);

// Measurement of the time from a mesh file to a CollisionWorld.

/// Result for one file and one number of threads. Times are medians over the repeats.
struct LoadRow {
    std::string name;
    std::string format;
    std::size_t triangles = 0;
    int threads = 0;  ///< threads of the build; reading uses one thread
    std::uint64_t file_bytes = 0;
    double read_seconds = 0.0;   ///< time from the file to the checked list of vertices and triangles
    double build_seconds = 0.0;  ///< time from this list to the CollisionWorld
};

/// Writes the case's file into a temporary folder, and times reading and building separately. The file is in the page
/// cache of the operating system, because it has just been written. Returns std::nullopt if the hook ends the
/// measurement. Throws RunError if the file cannot be written, or if the numbers of written and read triangles differ.
[[nodiscard]] std::optional<std::vector<LoadRow>> measure_load(const LoadCase& c, const MeasurementPlan& plan,
                                                               const Hook& hook = {});

}  // namespace ricochet::bench
