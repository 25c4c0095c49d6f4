#include "ricochet/simulation/spawn_occupancy.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ricochet {
namespace {

double cell_at(double x, double cell) { return std::floor(x / cell); }

bool overlap(const FlyingBall& a, const FlyingBall& b) {
    const double time = std::max(a.time, b.time);
    const double distance = a.radius + b.radius;
    return length_squared(a.at(time) - b.at(time)) < distance * distance;
}

}  // namespace

Vec3 FlyingBall::at(double t) const {
    const double s = t - time;
    return position + s * (velocity + (0.5 * s) * acceleration);
}

std::size_t SpawnOccupancy::CellHash::operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const double value : {cell.x, cell.y, cell.z}) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 29U;
    }
    return hash;
}

/// Returns the box of all positions of a ball until the end of the step.
Box3 SpawnOccupancy::box_of(const FlyingBall& ball) const {
    const double rest = std::max(0.0, end_ - ball.time);
    const Vec3 fall = rest * ball.acceleration;
    Box3 box;
    for (const Vec3& velocity : {Vec3{}, ball.velocity, ball.velocity + 0.5 * fall, ball.velocity + fall}) {
        box.include(ball.position + rest * velocity);
    }
    const Vec3 radius{ball.radius, ball.radius, ball.radius};
    return {box.lower - radius, box.upper + radius};
}

void SpawnOccupancy::add(const FlyingBall& ball) {
    const Box3 box = box_of(ball);
    const Vec3 size = box.size();
    const double extent = std::max({size.x, size.y, size.z});
    if (!(extent > 0.0) || !std::isfinite(extent)) return;
    const int exponent = std::ilogb(extent) + 1;
    const double cell = std::ldexp(1.0, exponent);
    const auto number = static_cast<std::uint32_t>(balls_.size());
    balls_.push_back(ball);
    Level& level = levels_[exponent];
    level.all.push_back(number);
    level.cells[{cell_at(box.lower.x, cell), cell_at(box.lower.y, cell), cell_at(box.lower.z, cell)}].push_back(number);
}

bool SpawnOccupancy::has_room(const FlyingBall& ball) const {
    const Box3 box = box_of(ball);
    return std::ranges::all_of(
        levels_, [&](const auto& entry) { return has_room_in(entry.second, std::ldexp(1.0, entry.first), ball, box); });
}

bool SpawnOccupancy::has_room_in(const Level& level, double cell, const FlyingBall& ball, const Box3& box) const {
    Vec3 first;
    Vec3 count;
    for (int axis = 0; axis < 3; ++axis) {
        first[axis] = cell_at(box.lower[axis] - cell, cell);
        count[axis] = cell_at(box.upper[axis], cell) - first[axis] + 1.0;
    }
    if (!(count.x * count.y * count.z < static_cast<double>(level.all.size()))) return !overlaps(level.all, ball);
    for (double z = 0.0; z < count.z; z += 1.0) {
        for (double y = 0.0; y < count.y; y += 1.0) {
            for (double x = 0.0; x < count.x; x += 1.0) {
                const auto found = level.cells.find({first.x + x, first.y + y, first.z + z});
                if (found != level.cells.end() && overlaps(found->second, ball)) return false;
            }
        }
    }
    return true;
}

bool SpawnOccupancy::overlaps(const std::vector<std::uint32_t>& balls, const FlyingBall& ball) const {
    return std::ranges::any_of(balls, [&](std::uint32_t k) { return overlap(balls_[k], ball); });
}

}  // namespace ricochet
