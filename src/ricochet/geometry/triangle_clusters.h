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
    Vec3 from;                 ///< m
    Vec3 along;                ///< m, to the other end
    double margin = 0.0;       ///< m, >= 0
    double length = 0.0;       ///< of the segment, m
};

/// Stretches of a tube's segment, in fractions of it, one a lane.
struct TubeStretches {
    std::array<double, 4> enter;
    std::array<double, 4> leave;
};

/// Up to four triangles, coordinate by coordinate, in single precision about their own centre. What is lost by that is
/// a small part of a triangle, and is made up for where it matters: this only tells which triangles are worth a look.
struct alignas(64) TriangleCluster {
    using Lanes = std::array<float, 4>;

    std::array<Lanes, 3> x;  ///< of the corners, in units of `size` from the centre
    std::array<Lanes, 3> y;
    std::array<Lanes, 3> z;
    std::array<std::uint32_t, 4> triangle;  ///< numbers; kNoTriangle last, its corners those of the first
    Vec3 center;                            ///< m
    double size = 1.0;                      ///< m, a power of two: corners are within [-1, 1]

    /// Bits of the lanes whose triangle may come within the margin of the segment, and for these a stretch outside of
    /// which it certainly does not. Errs on the side of more. Triangles may be degenerate.
    [[nodiscard]] unsigned near(const SegmentTube& tube, TubeStretches& stretches) const;
    /// A box about the triangles, m.
    [[nodiscard]] Box3 box() const;
};
static_assert(sizeof(TriangleCluster) == 192);

/// All triangles of a mesh in clusters of neighbours.
[[nodiscard]] std::vector<TriangleCluster> make_clusters(std::span<const Vec3> vertices,
                                                         std::span<const Triangle> triangles);

}  // namespace ricochet
