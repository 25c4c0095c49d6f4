/// \file
/// Balls drawn as threads along their path while the shutter is open.
#pragma once

#include <optional>
#include <span>

#include "ricochet/core/vec3.h"
#include "view/render/motion_path.h"
#include "view/render/preview.h"

namespace ricochet {

/// A ball and its path.
struct Streak {
    std::span<const PathNode> nodes;  ///< at least one, in the order of time
    double from = 0.0, to = 0.0;      ///< drawn interval of the path, in s
    double radius = 0.0;              ///< m, > 0
    Vec3 color;
    std::optional<Vec3> emission{};  ///< emitted light; either all streaks and other lines of a picture have it, or
                                     ///< none
};

/// Adds a streak to the drawn lines. It is as bright as the ball and gives the light of one ball in total. The light
/// is distributed over the path by the time that the ball spends there, whatever the total duration.
void add_streak(const Streak& streak, PreviewLines& lines);

}  // namespace ricochet
