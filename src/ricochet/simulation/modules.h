/// \file
/// Private to the simulation: the list of its modules, and the modules that other parts of a run read.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/simulation.h"
#include "ricochet/simulation/coupled_motion.h"
#include "ricochet/simulation/driven_motion.h"
#include "ricochet/simulation/module.h"
#include "ricochet/simulation/offspring.h"
#include "ricochet/simulation/population.h"
#include "ricochet/simulation/rank_balance.h"
#include "ricochet/simulation/rank_share.h"
#include "ricochet/simulation/start_warnings.h"

namespace ricochet {

class CloudMotion;
class PairMotion;
struct WholeRun;

/// Parts of a run that modules use. All must outlive the modules.
struct ModuleParts {
    const SimulationOptions& options;
    const StartWarnings& warnings;
    const StepClock& clock;
    RankShare& share;
    CollisionScene& scene;
    const Response& response;
    RunRecorder& recorder;
    Population& population;
    const std::vector<Emitter>& emitters;
    ActiveMover& mover;
    MoveHooks& hooks;  ///< modules set the pointers to their objects
};

/// Adds the children of each generation, and records all births.
class ChildrenModule final : public Module {
public:
    explicit ChildrenModule(const ModuleParts& parts);

    /// Sets the clouds, which must outlive the module.
    void set_clouds(CloudMotion& clouds);
    /// Returns the particles born in the last step.
    [[nodiscard]] const std::vector<BirthRecord>& births() const { return births_; }
    /// Discards the births of a stopped step.
    void forget_births() { births_.clear(); }

    void begin_step(const TimeSpan& step) override;
    void before_generation(const ParticleRange& generation, const TimeSpan& step) override;
    bool spawn(const TimeSpan& step) override;
    void end_step(SimulationStatistics& statistics) override;
    void append() override;
    void restart(double /*time*/) override { is_in_step_ = false; }

private:
    void inherit_sides(const Child& child);
    void count(const OffspringCounts& counts);

    ModuleParts parts_;
    Offspring offspring_;
    CloudMotion* clouds_ = nullptr;  // null without clouds
    std::vector<BirthRecord> births_;
    bool is_in_step_ = false;  // false between steps, when users can add particles
};

/// Plans the motion of particles that are coupled by springs or by forces between particles. Children are coupled from
/// the next step on. Every run has this module, which does nothing without coupled particles. If several ranks share
/// the run, particles with springs stay on the first rank, which plans their motion.
class SpringsModule final : public Module {
public:
    /// setup: its springs and its forces between particles are moved out.
    SpringsModule(SimulationSetup& setup, const ModuleParts& parts);

    [[nodiscard]] const CoupledMotion& motion() const { return motion_; }
    [[nodiscard]] const std::vector<SpringFace>& faces() const { return faces_; }
    /// Sets the motion of spheres that collide with each other. pairs must outlive the module.
    void set_pairs(const PairMotion& pairs) { pairs_ = &pairs; }

    void before_generation(const ParticleRange& generation, const TimeSpan& step) override;
    double plan(const ParticleRange& generation, const TimeSpan& rest) override;
    void correct(const ParticleRange& generation, const TimeSpan& substep, std::vector<BlockRecord>& blocks) override;
    void after_generation(const ParticleRange& generation, const TimeSpan& step) override;
    void end_step(SimulationStatistics& statistics) override;
    void bind() override;
    [[nodiscard]] bool allows_deferred_steps() const override { return !motion_.is_active(); }
    void archive(BinaryWriter& a) override { motion_.archive(a); }
    void archive(BinaryReader& a) override { motion_.archive(a); }

private:
    [[nodiscard]] bool moves(const ParticleRange& generation) const {
        return motion_.is_active() && !generation.are_children;
    }
    [[nodiscard]] double plan_here(const TimeSpan& rest);
    [[nodiscard]] double plan_on_first_rank(const TimeSpan& rest);

    ModuleParts parts_;
    CoupledMotion motion_;
    std::vector<SpringFace> faces_;
    const PairMotion* pairs_ = nullptr;  // null if spheres pass through each other
};

/// Moves dynamic bodies, in substeps in which planned and actual loads agree. Every run has this module.
class BodiesModule final : public Module {
public:
    /// Plans the first step. bodies: see DrivenMotion.
    BodiesModule(std::vector<BodyDescription> bodies, const ModuleParts& parts);

    [[nodiscard]] const std::vector<DrivenBody>& bodies() const { return motion_.bodies(); }

    void begin_step(const TimeSpan& step) override;
    void before_generation(const ParticleRange& generation, const TimeSpan& step) override;
    double plan(const ParticleRange& generation, const TimeSpan& rest) override;
    void record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks,
                std::vector<ColliderLoad>& loads) override;
    [[nodiscard]] bool allows_deferred_steps() const override { return true; }
    [[nodiscard]] const char* fault(double time) const override;
    void add_to_fingerprint(StateHash& hash) const override;
    void archive(BinaryWriter& a) override;
    void archive(BinaryReader& a) override;

private:
    template <class Archive>
    void archive_bodies(Archive& a);
    [[nodiscard]] double settle(const ParticleRange& generation, TimeSpan part);
    [[nodiscard]] double oldest_position() const;

    ModuleParts parts_;
    DrivenMotion motion_;
};

/// Divides the particles of a run between its ranks, moves particles to other ranks to balance the work, and gathers
/// the run on the first rank. Particles change ranks only after their deferred steps.
class SharedRun final : public Module {
public:
    explicit SharedRun(const ModuleParts& parts) : parts_(parts) {}

    /// Keeps only this rank's particles, and the counts on the first rank. All ranks must have all particles before.
    void take_share();
    [[nodiscard]] const RankBalance& balance() const { return balancer_.balance(); }
    /// Returns the whole run on the first rank. All ranks must call this function.
    [[nodiscard]] WholeRun gather(Shown what);

    void begin_step(const TimeSpan& step) override;
    void before_substep(const ParticleRange& generation, const TimeSpan& substep) override;
    void record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks,
                std::vector<ColliderLoad>& loads) override;
    void end_step(SimulationStatistics& statistics) override;
    [[nodiscard]] bool allows_deferred_steps() const override { return true; }

private:
    void give_away(TransferChoice choice);
    [[nodiscard]] std::vector<std::byte> bytes_for(std::uint32_t rank, const std::vector<std::uint32_t>& goes_to) const;

    ModuleParts parts_;
    RankBalancer balancer_;
    WorkCounts work_;  // work of the present substep
};

/// Returns the module that ends a run in which a particle was accelerated beyond kMaxSpeed.
[[nodiscard]] std::unique_ptr<Module> make_runaways(const ModuleParts& parts);

/// Adds the modules of a run, in the order of their calls. setup: the settings of modules are moved out.
void add_modules(ModuleList& modules, SimulationSetup& setup, const ModuleParts& parts);

}  // namespace ricochet
