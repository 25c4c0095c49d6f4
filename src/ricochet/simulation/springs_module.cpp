#include "ricochet/simulation/modules.h"

#include <optional>
#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/simulation/pair_motion.h"

namespace ricochet {

SpringsModule::SpringsModule(SimulationSetup& setup, const ModuleParts& parts)
    : parts_(parts),
      motion_(std::move(setup.springs), setup.particles_forces, std::move(setup.solver), parts.response.rules().forces,
              parts.options.integrator, parts.options.time_step, parts.warnings.knows_implicit()),
      faces_(std::move(setup.spring_faces)) {
    parts.hooks.coupled = &motion_;
    motion_.call_between([&response = parts.response] { response.rules().poll(); });
    if (parts.share.is_alone()) return;
    std::vector<std::uint64_t> ids;
    for (const Spring& spring : motion_.springs().springs()) ids.insert(ids.end(), {spring.first, spring.second});
    parts.share.keep_together(std::move(ids));
    if (!parts.share.is_first()) motion_.disable();
}

void SpringsModule::before_generation(const ParticleRange& generation, const TimeSpan& /*step*/) {
    if (moves(generation)) parts_.mover.begin_step();
}

double SpringsModule::plan(const ParticleRange& generation, const TimeSpan& rest) {
    const bool is_shared = parts_.share.keeps_together();
    if (generation.are_children || !(motion_.is_active() || is_shared)) return rest.end;
    const double planned = is_shared ? plan_on_first_rank(rest) : plan_here(rest);
    return planned < rest.end - rest.begin ? rest.begin + planned : rest.end;
}

/// Plans the motion of this process's particles. Returns the planned duration, in s.
double SpringsModule::plan_here(const TimeSpan& rest) {
    // A particle under load from other spheres is assumed to keep its velocity, like a particle that a wall supports.
    const std::vector<std::uint8_t> pressing = pairs_ != nullptr ? pairs_->pressing() : std::vector<std::uint8_t>();
    const auto hold = [&](std::size_t i, const Vec3& pull) {
        if (!pressing.empty() && pressing[i] != 0) return Vec3{};
        return parts_.mover.supported_acceleration(i, rest.begin, pull);
    };
    return motion_.plan(parts_.population.particles(), rest.begin, rest.end - rest.begin,
                        {parts_.scene.world(), parts_.scene.materials(), parts_.options.resting_speed}, hold);
}

/// Plans the substep on the first rank. All ranks use this plan, or throw an error with the message of the first rank.
double SpringsModule::plan_on_first_rank(const TimeSpan& rest) {
    double planned = rest.end - rest.begin;
    std::optional<std::string> message;
    try {
        if (motion_.is_active()) planned = plan_here(rest);
    } catch (const DivergedError& error) {
        message = error.what();
    }
    if (const auto first = parts_.share.first_message(message, 0)) throw DivergedError(*first);
    return parts_.share.shortest(planned);
}

void SpringsModule::correct(const ParticleRange& generation, const TimeSpan& substep,
                            std::vector<BlockRecord>& blocks) {
    if (!moves(generation)) return;
    const CoupledMotion::Correction correction = motion_.correct_velocities(parts_.population.store().particles());
    parts_.mover.apply_correction(correction.corrections, substep, blocks);
    if (correction.runaway) {
        blocks.emplace_back().note({*correction.runaway, correction.runaway_speed, RunawayCause::others});
    }
}

void SpringsModule::after_generation(const ParticleRange& generation, const TimeSpan& /*step*/) {
    if (moves(generation)) motion_.settle(parts_.population.particles());
}

void SpringsModule::end_step(SimulationStatistics& statistics) {
    if (!motion_.is_active()) return;
    statistics.springs_broken = motion_.springs().broken();
    statistics.springs_lost = motion_.springs().lost();
    statistics.unsolved_steps += motion_.unsolved_steps();
}

void SpringsModule::bind() {
    if (motion_.is_active()) motion_.bind(parts_.population.particles());
}

}  // namespace ricochet
