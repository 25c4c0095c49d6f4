/// \file
/// The benchmark's table of mesh files that are read and made ready to collide with.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

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

}  // namespace ricochet::bench
