/// \file
/// The colliders of a case and how they move.
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

/// Rocks on their lattice, about the origin, as one mesh of about so many triangles.
[[nodiscard]] TriangleMesh make_rocks(std::size_t triangles);

/// The case's colliders; what moves stands in a frame of frames_of().
[[nodiscard]] std::vector<ColliderDescription> colliders_of(const Case& c,
                                                            const std::shared_ptr<const TriangleMesh>& mesh);

/// How they move; null where nothing does.
[[nodiscard]] std::shared_ptr<const FrameTree> frames_of(const Case& c);

/// Flights at a time, s, as the case's ground sees them: in its frame, and over its size. The same where the ground
/// stands still or has several parts.
[[nodiscard]] std::vector<Flight> seen_from_ground(const Case& c, std::vector<Flight> flights, double time);

}  // namespace ricochet::bench
