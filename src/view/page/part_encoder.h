/// \file
/// Encoders of colliders as blocks of bytes for the page.
#pragma once

#include <string>
#include <vector>

#include "view/page/channel_encoder.h"
#include "view/page/collider_parts.h"
#include "view/page/levels.h"

namespace ricochet {

/// Returns the bytes of a collider's mesh, which the page loads before any frame. First come the vertices as three
/// channels of 16 bits, then the corners of the triangles as differences to the preceding corner. Channels of 8 bits
/// for hits and impulses follow, if the run has them. The decoder is in web/blocks.js.
[[nodiscard]] std::string encoded_part(const ColliderPart& part);
/// Returns the grid to which a part's vertices are rounded. For a deforming part, it covers all frames.
[[nodiscard]] PositionGrid part_grid(const ColliderPart& part, int bits);

/// Returns the largest distance, in m, by which rounding moves a vertex of the part on the page. `bits` is the number
/// of bits per coordinate in frames.
[[nodiscard]] double vertex_rounding_error(const ColliderPart& part, int bits);

/// Encoder of the moving colliders in a frame's block. The pose of a rigid collider takes twelve 32-bit floats: three
/// rows of the rotation, each followed by the translation along its axis. The vertices of a deforming collider take
/// three channels.
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
