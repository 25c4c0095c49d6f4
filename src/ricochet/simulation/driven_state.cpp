// Checks that the state of dynamic bodies in a file can be one that a run has left behind.
#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/simulation/driven_motion.h"

namespace ricochet {
namespace {

/// Largest entry of the product of a rotation and its transpose, minus the unit matrix. A step adds a few roundings of
/// 1e-16, so a run of 1e9 steps stays below. Larger: stretched shapes would be accepted. Local: a limit of input
/// values.
constexpr double kMostSkew = 1e-6;

bool is_finite(const Wrench& wrench) {
    return ricochet::is_finite(wrench.impulse) && ricochet::is_finite(wrench.moment);
}

bool is_unit(const Vec3& v) { return std::fabs(dot(v, v) - 1.0) <= kMostSkew; }

/// Returns true for a rotation with a translation.
bool is_rigid(const AffineMap& map) {
    const double skew = std::max({std::fabs(dot(map.row_x, map.row_y)), std::fabs(dot(map.row_y, map.row_z)),
                                  std::fabs(dot(map.row_z, map.row_x))});
    return is_unit(map.row_x) && is_unit(map.row_y) && is_unit(map.row_z) && skew <= kMostSkew && !map.mirrors() &&
           ricochet::is_finite(map.translation);
}

bool is_path(const BodyPath& path) {
    const bool is_path_finite = std::all_of(path.center_path.begin(), path.center_path.end(),
                                            [](const Vec3& v) { return ricochet::is_finite(v); });
    const bool is_turn_finite =
        std::all_of(path.turns.begin(), path.turns.end(), [](double x) { return std::isfinite(x); });
    return std::isfinite(path.begin) && std::isfinite(path.end) && path.begin <= path.end && is_path_finite &&
           is_turn_finite && std::isfinite(path.degrees) && ricochet::is_finite(path.carrier) && is_unit(path.axis) &&
           is_rigid(path.at_begin);
}

/// Speeds are limited as at the start of a scene.
bool is_body(const DrivenBody& body) {
    return is_rigid(body.world_from_frame()) && ricochet::is_finite(body.center()) &&
           length(body.velocity()) <= kMaxSpeed && length(body.angular_velocity()) <= kMaxSpeed &&
           std::isfinite(body.coordinate()) && std::fabs(body.rate()) <= kMaxSpeed;
}

}  // namespace

bool BodyPaths::is_sound(std::size_t body) const {
    const std::vector<BodyPath>& paths = of(body);
    const auto leaves_gap = [](const BodyPath& a, const BodyPath& b) { return a.end != b.begin; };
    return std::all_of(paths.begin(), paths.end(), is_path) &&
           std::adjacent_find(paths.begin(), paths.end(), leaves_gap) == paths.end() && paths.size() == of(0).size() &&
           (!is_planned_ || !paths.empty());
}

bool DrivenMotion::is_sound(double time) const {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const std::vector<std::uint64_t>& ids = contacts_[k].now;
        const bool is_whole = is_body(bodies_[k]) && paths_.is_sound(k) && is_finite(resting_loads_[k]) &&
                              relaxations_[k].is_sound() && std::is_sorted(ids.begin(), ids.end());
        if (!is_whole) return false;
    }
    // A substep that does not advance the time would be repeated without end.
    return resting_time_ >= 0.0 && std::isfinite(resting_time_) && time + longest_part_ > time;
}

}  // namespace ricochet
