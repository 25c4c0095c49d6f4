/// \file
/// Private to the library: what stands somewhere at one time as a glTF 2.0 file (.glb), for other programs.
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

/// Most spheres that are nodes of their own. Reason: each is an object in the programs that open the file, which are
/// not made for hundreds of thousands of them. Larger: files that only few programs open. Smaller: points, where
/// spheres could be seen.
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
    std::vector<Vec3> points;        ///< one primitive of points, named particles
    std::vector<GlbSphere> spheres;  ///< a node each, all of them with one mesh
};

/// Writes the file with y up, as the format wants it: (x, y, z) becomes (x, z, -y). Coordinates are single precision
/// about the middle of each mesh, which stands in its node in double precision. Throws InputError for coordinates that
/// single precision cannot hold and for more than 4 GB, RunError when the disk does not take it. Returns the bytes.
std::uint64_t write_glb(const std::filesystem::path& path, const GlbScene& scene);

}  // namespace ricochet
