// Statistics of straight paths in closed bodies: mean free paths, angles of incidence, hit rates and pressure, compared
// with integral geometry and kinetic theory.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/response/exact.h"
#include "support/counts.h"
#include "support/parity.h"
#include "support/shared_meshes.h"
#include "support/statistics.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::RatioSample;
using testing::Sample;

constexpr double kPi = 3.14159265358979323846;
const Material kMirror{"mirror", 1.0, 0.0};

/// A closed body that contains molecules.
struct Body {
    std::string name;
    std::vector<ColliderDescription> colliders;
    double volume;
    double surface;
    double size;  // half the edge of an enclosing cube
    std::function<bool(const Vec3&)> is_inside;
};

Body cube() {
    return {"cube", {{"cube", CuboidShape{{1, 1, 1}, {}}, 0}},     1.0, 6.0,
            0.5,    [](const Vec3& p) {
                return max_abs(p) < 0.5; }};
}
Body ball() {
    return {"ball", {{"ball", BallShape{1.0, {}}, 0}}, 4.0 / 3.0 * kPi, 4.0 * kPi, 1.0, [](const Vec3& p) {
                return length(p) < 1.0;
            }};
}
Body cylinder() {
    return {"cylinder", {{"cylinder", CylinderShape{1.0, 2.0, {}}, 0}},
            2.0 * kPi,  6.0 * kPi,
            1.0,        [](const Vec3& p) { return std::hypot(p.x, p.y) < 1.0 && std::fabs(p.z) < 1.0; }};
}

Vec3 random_place(const Body& body, RandomSequence& random) {
    Vec3 p;
    do {
        const double x = random.uniform();
        const double y = random.uniform();
        p = body.size * Vec3{2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * random.uniform() - 1.0};
    } while (!body.is_inside(p));
    return p;
}

/// Contact records of one molecule's path, and the length of the path.
struct Flown {
    std::vector<ContactRecord> hits;
    double translation;
};

/// Lets each of `count` molecules fly for `mean_paths` mean free paths. Starts are uniform in the body, with random
/// directions.
void fly_gas(const Body& body, int count, double mean_paths, const std::function<void(const Flown&)>& evaluate) {
    Course course(body.colliders, kMirror, {}, IntegratorKind::ballistic, 1000000);
    const double translation = mean_paths * 4.0 * body.volume / body.surface;
    for (int i = 0; i < count; ++i) {
        RandomSequence random(7, 0, static_cast<std::uint64_t>(i));
        const Vec3 place = random_place(body, random);
        ForceInput state{place, random.unit_vector(), 1.0, 0.0, 0.0};
        (void)course.move(state, translation);
        evaluate({course.scratch.records, translation});
    }
}

class GasIn : public ::testing::TestWithParam<Body (*)()> {};
INSTANTIATE_TEST_SUITE_P(Bodies, GasIn, ::testing::Values(cube, ball, cylinder),
                         [](const auto& body) { return body.param().name; });

// By Cauchy's theorem, an isotropic and uniform ensemble hits the walls S / (4 V) times per unit length.
TEST_P(GasIn, FliesFourVolumesOverTheSurfaceBetweenHits) {
    const Body body = GetParam()();
    const double expected = body.surface / (4.0 * body.volume);
    Sample rate;
    fly_gas(body, test::scaled(4000), 50.0,
            [&](const Flown& flown) { rate.add(static_cast<double>(flown.hits.size()) / flown.translation); });
    EXPECT_NEAR(rate.mean(), expected, 4.0 * rate.error());
    EXPECT_LT(rate.error(), 0.1 * expected);
}

// The flux onto a wall is weighted by the cosine of the angle to the normal. The mean cosine of hits is 2/3. The share
// of hits within 30 degrees of the normal is sin^2(30 degrees).
TEST_P(GasIn, HitsTheWallsByTheCosineLaw) {
    RatioSample cosine(2.0 / 3.0);
    RatioSample within_thirty(0.25);
    fly_gas(GetParam()(), test::scaled(4000), 50.0, [&](const Flown& flown) {
        double sum = 0.0;
        double steep = 0.0;
        for (const ContactRecord& hit : flown.hits) {
            const double c = -dot(hit.velocity_before, hit.normal);
            sum += c;
            steep += c > std::sqrt(0.75) ? 1.0 : 0.0;
        }
        cosine.add(sum, static_cast<double>(flown.hits.size()));
        within_thirty.add(steep, static_cast<double>(flown.hits.size()));
    });
    EXPECT_NEAR(cosine.ratio(), 2.0 / 3.0, 4.0 * cosine.error());
    EXPECT_NEAR(within_thirty.ratio(), 0.25, 4.0 * within_thirty.error());
}

