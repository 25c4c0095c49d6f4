#include "view/page/part_encoder.h"

#include <algorithm>

namespace ricochet {
namespace {

constexpr int kVertexBits = 16;

void write_alone(const Levels& levels, int bits, ByteWriter& out) {
    RowHistory rows;
    rows.follow_same(levels.size());
    ChannelEncoder(bits).encode(levels, rows, out);
}

}  // namespace

PositionGrid part_grid(const ColliderPart& part, int bits) {
    Box3 box;
    if (part.motion == PartMotion::deforming) return position_grid(part.reach, bits);
    for (const Vec3& vertex : part.mesh.vertices) box.include(vertex);
    return position_grid(box, bits);
}

double vertex_rounding_error(const ColliderPart& part, int bits) {
    if (part.motion == PartMotion::deforming) return rounding_distance(part_grid(part, bits).step);
    const PositionGrid grid = part_grid(part, kVertexBits);
    double largest = 0.0;
    for (const Vec3& vertex : part.mesh.vertices) {
        Vec3 off;
        for (int axis = 0; axis < 3; ++axis) {
            off[axis] = vertex[axis] - (grid.lower[axis] + grid.step * grid.axis(axis).level(vertex[axis]));
        }
        largest = std::max(largest, length(off));
    }
    return largest;
}

std::string encoded_part(const ColliderPart& part) {
    ByteWriter out;
    const PositionGrid grid = part_grid(part, kVertexBits);
    for (int axis = 0; axis < 3; ++axis) write_alone(axis_levels(part.mesh.vertices, grid, axis), kVertexBits, out);
    std::int64_t before = 0;
    for (const Triangle& triangle : part.mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            out.signed_varint(static_cast<std::int64_t>(corner) - before);
            before = corner;
        }
    }
    for (const PartMap* const map : {&part.hits, &part.impulse}) {
        if (!map->levels.empty()) write_alone(map->levels, 8, out);
    }
    return out.bytes();
}

MovingEncoder::MovingEncoder(const ColliderParts& colliders, const Vec3& origin, int bits) : origin_(origin) {
    for (const ColliderPart& part : colliders.parts()) {
        if (part.motion != PartMotion::deforming) continue;
        deforming_.push_back({part_grid(part, bits), std::vector<ChannelEncoder>(3, ChannelEncoder(bits)), {}});
    }
}

void MovingEncoder::encode(const MovingFrame& frame, ByteWriter& out) {
    for (const AffineMap& pose : frame.poses) {
        const Vec3 shift = pose.point(origin_) - origin_;
        const std::array<Vec3, 3> rows = {pose.row_x, pose.row_y, pose.row_z};
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) out.float32(rows[static_cast<std::size_t>(row)][column]);
            out.float32(shift[row]);
        }
    }
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
        Deforming& part = deforming_[i];
        part.rows.follow_same(frame.points[i].size());
        for (int axis = 0; axis < 3; ++axis) {
            part.axes[static_cast<std::size_t>(axis)].encode(axis_levels(frame.points[i], part.grid, axis), part.rows,
                                                             out);
        }
    }
}

}  // namespace ricochet
