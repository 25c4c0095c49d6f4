/// \file
/// Colliders, encoded as blocks of bytes for the page.
#pragma once

#include <string>
#include <vector>

#include "view/page/channel_encoder.h"
#include "view/page/collider_parts.h"
#include "view/page/levels.h"

namespace ricochet {

/// Encodes a part that a page shows before any frame. The bytes hold vertices (three channels of 16 bits) and corners
/// of triangles as differences. Channels of 8 bits for hits and impulse follow, if present. The decoder is in
/// web/blocks.js.
[[nodiscard]] std::string encoded_part(const ColliderPart& part);
/// Returns the grid of a part's vertices.
[[nodiscard]] PositionGrid part_grid(const ColliderPart& part, int bits);

/// Returns the largest displacement of the page's vertices by rounding, in m. `bits` is the number of bits per
/// coordinate in frames.
[[nodiscard]] double told_error(const ColliderPart& part, int bits);

/// Encoder of the moving colliders in a frame's block. A rigid collider takes twelve 32-bit numbers: three rows of the
/// rotation, each followed by its translation. A deforming collider takes three channels.
class MovingEncoder {
public:
    /// `origin` is the page's origin in world coordinates.
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
