#include "ricochet/response/held_motion.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/sphere_contact.h"

namespace ricochet {
namespace {

/// Parts of the friction that are tried where the whole has no answer: a sphere that something jams in.
constexpr std::array kFrictionParts{1.0, 0.999, 0.99, 0.9, 0.5, 0.0};

/// Plans that end at once, one after the other, before the last counts.
constexpr int kMostPlans = 4;

double product(const MotionVector& a, const MotionVector& b) {
    double sum = 0.0;
    for (std::size_t c = 0; c < a.size(); ++c) sum += a[c] * b[c];
    return sum;
}

void add_multiple(MotionVector& a, double factor, const MotionVector& b) {
    for (std::size_t c = 0; c < a.size(); ++c) a[c] += factor * b[c];
}

/// Takes the parts along directions out of a motion. Method: modified Gram-Schmidt, twice.
class Remover {
public:
    void add(MotionVector direction) {
        const double whole = std::sqrt(product(direction, direction));
        for (int pass = 0; pass < 2; ++pass) {
            for (std::size_t k = 0; k < count_; ++k) add_multiple(direction, -product(direction, basis_[k]), basis_[k]);
        }
        const double left = std::sqrt(product(direction, direction));
        if (count_ == basis_.size() || !(left > kDependentDirection * whole)) return;
        for (double& x : direction) x /= left;
        basis_[count_++] = direction;
    }
    void remove_from(MotionVector& motion) const {
        for (int pass = 0; pass < 2; ++pass) {
            for (std::size_t k = 0; k < count_; ++k) add_multiple(motion, -product(motion, basis_[k]), basis_[k]);
        }
    }

private:
    std::array<MotionVector, 6> basis_{};
    std::size_t count_ = 0;
};

/// Something that resists, and how it is going.
struct Resistance {
    std::size_t surface = 0;
    bool is_rolling = false;  ///< against turning; otherwise against slip
    Vec3 rate;                ///< slip, or radius times angular velocity along the surface, m/s
    double speed = 0.0;       ///< 0 where it is stuck
};

/// One plan: the forces on a motion, and how long they stay.
class Plan {
public:
    Plan(const Motion& motion, double radius, const Vec3& a, std::span<const HoldingSurface> surfaces, const Grip& grip,
         double duration, const std::array<Stuck, kMostHolding>& stuck)
        : motion_(motion), radius_(radius), a_(a), surfaces_(surfaces), grip_(grip), duration_(duration) {
        find_resistances(stuck);
        solve();
    }

    [[nodiscard]] ContactInterval interval() const {
        ContactInterval interval{motion_, acceleration_, spin_acceleration_, duration_};
        interval.push = push_;
        interval.at_rest = is_still() && stays_still();
        if (!interval.at_rest) limit(interval);
        return interval;
    }

private:
    [[nodiscard]] bool is_sphere() const { return radius_ > 0.0; }

    void find_resistances(const std::array<Stuck, kMostHolding>& stuck) {
        const double scale = length(motion_.velocity) + radius_ * length(motion_.spin);
        const auto add = [&](std::size_t surface, bool is_rolling, const Vec3& rate) {
            const double speed = length(rate);
            const bool is_stuck = is_rolling ? stuck[surface].to_turning : stuck[surface].to_slip;
            resistances_[count_++] = {surface, is_rolling, rate, !is_stuck && speed > kSlowSlip * scale ? speed : 0.0};
        };
        for (std::size_t k = 0; k < surfaces_.size(); ++k) {
            const HoldingSurface& surface = surfaces_[k];
            if (surface.friction > 0.0) add(k, false, slip_velocity(motion_, radius_, surface.normal));
            if (surface.rolling_friction == 0.0 || !is_sphere()) continue;
            const Vec3 turning = motion_.spin - dot(motion_.spin, surface.normal) * surface.normal;
            add(k, true, radius_ * turning);
        }
    }

