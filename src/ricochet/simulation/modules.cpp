#include "ricochet/simulation/modules.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/simulation/cloud_motion.h"
#include "ricochet/simulation/counters/counter_tally.h"
#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/driven_motion.h"
#include "ricochet/simulation/heat_stage.h"
#include "ricochet/simulation/offspring.h"
#include "ricochet/simulation/pair_motion.h"
#include "ricochet/simulation/rank_share.h"
#include "ricochet/simulation/retirement.h"
#include "ricochet/verify/sphere_overlaps.h"

namespace ricochet {
namespace {

/// Remembers the particles that may spawn children before they move. Simulation::Impl spawns the children.
class ChildrenModule final : public Module {
public:
    ChildrenModule(Offspring& offspring, ParticleStore& store) : offspring_(offspring), store_(store) {}

    void before_generation(const ParticleRange& generation, const TimeSpan& /*step*/) override {
        offspring_.before_move(store_.particles(), generation.begin, store_.sides_from(generation.begin));
    }

private:
    Offspring& offspring_;
    ParticleStore& store_;
};

/// Cools and heats particles.
class HeatModule final : public Module {
public:
    HeatModule(HeatStage& heat, ParticleStore& store) : heat_(heat), store_(store) {}

    void before_generation(const ParticleRange& generation, const TimeSpan& step) override {
        gains_.clear();
        heat_.before_move(store_.particles(), generation, step);
    }
    void record(const ParticleRange& /*generation*/, const std::vector<BlockRecord>& blocks,
                std::vector<ColliderLoad>& /*loads*/) override {
        for (const BlockRecord& block : blocks) gains_.insert(gains_.end(), block.heat.begin(), block.heat.end());
    }
    void after_generation(const ParticleRange& generation, const TimeSpan& step) override {
        heat_.after_move(store_.particles(), generation, step, std::exchange(gains_, {}));
    }

private:
    HeatStage& heat_;
    ParticleStore& store_;
    std::vector<HeatGain> gains_;  // in this generation
};

/// Moves the children of clouds behind their parents.
class CloudsModule final : public Module {
public:
    CloudsModule(CloudMotion& clouds, const ModuleParts& parts)
        : clouds_(clouds), store_(parts.store), bounds_(parts.bounds), retirement_(parts.retirement) {}

    void begin_step(const TimeSpan& /*step*/) override { clouds_.begin_step(); }
    void before_generation(const ParticleRange& generation, const TimeSpan& /*step*/) override {
        clouds_.before_move(generation);
    }
    void after_substep(const ParticleRange& generation, const TimeSpan& substep,
                       std::vector<BlockRecord>& blocks) override {
        clouds_.move(generation, substep, blocks);
    }
    void before_removal(double time) override {
        if (bounds_) clouds_.part_from_leavers(retirement_, time);
    }
    void append() override { clouds_.append(); }
    void compact(const std::vector<std::uint8_t>& keep) override { clouds_.compact(keep); }
    [[nodiscard]] const char* fault_of(std::size_t i) const override {
        return clouds_.is_sound(i, store_.next_id()) ? nullptr : "a particle of an unknown cloud";
    }

private:
    CloudMotion& clouds_;
    const ParticleStore& store_;
    const std::optional<Box3>& bounds_;
    const Retirement& retirement_;
};

/// Solves the impacts and contacts of spheres with each other.
class SpheresModule final : public Module {
public:
    SpheresModule(PairMotion& pairs, const ModuleParts& parts)
        : pairs_(pairs), store_(parts.store), recorder_(parts.recorder), verifies_(parts.check != nullptr) {}

    void before_substep(const ParticleRange& generation, const TimeSpan& substep) override {
        pairs_.solve(generation, substep);
    }
    void after_substep(const ParticleRange& /*generation*/, const TimeSpan& substep,
                       std::vector<BlockRecord>& blocks) override {
        pairs_.write_back(substep, blocks);
        SimulationStatistics& statistics = recorder_.statistics();
        statistics.pair_impacts += pairs_.counts().impacts;
        statistics.overlap_largest = std::max(statistics.overlap_largest, pairs_.counts().largest_overlap);
        recorder_.add_pair_impacts(pairs_.impacts());
        if (verifies_) recorder_.add_pair_violations(RunCheck::check_meetings(pairs_.meetings(), pairs_.books()));
    }
    void count(SimulationStatistics& statistics) const override { statistics.unsolved_steps += pairs_.unsolved(); }
    void wake_all(double time) override { pairs_.wake_all(time); }
    [[nodiscard]] const char* fault_of(std::size_t i) const override {
        return pairs_.has_material(i) ? nullptr : "a particle of an unknown material";
    }
    [[nodiscard]] const char* fault(double /*time*/) const override {
        return pairs_.is_sound(store_.next_id()) ? nullptr : "impossible contacts or sleeping particles";
    }

private:
    PairMotion& pairs_;
    const ParticleStore& store_;
    RunRecorder& recorder_;
    bool verifies_;
};

/// Plans the motion of particles that springs, or forces between particles, couple. Children join in the next step.
class SpringsModule final : public Module {
public:
    explicit SpringsModule(const ModuleParts& parts) : parts_(parts) {}

