#include "view/page/frame_encoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/particles.h"
#include "view/export/frame_reader.h"
#include "view/render/color_map.h"

namespace ricochet {
namespace {

constexpr std::uint32_t kThinning = 0x7061'6765;  // stream of the random numbers; "page" in ASCII

bool is_kept(std::int64_t id, const RunSurvey& survey, double part) {
    if (part >= 1.0) return true;
    if (std::binary_search(survey.spring_ids.begin(), survey.spring_ids.end(), id)) return true;
    return RandomSequence(0, kThinning, static_cast<std::uint64_t>(id)).uniform() < part;
}

// Returns the rows of a frame that go into the page.
std::vector<std::uint32_t> kept_rows(const VtkPolyData& frame, const std::vector<std::int64_t>& ids,
                                     const RunSurvey& survey, double part, std::uint64_t& outside_count) {
    std::vector<std::uint32_t> rows;
    rows.reserve(ids.size());
    for (std::uint32_t row = 0; row < ids.size(); ++row) {
        if (!survey.box.contains(frame.points[row])) {
            ++outside_count;
        } else if (is_kept(ids[row], survey, part)) {
            rows.push_back(row);
        }
    }
    return rows;
}

void add_positions(PageFrame& page, const VtkPolyData& frame, const std::vector<std::uint32_t>& rows,
                   const RunSurvey& survey, int bits) {
    std::vector<Vec3> points;
    points.reserve(rows.size());
    for (const std::uint32_t row : rows) points.push_back(frame.points[row]);
    const PositionGrid grid = position_grid(survey.box, bits);
    for (int axis = 0; axis < 3; ++axis) page.channels.push_back(axis_levels(points, grid, axis));
}

void add_colors(PageFrame& page, const VtkPolyData& frame, const std::vector<std::uint32_t>& rows,
                const FrameFile& file) {
    const VtkArray* const array = find_array(frame.point_arrays, kColorAttribute);
    const auto* const colors = array == nullptr ? nullptr : std::get_if<std::vector<Vec3>>(&array->values);
    if (colors == nullptr) throw InputError(fmt::format("{}: has no array {}", file.path.string(), kColorAttribute));
    const LevelScale scale{0.0, 1.0 / 255.0, 255, false};
    std::array<Levels, 3> levels;
    for (const std::uint32_t row : rows) {
        const Vec3& light = (*colors)[row];
        // A colour brighter than the screen is scaled down, because clamping each channel would change its hue.
        const double most = std::max({light.x, light.y, light.z, 1.0});
        for (int channel = 0; channel < 3; ++channel) {
            const double part = light[channel] / most;
            levels[static_cast<std::size_t>(channel)].push_back(scale.level(part > 0.0 ? srgb_from_linear(part) : 0.0));
        }
    }
    for (Levels& channel : levels) page.channels.push_back(std::move(channel));
}

// Adds the rotations as channels. Their coordinates are in [-1, 1].
void add_turns(PageFrame& page, const std::vector<std::array<float, 3>>& turns, const std::vector<std::uint32_t>& rows,
               int bits) {
    const LevelScale scale = turn_scale(bits);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Levels levels;
        levels.reserve(rows.size());
        for (const std::uint32_t row : rows) levels.push_back(scale.level(static_cast<double>(turns[row][axis])));
        page.channels.push_back(std::move(levels));
    }
}

// Adds the springs. A spring is left out if one of its particles is not on the page.
void add_springs(PageFrame& page, const VtkPolyData& frame, const std::vector<std::uint32_t>& rows) {
    if (frame.lines.empty() && frame.triangles.empty()) return;
    std::vector<std::uint32_t> new_row(frame.points.size(), RowHistory::kNew);
    for (std::uint32_t k = 0; k < rows.size(); ++k) new_row[rows[k]] = k;
    for (const auto& [a, b] : frame.lines) {
        const VtkLine line{new_row[a], new_row[b]};
        if (std::max(line[0], line[1]) != RowHistory::kNew) page.lines.push_back(line);
    }
    for (const auto& [a, b, c] : frame.triangles) {
        const Triangle triangle{new_row[a], new_row[b], new_row[c]};
        if (*std::max_element(triangle.begin(), triangle.end()) != RowHistory::kNew) page.triangles.push_back(triangle);
    }
}

template <class Cell>
void write_cells(const std::vector<Cell>& cells, ByteWriter& out) {
    out.varint(cells.size());
    std::int64_t before = 0;
    for (const Cell& cell : cells) {
        for (const std::uint32_t corner : cell) {
            out.signed_varint(static_cast<std::int64_t>(corner) - before);
            before = corner;
        }
    }
}

}  // namespace

std::vector<std::size_t> PageDetail::chosen_frames(std::size_t count) const {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < count; i += every_frame) chosen.push_back(i);
    if (count > 0 && chosen.back() != count - 1) chosen.push_back(count - 1);
    return chosen;
}

int attribute_bits(const PageAttribute& attribute, int bits) { return attribute.array == "radius" ? 16 : bits; }

