/// \file
/// Numbers of particles (or vertices) over the frames of a run, told as differences to what earlier frames let expect.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "view/page/levels.h"
#include "view/page/packing.h"

namespace ricochet {

/// How the rows of a frame follow those of the frame before.
struct RowHistory {
    static constexpr std::uint32_t kNew = 0xffffffffU;

    std::vector<std::uint32_t> parent;  ///< the row's particle in the frame before; kNew where it was not there
    std::vector<std::uint8_t> known;    ///< earlier frames without a break in which it was, 3 at most

    /// Goes on to a frame with these parents.
    void follow(std::vector<std::uint32_t> parents);
    /// Goes on to a frame with as many rows as before, all the same; the first one makes `count` new rows.
    void follow_same(std::size_t count);
};

/// Writes one channel, frame after frame. What is written: a byte, the order (0 to 2) of the polynomial through a row's
/// last values that is taken as the prediction, as far as the row has so many; then the differences, modulo 2^bits, as
/// 0, -1, 1, -2, ... are counted: all low bytes, then, of more than 8 bits, all high bytes. A new row's prediction is
/// the value of the row before it in its own frame, the first row's is 0. Read again in web/blocks.js.
class ChannelEncoder {
public:
    explicit ChannelEncoder(int bits) : bits_(bits) {}

    /// history: of the same frame.
    void encode(const Levels& values, const RowHistory& history, ByteWriter& out);

private:
    int bits_;
    std::array<Levels, 3> past_;  // by row of the frame before; the latest first
};

}  // namespace ricochet
