#include "ricochet/collision/contact_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/counts.h"
#include "support/exact_oracle.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::query;

using testing::mesh_collider;
using testing::plane_collider;
using testing::world_of;

/// Triangles of many sizes and shapes in the unit ball, with shared edges and duplicates.
TriangleMesh soup(int count, RandomSequence& random) {
    TriangleMesh mesh;
    for (int k = 0; k < count; ++k) {
        const Vec3 center = random.in_unit_ball();
        const double size = std::pow(10.0, -3.0 * random.uniform());
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int corner = 0; corner < 4; ++corner) mesh.vertices.push_back(center + size * random.unit_vector());
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first + 2, first + 1, first + 3});
        if (k % 8 == 0) mesh.triangles.push_back({first, first + 2, first + 1});
    }
    return mesh;
}

/// First contact from a test of every surface of the world.
struct Reference {
    double time = 0.0;
    std::vector<SurfaceId> surfaces;
};

std::optional<Reference> brute_force(const CollisionWorld& world, const Path& path) {
    std::vector<std::pair<double, SurfaceId>> found;
    for (const auto& [plane, surface] : world.planes()) {
        if (const auto crossing = first_crossing(path, plane)) found.emplace_back(crossing->time, surface);
    }
    for (std::uint32_t t = 0; t < world.triangles().size(); ++t) {
        if (world.is_degenerate(t)) continue;
        const auto [a, b, c] = world.corners_of_triangle(t);
        if (const auto crossing = first_crossing(path, a, b, c)) {
            found.emplace_back(crossing->time, world.surface_of_triangle(t));
        }
    }
    if (found.empty()) return std::nullopt;
    Reference reference{std::min_element(found.begin(), found.end())->first, {}};
    const double latest = reference.time + kSimultaneousUlps * ulp(reference.time);
    for (const auto& [time, surface] : found) {
        if (time <= latest) reference.surfaces.push_back(surface);
    }
    std::sort(reference.surfaces.begin(), reference.surfaces.end());
    return reference;
}

void expect_same(const std::optional<Contact>& contact, const std::optional<Reference>& reference) {
    ASSERT_EQ(contact.has_value(), reference.has_value());
    if (!contact) return;
    ASSERT_EQ(contact->time, reference->time);
    ASSERT_EQ(static_cast<std::size_t>(contact->count),
              std::min<std::size_t>(reference->surfaces.size(), Contact::kMostSurfaces));
    for (int k = 0; k < contact->count; ++k) {
        ASSERT_EQ(contact->surfaces[static_cast<std::size_t>(k)].surface,
                  reference->surfaces[static_cast<std::size_t>(k)]);
    }
}

Path random_line(RandomSequence& random) {
    const Vec3 velocity = 2.0 * random.unit_vector();
    return line_path(random.in_unit_ball(), velocity, 1.0);
}

Path random_parabola(RandomSequence& random, const Vec3& start, double speed, double acceleration) {
    const Vec3 pull = acceleration * random.unit_vector();
    return parabola_path(start, speed * random.unit_vector(), pull, 1.0);
}

Path random_path(const CollisionWorld& world, int kind, RandomSequence& random) {
    const Vec3 start = 1.5 * random.in_unit_ball();
    const auto& t =
        world.triangles()[static_cast<std::size_t>(random.uniform() * static_cast<double>(world.triangles().size()))];
    const Vec3 target = world.vertices()[t[static_cast<std::size_t>(3.0 * random.uniform())]];
    switch (kind) {
        case 0:
            return line_path(start, 3.0 * random.unit_vector(), 1.0);
        case 1:
            return line_path(start, target - start, 1.5);  // at a vertex
        case 2:
            return random_parabola(random, start, 3.0, 4.0);
        case 3:  // strongly curved: many pieces
            return random_parabola(random, start, 30.0, 60.0);
        case 4:  // a parabola through a vertex
            return parabola_path(start, (target - start) - Vec3{0, 0, -2.0}, {0, 0, -4.0}, 1.5);
        case 5:  // from and to far away
            return line_path(start + 1e7 * (start - target), 2e7 * (target - start), 1.0);
        case 6:  // in no time out of sight: the path's rounding is larger than the mesh
            return parabola_path(start, 1e12 * (target - start), 1e12 * random.unit_vector(), 1.0);
        default:
            return parabola_path(start, {}, 1e-3 * random.unit_vector(), 1.0);
    }
}

