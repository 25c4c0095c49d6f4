/// \file
/// Clusters of four neighbouring triangles, stored so that four triangles are tested at once. The clusters are the
/// leaves of the broad phase.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "ricochet/core/box3.h"
#include "ricochet/core/page_vector.h"
#include "ricochet/core/vector_unit.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Index that marks an empty lane of a cluster.
inline constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFU;

/// All points within a margin of a line or parabola from `start` to `end`. The path is start + f (end - start)
/// - f (1 - f) curve for f in [0, 1].
class Tube {
public:
    Tube() = default;
    /// Makes a tube of the given radius `distance` (m, >= 0).
    Tube(const Vec3& start, const Vec3& end, double distance, const Vec3& curvature = {});

    [[nodiscard]] Vec3 offset(double fraction) const {
        return fraction * along - (fraction * (1.0 - fraction)) * curve;
    }

    Vec3 from;
    Vec3 along;  ///< chord to the other end
    Vec3 curve;
    double margin = 0.0;    ///< in m, rounded up
    double size = 0.0;      ///< bound on the sum of the magnitudes of the components of chord and curve, in m
    double rounding = 0.0;  ///< of projections onto the chord, relative to the size of the projected vector, in m
    double beside = 0.0;    ///< margin times length of the chord, in m^2, rounded up
    double per_squared_length = 0.0;  ///< in 1/m^2; 0 for a chord so short that the number is beyond doubles
    // Least and largest difference between the projections of path and chord onto the chord, in m^2.
    double least_ahead = 0.0;
    double most_ahead = 0.0;
    bool is_straight = true;
};

/// Intervals of a tube's path for each lane, in fractions of the path.
struct TubeIntervals {
    std::array<double, 4> enter;
    std::array<double, 4> leave;
};

/// Up to four triangles as a structure of arrays.
struct alignas(64) TriangleCluster {
    using Lanes = std::array<double, 4>;

    std::array<std::array<Lanes, 3>, 3> corners;  ///< coordinates in m, by corner and axis
    std::array<std::uint32_t, 4> triangle;        ///< indices; unused lanes have kNoTriangle and the corners of lane 0
    std::array<float, 4> edge;                    ///< length of the longest edge, in m, rounded up

    /// Returns one bit for each lane whose triangle may intersect the tube. For these lanes it sets the interval of the
    /// path outside of which the tube certainly does not touch the triangle. Undecided triangles count as candidates.
    /// Triangles may be degenerate. The result does not depend on the vector unit.
    [[nodiscard]] unsigned overlaps(const Tube& tube, TubeIntervals& intervals) const;
    [[nodiscard]] unsigned overlaps(const Tube& tube, TubeIntervals& intervals, VectorUnit unit) const;
    /// Returns the box of the triangles, in m.
    [[nodiscard]] Box3 box() const;
};
static_assert(sizeof(TriangleCluster) == 320);

using TriangleClusters = PageVector<TriangleCluster>;

/// Returns all triangles of a mesh in clusters of neighbours.
[[nodiscard]] TriangleClusters make_clusters(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

/// Returns clusters of the same triangles after vertices have moved. Queries take more time if neighbours have moved
/// apart.
[[nodiscard]] TriangleClusters refitted(std::span<const TriangleCluster> clusters, std::span<const Vec3> vertices,
                                        std::span<const Triangle> triangles);

}  // namespace ricochet
