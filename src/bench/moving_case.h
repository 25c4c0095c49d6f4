/// \file
/// The colliders of a case and how they move.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "bench/cases.h"
#include "ricochet/collision/collider.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::bench {

/// Rocks on their lattice, about the origin, as one mesh of about so many triangles.
[[nodiscard]] TriangleMesh make_rocks(std::size_t triangles);

/// The case's colliders; what moves stands in a frame of frames_of().
[[nodiscard]] std::vector<ColliderDescription> colliders_of(const Case& c,
                                                            const std::shared_ptr<const TriangleMesh>& mesh);

/// How they move; null where nothing does.
[[nodiscard]] std::shared_ptr<const FrameTree> frames_of(const Case& c);

/// The pose of the case's ground at a time, s; that of the world where it stands still or has several parts.
[[nodiscard]] MovingPose ground_pose(const Case& c, double time);

}  // namespace ricochet::bench
