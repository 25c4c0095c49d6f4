#include "view/page/run_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/dynamics/particles.h"
#include "view/export/frame_reader.h"

namespace ricochet {
namespace {

constexpr std::size_t kSampledFrames = 12;
constexpr std::size_t kSampledParticles = 20'000;  // number of sampled particles per frame
/// Margin around the bulk (1st to 99th percentile) of positions and values. The unit is the diagonal of the bulk's box,
/// or the width of the bulk's range. Outliers beyond the margin are cut, because a larger range would reduce the
/// precision of all other values.
constexpr double kReach = 4.0;
/// Width below which the bulk of an attribute's values counts as a single value. In this case no outliers are cut.
constexpr double kNarrow = 1e-9;

// Range and sample of one array in one frame.
struct ArrayFacts {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    bool has_gaps = false;
    std::vector<double> sample;
};

struct FrameFacts {
    double time = 0.0;
    std::uint64_t count = 0;
    Box3 box;
    std::vector<Vec3> sample;
    std::vector<ArrayFacts> arrays;
    std::vector<std::int64_t> spring_ids;
    std::int64_t largest_id = 0;
};

bool is_scalar_whole(const VtkArray& array) {
    return std::holds_alternative<std::vector<std::uint32_t>>(array.values) ||
           std::holds_alternative<std::vector<std::uint8_t>>(array.values) ||
           std::holds_alternative<std::vector<std::int64_t>>(array.values);
}

std::vector<PageAttribute> attributes_of(const VtkPolyData& frame) {
    std::vector<PageAttribute> attributes;
    for (const VtkArray& array : frame.point_arrays) {
        if (array.name == "id" || array.name == kColorAttribute) continue;
        PageAttribute attribute;
        attribute.array = array.name;
        attribute.name = array.name == "velocity" ? "speed" : array.name;
        attribute.is_whole = is_scalar_whole(array);
        attributes.push_back(attribute);
    }
    return attributes;
}

ArrayFacts array_facts(const std::vector<double>& values, bool is_sampled) {
    ArrayFacts facts;
    for (const double value : values) {
        if (!std::isfinite(value)) {
            facts.has_gaps = true;
            continue;
        }
        facts.low = std::min(facts.low, value);
        facts.high = std::max(facts.high, value);
    }
    const std::size_t stride = values.size() / kSampledParticles + 1;
    for (std::size_t i = 0; is_sampled && i < values.size(); i += stride) facts.sample.push_back(values[i]);
    return facts;
}

FrameFacts frame_facts(const FrameFile& file, const std::vector<PageAttribute>& attributes, bool is_sampled) {
    const VtkPolyData frame = read_frame(file.path);
    const std::vector<std::int64_t>& ids = frame_ids(frame, file);
    FrameFacts facts;
    facts.time = frame.time;
    facts.count = frame.points.size();
    facts.largest_id = ids.empty() ? 0 : ids.back();
    for (const Vec3& point : frame.points) {
        if (is_finite(point)) facts.box.include(point);
    }
    const std::size_t stride = frame.points.size() / kSampledParticles + 1;
    for (std::size_t i = 0; is_sampled && i < frame.points.size(); i += stride) {
        if (is_finite(frame.points[i])) facts.sample.push_back(frame.points[i]);
    }
    for (const PageAttribute& attribute : attributes) {
        facts.arrays.push_back(array_facts(attribute_values(frame, attribute, file), is_sampled));
    }
    for (const VtkLine& line : frame.lines) {
        for (const std::uint32_t end : line) facts.spring_ids.push_back(ids[end]);
    }
    for (const Triangle& triangle : frame.triangles) {
        for (const std::uint32_t corner : triangle) facts.spring_ids.push_back(ids[corner]);
    }
    std::sort(facts.spring_ids.begin(), facts.spring_ids.end());
    facts.spring_ids.erase(std::unique(facts.spring_ids.begin(), facts.spring_ids.end()), facts.spring_ids.end());
    return facts;
}

// Returns the box from the 1st to the 99th percentile of the points along each axis.
Box3 bulk_box(const std::vector<Vec3>& points) {
    Box3 box;
    if (points.empty()) return box;
    Vec3 lower;
    Vec3 upper;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double> values;
        values.reserve(points.size());
        for (const Vec3& point : points) values.push_back(point[axis]);
        const ValueRange range = robust_range(std::move(values));
        lower[axis] = range.low;
        upper[axis] = range.high;
    }
    box.include(lower);
    box.include(upper);
    return box;
}

// Returns the box of all particles except outliers far from the bulk and from the colliders.
Box3 shown_box(const Box3& all, Box3 bulk) {
    if (all.empty()) return all;
    const double reach = kReach * bulk.diagonal();
    const Vec3 margin{reach, reach, reach};
    return {max(all.lower, bulk.lower - margin), min(all.upper, bulk.upper + margin)};
}

void set_ranges(PageAttribute& attribute, ArrayFacts facts) {
    attribute.has_gaps = facts.has_gaps;
    if (facts.low > facts.high) return;  // the attribute has no finite value
    attribute.shown = robust_range(std::move(facts.sample));
    const double width = attribute.shown.high - attribute.shown.low;
    const bool is_narrow = width <= 0.01 * std::fabs(attribute.shown.low) || width < kNarrow;
    attribute.low = is_narrow ? facts.low : std::max(facts.low, attribute.shown.low - kReach * width);
    attribute.high = is_narrow ? facts.high : std::min(facts.high, attribute.shown.high + kReach * width);
    attribute.is_cut = attribute.low > facts.low || attribute.high < facts.high;
    if (is_narrow) {
        attribute.shown = {attribute.low, attribute.high};
        return;
    }
    // The range of the colour scale stays within the actual values. It begins at 0 if no value is negative and its
    // lower end is close to 0.
    attribute.shown = {std::max(attribute.shown.low, facts.low), std::min(attribute.shown.high, facts.high)};
    if (facts.low >= 0.0 && attribute.shown.low < 0.25 * attribute.shown.high) attribute.shown.low = 0.0;
}

std::vector<bool> spread_choice(std::size_t count) {
    std::vector<bool> is_chosen(count, count <= kSampledFrames);
    for (std::size_t i = 0; i < kSampledFrames; ++i) is_chosen[i * (count - 1) / (kSampledFrames - 1)] = true;
    return is_chosen;
}

RunSurvey joined(std::vector<FrameFacts>& facts, std::vector<PageAttribute> attributes, const Box3& colliders) {
    RunSurvey survey;
    Box3 all;
    std::vector<ArrayFacts> arrays(attributes.size());
    for (FrameFacts& frame : facts) {
        survey.times.push_back(frame.time);
        survey.counts.push_back(frame.count);
        survey.largest_id = std::max(survey.largest_id, frame.largest_id);
        all.include(frame.box);
        survey.sample.insert(survey.sample.end(), frame.sample.begin(), frame.sample.end());
        for (std::size_t a = 0; a < arrays.size(); ++a) {
            arrays[a].low = std::min(arrays[a].low, frame.arrays[a].low);
            arrays[a].high = std::max(arrays[a].high, frame.arrays[a].high);
            arrays[a].has_gaps = arrays[a].has_gaps || frame.arrays[a].has_gaps;
            arrays[a].sample.insert(arrays[a].sample.end(), frame.arrays[a].sample.begin(),
                                    frame.arrays[a].sample.end());
        }
        std::vector<std::int64_t> both;
        std::set_union(survey.spring_ids.begin(), survey.spring_ids.end(), frame.spring_ids.begin(),
                       frame.spring_ids.end(), std::back_inserter(both));
        survey.spring_ids = std::move(both);
    }
    survey.has_springs = !survey.spring_ids.empty();
    Box3 bulk = bulk_box(survey.sample);
    if (!colliders.empty()) bulk.include(colliders);
    survey.box = shown_box(all, bulk);
    survey.origin = bulk.empty() ? Vec3{} : bulk.center();
    for (std::size_t a = 0; a < arrays.size(); ++a) set_ranges(attributes[a], std::move(arrays[a]));
    survey.attributes = std::move(attributes);
    return survey;
}

}  // namespace

