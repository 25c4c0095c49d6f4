/// \file
/// Frames of a run as blocks of bytes for the page.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/io/run_folder.h"
#include "view/page/channel_encoder.h"
#include "view/page/collider_parts.h"
#include "view/page/levels.h"
#include "view/page/part_encoder.h"
#include "view/page/run_survey.h"

namespace ricochet {

/// How much of a run goes into its page.
struct PageDetail {
    int position_bits = 16;       ///< of a coordinate, over the longest edge of the box
    int value_bits = 16;          ///< of an attribute, over its range; 8 or 16, see attribute_bits()
    std::size_t every_frame = 1;  ///< one frame of so many; the last one always
    double particles = 1.0;       ///< part of the particles, chosen by chance; those at springs always

    /// Which of `count` frames are taken.
    [[nodiscard]] std::vector<std::size_t> chosen_frames(std::size_t count) const;
};

/// The bits of an attribute: `bits`, but 16 for radii. They rarely change, so that these cost little, and those of
/// small spheres among large ones would drown in the rounding.
[[nodiscard]] int attribute_bits(const PageAttribute& attribute, int bits);
/// The levels that an attribute is told in, of attribute_bits().
[[nodiscard]] LevelScale level_scale(const PageAttribute& attribute, int bits);
/// The levels of a coordinate of turns.
[[nodiscard]] LevelScale turn_scale(int bits);
/// True where an attribute needs no bytes in the frames: every particle has the same value.
[[nodiscard]] inline bool is_constant(const PageAttribute& attribute) {
    return attribute.low == attribute.high && !attribute.has_gaps && !attribute.is_cut;
}

/// One frame, as whole numbers.
struct PageFrame {
    std::vector<std::int64_t> ids;
    std::vector<Levels> channels;  ///< x, y, z; attributes that are not constant; red, green, blue in sRGB; turns
    std::vector<VtkLine> lines;    ///< between rows
    std::vector<Triangle> triangles;
    MovingFrame moving;
    std::uint64_t left_out = 0;  ///< particles outside the survey's box
};

/// Reads and rounds a frame. May be called from several threads.
[[nodiscard]] PageFrame page_frame(const FrameFile& file, const RunSurvey& survey, const PageDetail& detail,
                                   const ColliderParts& colliders);

/// Writes frames one after the other; each block leans on the ones before. Layout: the rows of the frame before that
/// are gone, as their number and gaps; the ids that are new, likewise; every channel (ChannelEncoder); springs: a byte
/// (0 none, 1 as in the frame before, 2 told anew), then their numbers and ends as differences; colliders that move
/// (ColliderParts). Read again in web/run.js.
class FrameEncoder {
public:
    FrameEncoder(const RunSurvey& survey, const PageDetail& detail, const ColliderParts& colliders);

    [[nodiscard]] std::string encode(const PageFrame& frame);

private:
    void write_rows(const PageFrame& frame, ByteWriter& out);
    void write_springs(const PageFrame& frame, ByteWriter& out);

    std::vector<std::int64_t> ids_;  // of the frame before
    RowHistory rows_;
    std::vector<ChannelEncoder> channels_;
    std::vector<VtkLine> lines_;
    std::vector<Triangle> triangles_;
    bool same_rows_ = false;
    MovingEncoder moving_;
};

}  // namespace ricochet
