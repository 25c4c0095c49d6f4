/// \file
/// What a ray hits, in whole numbers of any length: every triangle is asked, by clipping the ray against its plane and
/// the sides of a prism (no orientation of the library's is used). Slow. And rays that are hard to answer.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::testing {

/// The truth about one ray.
struct TrueHits {
    std::vector<std::uint32_t> first;  ///< all triangles that contain the first common point, ascending
    std::size_t places = 0;            ///< distinct points in which the ray meets the surface
    bool runs_along = false;           ///< the ray meets a triangle in whose plane it runs: places mean nothing
    bool begins_on = false;            ///< the first common point is the ray's origin
};

class RayOracle {
public:
    explicit RayOracle(const TriangleMesh& mesh);
    [[nodiscard]] TrueHits ask(const Vec3& origin, const Vec3& direction) const;

private:
    using Integer = boost::multiprecision::cpp_int;
    using Point = std::array<Integer, 3>;
    /// numerator / denominator, the denominator above 0.
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

/// A ray of a kind that is hard: at a corner, an edge, along a face, from the surface, and a last bit beside. All
/// coordinates of the mesh are multiples of `unit`, so that many rays hit exactly what they are aimed at.
struct HardRay {
    Vec3 origin;
    Vec3 direction;
};
[[nodiscard]] HardRay hard_ray(const TriangleMesh& mesh, double unit, RandomSequence& random);

/// A ball of triangles whose coordinates are multiples of 2^-10 times `scale`, about a centre that is too.
[[nodiscard]] TriangleMesh lattice_ball(const Vec3& center, double scale, int levels);

}  // namespace ricochet::testing
