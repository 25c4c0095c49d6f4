/// \file
/// The planes of the triangles that were asked about last.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "ricochet/collision/collision_world.h"
#include "ricochet/geometry/predicates/triangle_plane.h"

namespace ricochet {

/// An impact asks the same few triangles again and again: where they are crossed, how far a place is from them, what
/// their normals are. Results do not depend on what is kept. For one thread.
class TrianglePlanes {
public:
    TrianglePlanes() { forget(); }

    /// Must be called before another world is asked about.
    void forget() { triangle_.fill(kNoTriangle); }

    /// Valid until another triangle is asked for.
    [[nodiscard]] const TrianglePlane& of(const CollisionWorld& world, std::uint32_t triangle) {
        const std::size_t slot = triangle % kSlots;
        if (triangle_[slot] != triangle) {
            const auto [a, b, c] = world.corners_of_triangle(triangle);
            std::construct_at(&plane_[slot], a, b, c);
            triangle_[slot] = triangle;
        }
        return plane_[slot];
    }

private:
    static constexpr std::size_t kSlots = 16;

    std::array<std::uint32_t, kSlots> triangle_;
    std::array<TrianglePlane, kSlots> plane_;
};

}  // namespace ricochet