std::uint64_t RunSurvey::total() const { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

const std::vector<std::int64_t>& frame_ids(const VtkPolyData& frame, const FrameFile& file) {
    const VtkArray* const array = find_array(frame.point_arrays, "id");
    const auto* const ids = array == nullptr ? nullptr : std::get_if<std::vector<std::int64_t>>(&array->values);
    if (ids == nullptr) throw InputError(fmt::format("{}: has no array id", file.path.string()));
    for (std::size_t i = 0; i < ids->size(); ++i) {
        if ((*ids)[i] < 0 || (i > 0 && (*ids)[i] <= (*ids)[i - 1])) {
            throw InputError(
                fmt::format("{}: particle {} has the id {}, expected ids that grow from particle to "
                            "particle",
                            file.path.string(), i, (*ids)[i]));
        }
    }
    return *ids;
}

std::vector<double> attribute_values(const VtkPolyData& frame, const PageAttribute& attribute, const FrameFile& file) {
    const VtkArray* const array = find_array(frame.point_arrays, attribute.array);
    if (array == nullptr) {
        throw InputError(
            fmt::format("{}: has no array {}, which the run's first frame has", file.path.string(), attribute.array));
    }
    return scalar_values(*array);
}

RunSurvey survey_run(const std::vector<FrameFile>& frames, const Box3& colliders,
                     const std::function<void(double)>& progress) {
    const VtkPolyData first = read_frame(frames.front().path);
    const std::vector<PageAttribute> attributes = attributes_of(first);
    const std::vector<bool> is_sampled = spread_choice(frames.size());
    std::vector<FrameFacts> facts(frames.size());
    std::size_t done = 0;
    std::mutex mutex;
    parallel_for_blocks(frames.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
        facts[i] = frame_facts(frames[i], attributes, is_sampled[i]);
        const std::lock_guard lock(mutex);
        progress(static_cast<double>(++done) / static_cast<double>(frames.size()));
    });
    RunSurvey survey = joined(facts, attributes, colliders);
    survey.has_colors = find_array(first.point_arrays, kColorAttribute) != nullptr;
    return survey;
}

}  // namespace ricochet
