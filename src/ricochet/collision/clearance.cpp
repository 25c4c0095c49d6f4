#include "ricochet/collision/clearance.h"

#include <algorithm>
#include <span>
#include <vector>

namespace ricochet {
namespace {

/// Largest number of surfaces considered, the nearest first, at a cubic cost. Local: each displacement is certified.
constexpr std::size_t kMostSurfaces = 24;

/// Largest number of rounds, each of which includes surfaces that the last displacement brought near. Local, as above.
constexpr int kMostRounds = 8;

/// Part of the clearance by which a displacement may fall short because of rounding. Local, as above.
constexpr double kClearEnough = 0x1p-20;

/// Smallest squared determinant of three normals, or squared sine of the angle between two, for which they count as
/// independent. Local, because if a combination of normals is skipped, other combinations give the displacement.
constexpr double kDependent = 1e-24;

/// A surface near the ball. The displacement d has to satisfy dot(d, normal) >= missing.
struct Limit {
    SurfaceId surface = 0;
    Vec3 normal;
    double missing = 0.0;  ///< in m
};

/// Returns all surfaces nearer to the ball than `reach`, the nearest first.
std::vector<Limit> limits_near(const CollisionWorld& world, const Vec3& center, double radius, double clearance,
                               double reach) {
    std::vector<Limit> limits;
    const auto add = [&](SurfaceId surface) {
        const CollisionWorld::Nearest nearest = world.nearest(surface, center);
        if (nearest.distance - radius < reach) {
            limits.push_back({surface, nearest.normal, clearance - (nearest.distance - radius)});
        }
    };
    for (const auto& plane : world.planes()) add(plane.surface);
    for (const auto& shape : world.shapes()) {
        for (SurfaceId part = 0; part < shape.shape.part_count(); ++part) add(shape.surface + part);
    }
    if (!world.triangles().empty()) {
        world.bvh_for(0.0).query_point(center, radius + reach, [&](std::uint32_t triangle) {
            if (!world.is_degenerate(triangle)) add(world.surface_of_triangle(triangle));
            return radius + reach;
        });
    }
    std::ranges::sort(limits, [](const Limit& a, const Limit& b) {
        return a.missing != b.missing ? a.missing > b.missing : a.surface < b.surface;
    });
    limits.resize(std::min(limits.size(), kMostSurfaces));
    return limits;
}

/// Finds the shortest displacement that satisfies all limits. It satisfies at most three of them with equality.
class ShortestDisplacement {
public:
    ShortestDisplacement(std::span<const Limit> limits, double slack) : limits_(limits), slack_(slack) {}

    [[nodiscard]] std::optional<Vec3> find() {
        for (std::size_t i = 0; i < limits_.size(); ++i) {
            const Limit& a = limits_[i];
            consider(a.missing * a.normal);
            for (std::size_t j = 0; j < i; ++j) {
                const Limit& b = limits_[j];
                const Vec3 across = cross(a.normal, b.normal);
                const double square = length_squared(across);
                if (!(square > kDependent)) continue;
                consider((a.missing * cross(b.normal, across) + b.missing * cross(across, a.normal)) / square);
                for (std::size_t k = 0; k < j; ++k) consider_three(a, b, limits_[k], across);
            }
        }
        return best_;
    }

private:
    void consider_three(const Limit& a, const Limit& b, const Limit& c, const Vec3& across) {
        const double determinant = dot(across, c.normal);
        if (!(determinant * determinant > kDependent)) return;
        consider((a.missing * cross(b.normal, c.normal) + b.missing * cross(c.normal, a.normal) + c.missing * across) /
                 determinant);
    }

    void consider(const Vec3& displacement) {
        if (best_ && !(length_squared(displacement) < length_squared(*best_))) return;
        const bool is_clear = std::ranges::all_of(
            limits_, [&](const Limit& limit) { return dot(displacement, limit.normal) >= limit.missing - slack_; });
        if (is_clear) best_ = displacement;
    }

    std::span<const Limit> limits_;
    double slack_;
    std::optional<Vec3> best_;
};

}  // namespace

std::optional<Vec3> displacement_to_clear(const CollisionWorld& world, const Vec3& center, double radius,
                                          double clearance) {
    std::optional<Vec3> displacement;
    double reach = clearance;
    for (int round = 0; round < kMostRounds; ++round) {
        const std::vector<Limit> limits = limits_near(world, center, radius, clearance, reach);
        if (limits.empty()) return displacement;
        const auto found = ShortestDisplacement(limits, kClearEnough * clearance).find();
        if (!found) return displacement;
        displacement = found;
        const double needed = clearance + length(*displacement);
        if (needed <= reach) break;
        reach = 2.0 * needed;
    }
    return displacement;
}

}  // namespace ricochet
