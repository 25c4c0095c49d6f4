#include "ricochet/simulation/driven_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Largest allowed entry of the product of a rotation and its transpose, minus the unit matrix. A step adds a few
/// rounding errors of 1e-16, so 1e9 steps stay below. More would accept stretched shapes. Local: a limit of input.
constexpr double kMostSkew = 1e-6;

bool is_unit(const Vec3& v) { return std::fabs(dot(v, v) - 1.0) <= kMostSkew; }

/// Returns true for a rotation with a translation.
bool is_rigid(const AffineMap& map) {
    const double skew = std::max({std::fabs(dot(map.row_x, map.row_y)), std::fabs(dot(map.row_y, map.row_z)),
                                  std::fabs(dot(map.row_z, map.row_x))});
    return is_unit(map.row_x) && is_unit(map.row_y) && is_unit(map.row_z) && skew <= kMostSkew && !map.mirrors() &&
           is_finite(map.translation);
}

bool is_path(const BodyPath& path) {
    const bool is_path_finite = std::ranges::all_of(path.center_path, is_finite);
    const bool is_turn_finite = std::ranges::all_of(path.turns, [](double x) { return std::isfinite(x); });
    return std::isfinite(path.begin) && std::isfinite(path.end) && path.begin <= path.end && is_path_finite &&
           is_turn_finite && std::isfinite(path.degrees) && is_finite(path.carrier) && is_unit(path.axis) &&
           is_rigid(path.at_begin);
}

/// Returns true if the state of a body is in range. The limits of speeds are those for the start of a scene.
bool is_body(const DrivenBody& body) {
    return is_rigid(body.world_from_frame()) && is_finite(body.center()) && length(body.velocity()) <= kMaxSpeed &&
           length(body.angular_velocity()) <= kMaxSpeed && std::isfinite(body.coordinate()) &&
           std::fabs(body.rate()) <= kMaxSpeed;
}

}  // namespace

BodyPaths::BodyPaths(const std::vector<DrivenBody>& bodies, FrameTree* frames, MovingColliders& colliders,
                     const ForceField& forces)
    : bodies_(bodies), frames_(frames), colliders_(&colliders), forces_(forces), shares_(bodies.size(), 1.0) {
    for (const DrivenBody& body : bodies) {
        const std::size_t frame = frames_->find(body.description().frame).value();
        frame_of_.push_back(frame);
        BodyId id = 0;
        while (id < colliders.size() && colliders.frame_of(id) != frame) ++id;
        const bool has_colliders = id < colliders.size();
        collider_of_.push_back(has_colliders ? id : kWorldBody);
        if (has_colliders) colliders_->set_mobility(id, body.mobility());
    }
}

void BodyPaths::set_shares(std::vector<double> shares) {
    shares.resize(bodies_.size(), 1.0);
    if (shares == shares_) return;
    shares_ = std::move(shares);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        if (collider_of_[k] == kWorldBody) continue;
        Mobility mobility = bodies_[k].mobility();
        mobility.of_mass = shares_[k] * mobility.of_mass;
        mobility.of_inertia = shares_[k] * mobility.of_inertia;
        colliders_->set_mobility(collider_of_[k], mobility);
    }
}

void BodyPaths::plan(const std::vector<Wrench>& loads, double begin, double end) {
    loads_ = loads;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const BodyPath next = bodies_[k].plan(forces_, loads_[k], begin, end);
        if (is_planned_) {
            frames_->replace_last_path(frame_of_[k], next);
        } else {
            frames_->append_path(frame_of_[k], next);
        }
        frames_->forget_paths(frame_of_[k], oldest_);
        const double size = max_abs(next.at(end).world_from_frame.translation);
        // Sweeps along a very fast rotation would not end, even about a centre that does not move.
        const MotionBounds motion = next.bounds(begin, end);
        if (!(size <= kLargestCoordinate) || !(std::max(motion.origin[1], motion.rotation[1]) < kMaxSpeed)) {
            throw DivergedError(fmt::format(
                "by t = {:.6g} s the body '{}' has left the range of the arithmetic: its motion has diverged; use a "
                "shorter time step or weaker forces",
                end, bodies_[k].description().frame));
        }
        publish_velocity_jump(k, of(k).size() - 1);
    }
    is_planned_ = true;
}

void BodyPaths::end_at(double time) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        BodyPath path = planned(k);
        const bool is_cut = time < path.end;
        path.end = time;
        // The force of a spring is known only at the ends of a substep, so the path is planned again.
        const JointSettings& joint = bodies_[k].description().settings;
        const bool is_sprung = joint.spring > 0.0 || joint.damping > 0.0;
        if (is_cut && is_sprung) path = bodies_[k].plan(forces_, loads_[k], path.begin, time);
        frames_->replace_last_path(frame_of_[k], path);
    }
}

std::vector<ImpactTally> BodyPaths::no_impacts() const {
    std::vector<ImpactTally> tallies;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        tallies.emplace_back(bodies_[k], planned(k), colliders_, collider_of_[k]);
    }
    return tallies;
}

double BodyPaths::repeat(double time) {
    set_shares({});
    const std::vector<BodyPath>& paths = of(0);
    std::size_t path = 0;
    while (path + 1 < paths.size() && paths[path + 1].begin <= time) ++path;
    for (std::size_t k = 0; k < bodies_.size(); ++k) publish_velocity_jump(k, path);
    return paths[path].end;
}

/// Publishes to a body's colliders whether its velocity jumps at the start of a path. All bodies share the indices.
void BodyPaths::publish_velocity_jump(std::size_t body, std::size_t path) const {
    if (collider_of_[body] == kWorldBody) return;
    const std::vector<BodyPath>& paths = of(body);
    const bool has_jumped =
        path > 0 && has_jump(paths[path - 1].at(paths[path - 1].end), paths[path].at(paths[path].begin));
    const bool is_free = bodies_[body].description().joint == JointKind::free;
    colliders_->set_motion(collider_of_[body], has_jumped,
                           is_free ? std::optional(bodies_[body].angular_momentum()) : std::nullopt);
}

bool BodyPaths::is_sound(std::size_t body) const {
    const std::vector<BodyPath>& paths = of(body);
    const auto leaves_gap = [](const BodyPath& a, const BodyPath& b) { return a.end != b.begin; };
    return is_body(bodies_[body]) && std::ranges::all_of(paths, is_path) &&
           std::ranges::adjacent_find(paths, leaves_gap) == paths.end() && paths.size() == of(0).size() &&
           (!is_planned_ || !paths.empty());
}

}  // namespace ricochet