TEST(ContactQuery, FindsTheSameFirstContactAsBruteForce) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        RandomSequence random(seed, 0, 0);
        const auto world = world_of(mesh_collider(soup(seed % 2 == 0 ? 4 : 60, random)),
                                    plane_collider({0, 0, -1.2}, {0.1, 0, 1}), mesh_collider(soup(30, random)));
        ContactScratch scratch;
        int contacts = 0;
        const int count = test::scaled(2400);
        for (int i = 0; i < count; ++i) {
            SCOPED_TRACE(::testing::Message() << "seed " << seed << ", path " << i);
            const Path path = random_path(world, i % 8, random);
            const auto found = query(world, scratch, path, 0.0);
            const auto& contact = found.contact;
            expect_same(contact, brute_force(world, path));
            if (HasFatalFailure()) return;
            contacts += contact ? 1 : 0;
        }
        EXPECT_GT(contacts, count / 10);
    }
}

TEST(ContactQuery, FindsTheSameContactsHoweverTheMeshIsCut) {
    const auto coarse = world_of(mesh_collider(testing::floor_mesh(100.0, 1)));
    const auto fine = world_of(mesh_collider(testing::floor_mesh(100.0, 64)));
    const auto plane = world_of(plane_collider({0, 0, 0}, {0, 0, 1}));
    RandomSequence random(9, 0, 0);
    ContactScratch scratch;
    for (int i = 0; i < test::scaled(2000); ++i) {
        const Vec3 start{random.uniform(), random.uniform(), 1.0 + random.uniform()};
        const Vec3 v = 10.0 * random.unit_vector();
        const Path path = i % 2 == 0 ? line_path(start, v, 1.0) : parabola_path(start, v, {0, 0, -9.81}, 2.0);
        const auto reference = query(plane, scratch, path, 0.0).contact;
        for (const CollisionWorld* world : {&coarse, &fine}) {
            const auto contact = query(*world, scratch, path, 0.0).contact;
            ASSERT_EQ(contact.has_value(), reference.has_value()) << i;
            if (!contact) continue;
            EXPECT_EQ(contact->time, reference->time) << i;
            EXPECT_EQ(contact->first().normal, reference->first().normal) << i;
        }
    }
}

TEST(ContactQuery, ReportsAllSurfacesOfACornerAndTheirFacingNormals) {
    const auto world = world_of(plane_collider({0, 0, 0}, {1, 0, 0}), plane_collider({0, 0, 0}, {0, -1, 0}),
                                plane_collider({0, 0, 0}, {0, 0, 1}));
    ContactScratch scratch;
    const auto contact = query(world, scratch, line_path({1, 1, 1}, {-1, -1, -1}, 2.0), 0.0).contact;
    ASSERT_TRUE(contact);
    EXPECT_EQ(contact->time, 1.0);
    ASSERT_EQ(contact->count, 3);
    EXPECT_EQ(contact->surfaces[0].normal, (Vec3{1, 0, 0}));
    EXPECT_EQ(contact->surfaces[1].normal, (Vec3{0, 1, 0}));
    EXPECT_EQ(contact->surfaces[2].normal, (Vec3{0, 0, 1}));
}

TEST(ContactQuery, HitsARimHeadOnWithANormalAgainstTheMotion) {
    const auto world = world_of(mesh_collider(testing::floor_mesh(1.0, 1)));
    ContactScratch scratch;
    const auto contact = query(world, scratch, line_path({-3, 0.25, 0}, {2, 0, 0}, 2.0), 0.0).contact;
    ASSERT_TRUE(contact);
    EXPECT_EQ(contact->time, 1.0);
    EXPECT_EQ(contact->first().normal, (Vec3{-1, 0, 0}));
}

