#include "ricochet/dynamics/system_integrator.h"

#include <algorithm>

#include "ricochet/dynamics/dormand_prince.h"

namespace ricochet {
namespace {

using Vectors = std::vector<Vec3>;

/// Returns a + h b, entry by entry.
Vectors along(const Vectors& a, double h, const Vectors& b) {
    Vectors result(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] + h * b[i];
    return result;
}

/// Accelerations of all members in a state, in m/s^2.
struct Accelerations {
    Vectors all;
    Vectors mutual;  // part of `all` that forces between members cause; empty without such forces
};

Accelerations accelerations(const ParticleSystem& system, double time, const Vectors& x, const Vectors& v) {
    Accelerations result{Vectors(system.size()), system.mutual_accelerations(time, x, v)};
    system.accelerations(time, x, v, result.mutual, result.all);
    return result;
}

/// Returns a step of h seconds with the given end state and start accelerations.
SystemStep step_to(Vectors positions, Vectors velocities, Accelerations start, double h) {
    SystemStep step{std::move(positions), std::move(velocities), std::move(start.all), h, h};
    step.mutual_start = std::move(start.mutual);
    return step;
}

SystemStep euler_step(const ParticleSystem& system, double h, bool kicks_first) {
    const Vectors& v = system.velocities();
    Accelerations a = accelerations(system, system.time(), system.positions(), v);
    Vectors end = along(v, h, a.all);
    Vectors positions = along(system.positions(), h, kicks_first ? end : v);
    return step_to(std::move(positions), std::move(end), std::move(a), h);
}

SystemStep midpoint_step(const ParticleSystem& system, double h) {
    const Vectors& x = system.positions();
    const Vectors& v = system.velocities();
    Accelerations a0 = accelerations(system, system.time(), x, v);
    const Vectors v_mid = along(v, 0.5 * h, a0.all);
    const Accelerations a_mid = accelerations(system, system.time() + 0.5 * h, along(x, 0.5 * h, v), v_mid);
    Vectors mutual_end(a_mid.mutual.size());
    for (std::size_t i = 0; i < mutual_end.size(); ++i) mutual_end[i] = 2.0 * a_mid.mutual[i] - a0.mutual[i];
    SystemStep step = step_to(along(x, h, v_mid), along(v, h, a_mid.all), std::move(a0), h);
    step.mutual_end = std::move(mutual_end);
    return step;
}

SystemStep verlet_step(const ParticleSystem& system, double h) {
    const Vectors& x = system.positions();
    const Vectors& v = system.velocities();
    Accelerations a0 = accelerations(system, system.time(), x, v);
    Vectors end(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) end[i] = x[i] + h * v[i] + (0.5 * h * h) * a0.all[i];
    Accelerations a1 = accelerations(system, system.time() + h, end, along(v, h, a0.all));
    Vectors velocities(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) velocities[i] = v[i] + (0.5 * h) * (a0.all[i] + a1.all[i]);
    SystemStep step = step_to(std::move(end), std::move(velocities), std::move(a0), h);
    step.mutual_end = std::move(a1.mutual);
    return step;
}

SystemStep rk4_step(const ParticleSystem& system, double h) {
    const Vectors& x = system.positions();
    const Vectors& v = system.velocities();
    const double t = system.time();
    const double half = 0.5 * h;
    Accelerations a1 = accelerations(system, t, x, v);
    const Vectors v2 = along(v, half, a1.all);
    const Vectors a2 = accelerations(system, t + half, along(x, half, v), v2).all;
    const Vectors v3 = along(v, half, a2);
    const Vectors a3 = accelerations(system, t + half, along(x, half, v2), v3).all;
    const Vectors v4 = along(v, h, a3);
    Accelerations a4 = accelerations(system, t + h, along(x, h, v3), v4);
    Vectors positions(x.size());
    Vectors velocities(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        positions[i] = x[i] + (h / 6.0) * (v[i] + 2.0 * (v2[i] + v3[i]) + v4[i]);
        velocities[i] = v[i] + (h / 6.0) * (a1.all[i] + 2.0 * (a2[i] + a3[i]) + a4.all[i]);
    }
    SystemStep step = step_to(std::move(positions), std::move(velocities), std::move(a1), h);
    step.mutual_end = std::move(a4.mutual);
    return step;
}

/// A step of dormand_prince, with the largest error of a member relative to the tolerance.
struct TriedStep {
    SystemStep step;
    double error = 0.0;
};

TriedStep dormand_prince_system(const ParticleSystem& system, double h, const ErrorTolerance& tolerance) {
    const std::size_t count = system.size();
    std::array<Vectors, kDormandPrinceStages> v;
    std::array<Vectors, kDormandPrinceStages> a;
    TriedStep tried;
    for (std::size_t s = 0; s < kDormandPrinceStages; ++s) {
        Vectors x = system.positions();
        v[s] = system.velocities();
        for (std::size_t j = 0; j < s; ++j) {
            const double weight = h * dormand_prince_weight(s, j);
            for (std::size_t i = 0; i < count; ++i) {
                x[i] += weight * v[j][i];
                v[s][i] += weight * a[j][i];
            }
        }
        Accelerations stage = accelerations(system, system.time() + dormand_prince_node(s) * h, x, v[s]);
        a[s] = std::move(stage.all);
        if (s == 0) tried.step.mutual_start = std::move(stage.mutual);
        if (s + 1 == kDormandPrinceStages) {
            tried.step.positions = std::move(x);
            tried.step.mutual_end = std::move(stage.mutual);
        }
    }
    std::array<Vec3, kDormandPrinceStages> own_v;
    std::array<Vec3, kDormandPrinceStages> own_a;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t s = 0; s < kDormandPrinceStages; ++s) {
            own_v[s] = v[s][i];
            own_a[s] = a[s][i];
        }
        tried.error =
            std::max(tried.error, relative_error(estimated_errors(own_v, own_a, h),
                                                 attainable(tolerance, system.positions()[i], system.velocities()[i])));
    }
    tried.step.velocities = std::move(v.back());
    tried.step.start_accelerations = std::move(a.front());
    tried.step.duration = h;
    return tried;
}

