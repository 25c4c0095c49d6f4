/// \file
/// Which points are inside a closed mesh that has a heart: a place that sees its whole inside in straight lines.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::bench {

/// The inside of one mesh. Safe from any number of threads.
class Insides {
public:
    /// The mesh must be closed, star-shaped about the heart, and outlive this.
    Insides(const TriangleMesh& mesh, const Vec3& heart);

    /// Exact: true when the straight line from the heart to p meets no triangle.
    [[nodiscard]] bool contains(const Vec3& p) const;
    /// The same for a ball's middle, which must be at least the radius (m, >= 0) away from every triangle, to rounding.
    [[nodiscard]] bool contains_ball(const Vec3& middle, double radius) const;

private:
    const TriangleMesh& mesh_;
    Vec3 heart_;
    TriangleBvh bvh_;
};

}  // namespace ricochet::bench
