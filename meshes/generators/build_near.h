/// \file
/// Search for the edge length that gives about a wanted number of triangles.
#pragma once

#include <cstddef>
#include <functional>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Function that makes one shape with edges of about the given length, in metres.
using ShapeBuilder = std::function<TriangleMesh(double edge_length)>;

/// Returns the shape at the edge length whose triangle count is near the target. The difference is at most about a
/// tenth if the shape can be refined that finely, since cells come in whole numbers. For smaller targets it is the
/// coarsest form.
/// \param target  wanted number of triangles, 2 to 100 million; InputError otherwise
/// \param coarse_edge  initial edge length, metres
[[nodiscard]] TriangleMesh build_near(std::size_t target, double coarse_edge, const ShapeBuilder& build);

}  // namespace ricochet::meshes