SystemStep adaptive_step(const Integrator& integrator, const ParticleSystem& system, double duration, double first_try,
                         double shortest) {
    double h = std::min(first_try, duration);
    for (;; h *= 0.5) {
        TriedStep tried = dormand_prince_system(system, h, integrator.tolerance);
        if (tried.error > 1.0 && 0.5 * h >= shortest) continue;
        const bool ended_here = h >= duration;  // the duration limited the step, not the error
        tried.step.next_duration = ended_here ? first_try : (tried.error < kErrorToDouble ? 2.0 * h : h);
        tried.step.solved = !(tried.error > 1.0);
        return std::move(tried.step);
    }
}

}  // namespace

Vec3 SupportConstraints::friction_at(const Vec3& mean) const {
    if (!(grip > 0.0)) return {};
    const Vec3 slip = slip_of(mean);
    return (-grip / std::max(length(slip), yield)) * slip;
}

double SupportConstraints::friction_energy_at(const Vec3& mean) const {
    if (!(grip > 0.0)) return 0.0;
    const double slip = length(slip_of(mean));
    return slip <= yield ? 0.5 * grip / yield * slip * slip : grip * (slip - 0.5 * yield);
}

// In the proportional range, the velocity change by friction is grip / yield times the slip that remains.
Vec3 SupportConstraints::mean_of(const Vec3& free) const {
    if (count == 0) return free;
    Vec3 along = across(free);
    const Vec3 slip = along - spin_slip;
    const double speed = length(slip);
    if (grip > 0.0 && speed > 0.0) along -= std::min(grip / speed, grip / (grip + yield)) * slip;
    return along + velocity;
}

SystemStep step_system(const Integrator& integrator, const ParticleSystem& system, double duration, double first_try,
                       double shortest) {
    switch (integrator.kind) {
        case IntegratorKind::forward_euler:
            return euler_step(system, duration, false);
        case IntegratorKind::symplectic_euler:
            return euler_step(system, duration, true);
        case IntegratorKind::implicit_euler:
            return implicit_system_step(system, duration, {}, {});
        case IntegratorKind::midpoint:
            return midpoint_step(system, duration);
        case IntegratorKind::rk4:
            return rk4_step(system, duration);
        case IntegratorKind::dormand_prince:
            return adaptive_step(integrator, system, duration, first_try,
                                 shortest > 0.0 ? shortest : kShortestSubstep * duration);
        case IntegratorKind::velocity_verlet:
        case IntegratorKind::ballistic:
            break;
    }
    return verlet_step(system, duration);
}

Flight planned_flight(IntegratorKind kind, const ParticleSystem& system, const SystemStep& step, std::size_t i) {
    const double h = step.duration;
    const Vec3& x = system.positions()[i];
    const Vec3& v = system.velocities()[i];
    const Vec3& end_velocity = step.free_velocity(i);
    Flight flight;
    flight.start = system.input(i, system.time(), x, v);
    flight.acceleration = step.start_accelerations[i];
    flight.end_velocity = end_velocity;
    switch (kind) {
        case IntegratorKind::forward_euler:
            flight.path = line_path(x, v, h);
            flight.steps_again = true;
            break;
        case IntegratorKind::symplectic_euler:
        case IntegratorKind::implicit_euler:
            flight.path = line_path(x, end_velocity, h);
            flight.acceleration = (end_velocity - v) / h;
            flight.kick_duration = h;
            break;
        case IntegratorKind::velocity_verlet:
        case IntegratorKind::ballistic:
            flight.path = hermite_path(x, v, parabola_end(x, v, flight.acceleration, h), end_velocity, h);
            break;
        default:
            flight.path = hermite_path(x, v, step.positions[i], end_velocity, h);
            break;
    }
    return flight;
}

bool holds_coupling(IntegratorKind kind) { return kicks_first(kind) || kind == IntegratorKind::forward_euler; }

Vec3 constrained_coupling(IntegratorKind kind, const ParticleSystem& system, const SystemStep& step, std::size_t i) {
    if (system.is_pinned(i)) return {};
    const Vec3& x = system.positions()[i];
    const Vec3& v = system.velocities()[i];
    if (kind == IntegratorKind::implicit_euler) {
        return (step.free_velocity(i) - v) / step.duration - system.own_acceleration(i, system.time(), x, v);
    }
    const Vec3 pull = system.spring_force_on(i, system.positions(), system.velocities()) / system.mass(i);
    return step.mutual_start.empty() ? pull : pull + step.mutual_start[i];
}

}  // namespace ricochet
