/// \file
/// Continuation of a run in a folder: an interrupted run from its checkpoint, or a finished run to a later time.
#pragma once

#include <cstdint>
#include <filesystem>

#include "cli/run_scene.h"
#include "ricochet/simulation.h"

namespace ricochet::cli {

/// Throws InputError unless --extend is a time and the run is resumed.
void check_extension(const RunArguments& arguments);

/// Returns the last step with a frame from which a longer run of the same scene can resume. `every` is the number of
/// steps between frames.
[[nodiscard]] std::uint64_t last_step_to_extend(const Simulation& simulation, std::uint64_t every);

/// Returns the file from which the run in the folder resumes. `simulation` must be at its first step. Throws
/// InputError if the run is finished, unless it is extended by at least one step.
[[nodiscard]] std::filesystem::path resumed_file(const RunArguments& arguments, const Simulation& simulation);

/// Throws InputError if the run is already beyond the requested end. A killed run may be exactly at its end, and is
/// accepted there.
void require_end_ahead(const RunArguments& arguments, const Simulation& simulation);

/// Warns if a resumed run stops writing its contact log.
void warn_of_ended_log(const RunArguments& arguments, const Simulation& simulation);

}  // namespace ricochet::cli
