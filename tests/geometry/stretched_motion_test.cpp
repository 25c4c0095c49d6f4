#include "ricochet/geometry/mesh/stretched_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

const KeyedCurve<Vec3>& growth() {
    static const KeyedCurve<Vec3> curve({{1.0, {1, 1, 1}}, {3.0, {2, 0.5, 1}}, {4.0, {1, 1, 3}}});
    return curve;
}

/// Returns a moving frame whose last motion is a scale.
FrameTree tree_of(std::vector<FrameMotion> motions, const KeyedCurve<Vec3>& factors = growth()) {
    FrameDescription frame;
    frame.name = "frame";
    frame.translation = {0.3, -0.2, 0.1};
    frame.motions = std::move(motions);
    frame.motions.emplace_back(KeyedScale{factors});
    return FrameTree({frame});
}

TEST(StretchedMotion, IsExactWithoutExtraKeysIfTheFrameDoesNotRotate) {
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1, 2, 1});
    const FrameTree frames = tree_of({KeyedTranslation{KeyedCurve<Vec3>({{0.0, {}}, {2.0, {4, 0, 0}}})}});
    const MeshMotion motion = stretched_motion(box.vertices, frames, 0, 0.0, 5.0);
    EXPECT_EQ(std::vector<double>(motion.times().begin(), motion.times().end()),
              (std::vector<double>{0.0, 1.0, 2.0, 3.0, 4.0, 5.0}));
    for (const double time : {-1.0, 0.25, 1.0, 1.75, 2.5, 3.9, 7.0}) {
        const double within = std::clamp(time, 0.0, 5.0);
        for (std::size_t v = 0; v < box.vertices.size(); ++v) {
            const Vec3 s = growth().value(within);
            const Vec3 p = box.vertices[v];
            const Vec3 center_path = Vec3{0.3, -0.2, 0.1} + std::min(2.0 * within, 4.0) * Vec3{1, 0, 0};
            const Vec3 expected = center_path + Vec3{s.x * p.x, s.y * p.y, s.z * p.z};
            EXPECT_LT(length(motion.at(time).position(v) - expected), 4e-15) << time;
        }
    }
}

TEST(StretchedMotion, StaysWithinItsDeviationAndCloseToItIfTheFrameRotates) {
    const TriangleMesh mesh = testing::sphere_mesh({0.2, 0.1, 0}, 1.0, 1);
    const double diagonal = length(bounds(mesh).size());
    for (const FrameMotion& turning :
         {FrameMotion{Spin{{1, 2, 0.5}, 180.0}}, FrameMotion{Swing{{0, 1, 0}, 50.0, 0.7}}}) {
        const FrameTree frames = tree_of({Oscillation{{0.2, 0, 0.3}, 0.5}, turning});
        const MeshMotion motion = stretched_motion(mesh.vertices, frames, 0, 0.0, 5.0);
        double most = 0.0;
        for (int k = 0; k <= 5000; ++k) {
            const double time = 5.0 * k / 5000;
            for (std::size_t v = 0; v < mesh.vertices.size(); v += 7) {
                const Vec3 expected = frames.map(0, time).point(mesh.vertices[v]);
                most = std::max(most, length(motion.at(time).position(v) - expected));
            }
        }
        EXPECT_LT(most, kStretchDeviation * diagonal);
        EXPECT_GT(most, 0.05 * kStretchDeviation * diagonal);
    }
}

// Two rotating frames with scales shear their contents.
TEST(StretchedMotion, StaysWithinItsDeviationAlongChains) {
    const TriangleMesh mesh = testing::sphere_mesh({0.2, 0.1, 0}, 1.0, 1);
    const KeyedCurve<Vec3> ease({{0.0, {1, 1, 1}}, {2.0, {0.6, 1.2, 2}}, {5.0, {1, 1, 1}}},
                                Interpolation::cubic_spline);
    const FrameTree frames({{"lower", "", {0, 0, 1}, {0, 0, 1}, 0.0, {Spin{{0, 1, 0}, 60.0}, KeyedScale{growth()}}},
                            {"upper", "lower", {1, 0, 0}, {0, 0, 1}, 0.0, {Spin{{1, 0, 1}, -90.0}, KeyedScale{ease}}}});
    const MeshMotion motion = stretched_motion(mesh.vertices, frames, 1, 0.0, 5.0);
    double most = 0.0;
    for (int k = 0; k <= 5000; ++k) {
        const double time = 5.0 * k / 5000;
        for (std::size_t v = 0; v < mesh.vertices.size(); v += 7) {
            const Vec3 expected = frames.map(1, time).point(mesh.vertices[v]);
            most = std::max(most, length(motion.at(time).position(v) - expected));
        }
    }
    EXPECT_LT(most, kStretchDeviation * length(bounds(mesh).size()));
    EXPECT_GT(most, 0.01 * kStretchDeviation * length(bounds(mesh).size()));
}

std::string refusal(const FrameTree& frames, double begin, double end) {
    try {
        static_cast<void>(stretched_motion(testing::box_mesh({0, 0, 0}, {1, 1, 1}).vertices, frames, 0, begin, end));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(StretchedMotion, RefusesUnsupportedMotions) {
    EXPECT_EQ(refusal(tree_of({}), 2.0, 2.0),
              "scale that changes in time: it ends before it begins, expected a later end");
    // The factor is above 0 at its keys, but not between them.
    const KeyedCurve<Vec3> dip({{0.0, {1, 1, 1}}, {1.0, {1, 0.01, 1}}, {1.5, {1, 0.01, 1}}, {2.0, {1, 2, 1}}},
                               Interpolation::cubic_spline);
    const std::string below = refusal(tree_of({}, dip), 0.0, 2.0);
    EXPECT_EQ(below.substr(0, 46), "scale that changes in time: found the factor -") << below;
    EXPECT_NE(below.find(" s, expected one above 0 at all times"), std::string::npos) << below;
    FrameDescription body;
    body.name = "body";
    body.is_driven = true;
    EXPECT_EQ(refusal(FrameTree({body}), 0.0, 1.0),
              "scale that changes in time: the frame 'body' is a body, which impulses move, expected a frame with "
              "motions of its own");
    const std::string memory = refusal(tree_of({Spin{{0, 0, 1}, 1e20}}), 0.0, 1.0);
    EXPECT_EQ(memory.substr(0, 36), "scale that changes in time: asks for") << memory;
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
