// Tests space-time segments beside a deforming mesh against closed-form values.
#include "ricochet/collision/deforming_sweep.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "ricochet/collision/moving_sweep.h"
#include "ricochet/geometry/mesh/mesh_motion.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kRise = 2.0;  // m/s

/// Triangle that rises through z = 0 at 0.5 s.
struct RisingTriangle {
    std::shared_ptr<const FrameTree> frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{});
    std::shared_ptr<ColliderList> list;
    std::unique_ptr<CollisionWorld> at_rest;
    std::unique_ptr<MovingColliders> bodies;

    RisingTriangle() {
        const std::vector<Vec3> flat{{-4, -4, 0}, {4, -4, 0}, {0, 5, 0}};
        TriangleMesh mesh;
        mesh.vertices = flat;
        mesh.triangles = {{0, 1, 2}};
        MeshShape shape{std::make_shared<const TriangleMesh>(mesh), {}, "", {}};
        const auto positions_at = [&](double time) {
            std::vector<Vec3> positions = flat;
            for (Vec3& p : positions) p.z = kRise * (time - 0.5);
            return positions;
        };
        shape.motion = std::make_shared<const MeshMotion>(sampled_motion(positions_at, {0.0, 1.0}, MeshEnds::hold));
        list = std::make_shared<ColliderList>(std::vector<ColliderDescription>{{"rising", shape, 0}});
        at_rest = std::make_unique<CollisionWorld>(list, "");
        bodies = std::make_unique<MovingColliders>(*at_rest, frames);
        bodies->prepare_radius(0.125);
        at_rest->prepare_radius(0.125);
        bodies->begin_step(0.0, 1.0);
    }
};

// A sphere may overlap a surface by 1e-12 of its own coordinates. The coordinates of the end of its path must not
// count.
TEST(DeformingSweep, LetsASphereOverlapByTheRoundingOfItsOwnPositionOnly) {
    const RisingTriangle scene;
    constexpr double kRadius = 0.125;
    for (const double far : {1.0, 1e5}) {
        const Vec3 begin{0, 0, 1};
        const Path path = line_path(begin, {far, 0, 0}, 1.0);
        const SurfacesInTime surfaces(*scene.bodies, kWorldBody, {0.0, 1.0, 0.0, 0.0, 1.0});
        TrianglePlaneCache planes;
        const SurfaceGeometry geometry(*scene.at_rest, planes);
        ContactScratch scratch;
        const ContactQuery query{path, kRadius};
        const PathPoint start{begin, 0.0, begin};
        MovingSweep sweep(surfaces, geometry, query, start, scratch);
        const ContactQueryResult found = sweep.sweep(start);
        // The segment goes straight down to the triangle's position at that time. It does not depend on the path.
        const auto is_free_with_gap = [&](double gap) {
            constexpr double kTime = 0.5;
            const Vec3 end{0, 0, kRadius + gap};
            return found.near.is_segment_free(start, {end, kTime, end});
        };
        EXPECT_TRUE(is_free_with_gap(1e-12)) << far;
        EXPECT_TRUE(is_free_with_gap(-1e-13)) << far;
        EXPECT_FALSE(is_free_with_gap(-1e-11)) << far;
        EXPECT_FALSE(is_free_with_gap(-1e-8)) << far;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
