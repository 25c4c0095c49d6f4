/// \file
/// Continuation of a run in a folder: an interrupted run from its checkpoint, or a finished run to a later time.
#pragma once

#include <cstdint>
#include <filesystem>

#include "cli/run_scene.h"
#include "ricochet/simulation.h"

namespace ricochet::cli {

/// Throws InputError if --extend is not a positive time, or is given without --resume.
void check_extension(const RunArguments& arguments);

/// Returns the last step with a frame from which a longer run of the same scene can resume. `every` is the number of
/// steps between frames.
[[nodiscard]] std::uint64_t last_step_to_extend(const Simulation& simulation, std::uint64_t every);

/// Returns the file from which the run in the folder resumes. `simulation` must be at its first step. Throws InputError
/// if the run is finished and is not extended by at least one step.
[[nodiscard]] std::filesystem::path resumed_file(const RunArguments& arguments, const Simulation& simulation);

/// Throws InputError if the run is already beyond the requested end. Accepts a run that was killed exactly at the
/// requested end.
void require_end_ahead(const RunArguments& arguments, const Simulation& simulation);

/// Warns if a resumed run stops writing its contact log.
void warn_of_ended_log(const RunArguments& arguments, const Simulation& simulation);

}  // namespace ricochet::cli
