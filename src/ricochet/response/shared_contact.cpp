#include "ricochet/response/shared_contact.h"

#include <algorithm>
#include <array>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/carried_particle.h"
#include "ricochet/response/deformed_surface.h"
#include "ricochet/response/impact_problem.h"
#include "ricochet/response/path_motion.h"

namespace ricochet {
namespace {

/// Corrections of the end of an interval. Each squares the relative error. Local: it ends below rounding.
constexpr int kCorrections = 3;

}  // namespace

bool SharedContact::is_slow(const Contact& contact, const Motion& arriving) const {
    const SurfaceKinematics& kinematics = step_.impact().surfaces();
    return std::ranges::all_of(contact.all(), [&](const ContactSurface& surface) {
        const Material& material = kinematics.material_of(surface.surface);
        const double approach = kinematics.surface_normal_speed(surface) - dot(arriving.velocity, surface.normal);
        if (surface.is_support || !(approach > 0.0)) return true;
        return !material.is_random() && material.restitution_at(approach) * approach < step_.resting_speed();
    });
}

/// Removes the velocity into the surfaces. Returns false if they leave the particle no way out.
bool SharedContact::land() {
    const SurfaceKinematics& kinematics = step_.impact().surfaces();
    const double before = fastest();
    const bool has_landed = std::ranges::all_of(surfaces_.all(), [&](const SharedSurface& touched) {
        return surfaces_.separation_speed(touched) >= -kStopRounding * before;
    });
    if (has_landed) return true;
    std::array<ImpactSurface, kMostSupports> landing;
    for (std::size_t k = 0; k < surfaces_.size(); ++k) landing[k] = kinematics.landing_on(surfaces_[k].surface);
    const ImpactResult result =
        solve_impact(particle().motion(), state().radius, std::span(landing).first(surfaces_.size()));
    particle().set_motion(result.after);
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        if (result.velocity_change[k] != Vec3{}) {
            ledger().record_impulse(surfaces_[k].surface.surface, result.velocity_change[k], false);
        }
    }
    const double scale = before + length(state().velocity);
    return std::ranges::all_of(surfaces_.all(), [&](const SharedSurface& touched) {
        return kinematics.separation_speed(touched.surface) >= -kSlowSlip * scale;
    });
}

/// Returns the speed, m/s, that scales the rounding of departures: beside a surface at rest, the velocity of a particle
/// that another one has stopped there is rounded by the speed of that one.
double SharedContact::fastest() const {
    double carried = 0.0;
    for (const SharedSurface& touched : surfaces_.all()) carried = std::max(carried, length(touched.velocity));
    return length(state().velocity) + carried;
}

/// Plans an interval without the slow departures that bounces have left. Drops surfaces that do not press.
SharedContact::SupportKind SharedContact::settle(double duration) {
    const Vec3 leaving = state().velocity;
    for (;;) {
        ShortestShift shift;
        std::array<double, kMostSupports> departures{};
        const std::size_t before = surfaces_.size();
        for (std::size_t k = 0; k < before; ++k) {
            departures[k] = -surfaces_.separation_speed(surfaces_[k]);
            shift.add(surfaces_[k].surface.normal, departures[k]);
        }
        state().velocity += shift.vector();
        const SupportKind kind = plan(duration);
        std::size_t left = 0;
        const auto is_kept = [&](std::size_t k) { return interval_.reaction[k] != Vec3{} || !(departures[k] < 0.0); };
        for (std::size_t k = 0; k < surfaces_.size(); ++k) left += is_kept(k) ? 1 : 0;
        if (left == before || left == 0 || kind != SupportKind::shared) {
            if (kind == SupportKind::shared) {
                ledger().record_impulse(surfaces_[0].surface.surface, state().velocity - leaving, false);
            } else {  // the surfaces of one frame resolve a departure by themselves
                state().velocity = leaving;
            }
            return kind;
        }
        surfaces_.keep_if(is_kept);
        state().velocity = leaving;
    }
}

/// Plans the next interval in the frame in which no surface advances. If one frame supports alone, drops the others.
SharedContact::SupportKind SharedContact::plan(double duration) {
    const std::size_t count = surfaces_.size();
    ShortestShift shift;
    for (const SharedSurface& touched : surfaces_.all()) {
        shift.add(touched.surface.normal, dot(touched.velocity, touched.surface.normal));
    }
    shift_ = shift.vector();
    std::array<SupportSurface, kMostSupports> constraints;
    for (std::size_t k = 0; k < count; ++k) constraints[k] = surfaces_.constraint(surfaces_[k], shift_);
    const std::span<const SupportSurface> all(constraints.data(), count);
    const Vec3 forces = step_.rules().forces.acceleration(state());
    const double reach = kTouchingOffsets * contact_offset(state().position);
    const FrictionLimits grip{1.0, step_.duration() / kShortestIntervals, reach};
    const Motion motion{state().velocity - shift_, particle().spin};
    // A slower slip is rounding of an impact that has stopped it. If friction just suffices to hold the particle,
    // nothing else would end that slip, whose direction turns at once.
    const double slow = kNegligibleSpeed * duration * length(forces);
    interval_ = plan_interval(motion, state().radius, forces, all, grip, duration,
                              sticking_surfaces(motion, state().radius, all, slow));
    std::optional<BodyId> holder;
    bool is_shared = false;
    for (std::size_t k = 0; k < count; ++k) {
        if (interval_.reaction[k] == Vec3{}) continue;
        is_shared = is_shared || (holder && *holder != surfaces_[k].body) || surfaces_.deforms(surfaces_[k]);
        holder = surfaces_[k].body;
    }
    if (!holder) return SupportKind::none;
    if (is_shared) return SupportKind::shared;
    surfaces_.keep_if([&](std::size_t k) { return surfaces_[k].body == *holder; });
    return SupportKind::single;
}

