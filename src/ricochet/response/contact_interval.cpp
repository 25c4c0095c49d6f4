#include "ricochet/response/contact_interval.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/single_contact.h"
#include "ricochet/response/sphere_contact.h"

namespace ricochet {
namespace {

/// Largest number of consecutive plans for one interval. Another plan is made if a motion stops at once. The last plan
/// is always accepted. Local: the next interval goes on.
constexpr int kMostPlans = 4;

/// A resistance at a surface, and the motion that it resists.
struct Resistance {
    enum class Kind { slip, turning, spinning };

    std::size_t surface = 0;
    Kind kind = Kind::slip;
    Vec3 rate;           ///< slip, or radius times angular velocity along the surface or about its normal, m/s
    double speed = 0.0;  ///< 0 if it is stuck
    Vec3 heading;        ///< unit, direction of the resisted motion; only if the speed is above 0
    bool slips = false;  ///< the load exceeds the static friction, so the slip begins
};

bool& is_stuck(Stuck& stuck, Resistance::Kind kind) {
    if (kind == Resistance::Kind::slip) return stuck.to_slip;
    return kind == Resistance::Kind::turning ? stuck.to_turning : stuck.to_spinning;
}

/// Returns a vector after the shortest rotation that turns one unit vector into another.
Vec3 turned_with(const Vec3& v, const Vec3& from, const Vec3& to) {
    if (from == to) return v;
    const Vec3 sum = from + to;
    return v - (dot(sum, v) / (1.0 + dot(from, to))) * sum + (2.0 * dot(from, v)) * to;
}

/// Returns true if no surface moves. Between moving surfaces a particle may be drawn in, and its slip need not stop.
bool are_at_rest(std::span<const SupportSurface> surfaces) {
    return std::ranges::all_of(surfaces, [](const SupportSurface& surface) {
        return surface.velocity == Vec3{} && surface.angular_velocity == Vec3{} && surface.motion == nullptr;
    });
}

/// One plan: the forces on a moving particle, and the time for which they are constant. seen: the surfaces at the
/// start, along which the given motion leads. surfaces: the same surfaces, with normals at the time for which forces
/// are computed.
class Plan {
public:
    Plan(const Motion& motion, double radius, const Vec3& a, std::span<const SupportSurface> seen,
         std::span<const SupportSurface> surfaces, const FrictionLimits& grip, double duration,
         const StuckSurfaces& stuck)
        : motion_(motion), radius_(radius), a_(a), seen_(seen), surfaces_(surfaces), grip_(grip), duration_(duration) {
        find_resistances(stuck);
        do solve();
        while (lets_slip());
    }

    [[nodiscard]] ContactInterval interval() {
        if (rests()) return {motion_, {}, {}, duration_, true, 0.0, false, reactions_, {}};
        if (jams_ && duration_ > 0.0) return jammed();
        double duration = time_to_turn();
        double turn = turn_in(duration);
        if (turn > kMostStraightTurn) {
            duration = std::min(duration, time_to_change());
            turn = turn_in(duration);
        }
        if (turn > kStraightHeading) solve_for_middle(duration);
        ContactInterval interval{motion_, acceleration_, spin_acceleration_, duration, false,
                                 turn,    false,         reactions_,         {}};
        stop(interval);
        interval.is_stiff = is_stiff(interval.duration);
        interval.jams = jams();
        return interval;
    }

    /// Returns true if a resistance sticks although its motion has not quite stopped. It must not do work on this
    /// motion.
    [[nodiscard]] bool drags(const ContactInterval& interval) const {
        return std::any_of(resistances_.begin(), resistances_.begin() + count_, [&](const Resistance& r) {
            StuckSurfaces stuck = interval.stuck;
            return r.speed == 0.0 && r.rate != Vec3{} && is_stuck(stuck[r.surface], r.kind) &&
                   length(r.rate) > kStopRounding * speed_scale(motion_, radius_, seen_);
        });
    }

private:
    using Kind = Resistance::Kind;

    [[nodiscard]] bool is_sphere() const { return radius_ > 0.0; }
    [[nodiscard]] std::span<Resistance> resistances() { return {resistances_.data(), count_}; }

    /// Returns true if the particle jams at the start, or in the middle of the interval.
    [[nodiscard]] bool jams() const { return jams_ || jams_in_middle_; }

