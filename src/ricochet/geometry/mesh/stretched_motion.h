/// \file
/// Meshes whose scale changes in time, within a frame that moves: as meshes that deform.
#pragma once

#include <cstddef>
#include <span>

#include "ricochet/core/frame_tree.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/mesh_motion.h"

namespace ricochet {

/// Of the diagonal of a mesh: as far at most a vertex between two keys of stretched_motion() is from where scale and
/// frame have it. Smaller: more keys, which take memory and cut paths. Larger: surfaces that turn while they are scaled
/// are further from their true place. Nothing leaks for it.
inline constexpr double kStretchDeviation = 1e-4;

/// The motion of a mesh, the vertices of which (m) stand in a frame that may be scaled, as may those that it stands on
/// (KeyedScale): x(t) = FrameTree::map(frame, t).point(v). Keys are at `begin` and `end`, s, at those of the frames in
/// between, and as many more, evenly between two of these, as keep every vertex within kStretchDeviation of the mesh's
/// diagonal: h^2 / 8 times a bound of the second derivative. Where no frame turns, and at most one is scaled, by linear
/// factors, none are added, and the motion is exact to rounding. Before and after it the mesh stands still. Throws
/// InputError unless begin < end, all factors are above 0 at the keys of the motion too, and the frame and those that
/// it stands on are not driven; and where memory does not suffice.
[[nodiscard]] MeshMotion stretched_motion(std::span<const Vec3> vertices, const FrameTree& frames, std::size_t frame,
                                          double begin, double end);

}  // namespace ricochet
