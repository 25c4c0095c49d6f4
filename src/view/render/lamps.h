/// \file
/// Lamps that replace glowing particles when the light on their surroundings is computed.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/preview.h"
#include "view/render/sprites.h"

namespace ricochet {

/// Small light source with equal intensity in all directions.
struct Lamp {
    Vec3 position;  ///< m
    /// Intensity, in units of light times m^2; a surface that faces the lamp at a distance d receives intensity / d^2.
    Vec3 intensity;
    /// Radius of the objects that the lamp represents, in m; at smaller distances, the received light does not
    /// increase.
    double radius = 0.0;
};

/// Merges the light of glowing discs and lines into a few lamps, one for each occupied cell of a grid. The total
/// intensity of the lamps equals the total intensity of their sources. Each disc counts as a sphere with the disc's
/// radius and colour. Each line is split into pieces, and each piece contributes to the cell of its middle. The grid is
/// made coarser until at most `most` (> 0) lamps remain. The lamps do not depend on the number of threads.
[[nodiscard]] std::vector<Lamp> lamps_of(const Sprites& sprites, std::span<const GlowingLine> lines, std::size_t most);
[[nodiscard]] inline std::vector<Lamp> lamps_of(const Sprites& sprites, std::size_t most) {
    return lamps_of(sprites, {}, most);
}

}  // namespace ricochet