TEST(ContactQuery, DecidesAboutSegmentsNearThePathExactly) {
    RandomSequence random(21, 0, 0);
    const TriangleMesh mesh = soup(40, random);
    const auto world = world_of(mesh_collider(mesh));
    ContactScratch scratch;
    for (int i = 0; i < test::scaled(400); ++i) {
        const Path path = random_line(random);
        const auto found = query(world, scratch, path, 0.0);
        const auto& contact = found.contact;
        const double until = contact ? contact->time : 1.0;
        const Vec3 p = path.position(0.5 * until * random.uniform());
        const Vec3 q = path.position(until * (random.uniform() < 0.5 ? 1.0 : random.uniform()));
        std::optional<SurfaceId> smallest;
        for (std::uint32_t t = 0; t < mesh.triangles.size() && !smallest; ++t) {
            const auto [a, b, c] = world.corners_of_triangle(t);
            if (testing::exact_segment_intersects_triangle(p, q, a, b, c)) smallest = t;
        }
        ASSERT_EQ(found.near.is_free(p, q), !smallest.has_value()) << i;
        ASSERT_EQ(found.near.blocker(p, q), smallest) << i;
    }
}

// The path is strongly curved and the triangles are tiny. The query ends in time because it bisects only pieces near
// the triangles.
TEST(ContactQuery, EndsForPathsThatCurveEnormously) {
    const auto world = world_of(mesh_collider(testing::sphere_mesh({}, 1e-3, 3)));
    ContactScratch scratch;
    const auto contact =
        query(world, scratch, parabola_path({5, 0, 0}, {-1e4, 0, 1e8}, {0, 0, -4e11}, 1.0), 0.0).contact;
    EXPECT_EQ(contact.has_value(),
              brute_force(world, parabola_path({5, 0, 0}, {-1e4, 0, 1e8}, {0, 0, -4e11}, 1.0)).has_value());
    EXPECT_FALSE(query(world, scratch, parabola_path({5, 0, 0}, {0, 1e30, 0}, {1e30, 0, 0}, 1.0), 0.0).contact);
}

TEST(ContactQuery, CoversACurvedPathThatEndsWhereItBegins) {
    const CollisionWorld world = world_of(mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 1})));
    ContactScratch scratch;
    const auto found = query(world, scratch, parabola_path({1, 0.25, 0.125}, {1, 0, 0}, {0, 0, -9.81}, 0.0), 0.0);
    const auto& contact = found.contact;
    ASSERT_TRUE(contact.has_value());
    EXPECT_EQ(contact->time, 0.0);
    EXPECT_TRUE(found.near.starts_in_overlap());
}

TEST(ContactQuery, MissesNothingAlongAPathWhoseCurvatureUnderflows) {
    const CollisionWorld world = world_of(mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 1})));
    ContactScratch scratch;
    const Vec3 hardly{0, 0, -1e-170};
    const Path path = parabola_path({0.1, 0.2, 0.3}, {2, 0, 0}, hardly, 1.0);
    const LookAhead look_ahead{parabola_path({0.1, 0.2, 0.3}, {2, 0, 0}, hardly, 100.0), 10.0, 2.0, 1.0};
    const auto found = query(world, scratch, path, 0.0, &look_ahead);
    const auto& contact = found.contact;
    ASSERT_TRUE(contact.has_value());
    EXPECT_NEAR(contact->time, 0.45, 1e-12);
}

TEST(ContactQuery, ListsTheSurfacesThatAPointTouches) {
    const auto world = world_of(plane_collider({0, 0, 0}, {0, 0, 1}), mesh_collider(testing::floor_mesh(1.0, 2)),
                                plane_collider({0, 0, 5}, {0, 0, 1}));
    ContactScratch scratch;
    const Vec3 center{0, 0, 0};
    const auto found = query(world, scratch, line_path(center, {0, 0, -1}, 1.0), 0.0);
    EXPECT_EQ(found.near.surfaces_at(center).size(), 1U + 6U);  // six triangles share the centre vertex
    EXPECT_TRUE(found.near.is_free_after(center, {0, 0, 1}));
    EXPECT_FALSE(found.near.is_free_after(center, {0, 1, 0}));  // the path stays in their plane
    EXPECT_FALSE(found.near.is_free(center, {0, 0, 1}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
