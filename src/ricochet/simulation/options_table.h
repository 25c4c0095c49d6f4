/// \file
/// Private to the library: table of the numeric options of a simulation, see core/setting.h.
#pragma once

#include "ricochet/core/setting.h"
#include "ricochet/simulation/options.h"

namespace ricochet {

/// Largest number of steps of a run. Local: a limit of input values.
inline constexpr double kMostSteps = 1e12;

inline constexpr Setting<SimulationOptions> kTimeTable[] = {
    {"time_step", &SimulationOptions::time_step, kPositive, "s", "Length of a step."},
    {"duration", &SimulationOptions::duration, kNotNegative, "s",
     "Simulated time. The number of steps is ceil(duration / time_step - 1e-6), and at least 1 if the duration "
     "is above 0. The last step ends at the duration."},
};

inline constexpr Setting<SimulationOptions> kRulesTable[] = {
    {"seed", &SimulationOptions::seed, kSeed, "",
     "Seed of all random numbers. The same seed gives the same run, bit for bit."},
    {"resting_speed", &SimulationOptions::resting_speed, kNotNegative, "m/s",
     "Rebound speed below which resting or sliding contact begins, if bounces lose energy and a force presses "
     "the particle on."},
    {"frame_rate", &SimulationOptions::frame_rate, positive_up_to(1e6), "1/s",
     "Frames per second for emitter rates per frame. It affects neither the output nor the time step."},
    {"max_depth", &SimulationOptions::max_depth, kCount, "",
     "Highest generation of particles that are born of particles. Births beyond it are refused and counted."},
    {"most_particles", &SimulationOptions::most_particles, kCount, "",
     "Largest number of particles alive at a time. Births beyond it are refused and counted. It is a fixed "
     "number, so that a run is the same on every machine. It must still fit the memory."},
    {"bounce_budget", &SimulationOptions::bounce_budget, kCountFromOne, "",
     "Largest number of impacts of one particle in one step. Beyond 64 contact intervals, every four intervals "
     "count as one impact. A particle that spends the budget stops for the rest of the step, and the omitted "
     "time is counted."},
};

}  // namespace ricochet
