#include "ricochet/verify/rebound.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace ricochet::verify {
namespace {

/// Tolerance of the normal velocities after an impact, relative to the largest speed. The equations of an impact are
/// solved to 1e-12. Velocities along surfaces in contact can have normal components of up to 1e-9. With a smaller
/// tolerance, rounding would be reported. With a larger one, wrong restitutions of slow impacts would not be found.
/// Local: a tolerance of the audit, which does not affect the run.
constexpr double kReboundRounding = 1e-9;

/// Tolerance of the normal velocities if several surfaces are hit at once, relative to the largest speed. Impacts in
/// wedges with friction may have no exact solution and are solved approximately. Local: a tolerance of the audit, which
/// does not affect the run.
constexpr double kReboundInWedge = 1e-3;

/// Largest normal speed, relative to the largest speed, at which a particle neither approaches nor leaves a supporting
/// surface. Local: a tolerance of the audit, which does not affect the run.
constexpr double kHeldSpeed = 1e-6;

double restitution_of(const RecordedImpact::Surface& surface, double approach) {
    const double threshold = surface.restitution_threshold;
    return approach < threshold ? surface.restitution * approach / threshold : surface.restitution;
}

/// Returns the normal velocity of the particle relative to the surface before the impact, in m/s. It is positive away
/// from the surface.
double before(const RecordedImpact& impact, const RecordedImpact::Surface& surface) {
    return dot(impact.before.velocity - surface.velocity_before, surface.normal);
}
double after(const RecordedImpact& impact, const RecordedImpact::Surface& surface) {
    return dot(impact.after.velocity - surface.velocity_after, surface.normal);
}

double scale_of(const RecordedImpact& impact) {
    double scale = length(impact.before.velocity) + length(impact.after.velocity);
    for (const auto& surface : impact.surfaces) {
        scale = std::max({scale, length(surface.velocity_before), length(surface.velocity_after)});
    }
    return scale;
}

}  // namespace

bool has_wrong_rebound(const RecordedImpact& impact) {
    const double scale = scale_of(impact);
    const auto moves_along = [&](const RecordedImpact::Surface& surface) {
        return std::fabs(before(impact, surface)) <= kHeldSpeed * scale;
    };
    // A listed surface is a support only if the particle moves along it. The contact interval may have touched both
    // sides of a thin body, or may have left the surface.
    const auto is_support = [&](const RecordedImpact::Surface& surface) {
        const bool is_listed = std::ranges::find(impact.supported_by, surface.surface) != impact.supported_by.end();
        return surface.is_support || (is_listed && moves_along(surface));
    };
    const auto is_hit = [&](const RecordedImpact::Surface& surface) {
        return !is_support(surface) && before(impact, surface) < 0.0;
    };
    double restitution = 1.0;
    // Sum of the normal speeds at the supports, in m/s. The impact treats these speeds as zero, so rebounds from other
    // surfaces can be wrong by this amount.
    double constrained_speed = 0.0;
    std::size_t hit = 0;
    for (const RecordedImpact::Surface& surface : impact.surfaces) {
        if (is_support(surface) && !moves_along(surface)) return true;
        if (is_support(surface)) constrained_speed += std::fabs(before(impact, surface));
        if (!is_hit(surface)) continue;
        ++hit;
        restitution = std::min(restitution, restitution_of(surface, -before(impact, surface)));
    }
    const double part = impact.surfaces.size() > 1 && hit != 1 ? kReboundInWedge : kReboundRounding;
    const double rounding = part * scale + 2.0 * constrained_speed;
    double least = std::numeric_limits<double>::infinity();
    for (const RecordedImpact::Surface& surface : impact.surfaces) {
        // By Moreau's law, a particle that was leaving a surface may return to this surface, at most at e times its
        // speed. The particle then hits this surface next.
        const double rebound = is_support(surface) ? 0.0 : -restitution * before(impact, surface);
        const double more = after(impact, surface) - rebound;
        if (more < -rounding) return true;
        if (is_hit(surface)) least = std::min(least, more);
    }
    // At least one of the hit surfaces must give an impulse. The particle must therefore not leave all hit surfaces
    // faster than required.
    return hit > 0 && least > rounding;
}

}  // namespace ricochet::verify
