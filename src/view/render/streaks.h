/// \file
/// Balls drawn as threads along the way that they went while the shutter was open.
#pragma once

#include <optional>
#include <span>

#include "ricochet/core/vec3.h"
#include "view/render/motion_path.h"
#include "view/render/preview.h"

namespace ricochet {

/// A ball and its way.
struct Streak {
    std::span<const PathNode> nodes;  ///< at least one, in the order of time
    double from = 0.0, to = 0.0;      ///< s, the part of the way that is drawn
    double radius = 0.0;              ///< m, > 0
    Vec3 color;
    std::optional<Vec3> emission{};  ///< light of its own; all streaks and other lines of a picture have it, or none
};

/// Adds a streak to what is drawn. It is as bright as the ball, and gives the light of one ball in all, spread over the
/// way by the time that the ball was there, however long that is.
void add_streak(const Streak& streak, PreviewLines& lines);

}  // namespace ricochet
