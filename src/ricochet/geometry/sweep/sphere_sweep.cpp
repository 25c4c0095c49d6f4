#include "ricochet/geometry/sweep/sphere_sweep.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/sphere_triangle_sweep.h"

namespace ricochet {
namespace {

/// Returns a lower bound on the squared distance of a point from a triangle: its squared distance from the triangle's
/// box.
double squared_gap(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 lower = min(a, min(b, c));
    const Vec3 upper = max(a, max(b, c));
    return length_squared(max(Vec3{}, max(lower - p, p - upper)));
}

/// Ratio of the whole path's slack to the slack of the path until latest_, above which culling with the second slack
/// saves time. Local, because only the cost depends on it.
constexpr double kWideSlack = 0x1p10;

/// Returns the sign of a height just after the start, which is the sign of its first nonzero coefficient.
int side_ahead(const std::array<DoubleDouble, 4>& height) {
    for (const DoubleDouble& coefficient : height) {
        if (coefficient.hi != 0.0) return sign(coefficient);
    }
    return 0;
}

}  // namespace

SphereSweep::SphereSweep(const Path& path, double radius, double beside)
    : path_(path),
      radius_(radius),
      latest_(path.duration),
      squared_displacement_(ricochet::squared_displacement<double>(path)),
      precise_squared_displacement_(ricochet::squared_displacement<DoubleDouble>(path)) {
    const double h = path.duration;
    hull_count_ = path.degree + 1;
    update_bounds();
    scale_ = std::max(max_abs(lower_), max_abs(upper_)) + radius;
    slack_ = kCandidateSlack * scale_ + beside;
    max_distance_ = h * (length(path.c[1]) + h * (length(path.c[2]) + h * length(path.c[3])));
}

/// Computes the control points of the path until latest_, and their box.
void SphereSweep::update_bounds() {
    const Vec3& start = path_.c[0];
    const double h = latest_;
    hull_ = {start, path_.position(h), start + (h / path_.degree) * path_.c[1],
             start + (h / 3.0) * (2.0 * path_.c[1] + h * path_.c[2])};
    lower_ = upper_ = start;
    for (int i = 1; i < hull_count_; ++i) {
        lower_ = min(lower_, hull(i));
        upper_ = max(upper_, hull(i));
    }
}

// The limit gets a margin, because a contact with an edge can become one with the face at a time that differs by
// rounding.
void SphereSweep::shorten_to(double latest) {
    const double until = latest + 2.0 * kCandidateSlack * path_.duration;
    if (!(until < latest_)) return;
    latest_ = until;
    update_bounds();
}

bool SphereSweep::misses_box(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const double margin = radius_ + slack_;
    const auto is_apart = [margin](double x, double y, double z, double low, double high) {
        return std::min({x, y, z}) > high + margin || std::max({x, y, z}) < low - margin;
    };
    return is_apart(a.x, b.x, c.x, lower_.x, upper_.x) || is_apart(a.y, b.y, c.y, lower_.y, upper_.y) ||
           is_apart(a.z, b.z, c.z, lower_.z, upper_.z);
}

// The bound on the error of each height is that of detail::filtered_sign.
bool SphereSweep::misses_plane(const detail::FilteredCross& normal, const Vec3& a) const {
    const double longest = length(normal.value) + detail::kDeterminantFilter * length(normal.magnitude);
    const double margin = (1.0 + 0x1p-40) * (radius_ + slack_) * longest;
    bool above = true;
    bool below = true;
    for (int i = 0; i < hull_count_; ++i) {
        const Vec3 w = hull(i) - a;
        const double height = dot(normal.value, w);
        const double bound = margin + detail::kDeterminantFilter * dot(normal.magnitude, ricochet::abs(w));
        above = above && height > bound;
        below = below && height < -bound;
    }
    return above || below;
}

bool SphereSweep::can_cull(const Vec3& a, const Vec3& b, const Vec3& c) const {
    return misses_box(a, b, c) || misses_plane(detail::filtered_cross(b - a, c - a), a);
}

bool SphereSweep::can_cull_at_end(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const Vec3 away = separating_direction(hull(1), a, b, c);
    for (int i = 0; i < hull_count_; ++i) {
        if (!(distance_lower_bound(away, hull(i), a, b, c) > radius_ + slack_)) return false;
    }
    return true;
}

bool SphereSweep::starts_separated_from(const Vec3& a, const Vec3& b, const Vec3& c) const {
    return squared_gap(path_.c[0], a, b, c) > (radius_ + slack_) * (radius_ + slack_);
}

double SphereSweep::separating_speed(const Vec3& a, const Vec3& b, const Vec3& c) const {
    if (path_.degree > 1) return 0.0;
    const Vec3 away = separating_direction(path_.c[0], a, b, c);
    if (!(distance_lower_bound(away, path_.c[0], a, b, c) > radius_)) return 0.0;
    const double speed = dot(away, path_.c[1]) / length(away);
    return speed > kCandidateSlack * length(path_.c[1]) ? speed : 0.0;
}

// The offset has an error of several roundings of the largest coordinate.
bool SphereSweep::is_separating_from(const ClosestPointOnTriangle& closest_to_start, const Vec3& a, const Vec3& b,
                                     const Vec3& c) const {
    if (path_.degree > 1) return false;
    const double largest = std::max({scale_, max_abs(a), max_abs(b), max_abs(c)});
    return dot(closest_to_start.offset, path_.c[1]) > kCandidateSlack * largest * length(path_.c[1]);
}

std::optional<SphereContact> SphereSweep::first_contact(const Vec3& a, const Vec3& b, const Vec3& c) const {
    if (can_cull(a, b, c)) return std::nullopt;
    return narrow_phase_contact(TrianglePlane(a, b, c));
}

/// The chords of the path are not tested.
bool SphereSweep::stays_clear(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const double largest = std::max({max_abs(lower_), max_abs(upper_), max_abs(a), max_abs(b), max_abs(c)}) + radius_;
    const double margin = kCandidateSlack * largest;
    if (!(slack_ > kWideSlack * margin)) return false;
    const auto is_apart_along = [&](const Vec3& away) {
        for (int i = 0; i < hull_count_; ++i) {
            if (!(distance_lower_bound(away, hull(i), a, b, c) > radius_ + margin)) return false;
        }
        return true;
    };
    return is_apart_along(separating_direction(hull(0), a, b, c)) ||
           is_apart_along(separating_direction(hull(1), a, b, c));
}

std::optional<SphereContact> SphereSweep::narrow_phase_contact(const TrianglePlane& triangle) const {
    if (stays_clear(triangle.a(), triangle.b(), triangle.c())) return std::nullopt;
    return SphereTriangleSweep(*this, triangle).first();
}

std::optional<SphereContact> SphereSweep::first_contact(const Plane& plane) const {
    const Vec3& n = plane.normal;
    const auto height = component_along(path_, difference<DoubleDouble>(path_.c[0], plane.point), n);
    const int side = side_ahead(height);
    if (side == 0) return std::nullopt;
    const auto contact_at = [&](double time) {
        const Vec3 p = path_.position(time);
        return SphereContact{time, side > 0 ? n : -n, p - dot(n, p - plane.point) * n, TriangleFeature::kFace};
    };
    const Polynomial clearance = face_clearance(path_, height, radius_, side);
    double from = 0.0;
    if (clearance.coefficients[0].hi <= 0.0) {
        const auto offset_at = [&](const Vec3& p) { return dot(n, p - plane.point) * n; };
        Extrema extrema;
        extrema.add_of_height(face_clearance(path_, height, 0.0, side));
        const double overlap = radius_ + kSeamSlack * (scale_ + max_abs(plane.point));
        const OverlapEnd end = follow_overlap(path_, overlap, extrema.sorted(), offset_at);
        if (end.kind == OverlapEnd::kNever) return std::nullopt;
        if (end.kind == OverlapEnd::kStopped) return contact_at(end.time);
        from = end.time;
    }
    const Times crossings = down_crossings(clearance, from, path_.duration);
    if (crossings.count == 0) return std::nullopt;
    return contact_at(crossings[0]);
}

// The distance from a convex set is convex along a line. If the distance increases from one end of the segment on, this
// end is the nearest point and decides for the whole segment.
bool sphere_segment_is_clear(const Vec3& p, const Vec3& q, double radius, double tolerance, const Vec3& a,
                             const Vec3& b, const Vec3& c) {
    const double least = std::max(0.0, radius - tolerance);
    const Vec3 lower = min(p, q) - Vec3{radius, radius, radius};
    const Vec3 upper = max(p, q) + Vec3{radius, radius, radius};
    const Vec3 low = min(a, min(b, c));
    const Vec3 high = max(a, max(b, c));
    if (low.x > upper.x || high.x < lower.x || low.y > upper.y || high.y < lower.y || low.z > upper.z ||
        high.z < lower.z) {
        return true;
    }
    // The end with the smaller lower bound is tested first, because it probably decides.
    const bool from_q = squared_gap(q, a, b, c) <= squared_gap(p, a, b, c);
    const Vec3 away = separating_direction(from_q ? q : p, a, b, c);
    if (distance_lower_bound(away, p, a, b, c) > least && distance_lower_bound(away, q, a, b, c) > least) return true;
    for (const bool at_q : {from_q, !from_q}) {
        const ClosestPointOnTriangle nearest = closest_point_on_triangle(at_q ? q : p, a, b, c);
        if (nearest.distance_squared < least * least) return false;
        if (dot(nearest.offset, at_q ? p - q : q - p) >= 0.0) return true;
    }
    return squared_distance_of_segment_from_triangle(p, q, a, b, c) >= least * least;
}

}  // namespace ricochet
