/// \file
/// Colliders as blocks of bytes for the page.
#pragma once

#include <string>
#include <vector>

#include "view/page/channel_encoder.h"
#include "view/page/collider_parts.h"
#include "view/page/levels.h"

namespace ricochet {

/// Writes a part that a page shows before any frame: vertices (three channels of 16 bits), corners of triangles as
/// differences, hits and impulse (channels of 8 bits), where there are any. Read again in web/blocks.js.
[[nodiscard]] std::string encoded_part(const ColliderPart& part);
/// The grid of its vertices.
[[nodiscard]] PositionGrid part_grid(const ColliderPart& part, int bits);

/// How far the page's vertices are from where they were at most, m. bits: of positions in frames.
[[nodiscard]] double told_error(const ColliderPart& part, int bits);

/// Writes the part of a frame's block that is about colliders that move: of a rigid one twelve numbers in 32 bits
/// (three rows of the rotation, each followed by the shift), of a deforming one three channels.
class MovingEncoder {
public:
    /// origin: world coordinates of the page's origin.
    MovingEncoder(const ColliderParts& colliders, const Vec3& origin, int bits);

    void encode(const MovingFrame& frame, ByteWriter& out);

private:
    struct Deforming {
        PositionGrid grid;
        std::vector<ChannelEncoder> axes;
        RowHistory rows;
    };
    Vec3 origin_;
    std::vector<Deforming> deforming_;
};

}  // namespace ricochet
