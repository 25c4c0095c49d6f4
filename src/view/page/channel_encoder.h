/// \file
/// Encoder of one number per particle (or per vertex) over the frames of a run. It encodes the differences to
/// predictions from earlier frames.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "view/page/levels.h"
#include "view/page/packing.h"

namespace ricochet {

/// Relation between the rows of a frame and the rows of the previous frame.
struct RowHistory {
    static constexpr std::uint32_t kNew = 0xffffffffU;

    /// Row of the same particle in the previous frame; kNew if the previous frame lacks the particle.
    std::vector<std::uint32_t> parent;
    std::vector<std::uint8_t> known;  ///< number of consecutive earlier frames with this particle, at most 3

    /// Advances to the next frame. `parents` becomes its `parent`.
    void follow(std::vector<std::uint32_t> parents);
    /// Advances to the next frame, which has the same rows. If `count` differs from the previous number of rows, all
    /// rows are new.
    void follow_same(std::size_t count);
};

/// Encoder of one channel: one integer per row, frame by frame. A polynomial through a row's last values predicts its
/// next value. Rows with a shorter history use a lower order. The prediction of a new row is the value of the preceding
/// row in the same frame, or 0 for the first row. The output of a frame consists of the order of the polynomial (0 to
/// 2) in one byte, and of the differences between values and predictions. Differences are taken modulo 2^bits, and 0,
/// -1, 1, -2, ... are stored as 0, 1, 2, 3, ... The low bytes of all rows precede the high bytes, which exist only for
/// more than 8 bits. The decoder is in web/blocks.js.
class ChannelEncoder {
public:
    explicit ChannelEncoder(int bits) : bits_(bits) {}

    /// Encodes the values of a frame. `history` must belong to the same frame.
    void encode(const Levels& values, const RowHistory& history, ByteWriter& out);

private:
    int bits_;
    std::array<Levels, 3> past_;  // values of the last three frames, latest first, by row of the previous frame
};

}  // namespace ricochet