    /// Returns an interval in which all slip stops at once: only an impulse satisfies the law of friction (Stewart
    /// 2000).
    [[nodiscard]] ContactInterval jammed() const {
        ContactInterval interval{motion_, acceleration_, spin_acceleration_, 0.0, false, 0.0, false, reactions_, {}};
        for (const Resistance& r : std::span(resistances_).first(count_))
            is_stuck(interval.stuck[r.surface], r.kind) = true;
        interval.ends_at_once = interval.jams = true;
        return interval;
    }

    void find_resistances(StuckSurfaces stuck) {
        const double scale = speed_scale(motion_, radius_, seen_);
        const auto add = [&](std::size_t surface, Kind kind, const Vec3& rate) {
            const double speed = length(rate);
            Resistance& added = resistances_[count_++];
            added = {surface, kind, rate, 0.0, {}, false};
            if (is_stuck(stuck[surface], kind) || !(speed > kSlowSlip * scale)) return;
            added.speed = speed;
            added.heading = rate / speed;
        };
        for (std::size_t k = 0; k < surfaces_.size(); ++k) {
            const SupportSurface& surface = surfaces_[k];
            const Vec3& n = seen_[k].normal;
            const auto carried = [&](const Vec3& rate) { return turned_with(rate, n, surface.normal); };
            if (surface.friction > 0.0) add(k, Kind::slip, carried(slip_on(seen_[k], motion_, radius_)));
            if (!is_sphere()) continue;
            const Vec3 spin = motion_.spin - surface.angular_velocity;
            const Vec3 spinning = dot(spin, n) * n;
            if (surface.rolling_friction > 0.0) add(k, Kind::turning, carried(radius_ * (spin - spinning)));
            if (surface.spinning_friction > 0.0) add(k, Kind::spinning, carried(radius_ * spinning));
        }
    }

    /// Marks the resistances whose static friction does not hold their load. Returns true if there are new ones.
    [[nodiscard]] bool lets_slip() {
        bool is_new = false;
        for (Resistance& r : resistances()) {
            const SupportSurface& surface = surfaces_[r.surface];
            if (r.kind != Kind::slip || r.speed > 0.0 || r.slips) continue;
            if (!(surface.static_friction > surface.friction)) continue;
            r.slips = length(change_of(r)) > kSupportRounding * scale();
            is_new = is_new || r.slips;
        }
        return is_new;
    }

    void solve() {
        if (const auto forces = forces_of_single_surface()) {
            const Vec3& n = surfaces_[0].normal;
            reactions_[0] = forces->normal * n;
            if (surfaces_[0].friction > 0.0) reactions_[0] += along_tangents(forces->resistance[0], n);
            acceleration_ = a_ + velocity_of(forces->change);
            accept(forces->change);
        } else {
            solve_problem();
        }
    }

    [[nodiscard]] CoulombContact contact(const SupportSurface& surface) const {
        return {normal_direction(surface.normal), dot(a_, surface.normal) + surface.curvature};
    }

    /// Returns the closed form, if there is a single surface. Friction is its first resistance.
    [[nodiscard]] std::optional<SingleContactForces> forces_of_single_surface() const {
        if (surfaces_.size() != 1) return std::nullopt;
        std::array<CoulombResistance, kMostOfSurface> resistances;
        for (std::size_t r = 0; r < count_; ++r) resistances[r] = resistance(resistances_[r]);
        return solve_single_contact(contact(surfaces_[0]), std::span(resistances).first(count_), grip_.pressure);
    }

    void solve_problem() {
        CoulombProblem problem;
        for (const SupportSurface& surface : surfaces_) problem.add(contact(surface));
        for (const Resistance& r : resistances()) problem.add(resistance(r));
        // Only a sliding particle can jam. For a particle at rest, a solution always exists.
        const bool slides = std::ranges::any_of(resistances(), [](const Resistance& r) { return r.speed > 0.0; });
        const auto effort = slides ? CoulombProblem::Effort::some : CoulombProblem::Effort::all;
        const double part = problem.solve_with_most(effort, grip_.pressure);
        const bool jams = slides && part < kJammingFriction && are_at_rest(surfaces_);
        if (jams) (weight_ == 0.0 ? jams_ : jams_in_middle_) = true;
        for (std::size_t k = 0; k < surfaces_.size(); ++k) reactions_[k] = problem.reaction(k) * surfaces_[k].normal;
        for (std::size_t r = 0; r < count_; ++r) {
            const std::size_t k = resistances_[r].surface;
            if (resistances_[r].kind == Kind::slip)
                reactions_[k] += along_tangents(problem.force_of(r), surfaces_[k].normal);
        }
        const MotionVector change = problem.change();
        acceleration_ = a_ + velocity_of(change);
        if (!problem.is_solved()) stay_on_surfaces();
        accept(change);
    }

