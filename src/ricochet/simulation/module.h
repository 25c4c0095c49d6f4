/// \file
/// Private to the simulation: modules, parts of a run that the stages of a step call, and the list of modules.
///
/// A module owns the objects of one capability. A stage calls it once for all particles of a generation or a block.
/// A module that reads the paths or impacts of particles overrides the functions of MoveObserver. Objects that take
/// part in the motion of single particles are in MoveHooks. The list in modules.cpp has the modules in the order of
/// their calls. A new module needs its class, a line in that list, and tests.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "ricochet/core/binary_archive.h"
#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/run_recorder.h"

namespace ricochet {

class StateHash;

/// Base class of modules. A function that a module does not override does nothing. A step calls the functions in the
/// order of declaration. It calls before_generation() to spawn() once per spawn generation, and plan() to record() once
/// per substep of the generation.
class Module : public MoveObserver {
public:
    // Stages of a step.

    virtual void begin_step(const TimeSpan& /*step*/) {}
    virtual void before_generation(const ParticleRange& /*generation*/, const TimeSpan& /*step*/) {}
    /// Plans the next substep. Returns its end, in s, which is at most rest.end. rest: remaining time of the step, or
    /// the substep that an earlier module has planned. Only SpringsModule and BodiesModule override this function.
    virtual double plan(const ParticleRange& /*generation*/, const TimeSpan& rest) { return rest.end; }
    virtual void before_substep(const ParticleRange& /*generation*/, const TimeSpan& /*substep*/) {}
    /// Moves the module's own particles, after those that no module moves. blocks: records of the substep so far.
    virtual void after_substep(const ParticleRange& /*generation*/, const TimeSpan& /*substep*/,
                               std::vector<BlockRecord>& /*blocks*/) {}
    /// Corrects velocities after all particles of the generation have been moved, or throws if this is impossible.
    virtual void correct(const ParticleRange& /*generation*/, const TimeSpan& /*substep*/,
                         std::vector<BlockRecord>& /*blocks*/) {}
    /// Processes the records of the substep. Modules can complete the loads of all blocks before they are recorded.
    virtual void record(const ParticleRange& /*generation*/, const std::vector<BlockRecord>& /*blocks*/,
                        std::vector<ColliderLoad>& /*loads*/) {}
    virtual void after_generation(const ParticleRange& /*generation*/, const TimeSpan& /*step*/) {}
    /// Adds the particles that the generation has spawned. Returns true if any rank has added particles.
    virtual bool spawn(const TimeSpan& /*step*/) { return false; }
    /// Removes particles at the end of a step, or prepares their removal by other code. time: end of the step, in s.
    virtual void retire(double /*time*/) {}
    /// Checks the state at the end of a step.
    virtual void verify(const TimeSpan& /*step*/) {}
    /// Ends a step, and writes the module's counts into the statistics of the run.
    virtual void end_step(SimulationStatistics& /*statistics*/) {}

    // Changes of the population. The store has changed already.

    /// Called after one particle was appended.
    virtual void append() {}
    /// Called after the particles whose flag is 0 were removed.
    virtual void compact(const std::vector<std::uint8_t>& /*keep*/) {}
    /// Called after particles were added, removed or replaced, so that indices and arrays have changed.
    virtual void bind() {}
    /// Called when the run continues from a restored state at a time, in s.
    virtual void restart(double /*time*/) {}
    /// Wakes sleeping particles at a time, in s, because the forces have changed.
    virtual void wake_all(double /*time*/) {}

    // State.

    /// Returns true if the module does not need the positions of particles in free flight in every step.
    [[nodiscard]] virtual bool allows_deferred_steps() const { return false; }
    /// Returns the reason why no run can produce the restored state of particle i. Returns null for a valid state.
    [[nodiscard]] virtual const char* fault_of(std::size_t /*i*/) const { return nullptr; }
    /// Returns the reason why no run can produce the restored state at a time, in s; null for a valid state.
    [[nodiscard]] virtual const char* fault(double /*time*/) const { return nullptr; }
    /// Adds the settings of the module to the fingerprint of a saved state.
    virtual void add_to_fingerprint(StateHash& /*hash*/) const {}
    /// Saves or restores states of particles that the store does not contain.
    virtual void archive_particles(BinaryWriter& /*a*/) {}
    virtual void archive_particles(BinaryReader& /*a*/) {}
    /// Saves or restores the rest of the module's state.
    virtual void archive(BinaryWriter& /*a*/) {}
    virtual void archive(BinaryReader& /*a*/) {}
};

/// The modules of a run, in the order of their calls.
class ModuleList {
public:
    void add(std::unique_ptr<Module> module) {
        hooks_.observers.add(*module);
        modules_.push_back(std::move(module));
    }
    /// Calls call(module) for each module.
    template <class Call>
    void each(const Call& call) const {
        for (const std::unique_ptr<Module>& module : modules_) call(*module);
    }
    /// Returns the module of a class, or null if the run has no such module.
    template <class Kind>
    [[nodiscard]] Kind* find() const {
        for (const std::unique_ptr<Module>& module : modules_) {
            if (auto* const found = dynamic_cast<Kind*>(module.get())) return found;
        }
        return nullptr;
    }
    /// Returns true if no module needs the positions of particles in free flight in every step.
    [[nodiscard]] bool allow_deferred_steps() const {
        return std::ranges::all_of(modules_, [](const auto& module) { return module->allows_deferred_steps(); });
    }
    /// Plans a substep of a generation. Each module can shorten the substep.
    [[nodiscard]] TimeSpan plan(const ParticleRange& generation, TimeSpan rest) const {
        for (const std::unique_ptr<Module>& module : modules_) rest.end = module->plan(generation, rest);
        return rest;
    }
    /// Adds the particles that a generation has spawned. Returns true if any rank has added particles.
    [[nodiscard]] bool spawn(const TimeSpan& step) const {
        bool has_spawned = false;
        for (const std::unique_ptr<Module>& module : modules_) has_spawned = module->spawn(step) || has_spawned;
        return has_spawned;
    }
    /// Returns the objects of the modules that take part in the motion of single particles.
    [[nodiscard]] MoveHooks& hooks() { return hooks_; }
    [[nodiscard]] const MoveHooks& hooks() const { return hooks_; }

private:
    std::vector<std::unique_ptr<Module>> modules_;
    MoveHooks hooks_;
};

}  // namespace ricochet
