#include "ricochet/geometry/sweep/moving_triangle.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/exact_arithmetic.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {
namespace {

/// Number of halvings of the time, down to the last bit of numbers near 1.
constexpr int kDeepest = 52;

/// Number of intervals after which the search ends without a result. A search near a rotating triangle needs many
/// intervals. The smaller the distance, the shorter are the intervals in which a single direction separates the bodies.
/// Local, because only the cost depends on it.
constexpr int kMostPieces = 1 << 15;

/// Relative error of a length and of the sum of three products of rounded factors, with a safety factor. Local: an
/// error bound of this arithmetic.
constexpr double kLengthError = 0x1p-49;
constexpr double kDotError = 0x1p-48;

/// The exact difference between a point and a corner at time 0 and at time 1.
struct Arm {
    ExactDifference begin;
    ExactDifference end;

    Arm(const MovingPoint& point, const MovingPoint& corner)
        : begin(point.from, corner.from), end(point.to, corner.to) {}
};

/// Returns the exact sign of n . ((1 - s) begin + s end) - least.
int exact_sign(const Vec3& n, const Arm& arm, double s, double least) {
    const double r = 1.0 - s;  // exact: s is a multiple of 2^-52
    const auto term = [&](double factor, const DoubleDouble& begin, const DoubleDouble& end) {
        return (Expansion<2>(begin) * r + Expansion<2>(end) * s) * factor;
    };
    const auto sum =
        term(n.x, arm.begin.x, arm.end.x) + term(n.y, arm.begin.y, arm.end.y) + term(n.z, arm.begin.z, arm.end.z);
    return (sum - Expansion<2>(DoubleDouble{least, 0.0})).sign();
}

/// Returns true if n . arm > least at s.
bool is_beyond(const Vec3& n, const Arm& arm, double s, double least) {
    const double r = 1.0 - s;
    const Vec3 begin = arm.begin.rounded();
    const Vec3 end = arm.end.rounded();
    const double value = dot(n, r * begin + s * end) - least;
    const double error = kDotError * (dot(abs(n), r * abs(begin) + s * abs(end)) + least);
    if (std::fabs(value) > error) return value > 0.0;
    return exact_sign(n, arm, s, least) > 0;
}

/// A pair of a point or sphere and a triangle.
class Pair {
public:
    Pair(const MovingPoint& point, double radius, const MovingTriangle& triangle)
        : point_(point),
          radius_(radius),
          triangle_(triangle),
          arms_{Arm(point, triangle.corners[0]), Arm(point, triangle.corners[1]), Arm(point, triangle.corners[2])} {}

    /// Returns true if one of the tried directions proves that the interval is free.
    [[nodiscard]] bool is_apart(double s, double t) const {
        const double middle = s + 0.5 * (t - s);
        const ClosestPointOnTriangle nearest = nearest_at(middle);
        if (separates(nearest.offset, s, t)) return true;
        // Beside an edge, the direction is made perpendicular to the edge, because the rounding of a small offset could
        // tilt it towards the edge's ends.
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = triangle_.corners[k].at(middle);
            const Vec3 edge = triangle_.corners[(k + 1) % 3].at(middle) - a;
            const Vec3 across = cross(edge, cross(nearest.offset, edge));
            if (separates(across, s, t)) return true;
        }
        for (const double time : {middle, s, t}) {
            const Vec3 normal = normal_at(time);
            if (separates(normal, s, t) || separates(-normal, s, t)) return true;
        }
        return false;
    }

    /// Returns the start of the first interval that is not proved to be free.
    [[nodiscard]] std::optional<double> first_doubt(double s, double t, int depth) {
        if (is_apart(s, t)) return std::nullopt;
        if (depth == kDeepest || ++pieces_ > kMostPieces) return s;
        const double middle = s + 0.5 * (t - s);
        const auto early = first_doubt(s, middle, depth + 1);
        return early ? early : first_doubt(middle, t, depth + 1);
    }

