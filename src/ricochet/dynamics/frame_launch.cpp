#include "ricochet/dynamics/frame_launch.h"

namespace ricochet {

Particle launched_from(const FrameTree& frames, std::size_t frame, Particle particle) {
    const MovingPose pose = frames.at(frame, particle.birth_time);
    const AffineMap& world = pose.world_from_frame;
    particle.velocity = world.direction(particle.velocity) + pose.velocity_of(particle.position);
    particle.position = world.point(particle.position);
    particle.spin = world.direction(particle.spin);
    if (particle.radius > 0.0) particle.spin += pose.angular_velocity;
    return particle;
}

}  // namespace ricochet
