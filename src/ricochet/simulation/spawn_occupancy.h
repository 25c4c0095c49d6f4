/// \file
/// Private to the simulation: test for free space for a birth among spheres that meet each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Motion of a sphere until it meets another: along a parabola, from a time on.
struct FlyingBall {
    double time = 0.0;  ///< s
    double radius = 0.0;
    Vec3 position;      ///< m, at that time
    Vec3 velocity;      ///< m/s, at that time
    Vec3 acceleration;  ///< m/s^2

    [[nodiscard]] Vec3 at(double t) const;
};

/// The spheres of a step, in cells as large as they are. Their sizes may differ by any factor.
class SpawnOccupancy {
public:
    /// end: end of the step, in s.
    explicit SpawnOccupancy(double end) : end_(end) {}

    void add(const FlyingBall& ball);
    /// Returns true if a ball overlaps no other ball at the later of their two births.
    [[nodiscard]] bool has_room(const FlyingBall& ball) const;

private:
    struct Cell {
        double x;
        double y;
        double z;
        friend bool operator==(const Cell&, const Cell&) = default;
    };
    struct CellHash {
        [[nodiscard]] std::size_t operator()(const Cell& cell) const;
    };
    /// Balls of about one size, each in the cell of the lower corner of its box.
    struct Level {
        std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells;
        std::vector<std::uint32_t> all;
    };

    [[nodiscard]] Box3 box_of(const FlyingBall& ball) const;
    [[nodiscard]] bool has_room_in(const Level& level, double cell, const FlyingBall& ball, const Box3& box) const;
    [[nodiscard]] bool overlaps(const std::vector<std::uint32_t>& balls, const FlyingBall& ball) const;

    double end_;
    std::vector<FlyingBall> balls_;
    std::map<int, Level> levels_;  // by the exponent of the size of the cells
};

}  // namespace ricochet
