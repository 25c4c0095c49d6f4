#include "ricochet/verify/rebound.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace ricochet::verify {
namespace {

/// Relative error of the normal velocities after an impact. Reason: the equations of an impact are solved to 1e-12, and
/// contact leaves 1e-9 along its surfaces. Smaller: rounding is reported. Larger: wrong restitutions of slow impacts
/// are not found. Local: a tolerance of the audit, which does not affect the run.
constexpr double kReboundRounding = 1e-9;

/// Relative error of the normal velocities if several surfaces with friction are hit. Impacts in wedges may have no
/// exact solution and are solved approximately. Local: a tolerance of the audit, which does not affect the run.
constexpr double kReboundInWedge = 1e-3;

/// Largest normal speed, relative to all speeds, at which a supporting surface counts as neither approached nor left.
/// Local: a tolerance of the audit, which does not affect the run.
constexpr double kHeldSpeed = 1e-6;

double restitution_of(const RecordedImpact::Surface& surface, double approach) {
    const double threshold = surface.restitution_threshold;
    return approach < threshold ? surface.restitution * approach / threshold : surface.restitution;
}

/// Returns the velocity, in m/s, along the normal, away from the surface.
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
    // The interval may have touched both sides of a thin body, or may have left a surface.
    const auto is_support = [&](const RecordedImpact::Surface& surface) {
        const bool is_listed = std::find(impact.supported_by.begin(), impact.supported_by.end(), surface.surface) !=
                               impact.supported_by.end();
        return surface.is_support || (is_listed && moves_along(surface));
    };
    const auto is_hit = [&](const RecordedImpact::Surface& surface) {
        return !is_support(surface) && before(impact, surface) < 0.0;
    };
    double restitution = 1.0;
    // In m/s. The impact treats it as zero, and the rebound off other surfaces changes by as much.
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
        // Moreau's law allows a particle to return to a surface that it was leaving, at most e times as fast. The
        // particle hits that surface next.
        const double rebound = is_support(surface) ? 0.0 : -restitution * before(impact, surface);
        const double more = after(impact, surface) - rebound;
        if (more < -rounding) return true;
        if (is_hit(surface)) least = std::min(least, more);
    }
    // At least one surface pushes, and the particle leaves that surface no faster than required.
    return hit > 0 && least > rounding;
}

}  // namespace ricochet::verify
