#include "ricochet/response/shared_contact.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/carried_particle.h"
#include "ricochet/response/curved_contact.h"
#include "ricochet/response/deformed_surface.h"
#include "ricochet/response/impact_problem.h"
#include "ricochet/response/path_motion.h"

namespace ricochet {
namespace {

/// Corrections of the end of an interval. Each squares the relative error. Local: it ends below the rounding of the
/// result.
constexpr int kCorrections = 3;

}  // namespace

bool SharedContact::is_slow(const Contact& contact, const Motion& arriving) const {
    return std::all_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
        const Material& material = surfaces().material_of(surface.surface);
        const double approach = surfaces().surface_normal_speed(surface) - dot(arriving.velocity, surface.normal);
        if (surface.is_support || !(approach > 0.0)) return true;
        return !material.is_random() && material.restitution_at(approach) * approach < step_.resting_speed();
    });
}

/// Loses what leads into the surfaces; false where they leave it no way out.
bool SharedContact::land() {
    const double before = fastest();
    // What goes on along all of them has landed already.
    const bool is_along = std::all_of(touched().begin(), touched().end(), [&](const Touched& one) {
        return separation_speed(one) >= -kStopRounding * before;
    });
    if (is_along) return true;
    std::array<ImpactSurface, kMostSupports> landing;
    for (std::size_t k = 0; k < count_; ++k) landing[k] = surfaces().landing_on(touched_[k].surface);
    const ImpactResult result =
        solve_impact({state().velocity, particle().spin}, state().radius, std::span(landing).first(count_));
    state().velocity = result.after.velocity;
    particle().spin = result.after.spin;
    for (std::size_t k = 0; k < count_; ++k) {
        if (result.velocity_change[k] != Vec3{}) {
            ledger().record_impulse(touched_[k].surface.surface, result.velocity_change[k], false);
        };
    }
    const double scale = before + length(state().velocity);
    return std::all_of(touched().begin(), touched().end(), [&](const Touched& one) {
        return surfaces().separation_speed(one.surface) >= -kSlowSlip * scale;
    });
}

/// Returns the speed, m/s, that scales the rounding of departures: beside a surface at rest, the velocity of a particle
/// that another one has stopped there is rounded by the speed of that one.
double SharedContact::fastest() const {
    double carried = 0.0;
    for (const Touched& one : touched()) carried = std::max(carried, length(one.velocity));
    return length(state().velocity) + carried;
}

/// Plans without the slow departures that are left of bounces on what presses the particle on: they have died out. What
/// does not press is left.
SharedContact::SupportKind SharedContact::settle(double duration) {
    const Vec3 leaving = state().velocity;
    for (;;) {
        std::array<Vec3, kMostSupports> normals;
        std::array<double, kMostSupports> departures{};
        for (std::size_t k = 0; k < count_; ++k) {
            normals[k] = touched_[k].surface.normal;
            departures[k] = -separation_speed(touched_[k]);
        }
        state().velocity += shift_by({normals.data(), count_}, {departures.data(), count_});
        const std::size_t before = count_;
        const SupportKind hold = plan(duration);
        std::size_t contact_state = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            const bool is_left = interval_.reaction[k] == Vec3{} && departures[k] < 0.0;
            if (!is_left) touched_[contact_state++] = touched_[k];
        }
        if (contact_state == before || contact_state == 0 || hold != SupportKind::shared) {
            // Surfaces of one frame answer the departure from them by themselves.
            if (hold != SupportKind::shared) state().velocity = leaving;
            if (hold == SupportKind::shared) {
                ledger().record_impulse(touched_[0].surface.surface, state().velocity - leaving, false);
            }
            return hold;
        }
        count_ = contact_state;
        state().velocity = leaving;
    }
}

/// Where it slips no faster than `most`, m/s: rounding of an impact that has stopped it. Where friction is just what
/// holds it, nothing else would end that slip, whose direction turns at once.
StuckSurfaces SharedContact::sticking(const Motion& motion, std::span<const SupportSurface> surfaces,
                                      double most) const {
    StuckSurfaces stuck{};
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        stuck[k].to_slip = surfaces[k].friction > 0.0 && length(slip_on(surfaces[k], motion, state().radius)) <= most;
    }
    return stuck;
}