    void before_generation(const ParticleRange& generation, const TimeSpan& /*step*/) override {
        if (moves(generation)) parts_.mover.begin_step();
    }
    double plan(const ParticleRange& generation, const TimeSpan& rest) override {
        if (generation.are_children) return rest.end;
        const double planned = parts_.share.keeps_together() ? plan_on_first_rank(rest) : plan_here(rest);
        return planned < rest.end - rest.begin ? rest.begin + planned : rest.end;
    }
    void after_substep(const ParticleRange& generation, const TimeSpan& substep,
                       std::vector<BlockRecord>& blocks) override {
        if (!moves(generation)) return;
        const CoupledMotion::Correction correction = parts_.coupled.correct_velocities(parts_.store.particles());
        parts_.mover.apply_correction(correction.corrections, substep, blocks);
        if (correction.runaway) {
            blocks.emplace_back().note({*correction.runaway, correction.runaway_speed, RunawayCause::others});
        }
    }
    void after_generation(const ParticleRange& generation, const TimeSpan& /*step*/) override {
        if (moves(generation)) parts_.coupled.settle(parts_.store.particles());
    }
    void count(SimulationStatistics& statistics) const override {
        if (!parts_.coupled.is_active()) return;
        statistics.springs_broken = parts_.coupled.springs().broken();
        statistics.springs_lost = parts_.coupled.springs().lost();
        statistics.unsolved_steps += parts_.coupled.unsolved_steps();
    }
    void bind() override {
        if (parts_.coupled.is_active()) parts_.coupled.bind(parts_.store.particles());
    }
    [[nodiscard]] bool allows_deferred_steps() const override { return !parts_.coupled.is_active(); }

private:
    /// Coupled particles live on the first rank. The others only follow its plan.
    [[nodiscard]] bool moves(const ParticleRange& generation) const {
        return parts_.coupled.is_active() && !generation.are_children;
    }
    /// Plans the motion of this process's particles. Returns the planned duration, in s.
    [[nodiscard]] double plan_here(const TimeSpan& rest) {
        // A particle under load from other spheres is assumed to keep its velocity, like one supported by a wall.
        const std::vector<std::uint8_t> pressing =
            parts_.pairs != nullptr ? parts_.pairs->pressing() : std::vector<std::uint8_t>();
        const auto hold = [&](std::size_t i, const Vec3& pull) {
            if (!pressing.empty() && pressing[i] != 0) return Vec3{};
            return parts_.mover.supported_acceleration(i, rest.begin, pull);
        };
        return parts_.coupled.plan(parts_.store.particles(), rest.begin, rest.end - rest.begin,
                                   {parts_.world, parts_.materials, parts_.options.resting_speed}, hold);
    }
    /// All ranks follow the plan of the first one, or end with its message.
    [[nodiscard]] double plan_on_first_rank(const TimeSpan& rest) {
        double planned = rest.end - rest.begin;
        std::optional<std::string> message;
        try {
            if (parts_.coupled.is_active()) planned = plan_here(rest);
        } catch (const DivergedError& error) {
            message = error.what();
        }
        if (const auto first = parts_.share.first_message(message, 0)) throw DivergedError(*first);
        return parts_.share.shortest(planned);
    }

    ModuleParts parts_;
};

/// Moves dynamic bodies. A step is divided into substeps in which planned and actual loads agree.
class BodiesModule final : public Module {
public:
    explicit BodiesModule(const ModuleParts& parts) : parts_(parts) {}