    /// Sets the accelerations from a change of the motion. Rounding does not set a resting particle in motion.
    void accept(const MotionVector& change) {
        if (motion_.velocity == Vec3{} && length(acceleration_) <= kSupportRounding * scale()) acceleration_ = {};
        if (is_sphere()) spin_acceleration_ = (kTurning / radius_) * turning_of(change);
    }

    /// Removes the accelerations into the surfaces. Needed if the solver has found no solution.
    void stay_on_surfaces() {
        ShortestShift lift;
        for (const SupportSurface& surface : surfaces_) {
            const double into = -dot(acceleration_, surface.normal) - surface.curvature;
            if (into > 0.0) lift.add(surface.normal, into);
        }
        acceleration_ += lift.vector();
    }

    /// Returns the equation of a resistance. It opposes the motion at the start, or for solve_for_middle() in the
    /// middle of the interval. Without motion, it opposes the rate that forces and curvature would cause.
    [[nodiscard]] CoulombResistance resistance(const Resistance& r) const {
        CoulombResistance result = at_rest(r);
        const bool is_implicit = weight_ > 0.0 && r.speed > 0.0;
        const Vec3& n = surfaces_[r.surface].normal;
        const auto [first, second] = tangent_frame(n);
        result.is_moving = r.speed > 0.0 && !is_implicit;
        std::array<double, 2> own{dot(r.rate, first), dot(r.rate, second)};
        if (result.is_moving) result.heading = {dot(r.heading, first), dot(r.heading, second)};
        if (r.kind == Kind::spinning) {
            result.heading = {dot(r.heading, n) < 0.0 ? -1.0 : 1.0, 0.0};
            own = {dot(r.rate, n), 0.0};
        }
        for (std::size_t d = 0; d < result.size && is_implicit; ++d) result.rate[d] += weight_ * own[d];
        return result;
    }

    [[nodiscard]] CoulombResistance at_rest(const Resistance& r) const {
        const SupportSurface& surface = surfaces_[r.surface];
        const auto contact = static_cast<std::uint32_t>(r.surface);
        const Vec3& n = surface.normal;
        if (r.kind == Kind::turning) {
            return rolling_resistance(contact, n, surface.rolling_friction, surface.turning_curvature);
        }
        if (r.kind == Kind::spinning) {
            return spinning_resistance(contact, n, surface.spinning_friction / radius_, surface.spinning_curvature * n);
        }
        const bool slips = r.speed > 0.0 || r.slips;
        const double friction = slips ? surface.friction : std::max(surface.friction, surface.static_friction);
        return sliding_friction(contact, surface.normal, friction, is_sphere(), a_ + surface.slip_curvature);
    }

    /// Returns true if the particle rests: its centre does not move, and nothing changes its motion.
    [[nodiscard]] bool rests() const {
        if (motion_.velocity != Vec3{}) return false;
        return length(acceleration_) + radius_ * length(spin_acceleration_) <= kSupportRounding * scale();
    }

    /// Returns the largest contribution to the accelerations, in m/s^2.
    [[nodiscard]] double scale() const {
        double largest = length(a_);
        for (const SupportSurface& surface : surfaces_) {
            largest = std::max({largest, std::fabs(surface.curvature), length(surface.slip_curvature),
                                length(surface.turning_curvature), std::fabs(surface.spinning_curvature)});
        }
        return largest;
    }

    /// Returns the rate, in m/s^2, at which all forces change the motion that a resistance opposes.
    [[nodiscard]] Vec3 change_of(const Resistance& r) const {
        const SupportSurface& surface = surfaces_[r.surface];
        const Vec3& n = surface.normal;
        const auto along = [&](const Vec3& v) { return v - dot(v, n) * n; };
        if (r.kind == Kind::slip) {
            return slip_velocity({acceleration_, spin_acceleration_}, radius_, n) + along(surface.slip_curvature);
        }
        const Vec3 turning = radius_ * spin_acceleration_;
        if (r.kind == Kind::turning) return along(turning) + along(surface.turning_curvature);
        return (dot(turning, n) + surface.spinning_curvature) * n;
    }

