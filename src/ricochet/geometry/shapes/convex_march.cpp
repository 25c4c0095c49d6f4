#include "ricochet/geometry/shapes/convex_march.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"

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

}  // namespace

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
    return gap.rate < -kSlowestApproach * length(path_.velocity(gap.time));
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

}  // namespace ricochet
