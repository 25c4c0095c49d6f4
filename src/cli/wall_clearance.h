// Keeps balls that are larger than their particles off the walls of a picture.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/queries/mesh_queries.h"
#include "view/render/preview.h"

namespace ricochet::cli {

/// Drawn balls of one kind. The lists are equally long.
struct DrawnBalls {
    std::span<Vec3> centers;           ///< m
    std::span<double> radii;           ///< m, to be drawn
    std::span<const double> own = {};  ///< m, of the particles
};

/// The walls of a picture.
class WallClearance {
public:
    /// planes: infinite ones. Meshes without triangles are left out.
    explicit WallClearance(std::vector<PreviewPlane> planes) : planes_(std::move(planes)) {}
    void add(TriangleMesh mesh);

    /// Moves balls that are larger than their particles off the walls, straight away from these. Each stays on its
    /// particle's side. A ball that fits nowhere near gets the place with the most room that was found, and becomes
    /// smaller, but not smaller than its particle.
    void clear(const DrawnBalls& balls) const;

private:
    struct Search;

    void find_nearest(Search& search) const;
    void find_blocked(Search& search) const;

    std::vector<PreviewPlane> planes_;
    std::vector<MeshQueries> meshes_;
};

}  // namespace ricochet::cli