    /// Returns the time, in s, until the direction of some resistance has turned by kMaxHeadingTurn. If this time is
    /// very short, the direction may turn by up to kMostHeadingTurn.
    [[nodiscard]] double time_to_turn() {
        double duration = duration_;
        for (const Resistance& r : resistances()) {
            if (r.speed == 0.0) continue;
            const Vec3 change = change_of(r);
            const double braking = -dot(change, r.heading);
            const double turning = length(change + braking * r.heading);
            const auto until = [&](double angle) {
                const double rate = turning + angle * braking;  // a braked motion turns ever faster
                return rate > 0.0 ? angle * r.speed / rate : duration_;
            };
            const bool is_straight = turning <= kStraightHeading * std::max(braking, 0.0);
            if (is_straight || until(kMaxHeadingTurn) >= duration) continue;
            const double least = std::min(grip_.shortest, until(kMostHeadingTurn));
            duration = std::min(duration, std::max(least, until(kMaxHeadingTurn)));
        }
        return duration;
    }

    /// Returns the time, in s, until a resisted motion changes by kMaxSlipChange, at least FrictionLimits::shortest.
    [[nodiscard]] double time_to_change() {
        double duration = duration_;
        for (const Resistance& r : resistances()) {
            const double change = length(change_of(r));
            if (r.speed > 0.0 && change > 0.0) duration = std::min(duration, kMaxSlipChange * r.speed / change);
        }
        return std::max(duration, grip_.shortest);
    }

    /// Returns the largest angle, in rad, by which the direction of a resistance turns in a duration, in s. If the
    /// resisted motion stops earlier, only the time until then counts.
    [[nodiscard]] double turn_in(double duration) {
        double turn = 0.0;
        for (const Resistance& r : resistances()) {
            if (r.speed == 0.0) continue;
            const Vec3 change = change_of(r);
            const double braking = -dot(change, r.heading);
            const double moving = braking * duration > r.speed ? r.speed / braking : duration;
            turn = std::max(turn, moving * length(change + braking * r.heading) / r.speed);
        }
        return turn;
    }

    /// Returns true if friction could stop a motion within the fraction 1 / kStageLimit of the duration, in s. An
    /// explicit Runge-Kutta step would then be unstable.
    [[nodiscard]] bool is_stiff(double duration) {
        return std::ranges::any_of(resistances(), [&](const Resistance& r) {
            const SupportSurface& surface = surfaces_[r.surface];
            const double pressing = grip_.pressure * dot(reactions_[r.surface], surface.normal);
            const double most = r.kind == Kind::slip ? kSlipAcceleration * surface.friction * pressing
                                : r.kind == Kind::turning
                                    ? kTurning * kTurning * surface.rolling_friction * pressing
                                    : kTurning * kTurning * surface.spinning_friction / radius_ * pressing;
            return r.speed > 0.0 && most * duration > kStageLimit * r.speed;
        });
    }

    /// Sets the directions of friction to those in the middle of the interval. The rule is implicit (midpoint rule),
    /// because a slow slip can turn in no time. If a motion stops before the end, the middle of the time until then is
    /// used.
    void solve_for_middle(double duration) {
        for (const Resistance& r : resistances()) {
            if (r.speed == 0.0) continue;
            const double braking = -dot(change_of(r), r.heading);
            if (r.speed < braking * duration) duration = r.speed / braking;
        }
        weight_ = 2.0 / duration;
        solve();
        weight_ = 0.0;
        for (Resistance& r : resistances()) {
            const Vec3 middle = r.rate + (0.5 * duration) * change_of(r);
            // A motion that has stopped by the middle has no direction there, and keeps that at the start.
            if (r.speed > 0.0 && length(middle) > kSlowSlip * r.speed) r.heading = normalized(middle);
        }
    }

    /// Ends the interval when a motion stops, and marks that motion as stuck.
    void stop(ContactInterval& interval) {
        for (const Resistance& r : resistances()) {
            if (r.speed == 0.0) continue;
            const double braking = -dot(change_of(r), r.heading);
            const double speed = dot(r.rate, r.heading);
            if (speed < braking * interval.duration) interval.duration = speed / braking;
        }
        for (const Resistance& r : resistances()) {
            const Vec3 change = change_of(r);
            bool& sticks = is_stuck(interval.stuck[r.surface], r.kind);
            if (r.speed == 0.0) {
                sticks = length(change) <= kSupportRounding * scale();
                continue;
            }
            const double left = length(r.rate + interval.duration * change);
            // On a slope near the angle of friction, the braking force is a small difference of large forces. Its
            // rounding error is therefore that of the large forces.
            const double rounding = kSupportRounding * scale() * interval.duration;
            const bool is_soon_over = left < kMostHeadingTurn * r.speed &&
                                      (left <= rounding || left * interval.duration <= grip_.negligible_path);
            sticks = left <= kStopRounding * r.speed || is_soon_over;
            // The next plan, without this very short slip, shows which surfaces support the particle afterwards.
            if (sticks && r.speed * interval.duration <= grip_.negligible_path) interval.ends_at_once = true;
        }
    }

