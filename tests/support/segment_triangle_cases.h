/// \file
/// Random segments and triangles that are hard for predicates: rounded out of a plane, aimed at vertices and edges,
/// grazing, slender, degenerate, far from the origin, tiny and huge.
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

/// Case `index` of the family that `seed` stands for: every combination of a kind of triangle, a kind of segment and a
/// placement comes round in turn. Coordinates keep within what the predicates promise to be exact for.
[[nodiscard]] SegmentTriangle segment_triangle_case(std::uint64_t seed, std::uint64_t index);

/// The case in words and in hexadecimal digits, for a failing test's message.
[[nodiscard]] std::string description(const SegmentTriangle& s);

}  // namespace ricochet::testing
