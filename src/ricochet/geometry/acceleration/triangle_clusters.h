/// \file
/// Triangles in groups of four neighbours, laid out for testing four at once: the leaves of the broad phase.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/page_vector.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// An empty lane of a cluster.
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;

/// A shear that projects along a direction onto the plane across its dominant axis.
/// Method: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", Journal of Computer Graphics
/// Techniques 2, 2013.
struct Shear {
    Shear() = default;
    /// Along the largest component of a direction, which need not be of unit length.
    explicit Shear(const Vec3& direction);

    int axis = 2;        ///< dominant; the next one (cyclic) is to the right and the one after that is up
    double right = 0.0;  ///< per length along the axis; at most 1 in magnitude, as is up
    double up = 0.0;
    double norm = 1.0;  ///< by which projected distances grow at most
};

/// A line or parabola from `start` to `end`, start + f (end - start) - f (1 - f) curve for f in [0, 1], and everything
/// within a margin of it.
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
    double sagitta = 0.0;     ///< m, by which the path leaves its chord
    double per_length = 0.0;  ///< 1/m, of the chord; not finite for a point
    Shear shear;              ///< along the chord
    bool is_straight = true;
};

/// Intervals of a tube's path, in fractions of it, one a lane.
struct TubeIntervals {
    std::array<double, 4> enter;
    std::array<double, 4> leave;
};

/// Up to four triangles as structure of arrays, quantised to 16 bits about their own centre; bounds cover the rounding,
/// since clusters only propose candidates. Two cache lines.
struct alignas(64) TriangleCluster {
    using Lanes = std::array<std::int16_t, 4>;
    /// Half the largest extent of a cluster in its units, at most.
    static constexpr float kExtent = 0x1p15F;

    std::array<Lanes, 3> x;  ///< of the corners, in units from the centre, rounded to the nearest
    std::array<Lanes, 3> y;
    std::array<Lanes, 3> z;
    std::array<std::uint32_t, 4> triangle;  ///< indices; kNoTriangle last, with the corners of the first
    Vec3 center;                            ///< m
    double per_unit = 1.0;                  ///< 1/m, a power of two

    /// Bits of the lanes whose triangle may be inside the tube, and for these the interval outside of which it
    /// certainly is not. Errs on the side of more. Triangles may be degenerate.
    [[nodiscard]] unsigned overlaps(const Tube& tube, TubeIntervals& intervals) const;
    /// A box about the triangles, m.
    [[nodiscard]] Box3 box() const;
};
static_assert(sizeof(TriangleCluster) == 128);

using TriangleClusters = PageVector<TriangleCluster>;

/// All triangles of a mesh in clusters of neighbours.
[[nodiscard]] TriangleClusters make_clusters(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

/// Clusters of the same triangles after vertices have moved. Where neighbours do not stay neighbours queries cost more.
[[nodiscard]] TriangleClusters refitted(std::span<const TriangleCluster> clusters, std::span<const Vec3> vertices,
                                        std::span<const Triangle> triangles);

}  // namespace ricochet
