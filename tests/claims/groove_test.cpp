// A sphere in a groove rolls and slips as in the closed form, for any walls, slope and time step.
//
// The groove descends along d. Its walls have the inclinations A and B across the groove. The component of gravity into
// the groove is c, and the component along the groove is s. The normal forces on the walls are
//
//     N1 = c sin B / sin(A + B),    N2 = c sin A / sin(A + B).
//
// The frictions t_i along d change the speed v and the slips u_i:
//
//     v' = s + t1 + t2,    u_i' = v' + 5/2 (t_i + cos(A + B) t_j).
//
// Friction acts against the slip, and |t_i| <= mu N_i. It keeps a slip at zero if this bound allows it. Between changes
// of the frictions, every motion is a parabola.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "claims/contact_scene.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = kStandardGravity;
constexpr double kSphereRadius = 0.1;

/// Inclinations in radians: of both walls across the groove, and of the groove along its direction.
struct Groove {
    double a, b, slope;
    [[nodiscard]] double along() const { return kG * std::sin(slope); }
    [[nodiscard]] std::array<double, 2> normal_forces() const {
        const double c = kG * std::cos(slope) / std::sin(a + b);
        return {c * std::sin(b), c * std::sin(a)};
    }
    /// Returns the smallest friction coefficient at which the sphere rolls on both walls from rest.
    [[nodiscard]] double rolling_limit() const {
        const double half = std::cos(0.5 * (a + b));
        const double share = 0.4 / (half * half);
        const auto normal = normal_forces();
        return 0.5 * along() * share / (1.0 + share) / std::min(normal[0], normal[1]);
    }
};

/// Closed form of the speed and the slips. The motion is integrated from one change of a slip to the next.
class GrooveReference {
public:
    GrooveReference(const Groove& groove, double friction, double speed, const std::array<double, 2>& slip)
        : groove_(groove), speed_(speed), slip_(slip) {
        const auto normal = groove.normal_forces();
        for (std::size_t i = 0; i < 2; ++i) bound_[i] = friction * normal[i];
    }
    /// Returns the distance travelled in `time` seconds.
    double distance_after(double time) {
        double distance = 0.0;
        for (int change = 0; time > 0.0 && change < 10; ++change) {
            const std::array<double, 2> t = friction();
            const std::array<double, 2> rate = slip_rates(t);
            double h = time;
            for (std::size_t i = 0; i < 2; ++i) {
                if (slip_[i] * rate[i] < 0.0) h = std::min(h, -slip_[i] / rate[i]);
            }
            const double acceleration = groove_.along() + t[0] + t[1];
            distance += h * (speed_ + 0.5 * h * acceleration);
            speed_ += h * acceleration;
            for (std::size_t i = 0; i < 2; ++i) advance(slip_[i], rate[i], h);
            time -= h;
        }
        return distance;
    }

private:
    static void advance(double& slip, double rate, double h) {
        const double before = slip;
        slip += h * rate;
        // If this slip ended the interval, its value is a rounding error and becomes exactly 0. Other slips are not
        // close to zero.
        if (std::fabs(slip) < 1e-12 * std::max(std::fabs(before), std::fabs(h * rate))) slip = 0.0;
    }
    [[nodiscard]] std::array<double, 2> slip_rates(const std::array<double, 2>& t) const {
        const double c = std::cos(groove_.a + groove_.b);
        const double rate = groove_.along() + t[0] + t[1];
        std::array<double, 2> rates{rate + 2.5 * (t[0] + c * t[1]), rate + 2.5 * (t[1] + c * t[0])};
        for (double& r : rates) {
            if (std::fabs(r) < 1e-13 * kG) r = 0.0;  // rounding error of the rate of a slip that friction keeps at zero
        }
        return rates;
    }
    /// Computes both frictions by projected Gauss-Seidel. The problem is positive definite, so the sweeps converge to
    /// rounding.
    [[nodiscard]] std::array<double, 2> friction() const {
        std::array<double, 2> t{};
        for (int sweep = 0; sweep < 200'000; ++sweep) {
            double change = 0.0;
            for (std::size_t i = 0; i < 2; ++i) {
                const double before = t[i];
                if (slip_[i] != 0.0) {
                    t[i] = -std::copysign(bound_[i], slip_[i]);
                } else {
                    t[i] = std::clamp(t[i] - slip_rates(t)[i] / 3.5, -bound_[i], bound_[i]);
                }
                change = std::max(change, std::fabs(t[i] - before));
            }
            if (change < 1e-17 * kG) break;
        }
        return t;
    }

