/// \file
/// From a wanted triangle count to the edge length that gives about as many.
#pragma once

#include <cstddef>
#include <functional>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Makes one shape with edges of about the given length in metres.
using ShapeBuilder = std::function<TriangleMesh(double edge_length)>;

/// The shape at the edge length whose triangle count is near the target: within about a tenth where the shape can be
/// refined that finely (cells come in whole numbers); its coarsest form where the target is below that.
/// \param target  triangles wanted, 2 to 100 million; InputError otherwise
/// \param coarse_edge  an edge length to start from, metres
[[nodiscard]] TriangleMesh build_near(std::size_t target, double coarse_edge, const ShapeBuilder& build);

}  // namespace ricochet::meshes
