/// \file
/// What a verified run finds wrong.
#pragma once

#include <cstdint>
#include <optional>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Where a place is.
enum class Side : std::uint8_t { inside, outside, on_surface };

/// What is wrong.
enum class ViolationKind : std::uint8_t {
    crossing,    ///< a segment that was travelled meets a surface
    gap,         ///< the segments do not join the place where the particle was last seen to that where it is now
    wrong_side,  ///< the particle is on another side of a closed surface than at birth
    overlap,     ///< a sphere is nearer to a surface than its radius, by more than sphere_tolerance()
};

/// One violation. Each is reported once: what follows from it later is measured from the new state.
struct Violation {
    ViolationKind kind = ViolationKind::crossing;
    std::uint64_t particle = 0;             ///< id
    Vec3 place;                             ///< m: of the meeting (rounded), else of the particle's centre
    double time = 0.0;                      ///< s: a crossing's flight began then; for the others the step's end
    std::optional<std::uint32_t> collider;  ///< index; nothing for a gap
    std::optional<std::uint32_t> triangle;  ///< of the collider's mesh; nothing for planes, shapes and sides
};

}  // namespace ricochet
