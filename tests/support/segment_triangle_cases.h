/// \file
/// Random segments and triangles that are difficult for predicates. Segments are nearly coplanar with the triangle,
/// grazing, or aimed at vertices and edges. Triangles can be slender or degenerate. Cases are also far from the origin,
/// tiny or huge.
#pragma once

#include <cstdint>
#include <string>

#include "ricochet/core/vec3.h"

namespace ricochet::testing {

/// A segment [p, q] and a triangle (a, b, c).
struct SegmentTriangle {
    Vec3 p;
    Vec3 q;
    Vec3 a;
    Vec3 b;
    Vec3 c;
};

/// Returns case `index` of the random family that `seed` selects. Successive cases cycle through all combinations of
/// triangle kind, segment kind and placement. All coordinates are in the range for which the predicates are exact.
[[nodiscard]] SegmentTriangle segment_triangle_case(std::uint64_t seed, std::uint64_t index);

/// Returns a description of the case in words and hexadecimal digits, for the message of a failing test.
[[nodiscard]] std::string description(const SegmentTriangle& s);

}  // namespace ricochet::testing
