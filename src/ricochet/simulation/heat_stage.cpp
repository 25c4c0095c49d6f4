#include "ricochet/simulation/heat_stage.h"

#include <algorithm>
#include <array>
#include <utility>

#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

/// Returns the kinetic energy of a solid sphere, in J.
double kinetic(const RecordedMotion& motion, double radius, double mass) {
    return 0.5 * mass * (dot(motion.velocity, motion.velocity) + 0.4 * radius * radius * dot(motion.spin, motion.spin));
}

/// Returns the kinetic energy of the motion along the normal, in J, that an impact dissipates.
double lost_along_normal(const ContactRecord& record) {
    const double before = dot(record.velocity_before - record.surface_velocity, record.normal);
    const double after = dot(record.velocity_after - record.surface_velocity, record.normal);
    return 0.5 * record.mass * (before * before - after * after);
}

}  // namespace

void FrictionMeter::measure(const MoveReport& move, std::vector<HeatGain>& gains) const {
    const ForceInput& moved = move.moved;
    std::size_t contact = 0;
    std::size_t load = 0;
    for (const MotionPart& part : move.motions) {
        if (part.kind == MotionPart::Kind::flight) continue;
        const double end = part.time + part.duration;
        const bool is_impact = part.duration == 0.0;
        double lost = kinetic(part.begin, part.radius, moved.mass) - kinetic(part.end, part.radius, moved.mass);
        if (!is_impact) lost += work_of_forces(part, moved);
        for (; load < move.loads.size() && move.loads[load].time <= end; ++load) {
            if (is_impact || !move.loads[load].impact)
                lost -= move.loads[load].work;
            else
                break;  // this load belongs to the impact at the end of the contact
        }
        double along_normal = 0.0;
        for (; is_impact && contact < move.contacts.size() && move.contacts[contact].time <= end; ++contact) {
            along_normal += lost_along_normal(move.contacts[contact]);
        }
        lost = std::max(lost, 0.0);  // negative only by rounding
        along_normal = std::clamp(along_normal, 0.0, lost);
        const double heat = heat_.impact_fraction * along_normal + heat_.friction_fraction * (lost - along_normal);
        if (heat > 0.0) gains.push_back({move.index, part.time + 0.5 * part.duration, heat});
    }
}

/// Returns the work of forces in lasting contact, in J. Uses Simpson's rule for force times velocity. The velocity in
/// the middle is that of a cubic through both ends. The result is exact for steady forces. In a moving frame, the
/// forces of `part` differ from the forces in the world, so the latter are computed again.
double FrictionMeter::work_of_forces(const MotionPart& part, const ForceInput& moved) const {
    const Vec3 displacement = part.end.position - part.begin.position;
    const Vec3 middle_velocity =
        (1.5 / part.duration) * displacement - 0.25 * (part.begin.velocity + part.end.velocity);
    std::array<Vec3, 3> forces = part.forces;
    if (!bodies_.empty() && part.kind == MotionPart::Kind::driven) {
        ForceInput input = moved;
        const auto at = [&](double time, const Vec3& position, const Vec3& velocity) {
            input.time = time, input.position = position, input.velocity = velocity;
            return forces_.acceleration(input);
        };
        const double half = 0.5 * part.duration;
        const Vec3 middle =
            0.5 * (part.begin.position + part.end.position) + 0.25 * half * (part.begin.velocity - part.end.velocity);
        forces = {at(part.time, part.begin.position, part.begin.velocity),
                  at(part.time + half, middle, middle_velocity),
                  at(part.time + part.duration, part.end.position, part.end.velocity)};
    }
    if (part.forces_are_steady && part.kind != MotionPart::Kind::driven)
        return moved.mass * dot(forces[0], displacement);
    return moved.mass * (part.duration / 6.0) *
           (dot(forces[0], part.begin.velocity) + 4.0 * dot(forces[1], middle_velocity) +
            dot(forces[2], part.end.velocity));
}

HeatStage::HeatStage(HeatSettings heat, ParticleStore& store, const ForceField& forces, const MovingColliders& bodies)
    : heat_(std::move(heat)),
      store_(store),
      column_(store.particles().attributes.find(kTemperatureAttribute).value()),
      meter_(heat_, forces, bodies) {}

void HeatStage::observe(const MoveReport& move, BlockRecord& block) {
    if (heat_.is_heated_by_surfaces()) meter_.measure(move, block.heat);
}

void HeatStage::before_generation(const ParticleRange& generation, const TimeSpan& step) {
    gains_.clear();
    if (!heat_.convection || heat_.convection->coefficient) return;
    coefficients_.resize(generation.size());
    parallel_for(generation.size(), kParticleBlock, [&](std::size_t k) {
        const std::size_t i = generation.begin + k;
        coefficients_[k] = coefficient(i, life_in(store_.particles(), i, step).begin);
    });
}

/// Returns the coefficient of convection, in W/(m^2 K), at the position of a particle at a time, in s.
double HeatStage::coefficient(std::size_t i, double time) const {
    const Particles& particles = store_.particles();
    const double radius = particles.radius[i];
    if (!heat_.convection || !(radius > 0.0)) return 0.0;
    const Convection& convection = *heat_.convection;
    Vec3 relative = particles.velocity[i];
    if (convection.flow) relative -= convection.flow->velocity(particles.position[i], time);
    return heat_transfer_coefficient(convection, radius, length(relative));
}

void HeatStage::record(const ParticleRange& /*generation*/, const std::vector<BlockRecord>& blocks,
                       std::vector<ColliderLoad>& /*loads*/) {
    for (const BlockRecord& block : blocks) gains_.insert(gains_.end(), block.heat.begin(), block.heat.end());
}

void HeatStage::after_generation(const ParticleRange& generation, const TimeSpan& step) {
    const auto is_before = [](const HeatGain& a, const HeatGain& b) { return a.particle < b.particle; };
    std::ranges::stable_sort(gains_, is_before);
    Particles& particles = store_.particles();
    parallel_for(generation.size(), kParticleBlock, [&](std::size_t k) {
        const std::size_t i = generation.begin + k;
        const TimeSpan life = life_in(particles, i, step);
        if (particles.frozen[i] != 0 || particles.absorbed[i] == 1 || life.end <= life.begin) return;
        const auto [first, last] = std::equal_range(gains_.begin(), gains_.end(), HeatGain{i, 0.0, 0.0}, is_before);
        const double before = coefficients_.empty() ? 0.0 : coefficients_[k];
        particles.attributes.set(column_, i, {changed(i, life, before, {first, last}), 0.0, 0.0});
    });
}

/// Returns the temperature of particle i at the end of its life in the step, in K. Convection uses the mean of the
/// coefficients at both ends. before: coefficient before the move. It is not used if the scene gives one value.
double HeatStage::changed(std::size_t i, const TimeSpan& life, double before, std::span<const HeatGain> gains) const {
    const Particles& particles = store_.particles();
    const double mass = particles.mass[i];
    double h = coefficient(i, life.end);
    if (!coefficients_.empty()) h = 0.5 * (before + h);
    const CoolingRates rates = cooling_rates(heat_, mass, particles.radius[i], h);
    double temperature = std::max(0.0, particles.attributes.value(column_, i).x);
    double now = life.begin;
    for (const HeatGain& gain : gains) {
        temperature = cooled(temperature, heat_.ambient_temperature, rates, gain.time - now);
        temperature += gain.energy / (mass * heat_.specific_heat);
        now = std::max(now, gain.time);
    }
    return cooled(temperature, heat_.ambient_temperature, rates, life.end - now);
}

}  // namespace ricochet
