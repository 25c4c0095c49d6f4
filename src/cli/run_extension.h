/// \file
/// Where a run of a folder goes on: an interrupted one from its checkpoint, a finished one to a later time.
#pragma once

#include <cstdint>
#include <filesystem>

#include "cli/run_scene.h"
#include "ricochet/simulation.h"

namespace ricochet::cli {

/// Throws InputError unless --extend is a time and the run is resumed.
void check_extension(const RunArguments& arguments);

/// Returns the last step with a frame from which a longer run of the same scene can go on. every: steps between frames.
[[nodiscard]] std::uint64_t last_step_to_extend(const Simulation& simulation, std::uint64_t every);

/// Returns the file that the run in the folder goes on from. simulation: of the scene, before its first step. Throws
/// InputError where the run is finished, unless it is extended by a step at least.
[[nodiscard]] std::filesystem::path resumed_file(const RunArguments& arguments, const Simulation& simulation);

/// Throws InputError where the run has gone beyond the end that is asked for. A killed run may be at its end.
void require_end_ahead(const RunArguments& arguments, const Simulation& simulation);

/// Warns where a run goes on without the contact log that it has had.
void warn_of_ended_log(const RunArguments& arguments, const Simulation& simulation);

}  // namespace ricochet::cli