    void solve() {
        CoulombProblem problem;
        for (const HoldingSurface& surface : surfaces_) {
            problem.add({normal_direction(surface.normal), dot(a_, surface.normal) + surface.bend});
        }
        for (std::size_t r = 0; r < count_; ++r) problem.add(resistance(resistances_[r]));
        // What slides can jam; what is at rest has an answer.
        const bool slides =
            std::any_of(resistances_.begin(), resistances_.begin() + static_cast<std::ptrdiff_t>(count_),
                        [](const Resistance& r) { return r.speed > 0.0; });
        const auto effort = slides ? CoulombProblem::Effort::some : CoulombProblem::Effort::all;
        for (const double part : kFrictionParts) {
            if (problem.solve(effort, part * grip_.pressure)) break;
        }
        for (std::size_t k = 0; k < surfaces_.size(); ++k) push_[k] = problem.push(k) * surfaces_[k].normal;
        for (std::size_t r = 0; r < count_; ++r) {
            const std::size_t k = resistances_[r].surface;
            if (!resistances_[r].is_rolling) push_[k] += along_tangents(problem.force_of(r), surfaces_[k].normal);
        }
        const MotionVector change = problem.change();
        acceleration_ = a_ + velocity_of(change);
        if (is_sphere()) spin_acceleration_ = (kTurning / radius_) * turning_of(change);
    }

    [[nodiscard]] CoulombResistance resistance(const Resistance& r) const {
        const HoldingSurface& surface = surfaces_[r.surface];
        const auto contact = static_cast<std::uint32_t>(r.surface);
        const auto [first, second] = tangent_frame(surface.normal);
        CoulombResistance result = sliding_friction(contact, surface.normal, surface.friction, is_sphere(),
                                                    r.is_rolling ? Vec3{} : a_ + surface.slip_bend);
        if (r.is_rolling) {
            result.bound = surface.rolling_friction;
            result.direction = {turning_direction(first), turning_direction(second)};
        }
        result.is_moving = r.speed > 0.0;
        if (result.is_moving) result.heading = {dot(r.rate, first) / r.speed, dot(r.rate, second) / r.speed};
        return result;
    }

    /// It does not move, or by less than can be told.
    [[nodiscard]] bool is_still() const {
        const double speed = length(motion_.velocity) + radius_ * length(motion_.spin);
        return speed == 0.0 || (duration_ > 0.0 && speed * duration_ <= grip_.negligible_path);
    }
    [[nodiscard]] bool stays_still() const {
        return length(acceleration_) + radius_ * length(spin_acceleration_) <= kHoldRounding * length(a_);
    }

    /// What the forces change the rate of a resistance by, m/s^2.
    [[nodiscard]] Vec3 change_of(const Resistance& r) const {
        const Vec3& n = surfaces_[r.surface].normal;
        if (!r.is_rolling) {
            const Vec3& bend = surfaces_[r.surface].slip_bend;
            return slip_velocity({acceleration_, spin_acceleration_}, radius_, n) + bend - dot(bend, n) * n;
        }
        return radius_ * (spin_acceleration_ - dot(spin_acceleration_, n) * n);
    }

    /// Ends the interval where something comes to a stop, or has turned.
    void limit(ContactInterval& interval) const {
        for (std::size_t r = 0; r < count_; ++r) {
            const Resistance& resistance = resistances_[r];
            Stuck& stuck = interval.stuck[resistance.surface];
            bool& sticks = resistance.is_rolling ? stuck.to_turning : stuck.to_slip;
            const Vec3 change = change_of(resistance);
            if (resistance.speed == 0.0) {
                sticks = length(change) <= kHoldRounding * length(a_);
                continue;
            }
            const Vec3 heading = resistance.rate / resistance.speed;
            const double along = dot(change, heading);
            const double turning = length(change - along * heading);
            if (turning * interval.duration > kMaxHeadingTurn * resistance.speed) {
                end(interval, std::max(grip_.shortest, kMaxHeadingTurn * resistance.speed / turning));
            }
            if (along < 0.0 && resistance.speed < -along * interval.duration) {
                end(interval, resistance.speed / -along);
                sticks = true;
            }
        }
    }

