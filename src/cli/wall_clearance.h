// Displacement of drawn balls from the walls of a picture, if they are larger than their particles.
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

/// Drawn balls of one kind. The lists have equal lengths.
struct DrawnBalls {
    std::span<Vec3> centers;           ///< m
    std::span<double> radii;           ///< drawn radii, in m
    std::span<const double> own = {};  ///< radii of the particles, in m
};

/// The walls of a picture.
class WallClearance {
public:
    /// `planes` are infinite. Meshes without triangles are ignored.
    explicit WallClearance(std::vector<PreviewPlane> planes) : planes_(std::move(planes)) {}
    void add(TriangleMesh mesh);

    /// Moves balls that are larger than their particles perpendicularly away from the walls. Each ball stays on its
    /// particle's side. If a ball does not fit at any tested position, it gets the tested position with the largest
    /// clearance. The ball then shrinks to this clearance, but never below its particle's radius.
    void clear(const DrawnBalls& balls) const;

private:
    struct Search;

    void find_nearest(Search& search) const;
    void find_blocked(Search& search) const;

    std::vector<PreviewPlane> planes_;
    std::vector<MeshQueries> meshes_;
};

}  // namespace ricochet::cli