/// Returns a position at a time, moved to the contact offset from pressing surfaces, and out of the others.
Vec3 SharedContact::kept_off(Vec3 end, double time) const {
    for (int pass = 0; pass < kCorrections; ++pass) {
        ShortestShift shift;
        for (std::size_t k = 0; k < surfaces_.size(); ++k) {
            const SharedSurfaces::Height height = surfaces_.height_above(surfaces_[k], end, time);
            const double missing = state().radius + height.offset - height.above;
            if (interval_.reaction[k] == Vec3{} && !(missing > 0.0)) continue;
            shift.add(height.normal, missing);
        }
        end += shift.vector();
    }
    return flush_tiny(end);
}

/// Moves the particle to the contact offset if it has come so near to a surface that rounding would decide its side. A
/// certified path may end nearer to the surfaces that it follows than positions are rounded.
void SharedContact::lift() {
    const bool is_low = std::ranges::any_of(surfaces_.all(), [&](const SharedSurface& touched) {
        const SharedSurfaces::Height height = surfaces_.height_above(touched, state().position, state().time);
        return height.above - state().radius < 0.25 * height.offset;
    });
    if (is_low) shift_to(step_, kept_off(state().position, state().time));
}

/// Lifts the middle of a path by 4 s (1 - s) of a height, over its duration. By the cubic's error, a point's path can
/// lie behind surfaces that turn. The lift turns with the surfaces, and is the same for all: a lift off one alone would
/// lead into another.
void SharedContact::lift_middle(Path& path) const {
    ShortestShift at_start;
    ShortestShift at_end;
    bool is_behind = false;
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        const auto height_at = [&](double time) {
            return surfaces_.height_above(surfaces_[k], path.position(time), state().time + time);
        };
        double behind = 0.0;
        for (const double part : {0.1, 0.25, 0.5, 0.75, 0.9}) {
            const SharedSurfaces::Height height = height_at(part * path.duration);
            const double missing = state().radius + height.offset - height.above;
            behind = std::max(behind, missing / (4.0 * part * (1.0 - part)));
        }
        if (behind <= (surfaces_.deforms(surfaces_[k]) ? 0.0 : 0.5 * state().radius)) behind = 0.0;
        if (interval_.reaction[k] == Vec3{} && behind == 0.0) continue;
        is_behind = is_behind || behind > 0.0;
        at_start.add(height_at(0.0).normal, behind);
        at_end.add(height_at(path.duration).normal, behind);
    }
    if (!is_behind) return;
    const Vec3 first = (4.0 / path.duration) * at_start.vector();
    const Vec3 last = (4.0 / path.duration) * at_end.vector();
    const Vec3 turn = last - first;
    path.c[1] += first;
    path.c[2] += (turn - first) / path.duration;
    path.c[3] -= turn / path.duration / path.duration;
    path.degree = std::max(path.degree, turn == Vec3{} ? 2 : 3);
}

/// Returns the path of an interval, which ends beside the surfaces at their later positions.
Path SharedContact::interval_path(double duration) const {
    const Vec3 velocity = interval_.motion.velocity + shift_;
    const Vec3 last = velocity + duration * interval_.acceleration;
    const Vec3 end = state().position + duration * (velocity + (0.5 * duration) * interval_.acceleration);
    const double until = duration >= step_.remaining() ? particle().step_end : state().time + duration;
    Path path = hermite_path(state().position, velocity, kept_off(end, until), last, duration);
    if (path.duration > 0.0) lift_middle(path);
    return path;
}

/// Returns the same path, ended where a surface ends. `duration`, in s, is shortened to that.
Path SharedContact::path_until_rim(double& duration) const {
    Path path = interval_path(duration);
    if (const double on = until_rim(path); on < duration) {
        duration = on;
        path = interval_path(duration);
    }
    return path;
}

/// Returns the time, in s, in which a path is over the faces of deforming meshes that support the particle. In the edge
/// of two faces the path bulges off one of them and so beyond the rim of the other, so positions are put back first.
double SharedContact::until_rim(const Path& path) const {
    const auto position_at = [&](double at) {
        return at < path.duration ? kept_off(path.position(at), state().time + at) : path.end;
    };
    double most = path.duration;
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        const SharedSurface& touched = surfaces_[k];
        if (interval_.reaction[k] == Vec3{} || !surfaces_.deforms(touched) || !touched.surface.flat) continue;
        const DeformedContact contact{touched.surface, touched.others};
        most = std::min(most, time_over(surfaces_.deforming(), contact, position_at, path.duration, state().time));
    }
    return most;
}

