#include "ricochet/response/impulse_recorder.h"

#include <cmath>
#include <utility>

#include "ricochet/collision/surfaces_in_time.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {

void ImpulseRecorder::add(const SurfaceHit& hit, const std::optional<Vec3>& spin_change) {
    const Vec3 spin = spin_change ? spin_ + *spin_change : motion_in_world().spin;
    const Vec3 couple = couple_of(spin - spin_);
    spin_ = spin;
    if (particle_.state.time > until_.time) since_ = std::exchange(until_, moment_of_time());
    if (is_entered(hit.surface)) enter(hit, couple);
}

void ImpulseRecorder::add_couple(SurfaceId surface, const Vec3& couple) {
    if (scratch_.record_loads && is_entered(surface)) enter({surface, Vec3{}, false}, couple);
}

void ImpulseRecorder::begin_impact(double approach) {
    if (!scratch_.record_loads) return;
    approach_ = approach;
    first_of_impact_ = scratch_.loads.size();
    energy_before_ = kinetic_energy();
}

void ImpulseRecorder::end_impact() {
    if (!scratch_.record_loads || scratch_.loads.size() == first_of_impact_) return;
    close();
    scratch_.loads.back().lost_energy = energy_before_ - kinetic_energy();
}

void ImpulseRecorder::close() {
    if (!scratch_.record_loads || scratch_.loads.size() == first_) return;
    const Vec3 spin = motion_in_world().spin;
    const Vec3 couple = couple_of(spin - std::exchange(spin_, spin));
    if (couple == Vec3{}) return;
    ColliderLoad& last = scratch_.loads.back();
    last.couple += couple;
    last.moment += couple;
    const BodyId body = rules_.bodies.body_of(last.surface);
    const Vec3& turning = rules_.materials[rules_.world.material_of(last.surface)].motion.angular_velocity;
    if (body == kWorldBody) {
        last.work += dot(couple, turning);
        return;
    }
    last.work += dot(couple, rules_.bodies.pose(body, last.time).world_from_frame.direction(turning));
    const SurfacesInTime then(rules_.bodies, kWorldBody, time_of_push(body, last.time, last.impact));
    last.work += dot(couple, then.angular_velocity_of(last.surface, then.stored(last.particle_center)));
}

bool ImpulseRecorder::is_entered(SurfaceId surface) const {
    return rules_.bodies.body_of(surface) != kWorldBody || rules_.materials[rules_.world.material_of(surface)].drives();
}

RecordedMotion ImpulseRecorder::motion_in_world() const {
    const RecordedMotion seen{particle_.state.position, particle_.state.velocity, particle_.spin};
    return reference_.is_moving() ? reference_.in_world(seen, particle_.state.time) : seen;
}

double ImpulseRecorder::kinetic_energy() const {
    const RecordedMotion motion = motion_in_world();
    const double radius = particle_.state.radius;
    return 0.5 * particle_.state.mass *
           (dot(motion.velocity, motion.velocity) + 0.4 * radius * radius * dot(motion.spin, motion.spin));
}

/// Returns the couple on a surface, in N m s, by a change of the spin of the particle, a solid sphere.
Vec3 ImpulseRecorder::couple_of(const Vec3& spin_change) const {
    const double radius = particle_.state.radius;
    return (-0.4 * particle_.state.mass * radius * radius) * spin_change;
}

/// Returns the work, in J, that a load does because the surface's material moves (a conveyor belt), with the motion at
/// a moment. The impulse does work on the velocity of the material at the contact. The couple minus the moment of the
/// impulse is a resistance to rolling or spinning. This resistance does work on the angular velocity of the material.
double ImpulseRecorder::work_on_material(const ColliderLoad& load, BodyId body, const Moment& at) const {
    const Material& material = rules_.materials[rules_.world.material_of(load.surface)];
    if (!material.drives()) return 0.0;
    const MovingPose pose = rules_.bodies.pose(body, at.time);
    const SurfacesInTime then(rules_.bodies, body, at.time);
    const PathPoint center = then.stored(at.particle_center);
    const Vec3 normal = then.nearest(load.surface, center).normal;
    const double radius = particle_.state.radius;
    const Vec3 along = material.motion.at(center.position - radius * normal, normal);
    const auto in_world = [&](const Vec3& v) { return pose.world_from_frame.direction(v); };
    const Vec3 resistance = load.couple + cross(radius * in_world(normal), load.impulse);
    return dot(load.impulse, in_world(along)) + dot(resistance, in_world(material.motion.angular_velocity));
}

