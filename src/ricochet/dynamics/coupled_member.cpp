#include "ricochet/dynamics/coupled_member.h"

#include <algorithm>
#include <array>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

/// Springs per unit of parallel work.
constexpr std::size_t kCoupledMemberBlock = 64;

/// A node of a quadrature rule on [0, 1].
struct Node {
    double at;
    double weight;
};
/// Gauss's rule, exact for polynomials of degree 5.
constexpr std::array<Node, 3> kGauss{{{0.11270166537925831, 5.0 / 18.0},  // (1 - sqrt(3/5)) / 2
                                      {0.5, 8.0 / 18.0},
                                      {0.88729833462074169, 5.0 / 18.0}}};
constexpr std::array<Node, 2> kTrapezoid{{{0.0, 0.5}, {1.0, 0.5}}};

/// Returns the quadrature rule that suits the integrator. velocity_verlet uses the forces at both ends of a path, which
/// is the trapezoidal rule. With any other rule, a bounce would lose energy
/// (docs/decisions/2026-11-24-springs-that-bounce.md).
std::span<const Node> rule_of(IntegratorKind kind) {
    const bool is_verlet = kind == IntegratorKind::velocity_verlet || kind == IntegratorKind::ballistic;
    return is_verlet ? std::span<const Node>(kTrapezoid) : std::span<const Node>(kGauss);
}

/// Returns the piece whose time interval contains a time, in s.
const FlownPiece& piece_at(std::span<const FlownPiece> pieces, double time) {
    const auto next = std::upper_bound(pieces.begin() + 1, pieces.end(), time,
                                       [](double t, const FlownPiece& piece) { return t < piece.begin; });
    return *(next - 1);
}

/// Returns the state after `s` seconds on a path of `duration` seconds that ends with the velocity `arrival`.
PhaseState state_along(const Path& path, double s, double duration, const Vec3& arrival) {
    if (duration == 0.0) return {path.position(0.0), arrival};
    s = std::clamp(s, 0.0, duration);
    const double part = s / duration;
    return {path.position(s), path.velocity(s) + (part * part) * (arrival - path.velocity(duration))};
}

/// Time interval within a step, in s.
struct TimeInterval {
    double begin;
    double end;
    [[nodiscard]] double middle() const { return 0.5 * (begin + end); }
};

/// Splits the step at the start of every piece, so that all paths and forces are smooth within each interval.
std::vector<TimeInterval> parts_between(std::span<const FlownPiece> first, std::span<const FlownPiece> second,
                                        const FlownPiece& step) {
    std::vector<double> times{step.begin + step.duration};
    for (const FlownPiece& piece : first) times.push_back(piece.begin);
    for (const FlownPiece& piece : second) times.push_back(piece.begin);
    std::sort(times.begin(), times.end());
    std::vector<TimeInterval> parts;
    for (std::size_t k = 1; k < times.size(); ++k) {
        if (times[k] > times[k - 1]) parts.push_back({times[k - 1], times[k]});
    }
    return parts;
}

template <class Function>
Vec3 integral(std::span<const Node> rule, const TimeInterval& part, const Function& f) {
    const double duration = part.end - part.begin;
    Vec3 sum;
    for (const Node& node : rule) sum += (node.weight * duration) * f(part.begin + node.at * duration);
    return sum;
}

}  // namespace

PhaseState FlownPiece::at(double time) const { return state_along(path, time - begin, duration, arrival); }

FlownPiece piece_of(const Flight& flight) {
    return {flight.path, flight.start.time, flight.path.duration, flight.start.velocity, flight.end_velocity, true};
}

Vec3 CoupledMember::acceleration(const ForceInput& input) const {
    if (system_ == nullptr) return constant_acceleration_;
    const auto state_of = [&](std::size_t k) {
        if (k == member_) return PhaseState{input.position, input.velocity};
        const Flight& plan = (*plans_)[k];
        return state_along(plan.path, input.time - plan.start.time, plan.path.duration, plan.end_velocity);
    };
    return system_->spring_force_in(member_, state_of) / input.mass +
           (mutual_.start + (input.time - mutual_.begin) * mutual_.slope);
}

