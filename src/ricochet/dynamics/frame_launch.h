/// \file
/// Particles that are let go from a moving frame.
#pragma once

#include <cstddef>

#include "ricochet/dynamics/frame_tree.h"
#include "ricochet/dynamics/particles.h"

namespace ricochet {

/// The particle as it stands in the world when it is let go from a frame at its birth time: position, velocity and spin
/// are given in the frame's coordinates, relative to the frame. With the frame's rotation R, origin o and motion (v, w)
/// at that time: position o + R p, velocity R u + v + w x (R p); a sphere was carried round by the frame until then, so
/// its spin is R s + w; a point has none. All else stays. frame < frames.size().
[[nodiscard]] Particle launched_from(const FrameTree& frames, std::size_t frame, Particle particle);

}  // namespace ricochet
