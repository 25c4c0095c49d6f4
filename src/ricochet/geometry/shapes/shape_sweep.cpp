#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/shapes/ellipsoid.h"
#include "ricochet/geometry/shapes/local_shape.h"

namespace ricochet {
namespace {

/// Number of samples of a path that starts in overlap. Local: a limit of this search, whose result is checked.
constexpr int kOverlapSamples = 32;

/// Number of Newton steps after which the interval is halved instead. At most seven were needed in tests.
constexpr int kMaxNewtonSteps = 16;

/// Number of halvings after which an interval of times is as short as the last place of a time.
constexpr int kMaxHalvings = 60;

/// Smallest fraction of the interval that counts as a long step. Local, because only the cost depends on it.
constexpr double kLongStep = 0.8;

double middle_of(double low, double high) { return low + 0.5 * (high - low); }

/// Maximum number of steps of one advancement.
constexpr int kMaxAdvancementSteps = 200;

/// Conservative advancement of a ball towards the surface of a convex body, from outside or from inside. Each step ends
/// before the contact, by a second-order bound that is valid for every convex body. The steps therefore converge
/// quadratically and skip no contact. The bounds are derived in docs/exactness.md.
///
/// The error of the time is the error of Ellipsoid::closest_point divided by the normal speed, plus an ulp. After
/// kMaxAdvancementSteps steps the last safe time is returned. Half a dozen steps are usual, and 30 for a grazing
/// contact.
class ConservativeAdvancement {
public:
    /// Prepares the advancement towards a body from outside, or towards one of its parts from inside. From inside, the
    /// part is extended beyond its rim.
    ConservativeAdvancement(const LocalShape& shape, const LocalPath& path, double radius,
                            std::optional<ShapePart> from_inside);

    /// Returns true if the ball touches or overlaps the surface at the path's start, to rounding.
    [[nodiscard]] bool starts_in_overlap() const { return is_touching(separation_at(0.0)); }

    /// Returns the first time of contact after `from`. At `from`, the ball must be separated from the surface.
    [[nodiscard]] std::optional<double> first_contact(double from) const {
        return side_ > 0 ? first_from_outside(from) : first_from_inside(from);
    }

    /// Result for a path that starts in overlap.
    struct Overlap {
        bool is_stopped = false;  ///< from `time` on the ball approaches while it touches
        double time = 0.0;        ///< otherwise: start of separation, or the duration if the ball never separates
    };
    /// Samples the path at kOverlapSamples equally spaced times and bisects between two of them.
    [[nodiscard]] Overlap follow_overlap() const;

private:
    /// The separation at one time and its rate of change.
    struct Separation {
        double time;
        double size;  ///< in m
        double rate;  ///< in m/s
        Vec3 normal;  ///< outward
    };

    [[nodiscard]] Separation separation_at(double s) const;
    [[nodiscard]] bool is_touching(const Separation& separation) const { return separation.size <= tolerance_; }
    [[nodiscard]] bool approaches(const Separation& separation) const;
    [[nodiscard]] std::optional<double> first_from_outside(double from) const;
    [[nodiscard]] std::optional<double> first_from_inside(double from) const;
    [[nodiscard]] std::optional<double> time_to_plane(const Separation& separation) const;
    [[nodiscard]] Separation contact_between(const Separation& low, Separation& overlapping) const;
    [[nodiscard]] std::optional<double> safe_fraction(const Separation& low, const Separation& high) const;

