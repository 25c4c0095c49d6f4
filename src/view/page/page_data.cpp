#include "view/page/page_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "view/export/frame_reader.h"
#include "view/page/packing.h"
#include "view/page/page_budget.h"

namespace ricochet {
namespace {

constexpr std::size_t kGroup = 8;  // number of frames that are in memory at the same time

// An estimate of the bytes encodes kEstimateSamples samples of kSampleFrames consecutive frames each. The first
// kSampleStart frames of a sample do not count, because the encoder has too few earlier frames to predict their
// values.
constexpr std::size_t kEstimateSamples = 3;
constexpr std::size_t kSampleFrames = 5;
constexpr std::size_t kSampleStart = 2;
constexpr double kEstimateMargin = 1.03;

// Returns the frames for which the file of the moving colliders exists. A run that was killed while it wrote a frame
// can lack this file.
std::vector<FrameFile> complete_frames(const RunFolder& folder) {
    std::vector<FrameFile> frames = folder.frames;
    const bool any_moves = std::any_of(folder.info.colliders.begin(), folder.info.colliders.end(),
                                       [](const ColliderInfo& collider) { return collider.moves; });
    if (any_moves) std::erase_if(frames, [](const FrameFile& frame) { return frame.moving.empty(); });
    if (frames.empty()) {
        throw InputError(fmt::format("{}: no frame has the positions of the moving colliders (moving_NNNNNN.vtp)",
                                     folder.frames.front().path.parent_path().string()));
    }
    return frames;
}

Camera page_camera(const RunFolder& folder, const RunSurvey& survey, const ColliderParts& colliders) {
    if (const auto& camera = folder.info.camera) {
        return {camera->position, camera->target, folder.info.up, camera->field_of_view_degrees};
    }
    ViewSubject subject{survey.sample, {}};
    for (const ColliderPart& part : colliders.parts()) {
        if (part.plane_normal || part.reach.empty()) continue;
        for (int corner = 0; corner < 8; ++corner) {
            const auto pick = [&](int axis) {
                return (corner >> axis & 1) != 0 ? part.reach.upper[axis] : part.reach.lower[axis];
            };
            subject.colliders.push_back({pick(0), pick(1), pick(2)});
        }
    }
    return automatic_camera(subject, folder.info.up, 16.0 / 9.0);
}

// Returns the rotations of the particles by step. Frames are processed in order of time, because each rotation
// continues the rotation of the previous frame.
std::map<std::uint64_t, std::vector<std::array<float, 3>>> turns_of(const std::vector<FrameFile>& frames,
                                                                    const PageShapes& shapes) {
    std::map<std::uint64_t, std::vector<std::array<float, 3>>> all;
    for (const FrameFile& file : frames) {
        std::vector<std::array<float, 3>>& turns = all[file.step];
        for (const Turn& turn : shapes.turns(read_frame(file.path))) {
            const Vec3 v = turn.w < 0.0 ? -turn.v : turn.v;
            turns.push_back({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
        }
    }
    return all;
}

// Returns the least number of bits of positions for the radii of small spheres. Spheres smaller than a quarter of the
// largest ones are ignored.
int least_position_bits(const RunSurvey& survey) {
    for (const PageAttribute& attribute : survey.attributes) {
        if (attribute.array != "radius" || survey.box.empty()) continue;
        const Vec3 size = survey.box.size();
        const double small = std::max(attribute.shown.low, 0.25 * attribute.shown.high);
        return needed_position_bits(small, std::max({size.x, size.y, size.z}));
    }
    return kLeastPositionBits;
}

// Estimates the bytes of all frames in the page from a few frames.
double estimated_bytes(const PageSource& source, const PageDetail& detail) {
    const std::vector<std::size_t> chosen = detail.chosen_frames(source.frames.size());
    const bool is_short = chosen.size() <= kEstimateSamples * kSampleFrames;
    const std::size_t samples = is_short ? 1 : kEstimateSamples;
    const std::size_t length = is_short ? chosen.size() : kSampleFrames;
    double bytes = 0.0;
    double rows = 0.0;
    for (std::size_t s = 0; s < samples; ++s) {
        const std::size_t begin = is_short ? 0 : s * (chosen.size() - length) / (samples - 1);
        std::vector<PageFrame> frames(length);
        parallel_for_blocks(length, 1, [&](std::size_t i, std::size_t, std::size_t) {
            frames[i] = page_frame(source.frames[chosen[begin + i]], source.survey, detail, source.colliders);
        });
        FrameEncoder encoder(source.survey, detail, source.colliders);
        for (std::size_t i = 0; i < length; ++i) {
            const std::string block = encoder.encode(frames[i]);
            if (!is_short && i < kSampleStart) continue;
            bytes += 4.0 / 3.0 * static_cast<double>(deflated(block).size());
            rows += 100.0 + static_cast<double>(source.survey.counts[chosen[begin + i]]);
        }
    }
    double all = 0.0;
    for (const std::size_t frame : chosen) all += 100.0 + static_cast<double>(source.survey.counts[frame]);
    return kEstimateMargin * bytes * all / rows;
}

// Returns all frames, or std::nullopt if they need more than `bytes`.
std::optional<PageFrames> packed_frames(const PageSource& source, const PageDetail& detail, double bytes,
                                        const std::function<void(double)>& progress) {
    PageFrames result;
    result.detail = detail;
    result.chosen = detail.chosen_frames(source.frames.size());
    FrameEncoder encoder(source.survey, detail, source.colliders);
    double taken = 0.0;
    for (std::size_t begin = 0; begin < result.chosen.size(); begin += kGroup) {
        const std::size_t count = std::min(kGroup, result.chosen.size() - begin);
        std::vector<PageFrame> frames(count);
        parallel_for_blocks(count, 1, [&](std::size_t i, std::size_t, std::size_t) {
            frames[i] = page_frame(source.frames[result.chosen[begin + i]], source.survey, detail, source.colliders);
        });
        std::vector<std::string> blocks;
        for (const PageFrame& frame : frames) {
            blocks.push_back(encoder.encode(frame));
            result.counts.push_back(frame.ids.size());
            result.outside_count += frame.outside_count;
        }
        parallel_for_blocks(count, 1,
                            [&](std::size_t i, std::size_t, std::size_t) { blocks[i] = base64(deflated(blocks[i])); });
        for (std::string& block : blocks) {
            taken += static_cast<double>(block.size());
            result.blocks.push_back(std::move(block));
        }
        if (taken > bytes) return std::nullopt;
        progress(static_cast<double>(begin + count) / static_cast<double>(result.chosen.size()));
    }
    return result;
}

}  // namespace

PageSource page_source(const RunFolder& folder, const PageShapes& shapes, const std::function<void(double)>& progress) {
    std::vector<FrameFile> frames = complete_frames(folder);
    ColliderParts colliders(folder, frames);
    RunSurvey survey = survey_run(frames, colliders.box(), progress);
    if (!shapes.meshes.empty()) survey.turns = turns_of(frames, shapes);
    const Camera camera = page_camera(folder, survey, colliders);
    return {folder, std::move(frames), std::move(colliders), std::move(survey), camera};
}

PageFrames fitted_frames(const PageSource& source, double bytes, const PageOptions& options) {
    const auto most = std::max_element(source.survey.counts.begin(), source.survey.counts.end());
    const std::vector<PageDetail> ladder =
        detail_ladder(source.frames.size(), *most, least_position_bits(source.survey));
    const auto estimate = [&](const PageDetail& detail) { return estimated_bytes(source, detail); };
    std::size_t level = bytes > 0.0 ? first_fitting(ladder, 0, bytes, estimate) : ladder.size();
    for (; level < ladder.size(); ++level) {
        const auto progress = [&](double part) { options.progress(0.5 + 0.5 * part); };
        if (auto frames = packed_frames(source, ladder[level], bytes, progress)) return std::move(*frames);
    }
    const double least = options.budget - bytes + estimate(ladder.back());
    throw InputError(fmt::format("--budget {:g}: too small for this run, expected at least about {:.1f} (MB)",
                                 options.budget / 1e6, std::ceil(least / 1e5) / 10.0));
}

}  // namespace ricochet