    void begin_step(const TimeSpan& step) override {
        parts_.driven.begin_step();
        parts_.driven.plan(step.begin, step.end, oldest_position());
    }
    void before_generation(const ParticleRange& generation, const TimeSpan& /*step*/) override {
        if (!generation.are_children) parts_.mover.begin_step();
    }
    /// Children repeat the substeps that the other particles have already taken, with the bodies on the same paths.
    double plan(const ParticleRange& generation, const TimeSpan& rest) override {
        const TimeSpan part{rest.begin, generation.are_children ? parts_.driven.repeat_substep(rest.begin)
                                                                : plan_new(generation, rest)};
        if (parts_.bodies != nullptr) parts_.bodies->begin_step(part.begin, part.end);
        return part.end;
    }
    void record(const ParticleRange& generation, const std::vector<BlockRecord>& /*blocks*/,
                std::vector<ColliderLoad>& loads) override {
        const std::vector<ColliderLoad> given = loads;
        for (ColliderLoad& load : loads) load.work += parts_.driven.work_by_yielding(load);
        if (generation.are_children) {
            parts_.driven.take(given);
            return;
        }
        parts_.driven.follow(given);
        ++parts_.recorder.statistics().body_parts;
    }
    [[nodiscard]] bool allows_deferred_steps() const override { return true; }
    [[nodiscard]] const char* fault(double time) const override {
        return parts_.driven.is_sound(time) ? nullptr : "a body with an impossible path";
    }

private:
    [[nodiscard]] double plan_new(const ParticleRange& generation, const TimeSpan& rest) {
        TimeSpan part{rest.begin, parts_.driven.next_substep_end(rest.begin, rest.end)};
        parts_.driven.plan(part.begin, part.end, oldest_position());
        return parts_.bodies != nullptr ? settle(generation, part) : part.end;
    }
    /// Plans a substep until the planned loads agree with the loads that the particles exert in it. Returns its end.
    [[nodiscard]] double settle(const ParticleRange& generation, TimeSpan part) {
        for (int round = 0;; ++round) {
            parts_.bodies->begin_step(part.begin, part.end);
            const std::vector<ColliderLoad> preview = parts_.mover.preview(generation, part);
            const bool is_planned_again = parts_.driven.plan_again(preview, parts_.driven.cut_by(preview), round);
            part.end = parts_.driven.planned_end();
            if (!is_planned_again) return part.end;
        }
    }
    /// Returns the earliest time, in s, at which a particle's position is stored. It is at most the start of the step,
    /// because children may start there.
    [[nodiscard]] double oldest_position() const {
        const double now = parts_.clock.time_at(parts_.recorder.statistics().steps);
        double oldest = now;
        for (std::size_t i = 0; i < parts_.store.size(); ++i) {
            oldest = std::min(oldest, parts_.store.stored_time(i, now));
        }
        return oldest;
    }

    ModuleParts parts_;
};

/// Checks every step with independent code.
class VerificationModule final : public Module {
public:
    VerificationModule(RunCheck& check, const ModuleParts& parts)
        : check_(check),
          store_(parts.store),
          recorder_(parts.recorder),
          clock_(parts.clock),
          contacts_(parts.options.particle_contacts) {}

    void verify(const TimeSpan& step) override {
        if (contacts_) verify_spheres(step);
        if (recorder_.statistics().steps + 1 < clock_.steps()) return;
        recorder_.add_violations(check_.check_end(store_.particles(), step.end));
    }
    void compact(const std::vector<std::uint8_t>& keep) override { check_.compact(keep); }
    void bind() override { check_.add_spawned(store_.size()); }
    void restart(double time) override { check_.restart(store_, time); }

private:
    void verify_spheres(const TimeSpan& step) {
        const double most = contacts_->method != PairMethod::events ? kMostPlannedOverlap : kMostMetOverlap;
        recorder_.add_pair_violations(check_.check_spheres(store_.particles(), step, most));
        SimulationStatistics& statistics = recorder_.statistics();
        statistics.overlap_verified = std::max(statistics.overlap_verified, check_.largest_overlap());
    }

    RunCheck& check_;
    const ParticleStore& store_;
    RunRecorder& recorder_;
    const StepClock& clock_;
    const std::optional<PairContactSettings>& contacts_;
};

}  // namespace

ModuleList make_modules(const ModuleParts& parts) {
    ModuleList modules;
    if (parts.offspring != nullptr) modules.add(std::make_unique<ChildrenModule>(*parts.offspring, parts.store));
    if (parts.heat != nullptr) modules.add(std::make_unique<HeatModule>(*parts.heat, parts.store));
    if (parts.clouds != nullptr) modules.add(std::make_unique<CloudsModule>(*parts.clouds, parts));
    if (parts.pairs != nullptr) modules.add(std::make_unique<SpheresModule>(*parts.pairs, parts));
    if (parts.coupled.is_active() || parts.share.keeps_together()) modules.add(std::make_unique<SpringsModule>(parts));
    if (parts.driven.is_active()) modules.add(std::make_unique<BodiesModule>(parts));
    if (parts.check != nullptr) modules.add(std::make_unique<VerificationModule>(*parts.check, parts));
    if (parts.counters != nullptr) modules.add(std::make_unique<CountersModule>(*parts.counters));
    return modules;
}

}  // namespace ricochet