// One molecule has unit mass and speed, and the density n = 1 / V. It makes n v / 4 hits per area and time. The
// pressure is n m <v^2> / 3.
TEST_P(GasIn, HasThePressureOfKineticTheoryOnTheWalls) {
    const Body body = GetParam()();
    Sample pressure;
    fly_gas(body, test::scaled(4000), 50.0, [&](const Flown& flown) {
        double impulse = 0.0;
        for (const ContactRecord& hit : flown.hits)
            impulse += dot(hit.velocity_after - hit.velocity_before, hit.normal);
        pressure.add(impulse / (body.surface * flown.translation));
    });
    EXPECT_NEAR(pressure.mean(), 1.0 / (3.0 * body.volume), 4.0 * pressure.error());
}

TEST(GasInABunny, FliesFourVolumesOverTheSurfaceBetweenHits) {
    RICOCHET_SHARED_MESH_OR_SKIP(path, "bunny-closed.off");
    const auto mesh = std::make_shared<const TriangleMesh>(read_mesh(path).mesh);
    const testing::ParityOracle oracle(*mesh);
    const Box3 box = bounds(*mesh);
    Placement placement;
    placement.position = -0.5 * (box.lower + box.upper);
    Body body{"bunny",
              {{"bunny", MeshShape{mesh, placement, "", {}}, 0}},
              std::fabs(signed_volume(*mesh)),
              surface_area(*mesh),
              0.5 * max_abs(box.size()),
              {}};
    body.is_inside = [&](const Vec3& p) { return oracle.inside(p - placement.position); };
    const double expected = body.surface / (4.0 * body.volume);
    Sample rate;
    fly_gas(body, test::scaled(1500), 30.0,
            [&](const Flown& flown) { rate.add(static_cast<double>(flown.hits.size()) / flown.translation); });
    EXPECT_NEAR(rate.mean(), expected, 4.0 * rate.error());
}

// The unit square has a disk in its middle. Mirrors at the square's sides are equivalent to an infinite lattice of
// disks.
// Source of the mean free path (1 - pi r^2) / (2 r): N. Chernov, "Entropy, Lyapunov exponents, and mean free path for
// billiards", J. Stat. Phys. 88, 1997.
TEST(LatticeOfDisks, IsHitOncePerMeanFreePath) {
    const double r = 0.25;
    const double expected = 2.0 * r / (1.0 - kPi * r * r);
    const std::vector<ColliderDescription> colliders{testing::plane_collider({0.5, 0, 0}, {-1, 0, 0}),
                                                     testing::plane_collider({-0.5, 0, 0}, {1, 0, 0}),
                                                     testing::plane_collider({0, 0.5, 0}, {0, -1, 0}),
                                                     testing::plane_collider({0, -0.5, 0}, {0, 1, 0}),
                                                     {"disk", CylinderShape{r, 1.0, {}}, 0}};
    Course course(colliders, kMirror, {}, IntegratorKind::ballistic, 1000000);
    Sample rate;
    for (int i = 0; i < test::scaled(4000); ++i) {
        RandomSequence random(8, 0, static_cast<std::uint64_t>(i));
        Vec3 place;
        do place = {random.uniform() - 0.5, random.uniform() - 0.5, 0.0};
        while (length(place) <= r);
        const double angle = 2.0 * kPi * random.uniform();
        ForceInput state{place, {std::cos(angle), std::sin(angle), 0}, 1.0, 0.0, 0.0};
        (void)course.move(state, 60.0);
        double hits = 0.0;
        for (const ContactRecord& hit : course.scratch.records) hits += hit.surface == 4 ? 1.0 : 0.0;
        rate.add(hits / 60.0);
    }
    EXPECT_NEAR(1.0 / expected, 1.607301, 1e-6);
    EXPECT_NEAR(rate.mean(), expected, 4.0 * rate.error());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
