/// \file
/// Triangles in groups of four neighbours, laid out for looking at four at once: the leaves of the broad phase.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/triangle_mesh.h"

namespace ricochet {

/// In a place of a cluster: no triangle.
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;

/// A segment and everything within a margin of it.
struct SegmentTube {
    Vec3 from;               ///< m
    Vec3 along;              ///< m, to the other end
    double margin = 0.0;     ///< m, >= 0
    double largest = 0.0;    ///< m, bounds the coordinates of the segment and of all triangles: what rounding goes by
};

/// Stretches of a tube's segment, in fractions of it.
struct TubeStretches {
    alignas(32) std::array<double, 4> enter;
    alignas(32) std::array<double, 4> leave;
};

/// Up to four triangles, coordinate by coordinate.
struct alignas(32) TriangleCluster {
    using Lanes = std::array<double, 4>;

    std::array<Lanes, 3> x;  ///< of the corners, m
    std::array<Lanes, 3> y;
    std::array<Lanes, 3> z;
    std::array<std::uint32_t, 4> triangle;  ///< numbers; kNoTriangle last, its corners those of the first

    /// Bits of the lanes whose triangle may come within the margin of the segment, and for these a stretch outside of
    /// which it certainly does not. Errs on the side of more. Triangles may be degenerate.
    [[nodiscard]] unsigned near(const SegmentTube& tube, TubeStretches& stretches) const;
    [[nodiscard]] Box3 box() const;
};

/// All triangles of a mesh in clusters of neighbours.
[[nodiscard]] std::vector<TriangleCluster> make_clusters(std::span<const Vec3> vertices,
                                                         std::span<const Triangle> triangles);

}  // namespace ricochet
