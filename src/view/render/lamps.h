/// \file
/// Glowing particles as lights on what is around them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/preview.h"
#include "view/render/sprites.h"

namespace ricochet {

/// A small light that shines the same in all directions.
struct Lamp {
    Vec3 position;        ///< m
    Vec3 intensity;       ///< light times m^2: on a surface that faces it at a distance d it is intensity / d^2
    double radius = 0.0;  ///< m, of what it stands for: nearer than this it gets no brighter
};

/// The light of glowing discs and lines, gathered into a few lamps: one for each cell of a grid about them that has
/// any. Their intensities add up to that of the discs, each a sphere of its radius that is as bright as its colour, and
/// of the lines, which are in each cell with what lies in it. most: the grid is made coarser until no more lamps are
/// left, > 0. The same lamps for any number of threads.
[[nodiscard]] std::vector<Lamp> lamps_of(const Sprites& sprites, std::span<const GlowingLine> lines, std::size_t most);
[[nodiscard]] inline std::vector<Lamp> lamps_of(const Sprites& sprites, std::size_t most) {
    return lamps_of(sprites, {}, most);
}

}  // namespace ricochet