    [[nodiscard]] MovingContact contact_at(double time) const {
        const ClosestPointOnTriangle nearest = nearest_at(time);
        const auto& [a, b, c] = triangle_.corners;
        MovingContact contact{time,
                              std::max(0.0, std::sqrt(nearest.distance_squared) - radius_),
                              barycentric_coordinates(nearest, a.at(time), b.at(time), c.at(time)),
                              {}};
        contact.normal = contact_normal(contact, nearest.offset);
        return contact;
    }

private:
    /// Returns true if the direction, of any length, separates the pair on [s, t]. The direction is scaled so that its
    /// largest component is 1.
    [[nodiscard]] bool separates(const Vec3& direction, double s, double t) const {
        const double size = max_abs(direction);
        if (!(size > 0.0) || !std::isfinite(size)) return false;
        const Vec3 n = direction / size;
        const double least = radius_ == 0.0 ? 0.0 : radius_ * length(n) * (1.0 + kLengthError);
        return std::all_of(arms_.begin(), arms_.end(),
                           [&](const Arm& arm) { return is_beyond(n, arm, s, least) && is_beyond(n, arm, t, least); });
    }

    [[nodiscard]] ClosestPointOnTriangle nearest_at(double s) const {
        const auto& [a, b, c] = triangle_.corners;
        return closest_point_on_triangle(point_.at(s), a.at(s), b.at(s), c.at(s));
    }
    [[nodiscard]] Vec3 normal_at(double s) const {
        const auto& [a, b, c] = triangle_.corners;
        return cross(b.at(s) - a.at(s), c.at(s) - a.at(s));
    }

    /// Returns the direction from the nearest point to a sphere's centre. A point in contact is on the triangle, so the
    /// triangle's normal is used, oriented against the point's relative motion.
    [[nodiscard]] Vec3 contact_normal(const MovingContact& contact, const Vec3& offset) const {
        if (radius_ > 0.0 && offset != Vec3{}) return normalized(offset);
        Vec3 motion = point_.to - point_.from;
        for (int k = 0; k < 3; ++k) {
            const MovingPoint& corner = triangle_.corners[static_cast<std::size_t>(k)];
            motion -= contact.barycentric[k] * (corner.to - corner.from);
        }
        Vec3 normal = normal_at(contact.time);
        if (normal == Vec3{}) normal = motion;  // a degenerate triangle has no normal
        if (normal == Vec3{}) return {0, 0, 1};
        return normalized(dot(normal, motion) > 0.0 ? -normal : normal);
    }

    MovingPoint point_;
    double radius_;
    MovingTriangle triangle_;
    std::array<Arm, 3> arms_;
    int pieces_ = 0;
};

void require_sound(const MovingPoint& point, double radius, const MovingTriangle& triangle) {
    const auto is_sound = [](const MovingPoint& p) {
        return std::max(max_abs(p.from), max_abs(p.to)) <= kLargestCoordinate && is_finite(p.from) && is_finite(p.to);
    };
    if (!is_sound(point) || !std::all_of(triangle.corners.begin(), triangle.corners.end(), is_sound)) {
        throw InputError("moving triangle: a coordinate is not finite or beyond 1e75 m");
    }
    if (!(radius >= 0.0 && radius <= kLargestCoordinate)) {
        throw InputError("moving triangle: the radius is negative, not finite or beyond 1e75 m");
    }
}

}  // namespace

bool is_apart(const MovingPoint& point, double radius, const MovingTriangle& triangle, double s, double t) {
    require_sound(point, radius, triangle);
    if (!(0.0 <= s && s <= t && t <= 1.0)) throw InputError("moving triangle: expected times 0 <= s <= t <= 1");
    return Pair(point, radius, triangle).is_apart(s, t);
}

std::optional<MovingContact> first_contact(const MovingPoint& point, double radius, const MovingTriangle& triangle) {
    require_sound(point, radius, triangle);
    Pair pair(point, radius, triangle);
    const std::optional<double> time = pair.first_doubt(0.0, 1.0, 0);
    if (!time) return std::nullopt;
    return pair.contact_at(*time);
}

}  // namespace ricochet
