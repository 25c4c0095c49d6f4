/// \file
/// Glowing particles as lights for their surroundings.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/preview.h"
#include "view/render/sprites.h"

namespace ricochet {

/// A small light that shines equally in all directions.
struct Lamp {
    Vec3 position;        ///< m
    Vec3 intensity;       ///< light times m^2: a surface that faces the lamp at a distance d receives intensity / d^2
    double radius = 0.0;  ///< radius of the objects that it represents, in m; it gets no brighter below this distance
};

/// Merges the light of glowing discs and lines into a few lamps, one for each occupied cell of a grid.
/// The lamps and their sources have the same total intensity. Each disc counts as a sphere of its radius that is as
/// bright as its colour. Each line contributes to a cell with the piece that lies in it. The grid is made coarser
/// until at most `most` (> 0) lamps remain. The lamps do not depend on the number of threads.
[[nodiscard]] std::vector<Lamp> lamps_of(const Sprites& sprites, std::span<const GlowingLine> lines, std::size_t most);
[[nodiscard]] inline std::vector<Lamp> lamps_of(const Sprites& sprites, std::size_t most) {
    return lamps_of(sprites, {}, most);
}

}  // namespace ricochet
