#include "ricochet/verify/impact_audit.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace ricochet {
namespace RICOCHET_FILE {

using verify::ImpactAudit;
using verify::is_wrong;

/// Returns two spheres of 1 kg and 0.1 m that collide along x at 2 m/s, with restitution e and a friction impulse along
/// y.
PairMeeting meeting_of(double e, double drag) {
    PairMeeting meeting{0.5, {{}, {}}, {{0, 1, {}}}};
    MetSphere& a = meeting.spheres[0];
    MetSphere& b = meeting.spheres[1];
    a = {1, 1.0, 0.1, false, {{0, 0, 0}, {1, 0.5, 0}, {}}, {}};
    b = {2, 1.0, 0.1, false, {{0.2, 0, 0}, {-1, -0.5, 0}, {}}, {}};
    const Vec3 impulse{(1.0 + e), drag, 0.0};
    meeting.contacts[0].impulse = impulse;
    const double inertia = 0.4 * 0.1 * 0.1;
    const Vec3 turn = (-0.1 / inertia) * cross(Vec3{1, 0, 0}, impulse);
    a.after = {a.before.position, a.before.velocity - impulse, turn};
    b.after = {b.before.position, b.before.velocity + impulse, turn};
    return meeting;
}

constexpr double kSticks = 1.0 / 7.0;  // N s: stops the slip of 1 m/s

TEST(ImpactAudit, CorrectImpactsPass) {
    EXPECT_FALSE(is_wrong(meeting_of(1.0, 0.0), {}));
    EXPECT_FALSE(is_wrong(meeting_of(0.5, 0.0), {.restitution = 0.5}));
    EXPECT_FALSE(is_wrong(meeting_of(0.5, kSticks), {.restitution = 0.5, .friction = 0.3}));
    EXPECT_FALSE(is_wrong(meeting_of(0.0, 0.0), {.restitution = 0.5, .resting_speed = 1.5}));
}

/// Returns a collision with a driven sphere that rotates about z at `spin`, rad/s, and throws another sphere along y.
/// The spheres slide to the end of the impact.
PairMeeting meeting_with_turning(double spin) {
    const Vec3 impulse{1.5, 2.25, 0};
    const Vec3 turn = (1.0 / (0.4 * 0.1 * 0.1)) * cross(Vec3{-0.1, 0, 0}, impulse);
    PairMeeting meeting{0.5, {{}, {}}, {{0, 1, impulse}}};
    meeting.spheres[0] = {1, 1.0, 0.1, true, {{}, {}, {0, 0, spin}}, {{}, {}, {0, 0, spin}}};
    meeting.spheres[1] = {
        2, 1.0, 0.1, false, {{0.2, 0, 0}, {-1, 0, 0}, {}}, {{0.2, 0, 0}, {-1.0 + 1.5, 2.25, 0}, turn}};
    return meeting;
}

TEST(ImpactAudit, DrivenSphereThatRotatesDoesWork) {
    const ImpactAudit books{.restitution = 0.5, .friction = 1.5};
    EXPECT_FALSE(is_wrong(meeting_with_turning(100.0), books));  // does 22.5 J of work; 8.5 J remain
    EXPECT_TRUE(is_wrong(meeting_with_turning(-100.0), books));
    EXPECT_TRUE(is_wrong(meeting_with_turning(0.0), books));
}

TEST(ImpactAudit, EveryKindOfMistakeIsReported) {
    const ImpactAudit books{.restitution = 0.5, .friction = 0.3};
    const std::vector<std::pair<std::string, std::function<void(PairMeeting&)>>> mistakes = {
        {"apart", [](PairMeeting& m) { m.spheres[1].before.position.x += 1e-8; }},
        {"not where they were",
         [](PairMeeting& m) { m.spheres[1].before.position.x = m.spheres[0].before.position.x; }},
        {"velocity", [](PairMeeting& m) { m.spheres[0].after.velocity.z += 1e-10; }},
        {"spin", [](PairMeeting& m) { m.spheres[1].after.spin.z += 1e-7; }},
        {"impulse", [](PairMeeting& m) { m.contacts[0].impulse.x += 1e-10; }},
        {"energy", [](PairMeeting& m) { m = meeting_of(1.5, 0.0); }},
        {"restitution", [](PairMeeting& m) { m = meeting_of(0.4, 0.0); }},
        {"friction", [](PairMeeting& m) { m = meeting_of(0.5, 0.5); }},
        {"pull", [](PairMeeting& m) { m = meeting_of(-1.5, 0.0); }},
        {"fixed", [](PairMeeting& m) {
             m.spheres[0].after.velocity = {1e300, 0, 0};
         }}};
    for (const auto& [name, make] : mistakes) {
        PairMeeting meeting = meeting_of(0.5, kSticks);
        ASSERT_FALSE(is_wrong(meeting, books));
        make(meeting);
        EXPECT_TRUE(is_wrong(meeting, books)) << name;
    }
}

TEST(ImpactAudit, LostEnergyIsReportedWithoutDissipation) {
    EXPECT_TRUE(is_wrong(meeting_of(0.9, 0.0), {}));
    EXPECT_FALSE(is_wrong(meeting_of(0.9, 0.0), {.restitution = 0.9}));
}

TEST(ImpactAudit, SpheresMayBeApartByTheErrorOfTheirPathsOnWalls) {
    PairMeeting meeting = meeting_of(1.0, 0.0);
    meeting.spheres[1].before.position.x += 5e-9;
    EXPECT_TRUE(is_wrong(meeting, {}));
    meeting.spheres[0].contact_path = 0.01;
    EXPECT_FALSE(is_wrong(meeting, {}));
    meeting.spheres[1].before.position.x += 1.5e-7;
    EXPECT_TRUE(is_wrong(meeting, {}));
    meeting.spheres[1].contact_path = 0.1;
    EXPECT_FALSE(is_wrong(meeting, {}));
    meeting.spheres[1].before.position.x += 1e-7;
    EXPECT_TRUE(is_wrong(meeting, {}));
}

TEST(ImpactAudit, EveryPairOfMaterialsIsCheckedAgainstItsOwnValues) {
    ImpactAudit books{.restitution = 1.0};
    books.materials = 2;
    books.by_materials = {{1.0, 0.0, 0.0}, {0.5, 0.3, 0.0}, {0.5, 0.3, 0.0}, {0.25, 0.0, 0.0}};
    PairMeeting meeting = meeting_of(0.5, kSticks);
    EXPECT_TRUE(is_wrong(meeting, books));
    meeting.spheres[1].material = 1;
    EXPECT_FALSE(is_wrong(meeting, books));
    meeting.spheres[0].material = 1;
    EXPECT_TRUE(is_wrong(meeting, books));
    meeting = meeting_of(0.25, 0.0);
    meeting.spheres[0].material = meeting.spheres[1].material = 1;
    EXPECT_FALSE(is_wrong(meeting, books));
}

TEST(ImpactAudit, SpheresOnApproximatePathsMayBeApart) {
    PairMeeting meeting = meeting_of(1.0, 0.0);
    meeting.spheres[1].before.position.x += 1e-6;
    EXPECT_TRUE(is_wrong(meeting, {}));
    EXPECT_FALSE(is_wrong(meeting, {.has_exact_paths = false}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