/// Plans the next interval in the frame in which none of the surfaces advances.
SharedContact::SupportKind SharedContact::plan(double duration) {
    std::array<Vec3, kMostSupports> normals;
    std::array<double, kMostSupports> advances{};
    std::array<SupportSurface, kMostSupports> surfaces;
    for (std::size_t k = 0; k < count_; ++k) {
        normals[k] = touched_[k].surface.normal;
        advances[k] = dot(touched_[k].velocity, normals[k]);
    }
    shift_ = shift_by({normals.data(), count_}, {advances.data(), count_});
    for (std::size_t k = 0; k < count_; ++k) surfaces[k] = supports(touched_[k], shift_);
    const Vec3 forces = step_.rules().forces.acceleration(state());
    const double reach = kTouchingOffsets * contact_offset(state().position);
    const FrictionLimits grip{1.0, step_.duration() / kShortestIntervals, reach};
    const Motion motion{state().velocity - shift_, particle().spin};
    const std::span<const SupportSurface> supporting_it(surfaces.data(), count_);
    interval_ = plan_interval(motion, state().radius, forces, supporting_it, grip, duration,
                              sticking(motion, supporting_it, kNegligibleSpeed * duration * length(forces)));
    std::optional<BodyId> holder;
    bool is_shared = false;
    for (std::size_t k = 0; k < count_; ++k) {
        if (interval_.reaction[k] == Vec3{}) continue;
        is_shared = is_shared || (holder && *holder != touched_[k].body) || deforms(touched_[k]);
        holder = touched_[k].body;
    }
    if (!holder) return SupportKind::none;
    if (is_shared) return SupportKind::shared;
    // One frame's surfaces hold it; others are only touched.
    std::size_t contact_state = 0;
    for (std::size_t k = 0; k < count_; ++k) {
        if (touched_[k].body == *holder) touched_[contact_state++] = touched_[k];
    }
    count_ = contact_state;
    return SupportKind::single;
}

/// A position at a time put at the contact offset from the surfaces that press on it, and not behind others.
Vec3 SharedContact::kept_off(Vec3 end, double time) const {
    for (int pass = 0; pass < kCorrections; ++pass) {
        std::array<Vec3, kMostSupports> normals;
        std::array<double, kMostSupports> lifts{};
        std::size_t count = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            const Height height = height_above(touched_[k], end, time);
            const double missing = state().radius + height.offset - height.above;
            if (interval_.reaction[k] == Vec3{} && !(missing > 0.0)) continue;
            normals[count] = height.normal;
            lifts[count++] = missing;
        }
        end += shift_by({normals.data(), count}, {lifts.data(), count});
    }
    return flush_tiny(end);
}

/// A path is certified to touch nothing that it goes along, but may end nearer to it than positions are rounded there.
/// On which side of the surface it is would be rounding from then on: puts it at the contact offset.
void SharedContact::lift() {
    const bool is_low = std::any_of(touched().begin(), touched().end(), [&](const Touched& one) {
        const Height height = height_above(one, state().position, state().time);
        return height.above - state().radius < 0.25 * height.offset;
    });
    if (is_low) shift_to(step_, kept_off(state().position, state().time));
}

/// Between its ends the path of a point can be behind surfaces that turn, by the cubic's error, where it would be
/// stopped: lifts it, by 4 s (1 - s) of a height over its duration. The lift turns with the surfaces, and is one for
/// all of them: one off each surface by itself would lead into others that hold the particle as well.
void SharedContact::lift_middle(Path& path) const {
    std::array<Vec3, kMostSupports> normals;
    std::array<Vec3, kMostSupports> last_normals;
    std::array<double, kMostSupports> lifts{};
    std::size_t count = 0;
    bool is_behind = false;
    for (std::size_t k = 0; k < count_; ++k) {
        const auto height_at = [&](double time) {
            return height_above(touched_[k], path.position(time), state().time + time);
        };
        double behind = 0.0;
        for (const double part : {0.1, 0.25, 0.5, 0.75, 0.9}) {
            const Height height = height_at(part * path.duration);
            const double missing = state().radius + height.offset - height.above;
            behind = std::max(behind, missing / (4.0 * part * (1.0 - part)));
        }
        if (behind <= (deforms(touched_[k]) ? 0.0 : 0.5 * state().radius)) behind = 0.0;
        if (interval_.reaction[k] == Vec3{} && behind == 0.0) continue;
        is_behind = is_behind || behind > 0.0;
        normals[count] = height_at(0.0).normal;
        last_normals[count] = height_at(path.duration).normal;
        lifts[count++] = behind;
    }
    if (!is_behind) return;
    const Vec3 first = (4.0 / path.duration) * shift_by({normals.data(), count}, {lifts.data(), count});
    const Vec3 last = (4.0 / path.duration) * shift_by({last_normals.data(), count}, {lifts.data(), count});
    const Vec3 turn = last - first;
    path.c[1] += first;
    path.c[2] += (turn - first) / path.duration;
    path.c[3] -= turn / path.duration / path.duration;
    path.degree = std::max(path.degree, turn == Vec3{} ? 2 : 3);
}

/// Along the interval, to where the surfaces will be.
Path SharedContact::interval_path(double duration) const {
    const Vec3 velocity = interval_.motion.velocity + shift_;
    const Vec3 last = velocity + duration * interval_.acceleration;
    const Vec3 end = state().position + duration * (velocity + (0.5 * duration) * interval_.acceleration);
    const double until = duration >= step_.remaining() ? particle().step_end : state().time + duration;
    Path path = hermite_path(state().position, velocity, kept_off(end, until), last, duration);
    if (path.duration > 0.0) lift_middle(path);
    return path;
}