void PlanDeviations::reset(std::size_t members, IntegratorKind kind) {
    kind_ = kind;
    entries_.resize(members);
    for (Entry& entry : entries_) {
        entry.flown.clear();
        entry.keeps_start = false;
    }
}

void PlanDeviations::record(std::size_t member, std::span<const FlownPiece> flown, const Vec3& velocity_change) {
    entries_[member].flown.assign(flown.begin(), flown.end());
    entries_[member].velocity_change = velocity_change;
}

void PlanDeviations::record_at_start(std::size_t member, const Vec3& velocity_change) {
    entries_[member].keeps_start = true;
    entries_[member].velocity_change = velocity_change;
}

void PlanDeviations::correct(const ParticleSystem& system, const std::vector<Flight>& plans,
                             const std::vector<std::uint8_t>& moves, std::vector<Vec3>& velocities) const {
    if (std::none_of(entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.has_left(); })) return;
    const std::vector<Vec3> given = momentum_changes(system, plans);
    const std::vector<Vec3> mutual = mutual_changes(system, plans);
    for (std::size_t k = 0; k < velocities.size(); ++k) {
        if (moves[k] == 0) continue;
        if (has_left(k)) {
            const Vec3 planned = plans[k].end_velocity - plans[k].path.duration * system.expected_reaction(k);
            velocities[k] = planned + entries_[k].velocity_change + own_change(system, k, plans[k]);
        }
        if (given[k] != Vec3{}) velocities[k] += given[k] / system.mass(k);
        if (!mutual.empty()) velocities[k] += mutual[k];
    }
}

/// Returns the velocity changes that forces between members cause, in m/s, for each member. The list is empty if there
/// are no such forces. If the forces depend on positions only, they act for half of the step, as in velocity Verlet: a
/// deviation in position grows from the bounce on, so twice its mean is at most its final value. A deviation in
/// velocity has its full size from the bounce on. If the forces depend on velocities, they therefore act for the whole
/// step.
std::vector<Vec3> PlanDeviations::mutual_changes(const ParticleSystem& system, const std::vector<Flight>& plans) const {
    const double duration = plans.front().path.duration;
    const double weight = (system.has_mutual_damping() ? 1.0 : 0.5) * duration;
    const double end = system.time() + duration;
    std::vector<Vec3> positions(system.size());
    std::vector<Vec3> velocities(system.size());
    for (std::size_t k = 0; k < system.size(); ++k) {
        positions[k] = plans[k].path.position(duration);
        velocities[k] = plans[k].end_velocity;
    }
    const std::vector<Vec3> planned = system.mutual_accelerations(end, positions, velocities);
    if (planned.empty()) return {};
    for (std::size_t k = 0; k < system.size(); ++k) {
        if (!has_left(k)) continue;
        const PhaseState start_velocity = summed_deviation(k, plans[k]);
        positions[k] += start_velocity.position / weight;
        velocities[k] += start_velocity.velocity / weight;
    }
    std::vector<Vec3> changes = system.mutual_accelerations(end, positions, velocities);
    for (std::size_t k = 0; k < changes.size(); ++k) changes[k] = weight * (changes[k] - planned[k]);
    return changes;
}

/// Returns the flown pieces of a member, or the plan as one piece if nothing is recorded.
std::span<const FlownPiece> PlanDeviations::flown_by(std::size_t member, const FlownPiece& plan) const {
    return entries_[member].flown.empty() ? std::span<const FlownPiece>(&plan, 1) : entries_[member].flown;
}

/// Returns the state for the evaluation of forces at a time, in s, on a flown piece.
PhaseState PlanDeviations::state_of(std::size_t member, const FlownPiece& piece, const Flight& plan,
                                    double time) const {
    if (entries_[member].keeps_start) return {plan.start.position, plan.start.velocity};
    return piece.at(time);
}

