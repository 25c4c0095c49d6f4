// Plants one fault of every kind of violation. The verifier must find it, and nothing in the same motion without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/simulation/run_check.h"
#include "ricochet/verify/verifier.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns the violations of a particle or sphere inside a box from 0 to 4. It moves from (1, 1, 1) along the positions
/// in one step.
std::vector<Violation> travel(const std::vector<Vec3>& positions, double radius, const RecordedParts& motion = {}) {
    const Verifier verifier({testing::box_mesh({0, 0, 0}, {4, 4, 4})});
    const Vec3 start{1, 1, 1};
    VerifiedParticle particle = verifier.watch(start, radius);
    std::vector<Segment> segments;
    for (std::size_t k = 0; k + 1 < positions.size(); k += 2) segments.push_back({positions[k], positions[k + 1], 0.5});
    std::vector<Violation> violations;
    verifier.check({3, start, positions.back(), radius, 1.0, segments, motion}, particle, violations);
    return violations;
}

/// Returns the violations of a sphere that hits the floor at 4 m/s and leaves it at `speed`, m/s.
std::vector<Violation> bounce(double speed) {
    const Vec3 at{1, 1, 1};
    MotionPart part{MotionPart::Kind::impact, 0.5, 0.0, 1.0, {at, {0, 0, -4}, {}}, {at, {0, 0, speed}, {}}, {}, true};
    return travel({at, at}, 1.0, {part.begin, part.end, {&part, 1}});
}

/// Returns the violations of such an impact against the restitution of the floor, 0.5.
std::vector<Violation> rebound(double speed) {
    RecordedImpact impact;
    impact.before.velocity = {1, 0, -4};
    impact.after.velocity = {1, 0, speed};
    impact.surfaces = {{0, {0, 0, 1}, {}, {}, 0.5, 0.0, false}};
    std::vector<Violation> violations;
    RunCheck::check_rebounds(3, {&impact, 1}, violations);
    return violations;
}

/// Returns the violations of two elastic spheres of 1 kg that collide at 2 m/s. The second one leaves at `speed`, m/s.
std::vector<Violation> pair_impact(double speed) {
    PairMeeting meeting{0.5, {{}, {}}, {{0, 1, {2, 0, 0}}}};
    meeting.spheres[0] = {1, 1.0, 0.1, false, {{0, 0, 0}, {2, 0, 0}, {}}, {{0, 0, 0}, {0, 0, 0}, {}}};
    meeting.spheres[1] = {2, 1.0, 0.1, false, {{0.2, 0, 0}, {0, 0, 0}, {}}, {{0.2, 0, 0}, {speed, 0, 0}, {}}};
    return RunCheck::check_meetings({meeting}, {});
}

/// Returns the violations of two spheres of 0.5 m radius, one step after they were 2 m apart.
std::vector<Violation> pair_at(double distance) {
    const CollisionWorld world({});
    const MovingColliders bodies(world);
    RunCheck check(world, bodies);
    Particles particles;
    for (std::uint64_t id = 0; id < 2; ++id) {
        Particle particle;
        particle.id = id;
        particle.radius = 0.5;
        particle.birth_time = -1.0;
        particle.position = {2.0 * static_cast<double>(id), 0, 0};
        particles.append(particle);
    }
    std::vector<Violation> found = check.check_spheres(particles, {0.0, 1.0}, 1e-9);
    particles.position[1] = {distance, 0, 0};
    const std::vector<Violation> later = check.check_spheres(particles, {1.0, 2.0}, 1e-9);
    found.insert(found.end(), later.begin(), later.end());
    return found;
}

/// Returns the violations in a motion with or without a fault of a kind. The switch has no default, so that a new kind
/// does not compile here.
std::vector<Violation> found(ViolationKind kind, bool is_planted) {
    const Vec3 start{1, 1, 1};
    const Vec3 end{3, 2, 2};
    switch (kind) {
        case ViolationKind::crossing:  // out and in again
            return is_planted ? travel({start, {1, 1, 5}, {1, 1, 5}, end}, 0.0) : travel({start, end}, 0.0);
        case ViolationKind::gap:  // by one unit in the last place
            return is_planted ? travel({start, end, {3, 2, std::nextafter(2.0, 3.0)}, start}, 0.0)
                              : travel({start, end, end, start}, 0.0);
        case ViolationKind::wrong_side:  // a jump through the wall
            return is_planted ? travel({start, end, {3, 2, 7}, {3, 2, 6}}, 0.0) : travel({start, end}, 0.0);
        case ViolationKind::overlap:  // by a billionth of the radius
            return travel({start, {1, 1, is_planted ? 1.0 - 1e-9 : 1.0}}, 1.0);
        case ViolationKind::energy:
            return bounce(is_planted ? 4.0 + 1e-12 : 4.0);
        case ViolationKind::pair_overlap:
            return pair_at(is_planted ? 1.0 - 1e-8 : 1.0);
        case ViolationKind::pair_impact:
            return pair_impact(is_planted ? 2.0 - 1e-9 : 2.0);
        case ViolationKind::rebound:
            return rebound(is_planted ? 2.0 + 1e-7 : 2.0);
    }
    return {};
}

TEST(PlantedFaults, EveryKindIsFoundAndSoundMotionPasses) {
    for (const ViolationKind kind :
         {ViolationKind::crossing, ViolationKind::gap, ViolationKind::wrong_side, ViolationKind::overlap,
          ViolationKind::energy, ViolationKind::pair_overlap, ViolationKind::pair_impact, ViolationKind::rebound}) {
        SCOPED_TRACE(static_cast<int>(kind));
        EXPECT_TRUE(found(kind, false).empty());
        const std::vector<Violation> violations = found(kind, true);
        EXPECT_TRUE(std::any_of(violations.begin(), violations.end(),
                                [&](const Violation& violation) { return violation.kind == kind; }));
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
