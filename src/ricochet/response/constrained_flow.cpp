#include "ricochet/response/constrained_flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/core/bisection.h"
#include "ricochet/core/error.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/stability.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/impact_resolver.h"
#include "ricochet/response/manifold_surfaces.h"
#include "ricochet/response/normal_rate.h"

namespace ricochet {
namespace {

/// Number of halvings in the bisection for the time at which the flow turns away from a wall. Local: it ends below
/// rounding.
constexpr int kReleaseHalvings = 60;

/// Returns the normal of a round shape at a position, on the same side as the contact's normal.
Vec3 round_normal(const SurfaceGeometry& geometry, const ContactSurface& surface, const Vec3& position) {
    const Vec3 normal = geometry.unit_normal_of(surface.surface, position);
    return dot(normal, surface.normal) < 0.0 ? -normal : normal;
}

/// A flow without its components along the normals of surfaces. Normals of round shapes are taken at each position.
class FlowAlong final : public FlowField {
public:
    /// particle: id of the particle, for error messages.
    FlowAlong(const FlowField& flow, const SurfaceGeometry& geometry, std::span<const ContactSurface> surfaces,
              std::uint64_t particle)
        : flow_(flow), geometry_(geometry), surfaces_(surfaces), particle_(particle) {}
    [[nodiscard]] Vec3 velocity(const Vec3& position, double time) const override {
        const Vec3 free = flow_.velocity(position, time);
        if (!is_finite(free)) refuse_if_in_range(free, position, time);
        std::array<Vec3, kMostSupports> normals;
        return surfaces_.empty() ? free : along_all(free, normals_at(position, normals));
    }
    [[nodiscard]] bool is_steady() const override { return flow_.is_steady(); }
    /// Returns the position moved to the given distance from each surface, in m.
    [[nodiscard]] Vec3 put_on(Vec3 position, double distance) const {
        constexpr int kCorrections = 3;
        for (int k = 0; k < kCorrections; ++k) {
            ShortestShift shift;
            std::array<Vec3, kMostSupports> normals;
            const auto at = normals_at(position, normals);
            for (std::size_t i = 0; i < surfaces_.size(); ++i) {
                const SurfaceId surface = surfaces_[i].surface;
                const double side = dot(geometry_.unit_normal_of(surface, position), at[i]) < 0.0 ? -1.0 : 1.0;
                shift.add(at[i], distance - side * geometry_.signed_distance_from(surface, position));
            }
            position += shift.vector();
        }
        return flush_tiny(position);
    }

private:
    /// Throws a RunError for a velocity g that is not finite at a position x in range. An integrator may try others.
    void refuse_if_in_range(const Vec3& g, const Vec3& x, double time) const {
        if (!is_finite(x) || max_abs(x) > kLargestJudged) return;
        throw RunError(
            fmt::format("flow: found the velocity [{}, {}, {}] m/s of particle {} at [{:.6g}, {:.6g}, {:.6g}] m and "
                        "{:.6g} s, expected finite numbers",
                        g.x, g.y, g.z, particle_, x.x, x.y, x.z, time));
    }
    std::span<const Vec3> normals_at(const Vec3& position, std::array<Vec3, kMostSupports>& normals) const {
        for (std::size_t i = 0; i < surfaces_.size(); ++i) {
            const ContactSurface& surface = surfaces_[i];
            normals[i] = surface.flat ? surface.normal : round_normal(geometry_, surface, position);
        }
        return {normals.data(), surfaces_.size()};
    }