/// m/s, what a surface has changed the velocity by in an interval: about an edge as much in its direction at the end as
/// in that at the start.
Vec3 SharedContact::velocity_change_of(std::size_t k, double elapsed, bool has_arrived) const {
    const Touched& one = touched_[k];
    const Vec3 reaction = elapsed * interval_.reaction[k];
    if (reaction == Vec3{} || !has_arrived || !deforms(one) || one.surface.flat) return reaction;
    const Vec3& n = one.surface.normal;
    return reaction + 0.5 * dot(reaction, n) * (height_above(one, state().position, state().time).normal - n);
}

/// Relative to all that presses on it.
bool SharedContact::rests() const {
    bool is_held = false;
    for (std::size_t k = 0; k < count_; ++k) {
        if (interval_.reaction[k] == Vec3{}) continue;
        const Touched& one = touched_[k];
        const double rounding = kStopRounding * (length(state().velocity) + length(one.velocity));
        if (length(state().velocity - one.velocity) > rounding) return false;
        const Vec3 turning = surfaces().angular_velocity_of(one.surface.surface);
        if (state().radius * length(particle().spin - turning) > rounding) return false;
        is_held = true;
    }
    return is_held;
}

/// The same, to where a surface ends: `duration`, s, is shortened to that.
Path SharedContact::path_until_rim(double& duration) const {
    Path path = interval_path(duration);
    if (const double on = until_rim(path); on < duration) {
        duration = on;
        path = interval_path(duration);
    }
    return path;
}

/// Follows the interval that is planned, of at most so long, s.
SharedContact::Followed SharedContact::follow_interval(double most) {
    step_.log().note_impact();
    const double before = step_.remaining();
    const Vec3 forces = step_.rules().forces.acceleration(state());
    const Vec3 velocity = interval_.motion.velocity + shift_;
    // What ends at once has ended after the shortest interval.
    const double shortest = std::min(before, step_.duration() / kShortestIntervals);
    Followed followed;
    followed.duration = interval_.duration > 0.0 ? interval_.duration : std::min(shortest, most);
    const Path path = path_until_rim(followed.duration);
    // Between its ends the path is beside surfaces that turn; up to a contact it ends on them as well.
    RefinementBudget looks;
    const auto closer = [&](double time, const Path& tried) -> std::optional<Path> {
        if (!(time > 0.0)) return {};
        Path next = interval_path(time);
        if (!looks.may_improve(tried.position(time), next.end, contact_offset(next.end))) return {};
        followed.duration = time;
        return next;
    };
    const std::vector<SurfaceId> supported_by = supporting(path);
    followed.contact = follow_path(step_, path, supported_by, closer);
    if (followed.contact) lift();
    const double elapsed = before - step_.remaining();
    const bool has_arrived = !followed.contact;
    // The path also makes good what the particle stands off, which in a short interval is no velocity of its own.
    if (has_arrived || is_on_deforming()) state().velocity = velocity + elapsed * interval_.acceleration;
    for (std::size_t k = 0; k < count_; ++k) {
        const Vec3 reaction = velocity_change_of(k, elapsed, has_arrived);
        if (has_arrived) state().velocity += reaction - elapsed * interval_.reaction[k];
        if (reaction != Vec3{}) ledger().record_impulse(touched_[k].surface.surface, reaction, false);
    }
    particle().spin = interval_.motion.spin + elapsed * interval_.spin_acceleration;
    ledger().note_driven();
    step_.log().note_contact(forces, path, true, supported_by);
    return followed;
}

std::optional<Contact> SharedContact::follow() {
    particle().contact = {};
    bool has_jumped = false;
    for (int count = 0; count < kMostContactIntervals && step_.has_intervals() && step_.remaining() > 0.0; ++count) {
        step_.note_interval();
        ledger().note_driven();
        gather();
        if (count_ == 0) return std::nullopt;
        if (!land()) {
            step_.log().note_impact();
            give_up(step_);
            return std::nullopt;
        }
        const std::optional<double> jump = next_jump();
        double most = std::min(step_.remaining(), longest());
        if (jump) most = std::clamp(*jump - state().time, 0.0, most);
        const SupportKind hold = settle(most);
        if (hold == SupportKind::single) particle().contact = contact_state();
        if (hold != SupportKind::shared) return std::nullopt;
        const double begin = state().time;
        Followed followed = follow_interval(most);
        if (followed.contact) {
            join_impact(*followed.contact);
            return followed.contact;
        }
        has_jumped = jump && followed.duration >= *jump - begin;
        if (has_jumped) break;
    }
    // At a jump a body goes on with another velocity, and the particle with its own.
    if (step_.remaining() <= 0.0 && !has_jumped) {
        particle().contact = contact_state();
        if (rests()) step_.outcome().end = MoveEnd::resting;
    }
    return std::nullopt;
}

}  // namespace ricochet
