#include "ricochet/geometry/sweep/pair_sweep.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/box_tools.h"
#include "ricochet/geometry/sweep/polynomial.h"

namespace ricochet {
namespace {

/// Returns the coefficients of a path with its time origin moved to s. The degree is unchanged.
std::array<Vec3, 4> shifted(const Path& path, double s) {
    if (s <= 0.0) return path.c;
    return {path.position(s), path.velocity(s), path.c[2] + (3.0 * s) * path.c[3], path.c[3]};
}

/// Returns |d|^2 - distance^2 to about 100 bits.
DoubleDouble clearance(const Vec3& d, double distance) {
    return dot_of<DoubleDouble>(d, d) - two_product(distance, distance);
}

/// Relative size of the discriminant below which a contact counts as grazing. The discriminant is a difference, which
/// has an error of about 2^-48 of its terms in doubles. With a smaller value, rounding would decide whether separating
/// spheres touch again. With a larger value, double-doubles would be used although doubles suffice. Local: it selects
/// the precision.
constexpr double kGraze = 0x1p-40;

/// Contact distance and smallest approach speed of two centres.
struct Approach {
    double distance;  ///< of the centres at contact, in m
    double slow;      ///< in m/s; slower approaches do not count

    /// Returns true if the spheres touch or overlap and approach each other.
    [[nodiscard]] bool is_at_once(const Vec3& d, const Vec3& u, double c) const {
        return c <= 0.0 && -dot(d, u) > slow * length(d);
    }
};

/// Returns the time, at most `duration`, at which |d + u t| decreases to the contact distance.
std::optional<double> meeting_on_line(const Vec3& d, const Vec3& u, const Approach& approach, double duration) {
    const double b = dot(d, u);
    if (!(b < 0.0)) return std::nullopt;
    const DoubleDouble clear = clearance(d, approach.distance);
    const double c = clear.hi;
    if (c <= 0.0) return approach.is_at_once(d, u, c) ? std::optional(0.0) : std::nullopt;
    // b^2 - a c loses digits at grazing contacts. The form with |d x u|^2 does not, because b^2 - a |d|^2 = -|d x u|^2.
    const double a = length_squared(u);
    double root = a * approach.distance * approach.distance - length_squared(cross(d, u));
    double speed = -b;
    if (root < kGraze * a * approach.distance * (approach.distance + length(d))) {
        const DoubleDouble exact_b = dot_of<DoubleDouble>(d, u);
        root = (exact_b * exact_b - dot_of<DoubleDouble>(u, u) * clear).hi;
        speed = -exact_b.hi;
    }
    if (!(root >= 0.0)) return std::nullopt;
    const double t = c / (speed + std::sqrt(root));
    return t >= 0.0 && t <= duration ? std::optional(t) : std::nullopt;
}

std::optional<double> meeting_on_curve(const Path& relative, const Approach& approach) {
    const PreciseVec3 start = difference<DoubleDouble>(relative.c[0], Vec3{});
    const Polynomial p{
        point_clearance<DoubleDouble>(relative, squared_displacement<DoubleDouble>(relative), start, approach.distance),
        2 * relative.degree, relative.duration};
    if (approach.is_at_once(relative.c[0], relative.c[1], static_cast<double>(p.coefficients[0]))) return 0.0;
    if (is_certainly_positive(p, relative.duration)) return std::nullopt;
    const Times falls = down_crossings(p, 0.0, relative.duration);
    return falls.count > 0 ? std::optional(falls[0]) : std::nullopt;
}

}  // namespace

std::optional<double> first_meeting(const TimedPath& a, const TimedPath& b, double distance, double slow) {
    const double from = std::max(a.begin, b.begin);
    const double duration = std::min(a.end, b.end) - from;
    if (!(duration >= 0.0)) return std::nullopt;
    const auto first = shifted(*a.path, from - a.begin);
    const auto second = shifted(*b.path, from - b.begin);
    Path relative;
    for (std::size_t k = 0; k < 4; ++k) relative.c[k] = second[k] - first[k];
    std::optional<double> meeting;
    if (relative.c[2] == Vec3{} && relative.c[3] == Vec3{}) {
        meeting = meeting_on_line(relative.c[0], relative.c[1], {distance, slow}, duration);
    } else {
        relative.degree = relative.c[3] == Vec3{} ? 2 : 3;
        relative.duration = duration;
        relative.end =
            relative.c[0] + duration * (relative.c[1] + duration * (relative.c[2] + duration * relative.c[3]));
        meeting = meeting_on_curve(relative, {distance, slow});
    }
    return meeting ? std::optional(from + *meeting) : std::nullopt;
}

Box3 box_of(const Path& path, double s) {
    if (path.degree == 1) return box_around(path.c[0], path.position(s));
    Path part = path;
    if (s < path.duration) {
        part.end = path.position(s);
        part.duration = s;
    }
    Box3 box;
    for (const Vec3& point : part.control_points()) box.include(point);
    return box;
}

}  // namespace ricochet
