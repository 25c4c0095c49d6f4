/// \file
/// Clusters of four neighbouring triangles, stored so that four triangles are tested at once. The clusters are the
/// leaves of the broad phase.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/page_vector.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Index that marks an empty lane of a cluster.
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;

/// A shear that projects along a direction onto the plane perpendicular to its dominant axis.
/// Method: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", Journal of Computer Graphics
/// Techniques 2, 2013.
struct Shear {
    Shear() = default;
    /// Makes the shear along a direction of any length. Its axis is the direction's largest component.
    explicit Shear(const Vec3& direction);

    int axis = 2;        ///< dominant; the next axis (cyclic) is "right" and the one after that is "up"
    double right = 0.0;  ///< shift per unit of length along the axis; at most 1 in magnitude, like `up`
    double up = 0.0;
    double norm = 1.0;  ///< largest factor by which projected distances grow
};

/// All points within a margin of a line or parabola from `start` to `end`. The path is start + f (end - start)
/// - f (1 - f) curve for f in [0, 1].
class Tube {
public:
    Tube() = default;
    /// Makes a tube of the given radius `distance` (m, >= 0).
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
    double sagitta = 0.0;     ///< largest distance of the path from its chord, in m
    double per_length = 0.0;  ///< 1 / length of the chord, in 1/m; infinite for a point
    Shear shear;              ///< along the chord
    bool is_straight = true;
};

/// Intervals of a tube's path for each lane, in fractions of the path.
struct TubeIntervals {
    std::array<double, 4> enter;
    std::array<double, 4> leave;
};

/// Up to four triangles as a structure of arrays, quantised to 16 bits relative to their common centre. Bounds cover
/// the rounding, because clusters only propose candidates. Occupies two cache lines.
struct alignas(64) TriangleCluster {
    using Lanes = std::array<std::int16_t, 4>;
    /// Upper bound on half the largest extent of a cluster, in its units. Local: a unit of this format.
    static constexpr float kExtent = 0x1p15F;

    std::array<Lanes, 3> x;  ///< of the corners, in units from the centre, rounded to the nearest
    std::array<Lanes, 3> y;
    std::array<Lanes, 3> z;
    std::array<std::uint32_t, 4> triangle;  ///< indices; unused lanes have kNoTriangle and the corners of lane 0
    Vec3 center;                            ///< in m
    double per_unit = 1.0;                  ///< in 1/m, a power of two

    /// Returns one bit for each lane whose triangle may intersect the tube. For these lanes it sets the interval of the
    /// path outside of which the tube certainly does not touch the triangle. Undecided triangles count as candidates.
    /// Triangles may be degenerate.
    [[nodiscard]] unsigned overlaps(const Tube& tube, TubeIntervals& intervals) const;
    /// Returns a box around the triangles, in m.
    [[nodiscard]] Box3 box() const;
};
static_assert(sizeof(TriangleCluster) == 128);

using TriangleClusters = PageVector<TriangleCluster>;

/// Returns all triangles of a mesh in clusters of neighbours.
[[nodiscard]] TriangleClusters make_clusters(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

/// Returns clusters of the same triangles after vertices have moved. Queries take more time if neighbours have moved
/// apart.
[[nodiscard]] TriangleClusters refitted(std::span<const TriangleCluster> clusters, std::span<const Vec3> vertices,
                                        std::span<const Triangle> triangles);

}  // namespace ricochet
