// A particle slides or rolls on one surface and hits another surface. It rebounds with the restitution of the surface
// that it hits. The result must not depend on the time step, nor on the rotation, position, scale and mirroring of the
// scene.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "claims/contact_scene.h"
#include "claims/moving_scene.h"
#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// A transformation of a scene: rotation, scale and shift, with or without mirroring.
struct Copy {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    double scale = 1.0;
    Vec3 shift;

    [[nodiscard]] Vec3 direction(const Vec3& d) const { return d.x * x + d.y * y + d.z * z; }
    [[nodiscard]] Vec3 point(const Vec3& p) const { return scale * direction(p) + shift; }
    [[nodiscard]] TriangleMesh mesh(TriangleMesh mesh) const {
        for (Vec3& vertex : mesh.vertices) vertex = point(vertex);
        return mesh;
    }
};

Copy random_copy(RandomSequence& random) {
    Copy copy;
    copy.x = random.unit_vector();
    copy.y = normalized(cross(random.unit_vector(), copy.x));
    copy.z = (random.uniform() < 0.5 ? -1.0 : 1.0) * cross(copy.x, copy.y);
    copy.scale = std::exp(3.0 * (2.0 * random.uniform() - 1.0));
    copy.shift = 3.0 * random.uniform() * random.unit_vector();
    return copy;
}

enum class Kind : std::uint8_t { slope, box, groove, pipe, seams, moving, threshold };
constexpr std::array kKinds{Kind::slope, Kind::box,    Kind::groove,   Kind::pipe,
                            Kind::seams, Kind::moving, Kind::threshold};

/// A particle that slides or rolls along x on its support. Gravity pulls it down a slope into a wall. Collider 0 is the
/// wall.
struct Course {
    Kind kind = Kind::slope;
    double restitution = 0.7;  ///< restitution of the wall
    double of_support = 0.3;   ///< restitution of all other surfaces
    double friction = 0.1;
    double radius = 0.05;
    double slope = 0.3;  ///< in rad
    double lean = 0.0;   ///< inclination of the wall, in rad; a wall with a positive inclination faces up
    double speed = 1.0;  ///< initial speed, in m/s
    /// For grooves: inclination of both sides. For the pipe: start angle from the bottom. In rad.
    double opening = 0.8;
    Vec3 carried;  ///< velocity of the wall and the floor, in m/s
    double time_step = 0.01;
};

Course random_course(Kind kind, RandomSequence& random) {
    Course course;
    course.kind = kind;
    course.restitution = 0.4 + 0.6 * random.uniform();
    course.of_support = kind == Kind::threshold ? course.restitution : 0.35 * random.uniform();
    course.friction = random.uniform() < 0.3 ? 0.0 : 0.15 * random.uniform();
    const bool is_round = kind == Kind::groove || kind == Kind::pipe || random.uniform() < 0.6;
    course.radius = is_round ? 0.03 + 0.05 * random.uniform() : 0.0;
    course.slope = 0.2 + 0.3 * random.uniform();
    course.lean = random.uniform() < 0.5 ? 0.0 : 0.3 * (2.0 * random.uniform() - 1.0);
    course.speed = 0.5 + random.uniform();
    course.opening = 0.5 + 0.5 * random.uniform();
    if (kind == Kind::moving) course.carried = {random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5};
    course.time_step = 0.002 + 0.02 * random.uniform();
    return course;
}

Vec3 wall_normal(const Course& course) { return {-std::cos(course.lean), 0.0, std::sin(course.lean)}; }