/// Returns a time, in s, at which a body still has the motion that it had during a contact. Lasting contact is recorded
/// at the end of its interval. This may be a key time, after which the body moves differently.
double ImpulseRecorder::time_of_push(BodyId body, double time, bool impact) const {
    if (impact || body == kWorldBody || rules_.bodies.is_dynamic(body)) return time;
    const double rounding = kKeyUlps * ulp(time);
    const double key = rules_.bodies.next_key(body, time - rounding);
    if (!(key <= time + rounding)) return time;
    return rules_.bodies.is_deforming(body) ? key - 2.0 * rounding : std::nextafter(key, key - 1.0);
}

void ImpulseRecorder::enter(const SurfaceHit& hit, const Vec3& couple) {
    const BodyId body = rules_.bodies.body_of(hit.surface);
    const double time = time_of_push(body, particle_.state.time, hit.impact);
    const MovingPose pose = rules_.bodies.pose(body, time);
    ColliderLoad load;
    load.particle = particle_.id;
    load.time = particle_.state.time;
    load.surface = hit.surface;
    load.mass = particle_.state.mass;
    load.impulse = hit.impulse;
    load.particle_center = motion_in_world().position;
    load.couple = couple;
    load.moment = cross(load.particle_center - pose.world_from_frame.translation, hit.impulse) + couple;
    load.work = dot(hit.impulse, pose.velocity) + dot(load.moment, pose.angular_velocity) +
                work_on_material(load, body, {particle_.state.time, load.particle_center});
    load.approach = approach_;
    if (rules_.bodies.is_dynamic(body)) {
        const Vec3 arm = load.particle_center - rules_.bodies.mobility(body, time).center;
        load.work += dot(cross(arm, hit.impulse) + couple, rules_.bodies.turning_beside_path(body, time));
    }
    if (rules_.bodies.is_deforming(body)) {
        const DeformingMesh::Motion motion =
            rules_.bodies.deforming().mesh_with(hit.surface).motion_at(hit.surface, load.particle_center, time);
        load.work += dot(hit.impulse, motion.velocity) + dot(couple, motion.turning);
    }
    load.impact = hit.impact;
    if (!hit.impact) enter_lasting(load, body);
    scratch_.loads.push_back(load);
}

/// Corrects a load of lasting contact, which has acted over its whole interval while particle and surface moved. Uses
/// the means of the values at both ends of the interval, which is of second order.
void ImpulseRecorder::enter_lasting(ColliderLoad& load, BodyId body) const {
    if (body == kWorldBody) {
        load.moment = cross(0.5 * (since_.particle_center + load.particle_center), load.impulse) + load.couple;
    } else if (rules_.bodies.is_dynamic(body) || rules_.bodies.is_deforming(body)) {
        return;  // the body's path is planned differently, and the position on the surface is not known
    }
    load.work = 0.5 * (load.work + work_at(load, body, since_));
    if (body == kWorldBody) return;
    const auto origin = [&](double time) { return rules_.bodies.pose(body, time).world_from_frame.translation; };
    load.moment += cross(0.5 * (origin(until_.time) - origin(since_.time)), load.impulse);
}

/// Returns the work, in J, that a load would do with the motion that the body has at a moment. The impulse acts at the
/// particle's position at the end of the interval. For moving surfaces, a separate couple records the resulting
/// difference from the particle's loss of angular momentum.
double ImpulseRecorder::work_at(const ColliderLoad& load, BodyId body, const Moment& at) const {
    const MovingPose pose = rules_.bodies.pose(body, at.time);
    const Vec3 moment = cross(load.particle_center - pose.world_from_frame.translation, load.impulse) + load.couple;
    return dot(load.impulse, pose.velocity) + dot(moment, pose.angular_velocity) + work_on_material(load, body, at);
}

}  // namespace ricochet
