/// \file
/// Narrow phase of one moving sphere against the features of one triangle. Private to SphereSweep.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/predicates/triangle_plane.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/polynomial.h"
#include "ricochet/geometry/sweep/sphere_sweep.h"

namespace ricochet {

/// Returns side * height - radius as a polynomial. It is positive while the sphere is clear of the plane on that side.
[[nodiscard]] Polynomial face_clearance(const Path& path, const std::array<DoubleDouble, 4>& height,
                                        const DoubleDouble& radius, int side);
[[nodiscard]] inline Polynomial face_clearance(const Path& path, const std::array<DoubleDouble, 4>& height,
                                               double radius, int side) {
    return face_clearance(path, height, DoubleDouble(radius), side);
}

/// Result of following a sphere that starts in overlap.
struct OverlapEnd {
    enum Kind {
        kStopped,  ///< from `time` on the distance decreases, while it is at most the radius
        kFree,     ///< the distance does not decrease until it exceeds the radius at `time`
        kNever     ///< the distance grows, or stays constant, to the end of the path
    };
    Kind kind = kNever;
    double time = 0.0;
};

/// Times at which the distance from a surface may have an extremum.
class Extrema {
public:
    /// Adds the extrema of the distance from a point or a line, given its clearance.
    void add_of(const Polynomial& clearance) { add(sign_changes(clearance.derivative())); }
    /// Adds the extrema of the distance from a plane, given the height above it: the height's extrema and zeros.
    void add_of_height(const Polynomial& height) {
        add_of(height);
        add(sign_changes(height));
    }
    /// Returns the times in ascending order.
    [[nodiscard]] std::span<const double> sorted() {
        std::sort(times_.begin(), times_.begin() + count_);
        return {times_.data(), static_cast<std::size_t>(count_)};
    }

private:
    void add(const Times& times) {
        for (const double time : times) times_[static_cast<std::size_t>(count_++)] = time;
    }
    std::array<double, 40> times_{};  // 5 for each of three edges and three vertices, 2 + 3 for the face
    int count_ = 0;
};

/// Follows a path that starts in overlap, at a distance up to `radius` (including its rounding). `cuts` are the ordered
/// times at which the distance from the surface may have an extremum. Between two cuts the distance is monotone, so its
/// rate in the middle decides. offset_at(p) is the vector from the surface's closest point to p.
template <class OffsetAt>
[[nodiscard]] OverlapEnd follow_overlap(const Path& path, double radius, std::span<const double> cuts,
                                        const OffsetAt& offset_at) {
    double start = 0.0;
    for (std::size_t i = 0; i <= cuts.size(); ++i) {
        const double end = i < cuts.size() ? cuts[i] : path.duration;
        if (!(end > start)) continue;
        if (start > 0.0 && length(offset_at(path.position(start))) > radius) return {OverlapEnd::kFree, start};
        const double middle = start + 0.5 * (end - start);
        const Vec3 offset = offset_at(path.position(middle));
        const Vec3 velocity = path.velocity(middle);
        if (dot(offset, velocity) < -kMinApproach * length(offset) * length(velocity)) {
            return {OverlapEnd::kStopped, start};
        }
        start = end;
    }
    return {};
}

/// One narrow-phase test; see SphereSweep::narrow_phase_contact.
class SphereTriangleSweep {
public:
    SphereTriangleSweep(const SphereSweep& sphere, const TrianglePlane& plane);

    [[nodiscard]] std::optional<SphereContact> first();

private:
    struct Candidate {
        double time;
        TriangleFeature feature;
    };
    /// The line through an edge. The line starts at the lexicographically first end, so that triangles that share the
    /// edge give the same bits.
    struct EdgeLine {
        int first;  ///< corner at which it starts
        PreciseVec3 direction;
        double length;
    };
    struct EdgeClearance {
        Polynomial polynomial;              ///< squared distance from the line minus squared radius
        std::array<DoubleDouble, 4> along;  ///< position along the line, in m from its start
    };

    void search(double from);
    void search_face(double from);
    void search_edge(int i, double from);
    void search_vertex(int i, double from);
    void add_contact(double time, TriangleFeature feature);
    [[nodiscard]] std::optional<SphereContact> search_from_overlap();

    [[nodiscard]] const Vec3& corner(int i) const { return corners_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const std::optional<Vec3>& normal();
    [[nodiscard]] std::array<DoubleDouble, 4> height_over_face(DoubleDouble& scaled_radius);
    [[nodiscard]] Times face_crossings(const std::array<DoubleDouble, 4>& height, const DoubleDouble& scaled_radius,
                                       double from) const;
    [[nodiscard]] bool certainly_passes_beside_face() const;
    [[nodiscard]] bool projects_onto_face(const Vec3& p);
    [[nodiscard]] bool is_along_normal(const Vec3& offset, double slack) const;
    [[nodiscard]] bool certainly_misses_edge(int i) const;
    [[nodiscard]] bool certainly_clears(const Coefficients<double>& clearance, double start_distance) const;
    [[nodiscard]] Polynomial polynomial(const Coefficients<DoubleDouble>& coefficients) const;
    [[nodiscard]] std::optional<EdgeLine> edge_line(int i) const;
    [[nodiscard]] EdgeClearance edge_clearance(const EdgeLine& line) const;
    [[nodiscard]] std::span<const double> distance_extrema(Extrema& extrema);
    [[nodiscard]] PreciseVec3 position_from(const Vec3& origin, double time) const;

    [[nodiscard]] SphereContact contact_at(const Candidate& candidate);
    [[nodiscard]] Vec3 offset_at(const Candidate& candidate) const;
    [[nodiscard]] double seam_slack(const Vec3& p) const;

    const SphereSweep& sphere_;
    const Path& path_;
    double radius_;
    const TrianglePlane& plane_;
    std::array<Vec3, 3> corners_;
    double largest_coordinate_;  ///< of the corners
    std::optional<Vec3> normal_;
    bool normal_is_known_ = false;
    std::optional<Candidate> best_;
    double limit_;  ///< in s; later contacts do not matter
    bool starts_in_overlap_ = false;
};

}  // namespace ricochet