/// Returns the colliders that support the particle, and its start position.
std::pair<std::vector<ColliderDescription>, Vec3> support_of(const Course& course, const Copy& copy) {
    const Vec3 up = copy.direction({0, 0, 1});
    const double r = course.radius;
    if (course.kind == Kind::groove) {
        const double c = std::cos(course.opening);
        const double s = std::sin(course.opening);
        return {{plane_collider(copy.point({}), copy.direction({0, s, c}), "left"),
                 plane_collider(copy.point({}), copy.direction({0, -s, c}), "right")},
                {0, 0, r / c}};
    }
    if (course.kind == Kind::pipe) {
        constexpr double kPipe = 0.4;
        ColliderDescription pipe{"pipe", CylinderShape{copy.scale * kPipe, copy.scale * 8.0, {}}, 0};
        Placement& placement = std::get<CylinderShape>(pipe.shape).placement;
        placement.position = copy.point({0, 0, kPipe});
        const Vec3 along = copy.direction({1, 0, 0});
        placement.rotation_axis = cross(Vec3{0, 0, 1}, along);
        placement.rotation_degrees = std::atan2(length(placement.rotation_axis), along.z) * 180.0 / kPiNumber;
        const double off = 0.3 * course.opening;
        return {{pipe}, {0, (kPipe - r) * std::sin(off), kPipe - (kPipe - r) * std::cos(off)}};
    }
    if (course.kind == Kind::seams) {
        return {
            {mesh_collider(copy.mesh(floor_mesh(4.0, 5)), {}, "floor"), plane_collider(copy.point({}), up, "below")},
            // The start position is slightly above the plane, because rounding could place a point between both
            // surfaces.
            {0, 0.13, r + 1e-9}};
    }
    return {{plane_collider(copy.point({}), up, "floor")}, {0, 0, r}};
}

SimulationSetup setup_on(const Course& course, const Copy& copy, double time_step) {
    const Vec3 gravity = kStandardGravity * Vec3{std::sin(course.slope), 0, -std::cos(course.slope)};
    SimulationSetup setup =
        ricochet::testing::setup_of(time_step, 1.5, Material{}, copy.scale * copy.direction(gravity));
    setup.options.record_contacts = true;
    setup.options.verify = true;
    setup.options.resting_speed *= copy.scale;
    setup.materials = {{"wall", course.restitution, course.friction}, {"support", course.of_support, course.friction}};
    if (course.kind == Kind::threshold) {
        for (Material& material : setup.materials) material.restitution_threshold = copy.scale * 0.05;
    }
    auto [colliders, start] = support_of(course, copy);
    for (ColliderDescription& collider : colliders) collider.material = 1;
    const bool is_box = course.kind == Kind::box;
    colliders.insert(colliders.begin(),
                     is_box ? mesh_collider(copy.mesh(box_mesh({1, -2, -0.3}, {1.5, 2, 1})), {}, "wall")
                            : plane_collider(copy.point({1, 0, 0}), copy.direction(wall_normal(course)), "wall"));
    if (course.kind == Kind::moving) {
        FrameDescription frame;
        frame.name = "lift";
        frame.motions = {steady(copy.scale * copy.direction(course.carried))};
        setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
        for (ColliderDescription& collider : colliders) collider.frame = "lift";
    }
    setup.colliders = std::move(colliders);
    const Vec3 velocity = copy.scale * copy.direction(course.carried + Vec3{course.speed, 0, 0});
    setup.particles.push_back(particle_of(copy.point(start), velocity, copy.scale * course.radius));
    return setup;
}

/// The first impact on the wall, with all surface contacts at the same time.
struct WallImpact {
    double time = 0.0;
    Vec3 before;
    Vec3 after;
    std::size_t rows = 0;
};

std::optional<WallImpact> first_wall_impact(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    std::optional<WallImpact> impact;
    while (!simulation.finished() && !impact) {
        simulation.step();
        const auto& records = simulation.contact_records();
        for (const ContactRecord& record : records) {
            if (!impact && simulation.surface_name(record.surface).collider != 0) continue;
            if (impact && record.time > impact->time) break;
            if (!impact) impact = WallImpact{record.time, record.velocity_before, {}, 0};
            impact->after = record.velocity_after;
            ++impact->rows;
        }
    }
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    return impact;
}

void expect_rebound_of_wall(const Course& course, const Copy& copy) {
    const Vec3 n = copy.direction(course.kind == Kind::box ? Vec3{-1, 0, 0} : wall_normal(course));
    const Vec3 carried = copy.scale * copy.direction(course.carried);
    std::array<std::optional<WallImpact>, 2> found;
    for (const double part : {1.0, 0.5}) {
        SCOPED_TRACE("step " + std::to_string(part * course.time_step));
        const auto impact = first_wall_impact(setup_on(course, copy, part * course.time_step));
        ASSERT_TRUE(impact.has_value());
        const double approach = -dot(impact->before - carried, n);
        const double speed = length(impact->before - carried) + length(carried);
        EXPECT_GT(approach, 0.4 * copy.scale);
        EXPECT_NEAR(dot(impact->after - carried, n), course.restitution * approach, 1e-9 * speed);
        found[part == 1.0 ? 0 : 1] = impact;
    }
    // Contact on planes is integrated exactly. Contact along a pipe is integrated with fourth order, here in steps of
    // at most a sixteenth of a swing.
    const double agree = course.kind == Kind::pipe ? 1e-3 : 1e-8;
    EXPECT_NEAR(found[0]->time, found[1]->time, agree);
    EXPECT_LT(length(found[0]->after - found[1]->after), agree * (length(found[0]->before) + length(carried)));
    EXPECT_EQ(found[0]->rows, found[1]->rows);
}

