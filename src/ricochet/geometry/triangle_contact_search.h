/// \file
/// The features of one triangle against one moving sphere: what SphereSweep does with a candidate that its cheap tests
/// have not discarded.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/closest_point.h"
#include "ricochet/geometry/distance_polynomials.h"
#include "ricochet/geometry/path.h"
#include "ricochet/geometry/polynomial.h"
#include "ricochet/geometry/predicates.h"
#include "ricochet/geometry/sphere_sweep.h"

namespace ricochet {

/// side * height - radius as a polynomial: positive while the sphere is clear of the plane on that side.
[[nodiscard]] Polynomial face_clearance(const Path& path, const std::array<DoubleDouble, 4>& height,
                                        const DoubleDouble& radius, int side);
[[nodiscard]] inline Polynomial face_clearance(const Path& path, const std::array<DoubleDouble, 4>& height,
                                               double radius, int side) {
    return face_clearance(path, height, DoubleDouble(radius), side);
}

/// How a start in overlap goes on.
struct OverlapEnd {
    enum Kind {
        kStopped,  ///< the distance shrinks from `time` on, while it is at most the radius
        kFree,     ///< it grows until at `time` it exceeds the radius
        kNever     ///< it grows, or stays, to the end of the path
    };
    Kind kind = kNever;
    double time = 0.0;
};

/// Follows a path that starts in overlap. `cuts` are the times, in order, at which the distance from the surface may
/// have an extremum; offset_at(p) is the vector from the surface's nearest point to p. The squared distance from a
/// convex set has a continuous derivative, so between two cuts it is monotone and its middle tells the direction.
/// Distances up to `reach`, the radius plus its rounding, count as overlap.
template <class Cuts, class OffsetAt>
[[nodiscard]] OverlapEnd follow_overlap(const Path& path, double reach, const Cuts& cuts, const OffsetAt& offset_at) {
    double start = 0.0;
    const auto step = [&](double end) -> std::optional<OverlapEnd> {
        if (start > 0.0 && length(offset_at(path.position(start))) > reach) {
            return OverlapEnd{OverlapEnd::kFree, start};
        }
        const double middle = start + 0.5 * (end - start);
        const Vec3 offset = offset_at(path.position(middle));
        const Vec3 velocity = path.velocity(middle);
        if (dot(offset, velocity) < -kSlowestApproach * length(offset) * length(velocity)) {
            return OverlapEnd{OverlapEnd::kStopped, start};
        }
        start = end;
        return std::nullopt;
    };
    for (const double cut : cuts) {
        if (!(cut > start && cut < path.duration)) continue;
        if (const auto end = step(cut)) return *end;
    }
    return step(path.duration).value_or(OverlapEnd{});
}

/// One search; see SphereSweep::first_contact.
class TriangleContactSearch {
public:
    TriangleContactSearch(const SphereSweep& sphere, const Vec3& a, const Vec3& b, const Vec3& c,
                          const detail::FilteredCross& rough_normal);

    [[nodiscard]] std::optional<SphereContact> first();

private:
    struct Candidate {
        double time;
        TriangleFeature feature;
    };
    /// The line through an edge, from its lexicographically first end, so that triangles that share it agree to the
    /// bit.
    struct EdgeLine {
        int first;  ///< corner it starts from
        PreciseVec3 direction;
        double length;
    };

    void search(double from);
    void search_face(double from);
    void search_edge(int i, double from);
    void search_vertex(int i, double from);
    void offer(double time, TriangleFeature feature);
    [[nodiscard]] std::optional<SphereContact> search_from_overlap();

    [[nodiscard]] const std::optional<Vec3>& normal();
    [[nodiscard]] std::array<DoubleDouble, 4> height_over_face(DoubleDouble& scaled_radius);
    [[nodiscard]] Times face_crossings(const std::array<DoubleDouble, 4>& height, const DoubleDouble& scaled_radius,
                                       double from) const;
    [[nodiscard]] bool certainly_passes_beside_face() const;
    [[nodiscard]] bool foot_is_on_face(const Vec3& p);
    [[nodiscard]] bool certainly_clears(const Coefficients<double>& clearance, double start_distance) const;
    [[nodiscard]] Polynomial polynomial(const Coefficients<DoubleDouble>& coefficients) const;
    [[nodiscard]] std::optional<EdgeLine> edge_line(int i) const;
    [[nodiscard]] PreciseVec3 position_from(const Vec3& origin, double time) const;

    [[nodiscard]] SphereContact contact_at(const Candidate& candidate);
    [[nodiscard]] Vec3 offset_at(const Candidate& candidate) const;
    [[nodiscard]] double seam_slack(const Vec3& p) const;

    const SphereSweep& sphere_;
    const Path& path_;
    double radius_;
    std::array<Vec3, 3> corners_;
    detail::FilteredCross rough_normal_;
    double largest_coordinate_;  ///< of the corners
    std::optional<Vec3> normal_;
    bool normal_is_known_ = false;
    std::optional<Candidate> best_;
    double limit_;  ///< times after this one do not matter any more
    bool starts_in_overlap_ = false;
};

}  // namespace ricochet