    /// What would have stuck later does not.
    void end(ContactInterval& interval, double duration) const {
        if (!(duration < interval.duration)) return;
        interval.duration = duration;
        for (std::size_t r = 0; r < count_; ++r) {
            if (resistances_[r].speed == 0.0) continue;
            Stuck& stuck = interval.stuck[resistances_[r].surface];
            (resistances_[r].is_rolling ? stuck.to_turning : stuck.to_slip) = false;
        }
    }

    Motion motion_;
    double radius_;
    Vec3 a_;
    std::span<const HoldingSurface> surfaces_;
    const Grip& grip_;
    double duration_;
    std::array<Resistance, 2 * kMostHolding> resistances_{};
    std::size_t count_ = 0;
    std::array<Vec3, kMostHolding> push_{};
    Vec3 acceleration_;
    Vec3 spin_acceleration_;
};

bool ends_at_once(const ContactInterval& interval, double radius, double negligible_path) {
    const bool sticks = std::any_of(interval.stuck.begin(), interval.stuck.end(),
                                    [](const Stuck& stuck) { return stuck.to_slip || stuck.to_turning; });
    const double speed = length(interval.motion.velocity) + radius * length(interval.motion.spin);
    return sticks && speed > 0.0 && speed * interval.duration <= negligible_path;
}

}  // namespace

bool leaves(const Vec3& velocity, const Vec3& n) { return dot(velocity, n) > kLeavingRounding * length(velocity); }

ContactInterval plan_held_interval(const Motion& motion, double radius, const Vec3& a,
                                   std::span<const HoldingSurface> surfaces, const Grip& grip, double duration,
                                   const std::array<Stuck, kMostHolding>& stuck) {
    surfaces = surfaces.first(std::min(surfaces.size(), kMostHolding));
    Motion start = along_surfaces(motion, radius, surfaces, {});
    for (int k = 1;; ++k) {
        const ContactInterval interval = Plan(start, radius, a, surfaces, grip, duration, stuck).interval();
        if (k == kMostPlans || interval.at_rest || !ends_at_once(interval, radius, grip.negligible_path))
            return interval;
        start = along_surfaces(start, radius, surfaces, interval.stuck);
    }
}

Vec3 along_all(const Vec3& v, std::span<const Vec3> normals) {
    Remover remover;
    for (const Vec3& normal : normals) remover.add(normal_direction(normal));
    MotionVector all = motion_vector(v, {});
    remover.remove_from(all);
    return velocity_of(all);
}

Vec3 shift_by(std::span<const Vec3> normals, std::span<const double> distances) {
    std::array<Vec3, 3> basis;
    std::array<double, 3> part{};
    std::size_t count = 0;
    Vec3 shift;
    for (std::size_t k = 0; k < normals.size() && count < basis.size(); ++k) {
        Vec3 rest = normals[k];
        double distance = distances[k];
        for (int pass = 0; pass < 2; ++pass) {
            for (std::size_t j = 0; j < count; ++j) {
                const double along = dot(rest, basis[j]);
                rest -= along * basis[j];
                distance -= along * part[j];
            }
        }
        const double left = length(rest);
        if (!(left > kDependentDirection)) continue;
        basis[count] = rest / left;
        part[count] = distance / left;
        shift += part[count] * basis[count];
        ++count;
    }
    return shift;
}

Motion along_surfaces(const Motion& motion, double radius, std::span<const HoldingSurface> surfaces,
                      const std::array<Stuck, kMostHolding>& stuck) {
    const bool is_sphere = radius > 0.0;
    Remover remover;
    for (const HoldingSurface& surface : surfaces) remover.add(normal_direction(surface.normal));
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        const Vec3& n = surfaces[k].normal;
        for (const Vec3& t : tangent_frame(n)) {
            if (stuck[k].to_slip) remover.add(sliding_direction(t, n, is_sphere));
            if (stuck[k].to_turning) remover.add(turning_direction(t));
        }
    }
    MotionVector all = motion_vector(motion.velocity, (radius / kTurning) * motion.spin);
    const double before = std::sqrt(product(all, all));
    remover.remove_from(all);
    if (std::sqrt(product(all, all)) <= kStopRounding * before) return {};
    return {velocity_of(all), is_sphere ? (kTurning / radius) * turning_of(all) : Vec3{}};
}

}  // namespace ricochet