/// Returns the integrals of a member's deviation from plan over the step, in m s for the position and in m for the
/// velocity. If its forces keep their start values, it counts as staying in its start state for half of the step,
/// because the plan already contains the mean of both forces.
PhaseState PlanDeviations::summed_deviation(std::size_t member, const Flight& plan) const {
    const FlownPiece planned = piece_of(plan);
    if (entries_[member].keeps_start) {
        const double half = 0.5 * plan.path.duration;
        return {half * (plan.start.position - plan.path.position(plan.path.duration)),
                half * (plan.start.velocity - plan.end_velocity)};
    }
    const std::span<const FlownPiece> flown(entries_[member].flown);
    PhaseState sum;
    for (const TimeInterval& part : parts_between(flown, {}, planned)) {
        const FlownPiece& piece = piece_at(flown, part.middle());
        sum.position += integral(kGauss, part, [&](double t) { return piece.at(t).position - planned.at(t).position; });
        sum.velocity += integral(kGauss, part, [&](double t) { return piece.at(t).velocity - planned.at(t).velocity; });
    }
    return sum;
}

/// Returns the momentum change that springs cause for each member, in N s, added in the order of the springs.
std::vector<Vec3> PlanDeviations::momentum_changes(const ParticleSystem& system,
                                                   const std::vector<Flight>& plans) const {
    std::vector<Vec3> sums(system.size());
    std::vector<ParticleSystem::Bond> changed;
    for (const ParticleSystem::Bond& bond : system.bonds()) {
        if (has_left(bond.first) || has_left(bond.second)) changed.push_back(bond);
    }
    std::vector<Vec3> impulses(changed.size());
    parallel_for_blocks(changed.size(), kCoupledMemberBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) impulses[k] = impulse_change(system, changed[k], plans);
    });
    for (std::size_t k = 0; k < changed.size(); ++k) {
        sums[changed[k].first] += impulses[k];
        sums[changed[k].second] -= impulses[k];
    }
    return sums;
}

/// Returns the impulse of a spring on its first end along the flown paths minus the impulse along the planned paths, in
/// N s.
Vec3 PlanDeviations::impulse_change(const ParticleSystem& system, const ParticleSystem::Bond& bond,
                                    const std::vector<Flight>& plans) const {
    const std::array<FlownPiece, 2> planned{piece_of(plans[bond.first]), piece_of(plans[bond.second])};
    const auto first = flown_by(bond.first, planned[0]);
    const auto second = flown_by(bond.second, planned[1]);
    const Spring& spring = system.spring_of(bond);
    const auto force = [&](const PhaseState& one, const PhaseState& other) {
        return spring_force(spring, one.position, one.velocity, other.position, other.velocity);
    };
    Vec3 sum;
    for (const TimeInterval& part : parts_between(first, second, planned[0])) {
        const FlownPiece& a = piece_at(first, part.middle());
        const FlownPiece& b = piece_at(second, part.middle());
        sum += integral(rule_of(kind_), part, [&](double t) {
            return force(state_of(bond.first, a, plans[bond.first], t),
                         state_of(bond.second, b, plans[bond.second], t)) -
                   force(planned[0].at(t), planned[1].at(t));
        });
    }
    return sum;
}

/// Returns the velocity change, in m/s, that forces on single particles cause along the flown path of a member, minus
/// the change along its planned path.
Vec3 PlanDeviations::own_change(const ParticleSystem& system, std::size_t member, const Flight& plan) const {
    if (system.has_uniform_forces()) return {};
    const FlownPiece planned = piece_of(plan);
    const bool keeps_start = entries_[member].keeps_start;
    const auto acceleration = [&](const PhaseState& state, double t) {
        return system.own_acceleration(member, t, state.position, state.velocity);
    };
    const std::span<const FlownPiece> flown = flown_by(member, planned);
    Vec3 sum;
    for (const TimeInterval& part : parts_between(flown, {}, planned)) {
        const FlownPiece& piece = piece_at(flown, part.middle());
        sum += integral(rule_of(kind_), part, [&](double t) {
            const double seen = keeps_start ? plan.start.time : t;
            return acceleration(state_of(member, piece, plan, t), seen) - acceleration(planned.at(t), t);
        });
    }
    return sum;
}

}  // namespace ricochet