    Motion motion_;
    double radius_;
    Vec3 a_;
    std::span<const SupportSurface> seen_;
    std::span<const SupportSurface> surfaces_;
    const FrictionLimits& grip_;
    double duration_;
    std::array<Resistance, 3 * kMostSupports> resistances_{};
    std::size_t count_ = 0;
    std::array<Vec3, kMostSupports> reactions_{};
    Vec3 acceleration_;
    Vec3 spin_acceleration_;
    bool jams_ = false;  // the sliding motion has a solution only with less than full friction
    bool jams_in_middle_ = false;
    // Factor, in 1/s, on the initial motions in the rates that friction opposes. 0: it opposes the initial motions.
    double weight_ = 0.0;
};

/// Returns true if the motion is negligible compared with the velocity that the forces can cause in the duration, in s.
/// A jammed particle then stops. Otherwise each interval would remove only a fraction of the motion.
bool hardly_moves(const Motion& motion, double radius, const Vec3& a, double duration) {
    const double speed = length(motion.velocity) + radius * length(motion.spin);
    return motion.velocity != Vec3{} && speed <= kNegligibleSpeed * length(a) * duration;
}

}  // namespace

bool leaves(const Vec3& velocity, const Vec3& n) { return dot(velocity, n) > kLeavingRounding * length(velocity); }

ContactInterval plan_interval(const Motion& motion, double radius, const Vec3& a,
                              std::span<const SupportSurface> surfaces, const FrictionLimits& grip, double duration,
                              const StuckSurfaces& stuck) {
    surfaces = surfaces.first(std::min(surfaces.size(), kMostSupports));
    Motion start = along_surfaces(motion, radius, surfaces, {});
    for (int k = 1;; ++k) {
        Plan plan(start, radius, a, surfaces, surfaces, grip, duration, stuck);
        const ContactInterval interval = plan.interval();
        if (interval.jams && hardly_moves(start, radius, a, duration)) {
            const ContactInterval still = Plan({}, radius, a, surfaces, surfaces, grip, duration, stuck).interval();
            if (still.at_rest) return still;
        }
        const bool goes_on = interval.ends_at_once || plan.drags(interval);
        if (k == kMostPlans || interval.at_rest || !goes_on) return interval;
        start = along_surfaces(start, radius, surfaces, interval.stuck);
    }
}

std::optional<Motion> rest_beside_rounding(const Motion& motion, double radius, const Vec3& a,
                                           std::span<const SupportSurface> surfaces, const FrictionLimits& grip,
                                           double duration) {
    surfaces = surfaces.first(std::min(surfaces.size(), kMostSupports));
    const double slow = kNegligibleSpeed * length(a) * duration;
    if (motion.velocity == Vec3{} || length(motion.velocity) > slow || !are_at_rest(surfaces)) return std::nullopt;
    StuckSurfaces stuck{};
    for (std::size_t k = 0; k < surfaces.size(); ++k) stuck[k].to_slip = surfaces[k].friction > 0.0;
    const Motion still = along_surfaces({{}, motion.spin}, radius, surfaces, stuck, slow / kStopRounding);
    if (still.velocity != Vec3{} || radius * length(still.spin - motion.spin) > slow) return std::nullopt;
    const bool rests = Plan(still, radius, a, surfaces, surfaces, grip, duration, {}).interval().at_rest;
    return rests ? std::optional(still) : std::nullopt;
}

ContactInterval plan_interval_by_middle(const Motion& motion, double radius, const Vec3& a,
                                        std::span<const SupportSurface> before, std::span<const SupportSurface> middle,
                                        const FrictionLimits& grip, double duration) {
    return Plan(motion, radius, a, before, middle, grip, duration, {}).interval();
}

Motion motion_after(const ContactInterval& interval, double elapsed, bool is_over, const Vec3& velocity, double radius,
                    std::span<const SupportSurface> surfaces) {
    const Motion motion{velocity, interval.motion.spin + elapsed * interval.spin_acceleration};
    if (!is_over) return motion;
    return along_surfaces(motion, radius, surfaces, interval.stuck, std::sqrt(twice_kinetic(interval.motion, radius)));
}

}  // namespace ricochet
