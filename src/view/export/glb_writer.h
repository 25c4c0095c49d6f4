/// \file
/// Private to the library: one moment of a run as a glTF 2.0 file (.glb), for other programs.
/// Source of the format: glTF 2.0 Specification, Khronos.
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

/// Largest number of spheres that are written as separate nodes; more become points.
/// Reason: each node is an object in the program that opens the file, and few programs open hundreds of thousands. A
/// larger limit gives files that few programs open; a smaller limit shows points although spheres were possible.
inline constexpr std::size_t kMostSphereNodes = 20'000;

struct GlbMesh {
    std::string name;
    TriangleMesh mesh;          ///< m, z up
    std::optional<Vec3> color;  ///< linear light; nothing: white
    double roughness = 1.0;
    bool glass = false;
};

struct GlbSphere {
    Vec3 center;          ///< m, z up
    double radius = 0.0;  ///< m, > 0
};

struct GlbScene {
    std::vector<GlbMesh> meshes;
    std::vector<Vec3> points;        ///< one primitive of points, named "particles"
    std::vector<GlbSphere> spheres;  ///< one node each, all with the same mesh
};

/// Writes the file with y up, as the format requires: (x, y, z) becomes (x, z, -y). Returns its size in bytes.
/// Vertices are single precision relative to the centre of their mesh, and the node stores that centre in double
/// precision. Throws InputError if coordinates exceed single precision or the file exceeds 4 GB; RunError if writing
/// fails.
std::uint64_t write_glb(const std::filesystem::path& path, const GlbScene& scene);

}  // namespace ricochet
