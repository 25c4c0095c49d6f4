/// \file
/// The colliders of a case and their motion.
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

/// Creates rocks on their lattice, about the origin, as one mesh of about the given number of triangles.
[[nodiscard]] TriangleMesh make_rocks(std::size_t triangles);

/// Returns the case's colliders. Moving ones belong to frames of frames_of().
[[nodiscard]] std::vector<ColliderDescription> colliders_of(const Case& c,
                                                            const std::shared_ptr<const TriangleMesh>& mesh);

/// Returns the frames of the moving colliders; null if nothing moves.
[[nodiscard]] std::shared_ptr<const FrameTree> frames_of(const Case& c);

/// Converts flights to the coordinates of the case's ground at a time, in s: to its frame, and divided by its size.
/// Returns them unchanged if the ground does not move or has several parts.
[[nodiscard]] std::vector<Flight> seen_from_ground(const Case& c, std::vector<Flight> flights, double time);

}  // namespace ricochet::bench