    Groove groove_;
    std::array<double, 2> bound_{};
    double speed_;
    std::array<double, 2> slip_;
};

/// Unit vectors of the groove in world coordinates: d downhill along the groove, u perpendicular to it and up, s across
/// it. They are rotated about the vertical, so that no vector is aligned with the axes.
struct GrooveFrame {
    explicit GrooveFrame(double slope) {
        const double yaw = 0.3;
        const Vec3 level{std::cos(yaw), std::sin(yaw), 0};
        s = {-std::sin(yaw), std::cos(yaw), 0};
        d = std::cos(slope) * level - Vec3{0, 0, std::sin(slope)};
        u = std::sin(slope) * level + Vec3{0, 0, std::cos(slope)};
    }
    Vec3 d, u, s;
};

/// Returns the normals of the walls, pointing out of the groove.
std::array<Vec3, 2> wall_normals(const Groove& g, const GrooveFrame& frame) {
    return {std::sin(g.a) * frame.s + std::cos(g.a) * frame.u, -std::sin(g.b) * frame.s + std::cos(g.b) * frame.u};
}

std::vector<ColliderDescription> walls_of_planes(const Groove& g, const GrooveFrame& frame) {
    const auto n = wall_normals(g, frame);
    return {plane_collider({}, n[0]), plane_collider({}, n[1])};
}

/// Returns both walls as one mesh of strips along the groove, 3 m wide. A sphere of 0.1 m touches the walls within 1.2
/// m of the bottom.
std::vector<ColliderDescription> walls_of_triangles(const Groove& g, const GrooveFrame& frame) {
    constexpr int kCells = 12;
    const auto n = wall_normals(g, frame);
    const std::array<Vec3, 2> up{3.0 * cross(frame.d, n[0]), -3.0 * cross(frame.d, n[1])};
    TriangleMesh mesh;
    for (int i = 0; i <= kCells; ++i) {
        const Vec3 bottom = (-2.0 + i) * frame.d;
        for (const Vec3& v : {bottom + up[0], bottom, bottom + up[1]}) mesh.vertices.push_back(v);
    }
    for (std::uint32_t i = 0; i < kCells; ++i) {
        for (std::uint32_t k = 3 * i; k < 3 * i + 2; ++k) {
            mesh.triangles.push_back({k, k + 1, k + 3});
            mesh.triangles.push_back({k + 1, k + 4, k + 3});
        }
    }
    return {mesh_collider(std::move(mesh))};
}

using MakeWalls = std::vector<ColliderDescription> (*)(const Groove&, const GrooveFrame&);

/// Returns a sphere in a groove. The centre is at the position at which the sphere touches both walls, up to rounding.
ContactScene in_groove(const Groove& g, const GrooveFrame& frame, std::vector<ColliderDescription> walls,
                       double friction, double time_step) {
    const double half = 0.5 * (g.a + g.b);
    const double lean = 0.5 * (g.a - g.b);
    const Vec3 center = kSphereRadius / std::cos(half) * (std::sin(lean) * frame.s + std::cos(lean) * frame.u);
    ContactScene scene;
    scene.colliders = std::move(walls);
    scene.materials = {{"", 0.5, friction}};
    scene.particle = particle_of(center, {}, kSphereRadius);
    scene.time_step = time_step;
    return scene;
}

constexpr std::array kSteps{0.001, 0.02, 0.05, 0.1};

/// Calls visit(groove) for walls of 5 to 85 degrees and slopes of 2 to 70 degrees.
template <class Visit>
void for_every_groove(Visit&& visit) {
    for (const double slope : {2.0, 20.0, 45.0, 70.0}) {
        for (const double a : {5.0, 25.0, 45.0, 65.0, 85.0}) {
            for (double b = 5.0; b <= a; b += 20.0) {
                SCOPED_TRACE("walls at " + std::to_string(a) + " and " + std::to_string(b) + ", slope " +
                             std::to_string(slope));
                visit(Groove{radians(a), radians(b), radians(slope)});
            }
        }
    }
}

/// Required bound on the error of the distance, relative to the distance. The motion is parabolic, so only rounding
/// errors occur for any time step.
constexpr double kBound = 1e-9;

void expect_closed_form_from_rest(const Groove& g, MakeWalls make_walls, double friction) {
    const GrooveFrame frame(g.slope);
    const double expected = GrooveReference(g, friction, 0.0, {}).distance_after(1.0);
    for (const double step : kSteps) {
        const ContactScene scene = in_groove(g, frame, make_walls(g, frame), friction, step);
        const double reached = dot(end_of(scene).position - scene.particle.position, frame.d);
        EXPECT_NEAR(reached / expected, 1.0, kBound) << "friction " << friction << ", steps of " << step << " s";
    }
}