    const FlowField& flow_;
    const SurfaceGeometry& geometry_;
    std::span<const ContactSurface> surfaces_;
    std::uint64_t particle_;
};

/// Returns the angle of the next chord along a curved surface, in rad, after a number of chords in the step. The angle
/// grows with this number. Otherwise a sphere that rolls round many edges would exhaust its budget: 500 chords of 0.01
/// rad turn by 5 rad; with growing angles by 50 rad.
double chord_angle(int chords) {
    return kMaxChordAngle * static_cast<double>(1 << std::min(chords / kChordsToDouble, kMostChordDoublings));
}

Vec3 displacement(const Path& path, double s) {
    Vec3 sum;
    for (std::size_t k = path.c.size(); k-- > 1;) sum = s * (path.c[k] + sum);
    return sum;
}

Path cut(Path path, double duration) {
    if (duration < path.duration) {
        path.end = path.position(duration);
        path.duration = duration;
    }
    return path;
}

}  // namespace

void SupportSet::add(std::size_t point, const Vec3& normal) {
    points_[count_] = point;
    normals_[count_++] = normal;
}

void SupportSet::remove(std::size_t k) {
    for (--count_; k < count_; ++k) {
        points_[k] = points_[k + 1];
        normals_[k] = normals_[k + 1];
    }
}

bool SupportSet::has(std::size_t point) const {
    return std::find(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(count_), point) !=
           points_.begin() + static_cast<std::ptrdiff_t>(count_);
}

Vec3 ConstrainedFlow::velocity() const { return project_off(free_velocity(), manifold_.normals()); }

bool ConstrainedFlow::leads_in(double time) const {
    const auto normals = manifold_.normals();
    if (normals.empty()) return false;
    const auto is_into = [&](const Vec3& v) {
        return std::ranges::any_of(normals, [&](const Vec3& normal) { return dot(v, normal) < 0.0; });
    };
    if (is_into(flow_.velocity(state_.position, time))) return true;
    Path trajectory =
        flow_path(rules_.settings.integrator, flow_, state_.position, time, kShortestRelease * step_, 0.0).path;
    trajectory.c[0] = {};
    const ControlPoints points = trajectory.control_points();
    return std::ranges::any_of(points, is_into);
}

double ConstrainedFlow::time_to_release(double remaining) const {
    if (flow_.is_steady() || leads_in(state_.time + remaining)) return remaining;
    return bisect(0.0, remaining, kReleaseHalvings, [&](double s) { return leads_in(state_.time + s); }).high;
}

Path ConstrainedFlow::next_path(double duration, double reach) {
    for (holders_ = holders_now();;) {
        find_followed();
        const bool is_arc = followed_count_ > 0;
        const Path path = is_arc ? arc(longest_arc(duration)) : free_path(duration);
        if (holders_.empty() || !can_be_followed(path)) return path;
        const Part held = is_arc ? arc_until_release(path) : until_release(path);
        if (is_no_progress(held.path.duration, held.path.c[1])) {  // the flow turns away here
            holders_.remove(held.ended_by);
            continue;
        }
        const Part part = until_rim(held.path, reach);
        if (is_no_progress(part.path.duration, part.path.c[1])) {  // the particle has passed the end of that surface
            manifold_.remove(holders_.point(part.ended_by));
            holders_ = holders_now();
            continue;
        }
        if (is_arc) return part.path;
        for (std::size_t k = 0; k < holders_.size(); ++k) {
            const ContactSurface support = manifold_[holders_.point(k)];
            if (!support.flat) return along_curved(support, part.path);
        }
        return lifted(part.path);
    }
}

bool ConstrainedFlow::is_negligible_path(double duration) const {
    return duration <= kNoProgress * step_ && is_no_progress(duration, velocity());
}

bool ConstrainedFlow::dips(const Path& path, double time) const {
    const double depth = 0.25 * contact_offset(state_.position);
    const Vec3 moved = displacement(path, time);
    for (std::size_t k = 0; k < manifold_.size(); ++k) {
        const ContactSurface surface = manifold_[k];
        if (surface.flat && !holders_.has(k) && dot(moved, surface.normal) < -depth) return true;
    }
    return false;
}

/// Returns the contact points with a positive reaction to the flow.
SupportSet ConstrainedFlow::holders_now() const {
    const auto normals = manifold_.normals();
    const auto loads = normal_accelerations(free_velocity(), normals);
    SupportSet holders;
    for (std::size_t k = 0; k < normals.size(); ++k) {
        if (loads[k] > 0.0) holders.add(k, normals[k]);
    }
    return holders;
}

Path ConstrainedFlow::free_path(double duration) {
    Surfaces surfaces;
    const FlowAlong along(flow_, geometry_, supports(surfaces), state_.id);
    const FlowPath free = flow_path(rules_.settings.integrator, along, state_.position, state_.time, duration,
                                    next_duration_, kShortestSubstep * step_);
    next_duration_ = free.next_duration;
    ++substeps_;
    is_coarse_ = is_coarse_ || free.is_coarse;
    return free.path;
}

/// Returns the holders' surfaces for the next path. A surface that is not followed on an arc counts as flat.
std::span<const ContactSurface> ConstrainedFlow::supports(Surfaces& surfaces) const {
    for (std::size_t k = 0; k < holders_.size(); ++k) {
        surfaces[k] = manifold_[holders_.point(k)];
        surfaces[k].flat = surfaces[k].flat || followed_count_ == 0;
    }
    return std::span(surfaces).first(holders_.size());
}

/// Finds the round shapes that an arc can follow. None if a shape touches at its rim, or another curved surface holds.
void ConstrainedFlow::find_followed() {
    followed_count_ = 0;
    for (std::size_t k = 0; k < holders_.size(); ++k) {
        const ContactSurface support = manifold_[holders_.point(k)];
        if (support.flat) continue;
        const SurfaceId surface = support.surface;
        if (!rules_.world.is_shape(surface) || geometry_.nearest(surface, state_.position).rim) {
            followed_count_ = 0;
            return;
        }
        followed_[followed_count_++] = surface;
    }
}

/// Returns an arc up to the time at which a holder releases the particle or ends.
ConstrainedFlow::Part ConstrainedFlow::arc_until_release(const Path& path) const {
    Part part{path, 0};
    const auto release_at = released_by(part.path.end, state_.time + part.path.duration);
    if (!release_at) return part;
    part.ended_by = *release_at;
    const double until = bisect(0.0, part.path.duration, kReleaseHalvings, [&](double s) {
                             const std::optional<std::size_t> by =
                                 s > 0.0 ? released_by(arc(s).end, state_.time + s) : std::nullopt;
                             if (by) part.ended_by = *by;
                             return !by;
                         }).high;
    part.path = arc(until);
    return part;
}

/// Returns the path along the holders for a duration, in s, as the cubic through its ends.
Path ConstrainedFlow::arc(double duration) const {
    Surfaces surfaces;
    const FlowAlong along(flow_, geometry_, supports(surfaces), state_.id);
    const Vec3& from = state_.position;
    const FlowPath trajectory = flow_path(rules_.settings.integrator, along, from, state_.time, duration, duration);
    const double passed = trajectory.path.duration;
    const Vec3 end = along.put_on(trajectory.path.end, state_.radius + contact_offset(trajectory.path.end));
    Path path =
        hermite_path(from, along.velocity(from, state_.time), end, along.velocity(end, state_.time + passed), passed);
    lift_middle(geometry_, manifold_, state_.radius, path);
    return path;
}

/// Returns the first holder onto which the flow does not press the particle at a position, or whose rim is there.
std::optional<std::size_t> ConstrainedFlow::released_by(const Vec3& position, double time) const {
    std::array<Vec3, kMostSupports> normals;
    for (std::size_t k = 0; k < holders_.size(); ++k) {
        const ContactSurface support = manifold_[holders_.point(k)];
        if (!support.flat && geometry_.nearest(support.surface, position).rim) return k;
        normals[k] = support.flat ? support.normal : round_normal(geometry_, support, position);
    }
    const auto loads = normal_accelerations(flow_.velocity(position, time), std::span(normals).first(holders_.size()));
    for (std::size_t k = 0; k < holders_.size(); ++k) {
        if (!(loads[k] > 0.0)) return k;
    }
    return std::nullopt;
}

/// Returns the time, in s, in which a holder's normal turns by kMaxArcAngle, at most `duration`. If the flow along the
/// surface is nearly at rest, a lower bound of its speed is used, because it may soon be faster.
double ConstrainedFlow::longest_arc(double duration) const {
    const Vec3 free = free_velocity();
    const Vec3 along = along_all(free, holders_.normals());
    const double speed = std::max(length(along), kSlowFlow * length(free));
    const Vec3 heading = along == Vec3{} ? tangent_frame(holders_.normals()[0])[0] : normalized(along);
    for (const SurfaceId surface : followed()) {
        const CollisionWorld::Nearest nearest = geometry_.nearest(surface, state_.position);
        const double turning =
            speed * length(normal_rate(geometry_, state_.radius, surface, nearest, state_.position, heading));
        if (turning * duration > kMaxArcAngle) duration = kMaxArcAngle / turning;
    }
    return duration;
}

/// Returns the number of the holder onto which a flow presses the particle least.
std::size_t ConstrainedFlow::weakest(const Vec3& g) const {
    const auto loads = normal_accelerations(g, holders_.normals());
    return static_cast<std::size_t>(
        std::min_element(loads.begin(), loads.begin() + static_cast<std::ptrdiff_t>(holders_.size())) - loads.begin());
}

/// Returns a path up to the time at which the flow turns away from a holder. Components along the normals are removed.
/// Otherwise a cubic whose end velocity leads away from the surface would dip into the surface before its end.
ConstrainedFlow::Part ConstrainedFlow::until_release(const Path& path) const {
    const auto flow_at = [&](double s) { return flow_.velocity(path.position(s), state_.time + s); };
    const auto holds = [&](double s) {
        const Vec3 g = flow_at(s);
        const auto loads = normal_accelerations(g, holders_.normals());
        return std::all_of(loads.begin(), loads.begin() + static_cast<std::ptrdiff_t>(holders_.size()),
                           [](double load) { return load > 0.0; });
    };
    Part part{path, 0};
    if (!holds(path.duration)) {
        const double until = bisect(0.0, path.duration, kReleaseHalvings, holds).high;
        part.ended_by = weakest(flow_at(until));
        Surfaces surfaces;
        const FlowAlong along(flow_, geometry_, supports(surfaces), state_.id);
        part.path = flow_path(rules_.settings.integrator, along, state_.position, state_.time, until, until).path;
    }
    Path& held = part.path;
    for (std::size_t k = 1; k < held.c.size(); ++k) held.c[k] = along_all(held.c[k], holders_.normals());
    held.end = held.c[0] + along_all(held.end - held.c[0], holders_.normals());
    return part;
}

/// Returns a path up to the first rim of the flat holders.
ConstrainedFlow::Part ConstrainedFlow::until_rim(const Path& path, double reach) const {
    Part part{path, 0};
    for (std::size_t k = 0; k < holders_.size(); ++k) {
        const ContactSurface support = manifold_[holders_.point(k)];
        if (!support.flat) continue;
        Path of_contact_point = path;
        of_contact_point.c[0] -= state_.radius * support.normal;
        const double on = rules_.world.time_over(support.surface, of_contact_point, reach);
        if (!(on < part.path.duration)) continue;
        part = {cut(path, on), k};
    }
    return part;
}

/// Returns a path along flat surfaces whose end keeps the contact offset from them.
Path ConstrainedFlow::lifted(Path path) const {
    const CollisionWorld& world = rules_.world;
    const double offset = contact_offset(path.end);
    ShortestShift shift;
    for (std::size_t k = 0; k < holders_.size(); ++k) {
        const ContactSurface support = manifold_[holders_.point(k)];
        const double side = dot(world.unit_normal_of(support.surface, path.end), support.normal) < 0.0 ? -1.0 : 1.0;
        const double height = side * world.signed_distance_from(support.surface, path.end) - state_.radius;
        const double lift = offset - height;
        // If the flow has turned away, the particle is above the surface by more than rounding. Near the origin, a
        // height above a large triangle can be pure rounding.
        const bool is_rounding =
            std::fabs(lift) <= 0.5 * kCandidateSlack * max_abs(path.end) && height <= 2.0 * kTouchingOffsets * offset;
        if (is_rounding) shift.add(support.normal, lift);
    }
    if (shift.is_empty()) return path;
    path.end = flush_tiny(path.end + shift.vector());
    // The path may start below the contact offset. It must not lead farther into the surface from there.
    path.c[1] += shift.vector() / path.duration;
    return path;
}

/// Shortens a path round an edge or a rim, so that the normal turns by at most chord_angle(). If the surface curves
/// away from the particle, the path is a tangent. Otherwise it is a chord.
Path ConstrainedFlow::along_curved(const ContactSurface& support, Path path) {
    const CollisionWorld::Nearest here = geometry_.nearest(support.surface, state_.position);
    const double turning =
        length(normal_rate(geometry_, state_.radius, support.surface, here, state_.position, path.c[1]));
    if (turning > 0.0) path = cut(path, chord_angle(chords_++) / turning);
    const CollisionWorld::Nearest there = geometry_.nearest(support.surface, path.end);
    const double side = dot(there.normal, support.normal) < 0.0 ? -1.0 : 1.0;
    const double offset = contact_offset(path.end);
    const double lift = state_.radius + offset - side * there.distance;
    if (!(lift > 0.0)) return path;
    const Vec3 end = flush_tiny(path.end + (side * lift) * there.normal);
    // Over the seam of a flat surface the height differs only by rounding.
    if (lift > kTouchingOffsets * offset) {
        path = line_path(state_.position, (end - state_.position) / path.duration, path.duration);
    }
    path.end = end;
    return path;
}

/// Returns true if a path takes a negligible part of the step and is shorter than the rounding of positions.
bool ConstrainedFlow::is_no_progress(double duration, const Vec3& velocity) const {
    return !(duration > kNoProgress * step_) && !(length(velocity) * duration > 0.25 * contact_offset(state_.position));
}

}  // namespace ricochet
