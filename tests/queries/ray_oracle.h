/// \file
/// Exact hits of a ray in arbitrary-precision integers, and rays that are numerically hard. The oracle tests every
/// triangle. It clips the ray against the triangle's plane and the sides of a prism, and uses no orientation predicate
/// of the library. It is slow.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::testing {

/// The exact result for one ray.
struct TrueHits {
    std::vector<std::uint32_t> first;  ///< all triangles that contain the first common point, ascending
    std::size_t places = 0;            ///< number of distinct points in which the ray meets the surface
    bool runs_along = false;           ///< the ray meets a triangle in whose plane it lies; `places` is meaningless
    bool begins_on = false;            ///< the first common point is the ray's origin
};

class RayOracle {
public:
    explicit RayOracle(const TriangleMesh& mesh);
    [[nodiscard]] TrueHits ask(const Vec3& origin, const Vec3& direction) const;

private:
    using Integer = boost::multiprecision::cpp_int;
    using Point = std::array<Integer, 3>;
    /// The number numerator / denominator, with a positive denominator.
    struct Fraction {
        Integer numerator;
        Integer denominator;
    };
    struct Meeting {
        Fraction t;
        bool in_plane = false;
    };

    [[nodiscard]] Point whole(const Vec3& p, int exponent) const;
    [[nodiscard]] bool certainly_misses(const Vec3& origin, const Vec3& direction, std::uint32_t triangle) const;
    [[nodiscard]] bool meets(const Point& origin, const Point& direction, const std::array<Point, 3>& corners,
                             Meeting& meeting) const;

    const TriangleMesh& mesh_;
};

/// A numerically hard ray: through a corner, along an edge or a face, from the surface, or one ulp beside. All
/// coordinates of the mesh are multiples of `unit`, so that many rays hit their target exactly.
struct HardRay {
    Vec3 origin;
    Vec3 direction;
};
[[nodiscard]] HardRay hard_ray(const TriangleMesh& mesh, double unit, RandomSequence& random);

/// Returns a ball of triangles around a centre. All its coordinates are multiples of 2^-10 times `scale`.
[[nodiscard]] TriangleMesh lattice_ball(const Vec3& center, double scale, int levels);

}  // namespace ricochet::testing
