/// \file
/// Spheres drawn as lines along their path while the shutter is open.
#pragma once

#include <optional>
#include <span>

#include "ricochet/core/vec3.h"
#include "view/render/motion_path.h"
#include "view/render/preview.h"

namespace ricochet {

/// Sphere and its path.
struct Streak {
    std::span<const PathNode> nodes;  ///< at least one node, in order of time
    double from = 0.0, to = 0.0;      ///< start and end of the drawn interval of the path, in s
    double radius = 0.0;              ///< m, > 0
    Vec3 color;
    std::optional<Vec3> emission{};  ///< emitted light; either all lines of a picture have a value, or none
};

/// Adds the lines of a streak. The lines are as bright as the sphere, and together they give their surroundings the
/// light of one sphere. Each line's part of this light is the sphere's share of time on the line.
void add_streak(const Streak& streak, PreviewLines& lines);

}  // namespace ricochet