/// Returns the change of velocity, m/s, by a surface in an interval. About an edge, half of it has its last direction.
Vec3 SharedContact::velocity_change_of(std::size_t k, double elapsed, bool has_arrived) const {
    const SharedSurface& touched = surfaces_[k];
    const Vec3 reaction = elapsed * interval_.reaction[k];
    if (reaction == Vec3{} || !has_arrived || !surfaces_.deforms(touched) || touched.surface.flat) return reaction;
    const Vec3& n = touched.surface.normal;
    const Vec3 last = surfaces_.height_above(touched, state().position, state().time).normal;
    return reaction + 0.5 * dot(reaction, n) * (last - n);
}

/// Applies and records the reactions of an interval that has lasted for `elapsed` seconds.
void SharedContact::take_reactions(double elapsed, bool has_arrived) {
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        const Vec3 change = velocity_change_of(k, elapsed, has_arrived);
        if (has_arrived) state().velocity += change - elapsed * interval_.reaction[k];
        if (change != Vec3{}) ledger().record_impulse(surfaces_[k].surface.surface, change, false);
    }
}

/// Follows the planned interval, for at most a time in s.
SharedContact::Followed SharedContact::follow_interval(double most) {
    step_.log().note_impact();
    const double before = step_.remaining();
    const Vec3 forces = step_.rules().forces.acceleration(state());
    const Vec3 velocity = interval_.motion.velocity + shift_;
    // An interval that ends at once takes the shortest time.
    const double shortest = std::min(before, step_.duration() / kShortestIntervals);
    Followed followed{interval_.duration > 0.0 ? interval_.duration : std::min(shortest, most)};
    const Path path = path_until_rim(followed.duration);
    // Between its ends a path lies beside surfaces that turn, so it is planned anew up to a contact.
    RefinementBudget budget;
    const auto refine = [&](double time, const Path& tried) -> std::optional<Path> {
        if (!(time > 0.0)) return {};
        Path next = interval_path(time);
        if (!budget.may_improve(tried.position(time), next.end, contact_offset(next.end))) return {};
        followed.duration = time;
        return next;
    };
    const std::vector<SurfaceId> supports = surfaces_.supporting(path);
    followed.contact = follow_path(step_, path, supports, refine);
    if (followed.contact) lift();
    const double elapsed = before - step_.remaining();
    const bool has_arrived = !followed.contact;
    // The path also corrects the distance from the surfaces. In a short interval that would be a wrong velocity.
    if (has_arrived || surfaces_.is_any_deforming()) state().velocity = velocity + elapsed * interval_.acceleration;
    take_reactions(elapsed, has_arrived);
    particle().spin = interval_.motion.spin + elapsed * interval_.spin_acceleration;
    ledger().note_driven();
    step_.log().note_contact(forces, path, true, supports);
    return followed;
}

/// Returns true if the particle is at rest relative to all surfaces that press on it.
bool SharedContact::rests() const {
    bool is_supported = false;
    for (std::size_t k = 0; k < surfaces_.size(); ++k) {
        if (interval_.reaction[k] == Vec3{}) continue;
        const SharedSurface& touched = surfaces_[k];
        const double rounding = kStopRounding * (length(state().velocity) + length(touched.velocity));
        if (length(state().velocity - touched.velocity) > rounding) return false;
        const Vec3 turning = step_.impact().surfaces().angular_velocity_of(touched.surface.surface);
        if (state().radius * length(particle().spin - turning) > rounding) return false;
        is_supported = true;
    }
    return is_supported;
}

std::optional<Contact> SharedContact::follow() {
    particle().contact = {};
    bool has_jumped = false;
    for (int count = 0; count < kMostContactIntervals && step_.has_intervals() && step_.remaining() > 0.0; ++count) {
        step_.note_interval();
        ledger().note_driven();
        surfaces_.gather();
        if (surfaces_.size() == 0) return std::nullopt;
        if (!land()) {
            step_.log().note_impact();
            give_up(step_);
            return std::nullopt;
        }
        const std::optional<double> jump = surfaces_.next_jump();
        double most = std::min(step_.remaining(), surfaces_.longest_interval());
        if (jump) most = std::clamp(*jump - state().time, 0.0, most);
        const SupportKind kind = settle(most);
        if (kind == SupportKind::single) particle().contact = surfaces_.contact_state();
        if (kind != SupportKind::shared) return std::nullopt;
        const double begin = state().time;
        Followed followed = follow_interval(most);
        if (followed.contact) {
            surfaces_.join_impact(*followed.contact);
            return followed.contact;
        }
        has_jumped = jump && followed.duration >= *jump - begin;
        if (has_jumped) break;
    }
    // At a jump the body gets another velocity, and the particle keeps its own.
    if (step_.remaining() <= 0.0 && !has_jumped) {
        particle().contact = surfaces_.contact_state();
        if (rests()) step_.outcome().end = MoveEnd::resting;
    }
    return std::nullopt;
}

}  // namespace ricochet
