#include "cli/chosen_frames.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>

#include "ricochet/core/error.h"

namespace ricochet::cli {

std::vector<FrameFile> chosen_frames(const RunFolder& folder, const std::string& frame, bool takes_all) {
    if (takes_all && frame == "all") return folder.frames;
    if (frame == "last") return {folder.frames.back()};
    std::uint64_t step = 0;
    const auto [stop, error] = std::from_chars(frame.data(), frame.data() + frame.size(), step);
    if (error != std::errc{} || stop != frame.data() + frame.size()) {
        throw InputError(
            fmt::format("--frame {}: expected a step number{}", frame, takes_all ? ", last or all" : " or last"));
    }
    for (const FrameFile& file : folder.frames) {
        if (file.step == step) return {file};
    }
    throw InputError(fmt::format("--frame {}: the run has no such frame; it has {} from step {} to {}", frame,
                                 folder.frames.size(), folder.frames.front().step, folder.frames.back().step));
}

}  // namespace ricochet::cli
