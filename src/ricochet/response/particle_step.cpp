#include "ricochet/response/particle_step.h"

#include <cmath>

#include "ricochet/collision/moving_sweep.h"
#include "ricochet/collision/surfaces_in_other_frames.h"

namespace ricochet {

void StepTime::begin_substep(double until, MovingParticle& particle) {
    if (!substep_end_) {
        whole_step_end_ = particle.step_end;
        rest_after_substep_ = 0.0;
    }
    // Limited to the step's end, because dynamic bodies can still get other paths beyond it.
    until = std::min(until, particle.step_end);
    substep_end_ = until;
    const double part = std::clamp(until - particle.state.time, 0.0, remaining_);
    rest_after_substep_ += remaining_ - part;
    remaining_ = part;
    particle.step_end = until;
}

void StepTime::end_substep(MovingParticle& particle) {
    if (!substep_end_) return;
    if (remaining_ <= 0.0) particle.state.time = *substep_end_;
    remaining_ += rest_after_substep_;
    particle.step_end = whole_step_end_;
    substep_end_.reset();
}

void SegmentChain::add(const StoredPosition& next, double recorded_at, MoveScratch& scratch) {
    if (scratch.record_segments) {
        scratch.segments.push_back({stored_.position, next.position, recorded_at, stored_.time, next.time});
    }
    stored_ = next;
}

ParticleStep::ParticleStep(const ResponseRules& rules, MovingParticle& particle, double duration, MoveScratch& scratch)
    : rules_(&rules),
      particle_(particle),
      scratch_(scratch),
      reference_(rules.bodies),
      geometry_(rules.world, scratch.contacts.plane_cache),
      impact_(rules, particle, scratch, outcome_, reference_),
      log_(rules, particle, scratch, reference_),
      chain_(particle, scratch, !rules.bodies.empty()),
      time_(duration),
      resting_speed_(rules.settings.resting_speed) {}

void ParticleStep::enter(BodyId body, const ResponseRules& rules, Contact* contact) {
    const ReferenceFrame before = reference_;
    reference_.set(body);
    rules_ = &rules;
    const RecordedMotion motion =
        reference_.in_frame(before.in_world(particle_.recorded_motion(), state().time), state().time);
    const StoredPosition& stored = chain_.stored();
    const MovingPose pose = rules.bodies.pose(body, stored.time);
    state().position = pose.local_position(stored.position);
    particle_.set_motion({motion.velocity, motion.spin});
    // Positions are stored in world coordinates, so the contact offset must cover the rounding of these coordinates.
    const MotionBounds& bounds = rules.bodies.bounds(body);
    const double path_length = remaining() * (bounds.origin[1] + bounds.rotation[1] * length(state().position));
    const double reach = max_abs(stored.position) + path_length + max_abs(pose.world_from_frame.translation);
    double least_offset = contact_offset({reach, 0.0, 0.0});
    if (rules.bodies.is_dynamic(body)) {
        least_offset = std::max(least_offset, offset_for_carrying(pose, state().position));
    }
    geometry_ = SurfaceGeometry(rules.world, scratch_.contacts.plane_cache, least_offset);
    chain_.begin(state().position, scratch_);
    turn_contact(contact, before, reference_);
}

void ParticleStep::leave(const ResponseRules& rules, Contact* contact) {
    const ReferenceFrame before = reference_;
    // At a key time of the body's motion, its velocity before the key is used.
    const std::optional<double>& substep_end = time_.substep_end();
    const bool is_at_key = substep_end && remaining() <= 0.0;
    const double time = is_at_key ? std::nextafter(*substep_end, 0.0) : state().time;
    const RecordedMotion motion = before.in_world(particle_.recorded_motion(), time);
    reference_.set(kWorldBody);
    scratch_.driven = true;  // the change of frames rounds the motion
    rules_ = &rules;
    state().position = chain_.stored().position;
    particle_.set_motion({motion.velocity, motion.spin});
    geometry_ = SurfaceGeometry(rules.world, scratch_.contacts.plane_cache);
    chain_.begin(state().position, scratch_);
    turn_contact(contact, before, reference_);
}

void ParticleStep::turn_contact(Contact* contact, const ReferenceFrame& from, const ReferenceFrame& to) const {
    for (int k = 0; contact != nullptr && k < contact->count; ++k) {
        Vec3& normal = contact->surfaces[static_cast<std::size_t>(k)].normal;
        const double time = particle_.state.time;
        normal = to.direction_in_frame(from.direction_in_world(normal, time), time);
    }
}

PathClock ParticleStep::clock_of(const Path& path) const {
    const double now = particle_.state.time;
    const double end =
        path.duration >= remaining() ? particle_.step_end : std::min(now + path.duration, particle_.step_end);
    const double begin = chain_.stored().time;
    return {begin, std::max(end, begin), now, 0.0, path.duration};
}

bool ParticleStep::is_among_bodies(const Path& path) const {
    if (rules_->bodies.empty()) return false;
    return reference_.is_moving() || !rules_->bodies.all_stay_out(reach_of(path, particle_.state.radius));
}

}  // namespace ricochet
