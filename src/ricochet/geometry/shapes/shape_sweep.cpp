#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/shapes/shape_sweep.h"

namespace ricochet {
namespace {

/// A gap below this fraction of the bound of a distance's error is closed: four times smaller is what has been seen.
constexpr double kClosed = 0.25;

/// Places at which a path that starts in overlap is looked at.
constexpr int kOverlapPlaces = 32;

/// Steps of Newton's method before halving takes over; seven have been seen to be enough.
constexpr int kMostNewtonSteps = 16;

/// Halvings that reach the last place of a time.
constexpr int kMostHalvings = 60;

/// Part of the way to the other end that counts as a long step.
constexpr double kLongStep = 0.8;

double middle_of(double low, double high) { return low + 0.5 * (high - low); }

/// Steps of one march.
constexpr int kMostMarchSteps = 200;

/// A ball of a given radius on a path in the frame of a shape, coming from one side of its surface.
class ConvexMarch {
public:
    /// side: +1 outside, -1 inside.
    ConvexMarch(const LocalShape& shape, const LocalPath& path, double radius, int side);

    /// True when the gap is closed at the path's start, to rounding.
    [[nodiscard]] bool starts_in_overlap() const { return is_closed(gap_at(0.0)); }

    /// The first time after `from` at which the gap between ball and surface closes; there it must be open.
    [[nodiscard]] std::optional<double> first_closing(double from) const {
        return side_ > 0 ? first_from_outside(from) : first_from_inside(from);
    }

    /// How a start in overlap goes on.
    struct Overlap {
        bool is_stopped = false;  ///< from `time` on the gap shrinks, while it is not open
        double time = 0.0;        ///< otherwise the gap is open from here on; the duration's end when it never is
    };
    /// Looks at kOverlapPlaces equally spaced places of the path and finds the turn between two of them by halving.
    [[nodiscard]] Overlap follow_overlap() const;

private:
    /// The gap at one time and how fast it grows.
    struct Gap {
        double time;
        double size;  ///< m
        double rate;  ///< m/s
        Vec3 normal;  ///< outward
    };

    [[nodiscard]] Gap gap_at(double s) const;
    [[nodiscard]] bool is_closed(const Gap& gap) const { return gap.size <= closed_; }
    [[nodiscard]] bool approaches(const Gap& gap) const;
    [[nodiscard]] std::optional<double> first_from_outside(double from) const;
    [[nodiscard]] std::optional<double> first_from_inside(double from) const;
    [[nodiscard]] std::optional<double> time_to_plane(const Gap& gap) const;
    [[nodiscard]] Gap closing_between(const Gap& low, Gap& closed) const;
    [[nodiscard]] std::optional<double> safe_part(const Gap& low, const Gap& high) const;