class GrooveGrid : public ::testing::TestWithParam<std::pair<const char*, MakeWalls>> {};

INSTANTIATE_TEST_SUITE_P(Of, GrooveGrid,
                         ::testing::Values(std::pair<const char*, MakeWalls>{"Planes", walls_of_planes},
                                           std::pair<const char*, MakeWalls>{"Triangles", walls_of_triangles}),
                         [](const auto& walls) { return walls.param.first; });

TEST_P(GrooveGrid, LetsSpheresRollFromRestIfBothWallsStick) {
    for_every_groove([&](const Groove& g) {
        for (const double factor : {1.05, 2.0}) {
            expect_closed_form_from_rest(g, GetParam().second, factor * g.rolling_limit());
        }
    });
}

TEST_P(GrooveGrid, LetsSpheresSlipFromRestIfAWallDoesNotStick) {
    for_every_groove([&](const Groove& g) {
        for (const double factor : {0.0, 0.2, 0.5, 0.95}) {
            expect_closed_form_from_rest(g, GetParam().second, factor * g.rolling_limit());
        }
    });
}

// The sphere is thrown along the groove without spin, or with the spin of rolling in the opposite direction. The slips
// on the two walls end one after the other.
TEST_P(GrooveGrid, SlowsSpheresUntilTheyRoll) {
    for_every_groove([&](const Groove& g) {
        const GrooveFrame frame(g.slope);
        const auto normals = wall_normals(g, frame);
        for (const double friction : {0.1, 0.6}) {
            for (const Vec3& spin : {Vec3{}, 12.0 * frame.s + 3.0 * frame.u}) {
                const double speed = 0.8;
                const auto slip = [&](const Vec3& n) { return speed + dot(cross(spin, -kSphereRadius * n), frame.d); };
                const double expected =
                    GrooveReference(g, friction, speed, {slip(normals[0]), slip(normals[1])}).distance_after(0.5);
                for (const double step : {0.001, 0.05, 0.1}) {
                    ContactScene scene = in_groove(g, frame, GetParam().second(g, frame), friction, step);
                    scene.duration = 0.5;
                    scene.particle.velocity = speed * frame.d;
                    scene.particle.spin = spin;
                    const double reached = dot(end_of(scene).position - scene.particle.position, frame.d);
                    EXPECT_NEAR(reached, expected, kBound * std::max(0.1, std::fabs(expected)))
                        << "friction " << friction << ", steps of " << step << " s, spin " << spin.x;
                }
            }
        }
    });
}

TEST_P(GrooveGrid, KeepsSpheresRollingOnLevelGround) {
    for (const double degrees : {5.0, 45.0, 85.0}) {
        const Groove g{radians(degrees), radians(degrees), 0.0};
        const GrooveFrame frame(0.0);
        for (const double step : kSteps) {
            ContactScene scene = in_groove(g, frame, GetParam().second(g, frame), 0.3, step);
            scene.particle.velocity = frame.d;
            scene.particle.spin = 1.0 / (kSphereRadius * std::cos(g.a)) * frame.s;
            scene.duration = 2.0;
            const double reached = dot(end_of(scene).position - scene.particle.position, frame.d);
            EXPECT_NEAR(reached / 2.0, 1.0, kBound) << degrees << " degrees, steps of " << step << " s";
        }
    }
}

// Compares the reference with the known formula for walls of equal inclination.
TEST(GrooveReference, IsTheKnownClosedFormBetweenEqualWalls) {
    for (const double degrees : {5.0, 45.0, 85.0}) {
        const Groove g{radians(degrees), radians(degrees), radians(20.0)};
        const double cosine = std::cos(g.a);
        const double rolling = kG * std::sin(g.slope) / (1.0 + 0.4 / (cosine * cosine));
        const double slipping = kG * std::sin(g.slope) - 0.5 * g.rolling_limit() * kG * std::cos(g.slope) / cosine;
        // The bounds cover the rounding of a few operations on about 4 m, and the convergence limit of the sweeps.
        EXPECT_NEAR(GrooveReference(g, 2.0 * g.rolling_limit(), 0.0, {}).distance_after(1.0), 0.5 * rolling, 1e-12);
        EXPECT_NEAR(GrooveReference(g, 0.5 * g.rolling_limit(), 0.0, {}).distance_after(1.0), 0.5 * slipping, 1e-12);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
