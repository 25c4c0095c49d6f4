// Selection of a run's frames by the option `--frame`.
#pragma once

#include <string>
#include <vector>

#include "run/run_folder.h"

namespace ricochet::cli {

/// Returns the frames for a step number, `last`, or `all` if that is allowed. Throws InputError.
[[nodiscard]] std::vector<FrameFile> chosen_frames(const RunFolder& folder, const std::string& frame, bool takes_all);

/// Returns the frame nearest to a time, in s. Frame times are computed with the time step in the run's info.
[[nodiscard]] FrameFile nearest_frame(const RunFolder& folder, double time);

}  // namespace ricochet::cli
