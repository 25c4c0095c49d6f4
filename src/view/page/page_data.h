/// \file
/// Data of a page: blocks of frames that fit a budget of bytes, and the description of the run for the page's script.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "view/page/collider_parts.h"
#include "view/page/frame_encoder.h"
#include "view/page/run_page.h"
#include "view/page/run_survey.h"
#include "view/render/camera.h"

namespace ricochet {

/// Data of a run that its page needs.
struct PageSource {
    const RunFolder& folder;
    std::vector<FrameFile> frames;  ///< frames that contain all moving colliders
    ColliderParts colliders;
    RunSurvey survey;
    Camera camera;
};

/// Reads a run. Throws like write_run_page().
[[nodiscard]] PageSource page_source(const RunFolder& folder, const PageShapes& shapes,
                                     const std::function<void(double)>& progress);

/// Frames as stored in the page: one block per frame, compressed and encoded as text.
struct PageFrames {
    PageDetail detail;
    std::vector<std::size_t> chosen;  ///< indices into PageSource::frames
    std::vector<std::string> blocks;
    std::vector<std::size_t> counts;  ///< number of particles in each frame
    /// Number of particles that are not shown because they are too far from all others, summed over the frames.
    std::uint64_t outside_count = 0;
};

/// Returns the frames with the most detail that fits into the given bytes. Throws InputError with the budget if
/// nothing fits.
[[nodiscard]] PageFrames fitted_frames(const PageSource& source, double bytes, const PageOptions& options);

/// Returns the description of the run as JSON for the page's script. It is ASCII without tag characters, so that it is
/// safe inside a <script>.
[[nodiscard]] std::string page_description(const PageSource& source, const PageFrames& frames,
                                           const PageOptions& options, const std::vector<std::string>& notes);

}  // namespace ricochet
