// Tests of the time of a particle's step and of its segments.
#include "ricochet/response/particle_step.h"

#include <gtest/gtest.h>

namespace ricochet {
namespace RICOCHET_FILE {

MovingParticle particle_at(double time, double step_end) {
    MovingParticle particle;
    particle.state.time = time;
    particle.step_end = step_end;
    return particle;
}

TEST(StepTime, PassesUntilNothingIsLeft) {
    StepTime time(1.0);
    time.pass(0.25);
    EXPECT_EQ(time.remaining(), 0.75);
    time.pass(0.875);
    EXPECT_EQ(time.remaining(), 0.0);
    EXPECT_EQ(time.duration(), 1.0);
}

TEST(StepTime, GivesTheRestBackAfterASubstep) {
    MovingParticle particle = particle_at(2.0, 3.0);
    StepTime time(1.0);
    time.begin_substep(2.25, particle);
    EXPECT_EQ(time.remaining(), 0.25);
    EXPECT_EQ(particle.step_end, 2.25);
    time.pass(0.25);
    time.end_substep(particle);
    EXPECT_EQ(time.remaining(), 0.75);
    EXPECT_EQ(particle.step_end, 3.0);
    EXPECT_EQ(particle.state.time, 2.25);
    EXPECT_FALSE(time.substep_end());
}

TEST(StepTime, KeepsTheTimeOfASubstepThatEndsEarly) {
    MovingParticle particle = particle_at(2.0, 3.0);
    StepTime time(1.0);
    time.begin_substep(2.5, particle);
    time.pass(0.125);
    particle.state.time = 2.125;
    time.end_substep(particle);
    EXPECT_EQ(time.remaining(), 0.875);
    EXPECT_EQ(particle.state.time, 2.125);
}

TEST(StepTime, EndsASubstepWithTheStepAtTheLatest) {
    MovingParticle particle = particle_at(2.0, 3.0);
    StepTime time(1.0);
    time.begin_substep(7.0, particle);
    EXPECT_EQ(time.remaining(), 1.0);
    EXPECT_EQ(particle.step_end, 3.0);
}

TEST(StepTime, LosesNoTimeByASubstepWithinASubstep) {
    MovingParticle particle = particle_at(2.0, 3.0);
    StepTime time(1.0);
    time.begin_substep(2.5, particle);
    time.begin_substep(2.125, particle);
    EXPECT_EQ(time.remaining(), 0.125);
    time.pass(0.125);
    time.end_substep(particle);
    EXPECT_EQ(time.remaining(), 0.875);
    EXPECT_EQ(particle.step_end, 3.0);
    EXPECT_EQ(particle.state.time, 2.125);
}

TEST(SegmentChain, RecordsSegmentsOnlyOnRequest) {
    MovingParticle particle = particle_at(2.0, 3.0);
    particle.state.position = {1, 0, 0};
    particle.stored_time = 2.0;
    MoveScratch scratch;
    SegmentChain chain(particle, scratch, true);
    EXPECT_TRUE(chain.is_timed());
    EXPECT_EQ(chain.start(), Vec3(1, 0, 0));
    chain.add({{2, 0, 0}, 2.5}, 2.0, scratch);
    EXPECT_TRUE(scratch.segments.empty());
    EXPECT_EQ(chain.stored().position, Vec3(2, 0, 0));
    scratch.record_segments = true;
    chain.add({{3, 0, 0}, 2.75}, 2.25, scratch);
    ASSERT_EQ(scratch.segments.size(), 1U);
    EXPECT_EQ(scratch.segments[0].from, Vec3(2, 0, 0));
    EXPECT_EQ(scratch.segments[0].to, Vec3(3, 0, 0));
    EXPECT_EQ(scratch.segments[0].time, 2.25);
    EXPECT_EQ(scratch.segments[0].begin, 2.5);
    EXPECT_EQ(scratch.segments[0].end, 2.75);
    chain.begin({9, 9, 9}, scratch);
    EXPECT_EQ(chain.first_segment(), 1U);
    EXPECT_EQ(chain.start(), Vec3(9, 9, 9));
    EXPECT_EQ(chain.stored().position, Vec3(3, 0, 0));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
