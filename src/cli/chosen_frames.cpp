#include "cli/chosen_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
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

FrameFile nearest_frame(const RunFolder& folder, double time) {
    const auto away = [&](const FrameFile& frame) {
        return std::fabs(static_cast<double>(frame.step) * folder.info.time_step - time);
    };
    return *std::min_element(folder.frames.begin(), folder.frames.end(),
                             [&](const FrameFile& a, const FrameFile& b) { return away(a) < away(b); });
}

}  // namespace ricochet::cli
