/// \file
/// Frames of a run, encoded as blocks of bytes for the page.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "run/run_folder.h"
#include "view/page/channel_encoder.h"
#include "view/page/collider_parts.h"
#include "view/page/levels.h"
#include "view/page/part_encoder.h"
#include "view/page/run_survey.h"

namespace ricochet {

/// Level of detail of a run's page.
struct PageDetail {
    int position_bits = 16;  ///< bits per coordinate; the 2^bits levels span the longest edge of the box
    /// Bits per attribute, over its range: 8 or 16; see attribute_bits() for the exception.
    int value_bits = 16;
    std::size_t every_frame = 1;  ///< every n-th frame is kept; the last frame is always kept
    /// Share of the particles that are kept, chosen at random; particles with springs are always kept.
    double particles = 1.0;

    /// Returns the indices of the frames that are kept, out of `count`.
    [[nodiscard]] std::vector<std::size_t> chosen_frames(std::size_t count) const;
};

/// Returns the number of bits of an attribute: 16 for radii, otherwise `bits`. Radii rarely change, so 16 bits cost
/// little. With fewer bits, rounding would change the radii of small spheres among large ones too much.
[[nodiscard]] int attribute_bits(const PageAttribute& attribute, int bits);
/// Returns the quantization of an attribute to attribute_bits() bits.
[[nodiscard]] LevelScale level_scale(const PageAttribute& attribute, int bits);
/// Returns the quantization of a coordinate of a rotation's quaternion, from -1 to 1.
[[nodiscard]] LevelScale turn_scale(int bits);
/// Returns true if every particle has the same value, so that the frames need no bytes for the attribute.
[[nodiscard]] inline bool is_constant(const PageAttribute& attribute) {
    return attribute.low == attribute.high && !attribute.has_gaps && !attribute.is_cut;
}

/// One frame with all values quantized.
struct PageFrame {
    std::vector<std::int64_t> ids;
    std::vector<Levels> channels;  ///< x, y, z; attributes that are not constant; red, green, blue in sRGB; rotations
    std::vector<VtkLine> lines;    ///< springs; ends are rows
    std::vector<Triangle> triangles;
    MovingFrame moving;
    std::uint64_t outside_count = 0;  ///< number of particles outside the survey's box
};

/// Reads and quantizes a frame. Safe to call from several threads.
[[nodiscard]] PageFrame page_frame(const FrameFile& file, const RunSurvey& survey, const PageDetail& detail,
                                   const ColliderParts& colliders);

/// Encoder of consecutive frames. Each block depends on the previous blocks. Layout of a block:
/// - Removed rows of the previous frame: their count, and for each the number of rows skipped before it.
/// - New ids: their count, and for each the number of ids skipped before it.
/// - All channels (ChannelEncoder).
/// - Springs: a byte (0: none, 1: same as in the previous frame, 2: new list). A new list has the counts of lines and
///   triangles, and their corners as differences to the preceding corner.
/// - Moving colliders (MovingEncoder).
/// The decoder is in web/run.js.
class FrameEncoder {
public:
    FrameEncoder(const RunSurvey& survey, const PageDetail& detail, const ColliderParts& colliders);

    [[nodiscard]] std::string encode(const PageFrame& frame);

private:
    void write_rows(const PageFrame& frame, ByteWriter& out);
    void write_springs(const PageFrame& frame, ByteWriter& out);

    std::vector<std::int64_t> ids_;  // ids of the previous frame
    RowHistory rows_;
    std::vector<ChannelEncoder> channels_;
    std::vector<VtkLine> lines_;
    std::vector<Triangle> triangles_;
    bool same_rows_ = false;
    MovingEncoder moving_;
};

}  // namespace ricochet
