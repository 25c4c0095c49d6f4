/// \file
/// Private to the library: writer of one frame of a run as a glTF 2.0 file (.glb), for other programs. The format is
/// defined in the glTF 2.0 Specification, Khronos.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Largest number of spheres that are written as separate nodes. If there are more, all particles are written as
/// points.
/// Reason: each node becomes an object in the program that opens the file, and few programs open files with hundreds of
/// thousands of objects. With a smaller limit, more scenes would show points although programs could show spheres.
inline constexpr std::size_t kMostSphereNodes = 20'000;

struct GlbMesh {
    std::string name;
    TriangleMesh mesh;          ///< in m, with z up
    std::optional<Vec3> color;  ///< in linear light; std::nullopt: white
    double roughness = 1.0;
    bool glass = false;
};

struct GlbSphere {
    Vec3 center;          ///< in m, with z up
    double radius = 0.0;  ///< m, > 0
};

struct GlbScene {
    std::vector<GlbMesh> meshes;
    std::vector<Vec3> points;        ///< written as one primitive of points, named "particles"
    std::vector<GlbSphere> spheres;  ///< written as one node per sphere; all nodes share a mesh
};

/// Writes a scene and returns the size of the file in bytes. The format requires y up, so (x, y, z) becomes (x, z, -y).
/// Vertices are stored in single precision relative to the centre of their mesh. The node stores the centre in double
/// precision. Throws InputError if coordinates exceed the range of single precision or the file exceeds 4 GB. Throws
/// RunError if writing fails.
std::uint64_t write_glb(const std::filesystem::path& path, const GlbScene& scene);

}  // namespace ricochet
