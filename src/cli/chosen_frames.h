// Frames of a run as `--frame` names them.
#pragma once

#include <string>
#include <vector>

#include "ricochet/io/run_folder.h"

namespace ricochet::cli {

/// The frames that a step number or `last` stands for, or `all` of them where that is allowed. Throws InputError.
[[nodiscard]] std::vector<FrameFile> chosen_frames(const RunFolder& folder, const std::string& frame, bool takes_all);

/// The frame nearest to a time, s; the run says its time step.
[[nodiscard]] FrameFile nearest_frame(const RunFolder& folder, double time);

}  // namespace ricochet::cli
