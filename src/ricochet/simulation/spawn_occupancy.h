/// \file
/// Private to the simulation: test whether a new sphere has free space among the other spheres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Motion of a sphere along a parabola, from a time on until it meets another sphere.
struct FlyingBall {
    double time = 0.0;  ///< s
    double radius = 0.0;
    Vec3 position;      ///< m, at that time
    Vec3 velocity;      ///< m/s, at that time
    Vec3 acceleration;  ///< m/s^2

    [[nodiscard]] Vec3 at(double t) const;
};

/// The spheres of a step, of any sizes, in grids whose cells have about the size of their spheres.
class SpawnOccupancy {
public:
    /// end: end of the step, in s.
    explicit SpawnOccupancy(double end) : end_(end) {}

    void add(const FlyingBall& ball);
    /// Returns true if a ball overlaps no other ball at the time of the later of both births.
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
    /// Balls of similar size. Each ball is in the cell that contains the lower corner of its box.
    struct Level {
        std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> cells;
        std::vector<std::uint32_t> all;
    };

    [[nodiscard]] Box3 box_of(const FlyingBall& ball) const;
    [[nodiscard]] bool has_room_in(const Level& level, double cell, const FlyingBall& ball, const Box3& box) const;
    [[nodiscard]] bool overlaps(const std::vector<std::uint32_t>& balls, const FlyingBall& ball) const;

    double end_;
    std::vector<FlyingBall> balls_;
    std::map<int, Level> levels_;  // by the binary exponent of the cell size
};

}  // namespace ricochet
