/// \file
/// Meshes whose scale changes in time, within a moving frame, as deforming meshes.
#pragma once

#include <cstddef>
#include <span>

#include "ricochet/core/frame_tree.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/mesh_motion.h"

namespace ricochet {

/// Largest distance of a vertex from its exact position between two keys of stretched_motion(), as a fraction of the
/// mesh's diagonal. A smaller value needs more keys, which take memory and divide the paths of particles. With a larger
/// value, surfaces that rotate while they are scaled deviate further from their exact position. No value causes leaks.
/// Local, because public headers cannot include the tolerances.
inline constexpr double kStretchDeviation = 1e-4;

/// Returns the motion of a mesh whose vertices (m) are attached to a frame. The frame and its ancestors may be scaled
/// (KeyedScale): x(t) = FrameTree::map(frame, t).point(v). Keys are at `begin` and `end` (s) and at the keys of the
/// frames in between. Further keys divide these intervals evenly, so that the error of every vertex is at most
/// kStretchDeviation of the mesh's diagonal. The error in an interval of length h is at most h^2 / 8 times a bound on
/// the second derivative.
///
/// If no frame rotates and at most one is scaled, by linear factors, no keys are added and the motion is exact to
/// rounding. The mesh is at rest before and after the motion. Throws InputError unless begin < end, all factors are
/// above 0 (also at the keys of the motion), and neither the frame nor an ancestor is driven. It also throws if memory
/// does not suffice.
[[nodiscard]] MeshMotion stretched_motion(std::span<const Vec3> vertices, const FrameTree& frames, std::size_t frame,
                                          double begin, double end);

}  // namespace ricochet
