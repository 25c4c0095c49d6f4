/// \file
/// Exact intersection of a ray and a triangle: whether they intersect, on which feature of the triangle, and which of
/// two triangles comes first. The ray is the set of all points origin + t direction with t >= 0. It has no end point
/// that would have to be rounded.
///
/// The side on which the line passes an edge is the sign of a determinant, as in T. Moeller, B. Trumbore, "Fast,
/// Minimum Storage Ray/Triangle Intersection", Journal of Graphics Tools 2, 1997. The signs are decided as in
/// docs/exactness.md.
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
    Vec3 origin;     ///< in m
    Vec3 direction;  ///< the largest component is at least 1 and below 2 in magnitude

    Ray() = default;
    /// Scales the direction, which must be finite and not zero, by a power of two. Components of the origin below
    /// 2^-287 become zero. Components of the direction below 2^-287 of the largest one become zero too. All other
    /// components keep their bits.
    Ray(const Vec3& from, const Vec3& along);
    /// Returns origin + t direction, rounded once from double-double.
    [[nodiscard]] Vec3 at(const DoubleDouble& t) const;
    /// Returns the distance of at(t) from the origin, in m, rounded once from double-double.
    [[nodiscard]] double distance(const DoubleDouble& t) const;
};

/// The features of a triangle through which a ray's line passes: edges without their ends, and corners.
class FeatureSet {
public:
    void add(TriangleFeature feature) { bits_ |= 1U << static_cast<unsigned>(feature); }
    [[nodiscard]] bool has(TriangleFeature feature) const {
        return (bits_ >> static_cast<unsigned>(feature) & 1U) != 0;
    }

private:
    unsigned bits_ = 0;
};

/// The intersection of a ray and a closed triangle.
struct RayIntersection {
    DoubleDouble t;                                    ///< of the first common point, with a relative error of 2^-58
    TriangleFeature feature = TriangleFeature::kFace;  ///< of the triangle, at the first common point
    int speed = 0;                                     ///< sign of direction . normal; 0 if in_plane
    bool in_plane = false;     ///< the ray runs in the triangle's plane, or the triangle has no area
    FeatureSet features;       ///< if in_plane: all features through which the ray passes from its origin on
    int axis = 0;              ///< if in_plane: axis of a one-to-one projection of the plane
    bool from_origin = false;  ///< if in_plane: the ray begins on the triangle, and t is 0
};

/// Returns the intersection, or nullopt if ray and triangle certainly have no common point. Exact. A triangle without
/// area counts as the segment or point that its corners span.
[[nodiscard]] std::optional<RayIntersection> meet(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c);

/// A triangle that a ray intersects.
struct MetTriangle {
    std::array<Vec3, 3> corners;
    RayIntersection intersection;
};

/// The identity of a triangle's feature. The corners are sorted by coordinates, so that the keys of a shared feature
/// are equal for all its triangles.
struct FeatureKey {
    int count = 0;  ///< 1 vertex, 2 edge, 3 face
    std::array<Vec3, 3> corners;

    FeatureKey(const std::array<Vec3, 3>& triangle, TriangleFeature feature);
    [[nodiscard]] static int order(const FeatureKey& x, const FeatureKey& y);  ///< -1, 0 (equal) or 1
};

/// Compares the first common points of the ray with x and with y, exactly. Returns -1 if the point of x comes first, 1
/// if the point of y comes first, and 0 if neither comes first.
[[nodiscard]] int compare_along(const Ray& ray, const MetTriangle& x, const MetTriangle& y);

}  // namespace ricochet