TEST(AnImpactInContact, ReboundsWithTheRestitutionOfTheHitWall) {
    const int count = test::is_long_run() ? 1000 : test::scaled(84);
    RandomSequence random(20, 1, 0);
    for (int k = 0; k < count; ++k) {
        const Kind kind = kKinds[static_cast<std::size_t>(k) % kKinds.size()];
        SCOPED_TRACE("case " + std::to_string(k) + ", kind " + std::to_string(static_cast<int>(kind)));
        const Course course = random_course(kind, random);
        expect_rebound_of_wall(course, random_copy(random));
    }
}

/// Returns the final velocity of a sphere of radius 1/8 m that starts 1/8 m above the origin, among planes with these
/// restitutions.
Vec3 velocity_after(const Vec3& velocity, std::vector<ColliderDescription> colliders,
                    const std::vector<double>& restitutions, double duration, double gravity) {
    ContactScene scene;
    scene.colliders = std::move(colliders);
    for (const double e : restitutions) scene.materials.push_back({"m", e, 0.0});
    scene.gravity = {0, 0, -gravity};
    scene.particle = particle_of({0, 0, 0.125}, velocity, 0.125);
    scene.duration = duration;
    return end_of(scene).velocity;
}

TEST(AnImpactInContact, ReboundsEvenIfTheApproachIsABillionthOfTheSpeed) {
    const auto floor = plane_collider({}, {0, 0, 1}, "floor");
    const auto side = plane_collider({0, -0.125 - 5e-10, 0}, {0, 1, 0}, "side");
    const Vec3 slid = velocity_after({1, -1e-9, 0}, {floor, side}, {0.3, 0.5}, 1.0, kStandardGravity);
    EXPECT_NEAR(slid.y, 0.5e-9, 1e-15);
    EXPECT_NEAR(slid.x, 1.0, 1e-12);
    const auto below = plane_collider({0, 0, -5e-10}, {0, 0, 1}, "below");
    const Vec3 flown = velocity_after({1, 0, -1e-9}, {below}, {0.5}, 1.0, 0.0);
    EXPECT_NEAR(flown.z, 0.5e-9, 1e-15);
}

// A sphere that touches the floor and a side wall hits the end wall.
TEST(AnImpactInContact, HasTheRestitutionOfTheThirdFaceOfACorner) {
    for (const double press : {0.0, 2.0}) {
        ContactScene scene;
        scene.colliders = {plane_collider({}, {0, 0, 1}), plane_collider({0, -0.1, 0}, {0, 1, 0}),
                           plane_collider({1, 0, 0}, {-1, 0, 0})};
        scene.materials = {{"floor", 0.2, 0.0}, {"side", 0.1, 0.0}, {"end", 0.9, 0.0}};
        scene.gravity = {0, -press, -kStandardGravity};
        scene.particle = particle_of({0, 0, 0.1}, {2, 0, 0}, 0.1);
        const Vec3 after = end_of(scene).velocity;
        EXPECT_NEAR(after.x, -1.8, 1e-12) << press;
        EXPECT_NEAR(after.y, 0.0, 1e-12) << press;
    }
}

// A particle in free flight reaches two surfaces at the same time and approaches both. The smaller restitution then
// applies.
TEST(AnImpactOutOfFreeFlight, OnTwoSurfacesHasTheSmallerRestitution) {
    const auto floor = plane_collider({0, 0, -1}, {0, 0, 1}, "floor");
    const auto wall = plane_collider({1.125, 0, 0}, {-1, 0, 0}, "wall");
    const Vec3 after = velocity_after({1, 0, -1}, {floor, wall}, {0.5, 0.8}, 1.5, 0.0);
    EXPECT_NEAR(after.x, -0.5, 1e-12);
    EXPECT_NEAR(after.z, 0.5, 1e-12);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
