/// \file
/// Private to the simulation: the parts of a running simulation, and its step.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "ricochet/simulation.h"
#include "ricochet/simulation/births.h"
#include "ricochet/simulation/collision_scene.h"
#include "ricochet/simulation/modules.h"
#include "ricochet/simulation/state_archive.h"
#include "ricochet/simulation/step_control.h"

namespace ricochet {

/// The parts of a running simulation. Members refer to members above them, so the object must not be moved.
struct Simulation::Impl {
    /// setup: most of its parts are moved out. particle_bytes: memory of one more particle, in bytes.
    Impl(SimulationSetup& setup, double particle_bytes);

    // A step, see step.cpp.

    void step();
    void make_step();
    void move_generation(const ParticleRange& generation, const TimeSpan& step);
    void move_substep(const ParticleRange& generation, const TimeSpan& substep, std::vector<BlockRecord>& blocks);
    void record(const ParticleRange& generation, const std::vector<BlockRecord>& blocks);
    void step_unless_stopped(const std::function<bool()>& goes_on);
    void keep_return_point();
    void go_back();

    // The state between two steps.

    [[nodiscard]] double now() const { return clock.time_at(recorder.statistics().steps); }
    [[nodiscard]] const Particles& particles() const { return population.particles(); }
    [[nodiscard]] const CoupledMotion& coupled() const { return *modules.hooks().coupled; }
    [[nodiscard]] ModuleParts parts() {
        return {options, warnings,       clock, share, scene, *response, recorder, population, emission.emitters(),
                mover,   modules.hooks()};
    }
    void restore(const ByteSource& source);
    void wake_all_sleepers();

    SimulationOptions options;
    StartWarnings warnings;
    StepClock clock;
    RankShare share;
    ForceField forces;
    CollisionScene scene;
    CollisionQueries queries;
    StepControl control;
    std::unique_ptr<Response> response;
    RunRecorder recorder;
    ModuleList modules;
    Population population;
    Emission emission;
    ActiveMover mover;
    ContactReporter reporter;
};

}  // namespace ricochet
