/// \file
/// Triangles in groups of four neighbours, laid out for looking at four at once: the leaves of the broad phase.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// In a place of a cluster: no triangle.
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;

/// How space looks along a direction: what lies `ahead`, one of the axes, is moved to where it began.
/// Method: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", Journal of Computer Graphics
/// Techniques 2, 2013 (the shear).
struct Shear {
    Shear() = default;
    /// Along the largest component of a direction, which need not be of unit length.
    explicit Shear(const Vec3& direction);

    int ahead = 2;       ///< axis; the next one (cyclic) is to the right and the one after that is up
    double right = 0.0;  ///< per length ahead; at most 1 in magnitude, as is up
    double up = 0.0;
    double stretch = 1.0;  ///< by which distances grow at most, as seen
};

/// A line or parabola from `start` to `end` and everything within a margin of it: at the fraction f of the way it is at
/// start + f (end - start) - f (1 - f) curve.
class Tube {
public:
    Tube() = default;
    /// distance >= 0, m.
    Tube(const Vec3& start, const Vec3& end, double distance, const Vec3& curvature = {})
        : from(start),
          along(end - start),
          curve(curvature),
          margin(distance),
          sagitta(0.25 * length(curve)),
          per_length(1.0 / length(along)),
          shear(along),
          is_straight(curve == Vec3{}) {}

    [[nodiscard]] Vec3 offset(double fraction) const {
        return fraction * along - (fraction * (1.0 - fraction)) * curve;
    }

    Vec3 from;
    Vec3 along;  ///< to the other end
    Vec3 curve;
    double margin = 0.0;
    double sagitta = 0.0;     ///< m, by which the way leaves its chord
    double per_length = 0.0;  ///< 1/m, of the chord; not finite for a point
    Shear shear;              ///< along the chord
    bool is_straight = true;
};

/// Stretches of a tube's way, in fractions of it, one a lane.
struct TubeIntervals {
    std::array<double, 4> enter;
    std::array<double, 4> leave;
};

/// Up to four triangles, coordinate by coordinate, as whole numbers about their own centre. What is lost by that is a
/// small part of a triangle, and is made up for: this only tells which triangles are worth a look. Two lines of a
/// processor's nearest memory.
struct alignas(64) TriangleCluster {
    using Lanes = std::array<std::int16_t, 4>;

    std::array<Lanes, 3> x;  ///< of the corners, in units from the centre, rounded to the nearest
    std::array<Lanes, 3> y;
    std::array<Lanes, 3> z;
    std::array<std::uint32_t, 4> triangle;  ///< numbers; kNoTriangle last, its corners those of the first
    Vec3 center;                            ///< m
    double per_unit = 1.0;                  ///< 1/m, a power of two

    /// Bits of the lanes whose triangle may come within the margin of the tube's way, and for these a stretch outside
    /// of which it certainly does not. Errs on the side of more. Triangles may be degenerate.
    [[nodiscard]] unsigned near(const Tube& tube, TubeIntervals& stretches) const;
    /// A box about the triangles, m.
    [[nodiscard]] Box3 box() const;
};
static_assert(sizeof(TriangleCluster) == 128);

/// All triangles of a mesh in clusters of neighbours.
[[nodiscard]] std::vector<TriangleCluster> make_clusters(std::span<const Vec3> vertices,
                                                         std::span<const Triangle> triangles);

}  // namespace ricochet
