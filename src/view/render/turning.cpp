#include "view/render/turning.h"

#include <cmath>
#include <numbers>

#include "ricochet/core/random.h"

namespace ricochet {
namespace {

constexpr std::uint64_t kSeed = 0x7475726e;  // constant, because a picture has no seed
constexpr std::uint32_t kTurnStream = 1;
constexpr std::uint32_t kAxisStream = 2;

Turn product(const Turn& a, const Turn& b) {
    return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
}

}  // namespace

Turn random_turn(std::uint64_t id) {
    RandomSequence draws(kSeed, kTurnStream, id);
    const double part = draws.uniform();
    const double one = 2.0 * std::numbers::pi * draws.uniform();
    const double two = 2.0 * std::numbers::pi * draws.uniform();
    const double a = std::sqrt(1.0 - part);
    const double b = std::sqrt(part);
    return {b * std::cos(two), {a * std::sin(one), a * std::cos(one), b * std::sin(two)}};
}

Turn rotation_after(const Turn& turn, const Vec3& spin, double seconds) {
    const double rate = length(spin);
    const double half = 0.5 * rate * seconds;
    if (!(rate > 0.0) || !std::isfinite(half)) return turn;
    const Turn after = product({std::cos(half), (std::sin(half) / rate) * spin}, turn);
    const double size = std::sqrt(after.w * after.w + dot(after.v, after.v));
    return {after.w / size, after.v / size};
}

AffineMap map_of(const Turn& turn) {
    const auto& [w, v] = turn;
    AffineMap map;
    map.row_x = {1.0 - 2.0 * (v.y * v.y + v.z * v.z), 2.0 * (v.x * v.y - w * v.z), 2.0 * (v.x * v.z + w * v.y)};
    map.row_y = {2.0 * (v.x * v.y + w * v.z), 1.0 - 2.0 * (v.x * v.x + v.z * v.z), 2.0 * (v.y * v.z - w * v.x)};
    map.row_z = {2.0 * (v.x * v.z - w * v.y), 2.0 * (v.y * v.z + w * v.x), 1.0 - 2.0 * (v.x * v.x + v.y * v.y)};
    return map;
}

ParticleTurning particle_turning(std::uint64_t id) {
    RandomSequence draws(kSeed, kAxisStream, id);
    ParticleTurning own;
    own.axis = draws.unit_vector();
    own.angle = 2.0 * std::numbers::pi * draws.uniform();
    own.spread = draws.uniform_around(0.0, 1.0);
    return own;
}

AffineMap stretch_along(const Vec3& direction, double factor) {
    const double across = 1.0 / std::sqrt(factor);
    const Vec3 more = (factor - across) * direction;
    AffineMap map;
    map.row_x = Vec3{across, 0, 0} + direction.x * more;
    map.row_y = Vec3{0, across, 0} + direction.y * more;
    map.row_z = Vec3{0, 0, across} + direction.z * more;
    return map;
}

AffineMap linear_product(const AffineMap& after, const AffineMap& before) {
    AffineMap map;
    map.row_x = before.direction_back(after.row_x);
    map.row_y = before.direction_back(after.row_y);
    map.row_z = before.direction_back(after.row_z);
    return map;
}

}  // namespace ricochet
