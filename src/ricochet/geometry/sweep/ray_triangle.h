/// \file
/// A ray against a triangle, exactly: whether they meet, in which part of the triangle, and which of two triangles the
/// ray meets first. The ray is the one that its origin and direction say, all of origin + t direction for t >= 0; no
/// end point is rounded.
///
/// The line's side of each edge is the sign of a determinant, as in T. Moeller, B. Trumbore, "Fast, Minimum Storage
/// Ray/Triangle Intersection", Journal of Graphics Tools 2, 1997, decided as docs/exactness.md says.
#pragma once

#include <array>
#include <optional>

#include "ricochet/core/double_double.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/predicates/exact_ratio.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {

/// A ray within the predicates' range.
struct Ray {
    Vec3 origin;     ///< m
    Vec3 direction;  ///< the largest component at least 1 and below 2 in magnitude

    Ray() = default;
    /// Scales the direction, finite and not zero, by a power of two. Components below 2^-287 (of the direction: of its
    /// largest) become zero; everything else is kept to the bit.
    Ray(const Vec3& from, const Vec3& along);
    /// origin + t direction, rounded once from double-double.
    [[nodiscard]] Vec3 at(const DoubleDouble& t) const;
    /// Of that point from the origin, m, rounded alike.
    [[nodiscard]] double distance(const DoubleDouble& t) const;
};

/// The parts of a triangle that a ray's line passes through: edges without their ends, and corners.
class FeatureSet {
public:
    void add(TriangleFeature feature) { bits_ |= 1U << static_cast<unsigned>(feature); }
    [[nodiscard]] bool has(TriangleFeature feature) const {
        return (bits_ >> static_cast<unsigned>(feature) & 1U) != 0;
    }

private:
    unsigned bits_ = 0;
};

/// How a ray meets a closed triangle.
struct RayMeeting {
    DoubleDouble t;                                    ///< of the first common point, within 2^-58 of itself
    TriangleFeature feature = TriangleFeature::kFace;  ///< of the triangle, that the point lies on
    int speed = 0;             ///< +1 where the ray goes along the triangle's normal, -1 against it, 0 where in_plane
    bool in_plane = false;     ///< the ray runs in the triangle's plane, or the triangle has no area
    FeatureSet features;       ///< where in_plane: all that the ray passes through from there on
    int axis = 0;              ///< where in_plane: along which the plane is projected, without loss
    bool from_origin = false;  ///< where in_plane: the ray begins on the triangle, t is 0
};

/// Nothing when ray and triangle certainly have no point in common; exact. A triangle without area is the segment or
/// point that its corners span.
[[nodiscard]] std::optional<RayMeeting> meet(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c);

/// A triangle that a ray meets.
struct MetTriangle {
    std::array<Vec3, 3> corners;
    RayMeeting meeting;
};

/// A part of a triangle by what it is: its corners in order of coordinates, so that triangles agree on what they share.
struct FeatureKey {
    int count = 0;  ///< 1 vertex, 2 edge, 3 face
    std::array<Vec3, 3> corners;

    FeatureKey(const std::array<Vec3, 3>& triangle, TriangleFeature feature);
    [[nodiscard]] static int order(const FeatureKey& x, const FeatureKey& y);  ///< -1, 0 (the same), 1
};

/// Which first common point comes first along the ray: -1 that of x, 1 that of y, 0 neither. Exact.
[[nodiscard]] int compare_along(const Ray& ray, const MetTriangle& x, const MetTriangle& y);

}  // namespace ricochet
