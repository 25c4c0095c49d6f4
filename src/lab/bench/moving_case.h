/// \file
/// Colliders of a case, and their motion.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "lab/bench/cases.h"
#include "lab/bench/native_rays.h"
#include "ricochet/collision/collider.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::bench {

/// Creates rocks on a lattice around the origin, as one mesh with about the given number of triangles.
[[nodiscard]] TriangleMesh make_rocks(std::size_t triangles);

/// Returns the case's colliders. Moving colliders refer to the frames of frames_of() by name.
[[nodiscard]] std::vector<ColliderDescription> colliders_of(const Case& c,
                                                            const std::shared_ptr<const TriangleMesh>& mesh);

/// Returns the frames of the moving colliders, or null if no collider moves as a rigid body.
[[nodiscard]] std::shared_ptr<const FrameTree> frames_of(const Case& c);

/// Converts flights to the coordinates of the case's mesh at a time, in s. A moving ground has a frame, and a deforming
/// ground has a scale factor. Flights are returned unchanged if the ground does not move or consists of rocks.
[[nodiscard]] std::vector<Flight> seen_from_ground(const Case& c, std::vector<Flight> flights, double time);

}  // namespace ricochet::bench
