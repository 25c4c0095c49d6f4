/// \file
/// Channels of numbers of particles (or vertices) over the frames of a run, encoded as differences to predictions from
/// earlier frames.
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

    std::vector<std::uint32_t> parent;  ///< row of the same particle in the previous frame; kNew if it did not exist
                                        ///< there
    std::vector<std::uint8_t> known;    ///< number of consecutive earlier frames with this particle, at most 3

    /// Advances to a frame with the given parents.
    void follow(std::vector<std::uint32_t> parents);
    /// Advances to a frame with the same rows as before. If the count differs, all `count` rows are new.
    void follow_same(std::size_t count);
};

/// Encoder of one channel, frame after frame.
/// The output starts with a byte: the order (0 to 2) of the polynomial through a row's last values, which serves as
/// prediction. Rows with a shorter history use a lower order.
/// Then follow the differences, modulo 2^bits, with 0, -1, 1, -2, ... numbered 0, 1, 2, 3, .... All low bytes come
/// first, then all high bytes if there are more than 8 bits.
/// A new row's prediction is the value of the preceding row of its frame. The first row's prediction is 0. The decoder
/// is in web/blocks.js.
class ChannelEncoder {
public:
    explicit ChannelEncoder(int bits) : bits_(bits) {}

    /// Encodes the values of a frame. `history` must belong to the same frame.
    void encode(const Levels& values, const RowHistory& history, ByteWriter& out);

private:
    int bits_;
    std::array<Levels, 3> past_;  // by row of the previous frame, latest first
};

}  // namespace ricochet
