#include "ricochet/geometry/shapes/shape_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/shapes/convex_march.h"

namespace ricochet {
namespace {

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
