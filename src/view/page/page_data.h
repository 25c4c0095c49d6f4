/// \file
/// Data of a page: the frames of a run as blocks that fit a budget, and the description for the page's script.
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

/// A run, loaded for its page.
struct PageSource {
    const RunFolder& folder;
    std::vector<FrameFile> frames;  ///< frames that can be shown
    ColliderParts colliders;
    RunSurvey survey;
    Camera camera;
};

/// Reads a run, see write_run_page().
[[nodiscard]] PageSource page_source(const RunFolder& folder, const PageShapes& shapes,
                                     const std::function<void(double)>& progress);

/// Blocks of frames as stored in the page: compressed, as text.
struct PageFrames {
    PageDetail detail;
    std::vector<std::size_t> chosen;  ///< indices into PageSource::frames
    std::vector<std::string> blocks;
    std::vector<std::size_t> counts;  ///< number of particles in each frame
    std::uint64_t left_out = 0;       ///< number of particles that are too far from all others, summed over frames
};

/// Returns the frames with the most detail that fits into the given bytes. Throws InputError with the budget if
/// nothing fits.
[[nodiscard]] PageFrames fitted_frames(const PageSource& source, double bytes, const PageOptions& options);

/// Returns the description of the run as JSON for the page's script. It is ASCII without tag characters, so that it is
/// safe inside a <script>.
[[nodiscard]] std::string page_description(const PageSource& source, const PageFrames& frames,
                                           const PageOptions& options, const std::vector<std::string>& notes);

}  // namespace ricochet
