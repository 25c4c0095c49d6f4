/// \file
/// The data of a page: the frames of a run as blocks that fit a budget, and what a script needs to read them.
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

/// A run as read for its page.
struct PageSource {
    const RunFolder& folder;
    std::vector<FrameFile> frames;  ///< those that can be shown
    ColliderParts colliders;
    RunSurvey survey;
    Camera camera;
};

/// Reads a run, see write_run_page().
[[nodiscard]] PageSource page_source(const RunFolder& folder, const PageShapes& shapes,
                                     const std::function<void(double)>& progress);

/// Blocks of frames as the page holds them: packed, as text.
struct PageFrames {
    PageDetail detail;
    std::vector<std::size_t> chosen;  ///< indices into PageSource::frames
    std::vector<std::string> blocks;
    std::vector<std::size_t> counts;  ///< particles of each
    std::uint64_t left_out = 0;       ///< particles, summed over frames, that are too far from all others
};

/// The most detail that fits into so many bytes. Throws InputError, naming the budget, where nothing does.
[[nodiscard]] PageFrames fitted_frames(const PageSource& source, double bytes, const PageOptions& options);

/// JSON for the page's script, as it may stand inside a <script>: no character of it is a tag's, all are ASCII.
[[nodiscard]] std::string page_description(const PageSource& source, const PageFrames& frames,
                                           const PageOptions& options, const std::vector<std::string>& notes);

}  // namespace ricochet