    const LocalShape& shape_;
    const LocalPath& path_;
    double radius_;
    std::optional<ShapePart> part_;  // if from inside
    int side_;                       // +1 outside, -1 inside
    double tolerance_;               // error of distances, in m
};

ConservativeAdvancement::ConservativeAdvancement(const LocalShape& shape, const LocalPath& path, double radius,
                                                 std::optional<ShapePart> from_inside)
    : shape_(shape),
      path_(path),
      radius_(radius),
      part_(from_inside),
      side_(from_inside ? -1 : 1),
      tolerance_(kShapeContact * shape.ellipsoid().distance_error(radius, Vec3{})) {}

ConservativeAdvancement::Separation ConservativeAdvancement::separation_at(double s) const {
    const PreciseVec3 position = path_.position(s);
    const ShapePoint near = part_ ? shape_.closest_point_beyond(*part_, position) : shape_.closest_point(position);
    return {s, side_ * near.distance - radius_, side_ * dot(near.normal, path_.velocity(s)), near.normal};
}

bool ConservativeAdvancement::approaches(const Separation& separation) const {
    return separation.rate < -kMinApproach * length(path_.velocity(separation.time));
}

/// Returns the duration from separation.time until the ball touches the tangent plane.
std::optional<double> ConservativeAdvancement::time_to_plane(const Separation& separation) const {
    const double left = path_.duration - separation.time;
    const double size = std::max(separation.size, 0.0);
    if (path_.degree < 2) {
        if (!(separation.rate < 0.0) || size > -separation.rate * left) return std::nullopt;
        return size / -separation.rate;
    }
    const double square = side_ * 0.5 * dot(separation.normal, path_.acceleration(separation.time));
    const double cube = side_ * dot(separation.normal, path_.jerk()) / 6.0;
    const Polynomial height{
        {DoubleDouble(size), DoubleDouble(separation.rate), DoubleDouble(square), DoubleDouble(cube)},
        path_.degree,
        left};
    const Times times = down_crossings(height, 0.0, left);
    return times.count > 0 ? std::optional(times[0]) : std::nullopt;
}

std::optional<double> ConservativeAdvancement::first_from_outside(double from) const {
    double s = from;
    for (int step = 0; step < kMaxAdvancementSteps; ++step) {
        const Separation separation = separation_at(s);
        if (is_touching(separation) && approaches(separation)) return s;
        const std::optional<double> advance = time_to_plane(separation);
        if (!advance) return std::nullopt;
        if (s + *advance <= s) return s;
        s = std::min(s + *advance, path_.duration);
    }
    return s;
}

/// Returns the fraction of the interval from `low` to `high` that is certainly free of contact. Returns nullopt if the
/// whole interval is free.
std::optional<double> ConservativeAdvancement::safe_fraction(const Separation& low, const Separation& high) const {
    const double span = high.time - low.time;
    const double acceleration = std::sqrt(
        std::max(length_squared(path_.acceleration(low.time)), length_squared(path_.acceleration(high.time))));
    const double curve = path_.degree < 2 ? 0.0 : 0.5 * acceleration * span * span;
    const double start = std::max(low.size, 0.0);
    // Roots of curve x^2 - fall x + start.
    const double fall = start - high.size + curve;
    const double discriminant = fall * fall - 4.0 * curve * start;
    if (fall <= 0.0 || discriminant < 0.0) return std::nullopt;
    const double x = 2.0 * start / (fall + std::sqrt(discriminant));
    return x < 1.0 ? std::optional(x) : std::nullopt;
}

/// Returns a time of contact, exact to rounding, between `low` and `overlapping`. At `low` the ball is separated, and
/// at `overlapping` it overlaps the surface. Uses Newton's method, or bisection if Newton's method leaves the bracket
/// or takes too many steps.
ConservativeAdvancement::Separation ConservativeAdvancement::contact_between(const Separation& low,
                                                                             Separation& overlapping) const {
    double separated = low.time;
    Separation latest = overlapping;
    for (int step = 0; step < kMaxNewtonSteps + kMaxHalvings && std::fabs(latest.size) > tolerance_; ++step) {
        const double newton = latest.rate < 0.0 ? latest.time - latest.size / latest.rate : separated;
        const bool is_usable = step < kMaxNewtonSteps && newton > separated && newton < overlapping.time;
        const double next = is_usable ? newton : middle_of(separated, overlapping.time);
        if (!(next > separated && next < overlapping.time)) break;
        latest = separation_at(next);
        if (latest.size < 0.0) {
            overlapping = latest;
        } else {
            separated = latest.time;
        }
    }
    return latest;
}

std::optional<double> ConservativeAdvancement::first_from_inside(double from) const {
    Separation low = separation_at(from);  // separated from `from` to here
    Separation high = separation_at(path_.duration);
    Separation last = high;  // the first known overlap, or the end
    for (int step = 0; step < kMaxAdvancementSteps; ++step) {
        if (is_touching(low) && approaches(low)) return low.time;
        if (high.size < -tolerance_) {
            last = high;
            high = contact_between(low, last);
        }
        const std::optional<double> part = safe_fraction(low, high);
        if (!part) {
            if (high.time >= path_.duration) return std::nullopt;
            low = high;
            high = last;
            continue;
        }
        const double safe = low.time + *part * (high.time - low.time);
        const bool advances = safe > low.time;
        if (!advances && low.rate < 0.0) return low.time;
        if (advances) low = separation_at(safe);
        // After a long step the interval keeps its end. After a short step the interval is halved, which reduces its
        // curvature term to a quarter.
        if (high.size <= 0.0 && *part >= kLongStep) continue;
        const double middle = middle_of(low.time, high.time);
        if (!(middle > low.time && middle < high.time)) return low.time;
        high = separation_at(middle);
    }
    return low.time;
}

ConservativeAdvancement::Overlap ConservativeAdvancement::follow_overlap() const {
    Separation low = separation_at(0.0);
    if (approaches(low)) return {true, 0.0};
    for (int sample = 1; sample <= kOverlapSamples; ++sample) {
        Separation high = separation_at(path_.duration * sample / kOverlapSamples);
        if (is_touching(high) && !approaches(high)) {
            low = high;
            continue;
        }
        // The ball has either separated or begun to approach. The bisection finds the first such time.
        for (int halving = 0; halving < kMaxHalvings; ++halving) {
            const double s = middle_of(low.time, high.time);
            if (!(s > low.time && s < high.time)) break;
            const Separation middle = separation_at(s);
            const bool is_past = !is_touching(middle) || approaches(middle);
            (is_past ? high : low) = middle;
        }
        const bool has_separated = !is_touching(high);
        return {!has_separated, has_separated ? high.time : low.time};
    }
    return {false, path_.duration};
}

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Tolerance for the position of a point beside a cap's plane or rim at the rounded time of a crossing: a few ulp. It
/// is a fraction of the distance travelled and of the shape's size. Local: an error bound of this arithmetic.
constexpr double kPositionError = 0x1p-50;

double first_time(const Times& times) { return times.count > 0 ? times[0] : kNever; }

/// Returns the height of the path above a cylinder's cap on the side `up` (+1 or -1), times `sign`. The cap is lowered
/// by `inset`.
Polynomial height_over_cap(const LocalShape& shape, const LocalPath& path, double up, const DoubleDouble& inset,
                           double sign) {
    Polynomial p;
    p.degree = path.degree;
    p.duration = path.duration;
    for (std::size_t k = 0; k < 4; ++k) p.coefficients[k] = sign * up * path.component[2][k];
    p.coefficients[0] = p.coefficients[0] - sign * (DoubleDouble(shape.half_height()) - inset);
    return p;
}

/// Returns the first time at which a path from inside comes within `inset` of a part. A nonzero inset requires a part
/// that is round or flat.
double first_exit(const LocalShape& shape, const LocalPath& path, ShapePart part, double inset, double from) {
    if (part != ShapePart::side) {
        const double up = part == ShapePart::top ? 1.0 : -1.0;
        const Polynomial below = height_over_cap(shape, path, up, DoubleDouble(inset), -1.0);
        return first_time(down_crossings(below, from, path.duration));
    }
    const Ellipsoid& ellipsoid = shape.ellipsoid();
    const Polynomial clearance = inset > 0.0 ? ellipsoid.value_along(path, -1, two_diff(ellipsoid.smallest(), inset))
                                             : ellipsoid.value_along(path, -1);
    return first_time(down_crossings(clearance, from, path.duration));
}

/// Returns the first time at which a point from outside enters a cylinder. The point enters through the side while it
/// is between the caps, or through a cap while it is inside the side. Both conditions allow for the rounding of the
/// time, so that no point at the edge fails both.
double first_entry_of_cylinder(const LocalShape& shape, const LocalPath& path) {
    const Ellipsoid& ellipsoid = shape.ellipsoid();
    const Polynomial side = ellipsoid.value_along(path, +1);
    double first = kNever;
    const auto offer = [&](const Times& times, const auto& is_on_feature) {
        for (const double time : times) {
            if (time < first && is_on_feature(time)) first = time;
        }
    };
    offer(down_crossings(side, 0.0, path.duration), [&](double time) {
        const double slack = kPositionError * (shape.half_height() + time * std::fabs(path.velocity(time).z));
        return std::fabs(path.position(time).z.hi) - shape.half_height() <= slack;
    });
    for (const double up : {1.0, -1.0}) {
        const Polynomial height = height_over_cap(shape, path, up, DoubleDouble(), 1.0);
        offer(down_crossings(height, 0.0, path.duration), [&](double time) {
            const PreciseVec3 y = path.position(time);
            const double moved = kPositionError * time * length(path.velocity(time));
            return ellipsoid.value(y).hi <= ellipsoid.value_error(rounded(y), moved, kPositionError);
        });
    }
    return first;
}

LocalSegment<DoubleDouble> start_of(const LocalPath& path) {
    const PreciseVec3 y = path.position(0.0);
    return {y, y, 0x1p-98 * length(rounded(y)), 0x1p-98};
}

int first_sign(const Polynomial& p) {
    for (std::size_t k = 1; k < p.coefficients.size(); ++k) {
        if (p.coefficients[k].hi != 0.0) return sign(p.coefficients[k]);
    }
    return 0;
}

/// Returns the direction of a path that starts on the surface: +1 out, -1 in, 0 along it.
int heading(const LocalShape& shape, const LocalPath& path) {
    const ShapePoint near = shape.closest_point(path.position(0.0));
    if (shape.is_capped() && std::fabs(near.normal.z) > 0.5) {
        return first_sign(height_over_cap(shape, path, near.normal.z > 0.0 ? 1.0 : -1.0, DoubleDouble(), 1.0));
    }
    return first_sign(shape.ellipsoid().value_along(path, +1));
}

ShapeContact contact_with(const ShapePoint& near, double time, int side) {
    return {time, side < 0 ? -near.normal : near.normal, near.point, near.part, near.on_rim};
}

double first_entry(const LocalShape& shape, const LocalPath& path) {
    if (shape.is_capped()) return first_entry_of_cylinder(shape, path);
    return first_time(down_crossings(shape.ellipsoid().value_along(path, +1), 0.0, path.duration));
}

/// Returns the first contact of a ball with the shape from outside, or with one part of it from inside. A ball that
/// hits a sphere from outside is equivalent to a point that hits a sphere larger by the radius. A ball inside a sphere
/// or a circular cylinder is equivalent to a point inside a surface smaller by the radius. Other contacts have no
/// closed form.
double contact_of_ball(const LocalShape& shape, const LocalPath& path, double radius,
                       std::optional<ShapePart> from_inside) {
    const ConservativeAdvancement advancement(shape, path, radius, from_inside);
    double from = 0.0;
    if (advancement.starts_in_overlap()) {
        const ConservativeAdvancement::Overlap overlap = advancement.follow_overlap();
        if (overlap.is_stopped) return overlap.time;
        if (!(overlap.time < path.duration)) return kNever;
        from = overlap.time;
    }
    const Ellipsoid& ellipsoid = shape.ellipsoid();
    if (!from_inside && ellipsoid.is_round() && !shape.is_capped()) {
        const Polynomial clearance = ellipsoid.value_along(path, +1, two_sum(ellipsoid.smallest(), radius));
        return first_time(down_crossings(clearance, from, path.duration));
    }
    const bool is_flat = from_inside && *from_inside != ShapePart::side;
    if (is_flat || (from_inside && ellipsoid.is_round() && radius < ellipsoid.smallest())) {
        return first_exit(shape, path, *from_inside, radius, from);
    }
    return advancement.first_contact(from).value_or(kNever);
}

int side_of_start(const LocalShape& shape, const LocalPath& path, double radius) {
    if (radius == 0.0) return shape.side_of_start(start_of(path));
    const double distance = shape.closest_point(path.position(0.0)).distance;
    const int side = static_cast<int>(distance > 0.0) - static_cast<int>(distance < 0.0);
    if (side != 0) return side;
    return heading(shape, path) < 0 ? -1 : 1;
}

}  // namespace

double LocalShape::time_over_cap(const LocalPath& path, double slack) const {
    const Ellipsoid widened({ellipsoid_.half_axis(0) + slack, ellipsoid_.half_axis(1) + slack, 1.0}, 2);
    return std::min(path.duration, first_time(down_crossings(widened.value_along(path, -1), 0.0, path.duration)));
}

ShapeContacts contacts_of(const LocalShape& shape, const LocalPath& path, double radius,
                          const SupportingParts& supports) {
    ShapeContacts found;
    const int side = side_of_start(shape, path, radius);
    if (side < 0) {
        for (const ShapePart part : shape.parts()) {
            if (supports[part]) continue;
            const double time =
                radius > 0.0 ? contact_of_ball(shape, path, radius, part) : first_exit(shape, path, part, 0.0, 0.0);
            if (time == kNever) continue;
            found.contacts[found.count++] =
                contact_with(shape.closest_point_beyond(part, path.position(time)), time, -1);
        }
    } else if (!supports.any()) {
        // A point that starts on the surface hits it at time 0, as if it came from the side opposite to its motion.
        // Planes use the same rule.
        double time = 0.0;
        if (side > 0) time = radius > 0.0 ? contact_of_ball(shape, path, radius, {}) : first_entry(shape, path);
        if (time == kNever) return found;
        const int seen_from = side > 0 ? 1 : -heading(shape, path);
        found.contacts[found.count++] = contact_with(shape.closest_point(path.position(time)), time, seen_from);
    }
    return found;
}

}  // namespace ricochet
