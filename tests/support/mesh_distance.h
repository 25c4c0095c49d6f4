/// \file
/// Distance from a mesh, computed by testing every triangle.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet::testing {

/// Returns the distance of a point from the mesh, in m.
inline double distance_from(const TriangleMesh& mesh, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b, c] : mesh.triangles) {
        least = std::min(
            least, closest_point_on_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]).distance_squared);
    }
    return std::sqrt(least);
}

}  // namespace ricochet::testing