LevelScale level_scale(const PageAttribute& attribute, int bits) {
    LevelScale scale{attribute.low, 1.0,
                     static_cast<std::uint16_t>((1U << static_cast<unsigned>(bits)) - (attribute.has_gaps ? 2U : 1U)),
                     attribute.has_gaps};
    const double width = attribute.high - attribute.low;
    if (!(width > 0.0)) return scale;
    scale.step = width / scale.largest;
    if (!attribute.is_whole || width > scale.largest) return scale;
    scale.step = 1.0;  // integers are stored exactly
    scale.largest = static_cast<std::uint16_t>(width);
    return scale;
}

LevelScale turn_scale(int bits) {
    const auto largest = static_cast<std::uint16_t>((1U << static_cast<unsigned>(bits)) - 1U);
    return {-1.0, 2.0 / largest, largest, false};
}

PageFrame page_frame(const FrameFile& file, const RunSurvey& survey, const PageDetail& detail,
                     const ColliderParts& colliders) {
    const VtkPolyData frame = read_frame(file.path);
    const std::vector<std::int64_t>& ids = frame_ids(frame, file);
    PageFrame page;
    const std::vector<std::uint32_t> rows = kept_rows(frame, ids, survey, detail.particles, page.outside_count);
    page.ids.reserve(rows.size());
    for (const std::uint32_t row : rows) page.ids.push_back(ids[row]);
    add_positions(page, frame, rows, survey, detail.position_bits);
    for (const PageAttribute& attribute : survey.attributes) {
        if (is_constant(attribute)) continue;
        const LevelScale scale = level_scale(attribute, attribute_bits(attribute, detail.value_bits));
        const std::vector<double> values = attribute_values(frame, attribute, file);
        Levels levels;
        levels.reserve(rows.size());
        for (const std::uint32_t row : rows) levels.push_back(scale.level(values[row]));
        page.channels.push_back(std::move(levels));
    }
    if (survey.has_colors) add_colors(page, frame, rows, file);
    if (!survey.turns.empty()) add_turns(page, survey.turns.at(file.step), rows, detail.value_bits);
    add_springs(page, frame, rows);
    page.moving = colliders.moving_frame(file);
    return page;
}

FrameEncoder::FrameEncoder(const RunSurvey& survey, const PageDetail& detail, const ColliderParts& colliders)
    : channels_(3, ChannelEncoder(detail.position_bits)), moving_(colliders, survey.origin, detail.position_bits) {
    for (const PageAttribute& attribute : survey.attributes) {
        if (!is_constant(attribute)) channels_.emplace_back(attribute_bits(attribute, detail.value_bits));
    }
    if (survey.has_colors) channels_.insert(channels_.end(), 3, ChannelEncoder(8));
    if (!survey.turns.empty()) channels_.insert(channels_.end(), 3, ChannelEncoder(detail.value_bits));
}

void FrameEncoder::write_rows(const PageFrame& frame, ByteWriter& out) {
    std::vector<std::uint32_t> parents;
    std::vector<std::uint64_t> gone;
    std::vector<std::int64_t> born;
    std::size_t old = 0;
    for (const std::int64_t id : frame.ids) {
        for (; old < ids_.size() && ids_[old] < id; ++old) gone.push_back(old);
        const bool is_old = old < ids_.size() && ids_[old] == id;
        if (!is_old) born.push_back(id);
        parents.push_back(is_old ? static_cast<std::uint32_t>(old++) : RowHistory::kNew);
    }
    for (; old < ids_.size(); ++old) gone.push_back(old);
    same_rows_ = gone.empty() && born.empty();
    out.varint(gone.size());
    std::uint64_t next_row = 0;
    for (const std::uint64_t row : gone) {
        out.varint(row - next_row);
        next_row = row + 1;
    }
    out.varint(born.size());
    std::int64_t next_id = 0;
    for (const std::int64_t id : born) {
        out.varint(static_cast<std::uint64_t>(id - next_id));
        next_id = id + 1;
    }
    rows_.follow(std::move(parents));
    ids_ = frame.ids;
}

void FrameEncoder::write_springs(const PageFrame& frame, ByteWriter& out) {
    if (frame.lines.empty() && frame.triangles.empty()) {
        out.byte(0);
    } else if (same_rows_ && frame.lines == lines_ && frame.triangles == triangles_) {
        out.byte(1);
    } else {
        out.byte(2);
        write_cells(frame.lines, out);
        write_cells(frame.triangles, out);
    }
    lines_ = frame.lines;
    triangles_ = frame.triangles;
}

std::string FrameEncoder::encode(const PageFrame& frame) {
    ByteWriter out;
    write_rows(frame, out);
    for (std::size_t c = 0; c < channels_.size(); ++c) channels_[c].encode(frame.channels[c], rows_, out);
    write_springs(frame, out);
    moving_.encode(frame.moving, out);
    return out.bytes();
}

}  // namespace ricochet