    const LocalShape& shape_;
    const LocalPath& path_;
    double radius_;
    int side_;
    double closed_;  ///< m: what distances err by
};

ConvexMarch::ConvexMarch(const LocalShape& shape, const LocalPath& path, double radius, int side)
    : shape_(shape),
      path_(path),
      radius_(radius),
      side_(side),
      closed_(kClosed * shape.around().distance_error(radius, Vec3{})) {}

ConvexMarch::Gap ConvexMarch::gap_at(double s) const {
    const LocalNearest near = shape_.nearest(path_.position(s));
    return {s, side_ * near.distance - radius_, side_ * dot(near.normal, path_.velocity(s)), near.normal};
}

bool ConvexMarch::approaches(const Gap& gap) const {
    return gap.rate < -kMinApproach * length(path_.velocity(gap.time));
}

/// Time after gap.time at which the ball touches the tangent plane.
std::optional<double> ConvexMarch::time_to_plane(const Gap& gap) const {
    const double left = path_.duration - gap.time;
    const double size = std::max(gap.size, 0.0);
    if (path_.degree < 2) {
        if (!(gap.rate < 0.0) || size > -gap.rate * left) return std::nullopt;
        return size / -gap.rate;
    }
    Polynomial height;
    height.degree = path_.degree;
    height.duration = left;
    height.coefficients[0] = DoubleDouble(size);
    height.coefficients[1] = DoubleDouble(gap.rate);
    height.coefficients[2] = DoubleDouble(side_ * 0.5 * dot(gap.normal, path_.acceleration(gap.time)));
    height.coefficients[3] = DoubleDouble(side_ * dot(gap.normal, path_.jerk()) / 6.0);
    const Times times = down_crossings(height, 0.0, left);
    return times.count > 0 ? std::optional(times[0]) : std::nullopt;
}

std::optional<double> ConvexMarch::first_from_outside(double from) const {
    double s = from;
    for (int step = 0; step < kMostMarchSteps; ++step) {
        const Gap gap = gap_at(s);
        if (is_closed(gap) && approaches(gap)) return s;
        const std::optional<double> advance = time_to_plane(gap);
        if (!advance) return std::nullopt;
        if (s + *advance <= s) return s;
        s = std::min(s + *advance, path_.duration);
    }
    return s;
}

/// The part of the way from `low` to `high` on which the gap is certainly open; nothing when it is open all the way.
std::optional<double> ConvexMarch::safe_part(const Gap& low, const Gap& high) const {
    const double span = high.time - low.time;
    const double bend = std::sqrt(
        std::max(length_squared(path_.acceleration(low.time)), length_squared(path_.acceleration(high.time))));
    const double curve = path_.degree < 2 ? 0.0 : 0.5 * bend * span * span;
    const double start = std::max(low.size, 0.0);
    // Roots of curve x^2 - fall x + start.
    const double fall = start - high.size + curve;
    const double discriminant = fall * fall - 4.0 * curve * start;
    if (fall <= 0.0 || discriminant < 0.0) return std::nullopt;
    const double x = 2.0 * start / (fall + std::sqrt(discriminant));
    return x < 1.0 ? std::optional(x) : std::nullopt;
}

/// A place between `low`, where the gap is open, and `closed` at which it is zero to rounding; `closed` moves up to it
/// from behind. Newton's method, and halving where it leaves the bracket or takes long.
ConvexMarch::Gap ConvexMarch::closing_between(const Gap& low, Gap& closed) const {
    double open = low.time;
    Gap latest = closed;
    for (int step = 0; step < kMostNewtonSteps + kMostHalvings && std::fabs(latest.size) > closed_; ++step) {
        const double newton = latest.rate < 0.0 ? latest.time - latest.size / latest.rate : open;
        const bool is_usable = step < kMostNewtonSteps && newton > open && newton < closed.time;
        const double next = is_usable ? newton : middle_of(open, closed.time);
        if (!(next > open && next < closed.time)) break;
        latest = gap_at(next);
        if (latest.size < 0.0) {
            closed = latest;
        } else {
            open = latest.time;
        }
    }
    return latest;
}

std::optional<double> ConvexMarch::first_from_inside(double from) const {
    Gap low = gap_at(from);  // open from `from` to here
    Gap high = gap_at(path_.duration);
    Gap last = high;  // the first place known where the gap is closed, or the end
    for (int step = 0; step < kMostMarchSteps; ++step) {
        if (is_closed(low) && approaches(low)) return low.time;
        if (high.size < -closed_) {
            last = high;
            high = closing_between(low, last);
        }
        const std::optional<double> part = safe_part(low, high);
        if (!part) {
            if (high.time >= path_.duration) return std::nullopt;
            low = high;
            high = last;
            continue;
        }
        const double safe = low.time + *part * (high.time - low.time);
        const bool advances = safe > low.time;
        if (!advances && low.rate < 0.0) return low.time;
        if (advances) low = gap_at(safe);
        // A long step needs no other end; after a short one half the way is tried, which bends a quarter as much.
        if (high.size <= 0.0 && *part >= kLongStep) continue;
        const double middle = middle_of(low.time, high.time);
        if (!(middle > low.time && middle < high.time)) return low.time;
        high = gap_at(middle);
    }
    return low.time;
}

ConvexMarch::Overlap ConvexMarch::follow_overlap() const {
    Gap low = gap_at(0.0);
    if (approaches(low)) return {true, 0.0};
    for (int place = 1; place <= kOverlapPlaces; ++place) {
        Gap high = gap_at(path_.duration * place / kOverlapPlaces);
        if (is_closed(high) && !approaches(high)) {
            low = high;
            continue;
        }
        // Either the gap has opened or it has begun to shrink: the first such time.
        for (int halving = 0; halving < kMostHalvings; ++halving) {
            const double s = middle_of(low.time, high.time);
            if (!(s > low.time && s < high.time)) break;
            const Gap middle = gap_at(s);
            const bool is_past = !is_closed(middle) || approaches(middle);
            (is_past ? high : low) = middle;
        }
        const bool has_opened = !is_closed(high);
        return {!has_opened, has_opened ? high.time : low.time};
    }
    return {false, path_.duration};
}

using std::size_t;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// A point at the time of a crossing, which is rounded, is on a cap or under it up to this fraction of the way it has
/// travelled and of the shape: a few ulp.
constexpr double kPlaceError = 0x1p-50;

double first_time(const Times& times) { return times.count > 0 ? times[0] : kNever; }

/// Height of the path over the cap on the side `up` (+1 or -1) of a cylinder, lowered by `inset`, times `sign`.
Polynomial height_over_cap(const LocalShape& shape, const LocalPath& path, double up, const DoubleDouble& inset,
                           double sign) {
    Polynomial p;
    p.degree = path.degree;
    p.duration = path.duration;
    for (size_t k = 0; k < 4; ++k) p.coefficients[k] = sign * up * path.component[2][k];
    p.coefficients[0] = p.coefficients[0] - sign * (DoubleDouble(shape.half_height()) - inset);
    return p;
}

/// First time at which a path from inside leaves the shape made smaller by `inset`, which is 0 unless it is round.
double first_exit(const LocalShape& shape, const LocalPath& path, double inset, double from) {
    const CentredEllipsoid& around = shape.around();
    const Polynomial clearance =
        inset > 0.0 ? around.value_along(path, -1, two_diff(around.smallest(), inset)) : around.value_along(path, -1);
    double time = first_time(down_crossings(clearance, from, path.duration));
    if (!shape.is_capped()) return time;
    for (const double up : {1.0, -1.0}) {
        const Polynomial below = height_over_cap(shape, path, up, DoubleDouble(inset), -1.0);
        time = std::min(time, first_time(down_crossings(below, from, path.duration)));
    }
    return time;
}

/// First time at which a point from outside enters a cylinder: through the side while between the caps, or through a
/// cap while inside the side. Both tests of the other feature leave room for the rounding of the time, so that nothing
/// passes between them at the rim.
double first_entry_of_cylinder(const LocalShape& shape, const LocalPath& path) {
    const CentredEllipsoid& around = shape.around();
    const Polynomial side = around.value_along(path, +1);
    double first = kNever;
    const auto offer = [&](const Times& times, const auto& is_on_feature) {
        for (const double time : times) {
            if (time < first && is_on_feature(time)) first = time;
        }
    };
    offer(down_crossings(side, 0.0, path.duration), [&](double time) {
        const double room = kPlaceError * (shape.half_height() + time * std::fabs(path.velocity(time).z));
        return std::fabs(path.position(time).z.hi) - shape.half_height() <= room;
    });
    for (const double up : {1.0, -1.0}) {
        const Polynomial height = height_over_cap(shape, path, up, DoubleDouble(), 1.0);
        offer(down_crossings(height, 0.0, path.duration), [&](double time) {
            const PreciseVec3 y = path.position(time);
            const double moved = kPlaceError * time * length(path.velocity(time));
            return around.value(y).hi <= around.value_error(rounded(y), moved, kPlaceError);
        });
    }
    return first;
}

LocalSegment<DoubleDouble> start_of(const LocalPath& path) {
    const PreciseVec3 y = path.position(0.0);
    return {y, y, 0x1p-98 * length(rounded(y)), 0x1p-98};
}

int first_sign(const Polynomial& p) {
    for (size_t k = 1; k < p.coefficients.size(); ++k) {
        if (p.coefficients[k].hi != 0.0) return sign(p.coefficients[k]);
    }
    return 0;
}

/// Which way a path heads that starts on the surface: +1 out, -1 in, 0 along it.
int heading(const LocalShape& shape, const LocalPath& path) {
    const LocalNearest near = shape.nearest(path.position(0.0));
    if (shape.is_capped() && std::fabs(near.normal.z) > 0.5) {
        return first_sign(height_over_cap(shape, path, near.normal.z > 0.0 ? 1.0 : -1.0, DoubleDouble(), 1.0));
    }
    return first_sign(shape.around().value_along(path, +1));
}

LocalContact contact_at(const LocalShape& shape, const LocalPath& path, double time, int side) {
    const LocalNearest near = shape.nearest(path.position(time));
    return {time, side < 0 ? -near.normal : near.normal, near.foot};
}

std::optional<LocalContact> first_contact_of_point(const LocalShape& shape, const LocalPath& path) {
    const int side = shape.side_of_start(start_of(path));
    // A point born on the surface is turned back from the side it heads for, as with planes.
    if (side == 0) return contact_at(shape, path, 0.0, -heading(shape, path));
    double time = kNever;
    if (side < 0) {
        time = first_exit(shape, path, 0.0, 0.0);
    } else if (shape.is_capped()) {
        time = first_entry_of_cylinder(shape, path);
    } else {
        time = first_time(down_crossings(shape.around().value_along(path, +1), 0.0, path.duration));
    }
    if (time == kNever) return std::nullopt;
    return contact_at(shape, path, time, side);
}

/// A sphere from outside is a point against the sphere that is larger by the radius; a sphere, or a circular cylinder,
/// from inside is one against the shape that is smaller by it.
bool has_closed_form(const LocalShape& shape, double radius, int side) {
    if (!shape.around().is_round()) return false;
    if (side > 0) return !shape.is_capped();
    return radius < shape.around().smallest() && (!shape.is_capped() || radius < shape.half_height());
}

double closing_in_closed_form(const LocalShape& shape, const LocalPath& path, double radius, int side, double from) {
    if (side < 0) return first_exit(shape, path, radius, from);
    const Polynomial clearance = shape.around().value_along(path, +1, two_sum(shape.around().smallest(), radius));
    return first_time(down_crossings(clearance, from, path.duration));
}

std::optional<LocalContact> first_contact_of_ball(const LocalShape& shape, const LocalPath& path, double radius) {
    const double distance = shape.nearest(path.position(0.0)).distance;
    int side = static_cast<int>(distance > 0.0) - static_cast<int>(distance < 0.0);
    if (side == 0) side = heading(shape, path) < 0 ? -1 : 1;
    const ConvexMarch march(shape, path, radius, side);
    double from = 0.0;
    if (march.starts_in_overlap()) {
        const ConvexMarch::Overlap overlap = march.follow_overlap();
        if (overlap.is_stopped) return contact_at(shape, path, overlap.time, side);
        from = overlap.time;
        if (from >= path.duration) return std::nullopt;
    }
    const double time = has_closed_form(shape, radius, side) ? closing_in_closed_form(shape, path, radius, side, from)
                                                             : march.first_closing(from).value_or(kNever);
    if (time == kNever) return std::nullopt;
    return contact_at(shape, path, time, side);
}

}  // namespace

std::optional<LocalContact> first_contact(const LocalShape& shape, const LocalPath& path, double radius) {
    return radius > 0.0 ? first_contact_of_ball(shape, path, radius) : first_contact_of_point(shape, path);
}

}  // namespace ricochet
