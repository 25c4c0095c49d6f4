#include "ricochet/response/impulse_ledger.h"

#include <cmath>
#include <utility>

#include "ricochet/collision/surfaces_in_time.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {

void ImpulseLedger::record_impulse(SurfaceId surface, const Vec3& velocity_change, bool impact,
                                   const std::optional<Vec3>& spin_change) {
    const double mass = particle_.state.mass;
    const Vec3 change = reference_.direction_in_world(velocity_change, particle_.state.time);
    velocity_change_ += change;
    scratch_.hits.push_back({surface, -mass * change, impact && are_hits_});
    scratch_.driven = scratch_.driven || surfaces_.material_of(surface).drives() || reference_.is_moving() ||
                      surfaces_.is_carried(surface);
    if (!scratch_.record_loads) return;
    const RecordedMotion now = motion_in_world();
    angular_impulse_ += cross(now.position - moment_center_, change);
    const Vec3 spin = spin_change ? spin_ + *spin_change : now.spin;
    const Vec3 couple = couple_of(spin - spin_);
    spin_ = spin;
    if (particle_.state.time > until_.time) since_ = std::exchange(until_, moment_of_time());
    add_load({surface, -mass * change, impact}, couple);
}

void ImpulseLedger::log_contact(const ContactSurface& surface, const Vec3& velocity_before) {
    if (!scratch_.record_contacts || !are_hits_) return;
    scratch_.records.push_back({particle_.state.time, particle_.id, surface.surface, particle_.state.position,
                                surface.normal, velocity_before, particle_.state.velocity, particle_.state.mass,
                                particle_.state.radius, surfaces_.velocity_of(surface)});
}

void ImpulseLedger::record_moment(SurfaceId surface, const Vec3& change) {
    if (scratch_.record_loads) add_load({surface, Vec3{}, false}, -particle_.state.mass * change);
}

void ImpulseLedger::begin_impact(double approach) {
    if (!scratch_.record_loads) return;
    approach_ = approach;
    first_of_impact_ = scratch_.loads.size();
    energy_before_ = kinetic_energy();
}

void ImpulseLedger::end_impact() {
    if (!scratch_.record_loads || scratch_.loads.size() == first_of_impact_) return;
    close();
    scratch_.loads.back().lost_energy = energy_before_ - kinetic_energy();
}

void ImpulseLedger::close() {
    if (!scratch_.record_loads || scratch_.loads.size() == first_) return;
    const Vec3 spin = motion_in_world().spin;
    const Vec3 couple = couple_of(spin - std::exchange(spin_, spin));
    if (couple == Vec3{}) return;
    ColliderLoad& last = scratch_.loads.back();
    last.couple += couple;
    last.moment += couple;
    const BodyId body = rules_.bodies.body_of(last.surface);
    const Vec3& turning = surfaces_.material_of(last.surface).motion.angular_velocity;
    if (body == kWorldBody) {
        last.work += dot(couple, turning);
        return;
    }
    last.work += dot(couple, rules_.bodies.pose(body, last.time).world_from_frame.direction(turning));
    const SurfacesInTime then(rules_.bodies, kWorldBody, time_of_push(body, last.time, last.impact));
    last.work += dot(couple, then.angular_velocity_of(last.surface, then.stored(last.particle_center)));
}

double ImpulseLedger::kinetic_energy() const {
    const RecordedMotion motion = motion_in_world();
    const double radius = particle_.state.radius;
    return 0.5 * particle_.state.mass *
           (dot(motion.velocity, motion.velocity) + 0.4 * radius * radius * dot(motion.spin, motion.spin));
}

/// Returns the couple on a surface, in N m s, by a change of the spin of the particle, a solid sphere.
Vec3 ImpulseLedger::couple_of(const Vec3& spin_change) const {
    const double radius = particle_.state.radius;
    return (-0.4 * particle_.state.mass * radius * radius) * spin_change;
}

/// Returns the work, in J, that a load does because the surface's material moves (a conveyor belt), with the motion at
/// a moment. The impulse does work on the velocity of the material at the contact. The couple minus the moment of the
/// impulse is a resistance to rolling or spinning. This resistance does work on the angular velocity of the material.
double ImpulseLedger::work_on_material(const ColliderLoad& load, BodyId body, const Moment& at) const {
    const Material& material = surfaces_.material_of(load.surface);
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
double ImpulseLedger::time_of_push(BodyId body, double time, bool impact) const {
    if (impact || body == kWorldBody || rules_.bodies.is_dynamic(body)) return time;
    const double rounding = kKeyUlps * ulp(time);
    const double key = rules_.bodies.next_key(body, time - rounding);
    if (!(key <= time + rounding)) return time;
    return rules_.bodies.is_deforming(body) ? key - 2.0 * rounding : std::nextafter(key, key - 1.0);
}

void ImpulseLedger::add_load(const SurfaceHit& hit, const Vec3& couple) {
    const BodyId body = rules_.bodies.body_of(hit.surface);
    if (body == kWorldBody && !surfaces_.material_of(hit.surface).drives()) return;
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
    load.is_hit = are_hits_;
    if (!hit.impact) make_lasting(load, body);
    scratch_.loads.push_back(load);
}

/// Corrects a load of lasting contact, which has acted over its whole interval while particle and surface moved. Uses
/// the means of the values at both ends of the interval, which is of second order.
void ImpulseLedger::make_lasting(ColliderLoad& load, BodyId body) const {
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
/// particle's position at the end of the interval; a separate couple records the resulting difference of angular
/// momentum.
double ImpulseLedger::work_at(const ColliderLoad& load, BodyId body, const Moment& at) const {
    const MovingPose pose = rules_.bodies.pose(body, at.time);
    const Vec3 moment = cross(load.particle_center - pose.world_from_frame.translation, load.impulse) + load.couple;
    return dot(load.impulse, pose.velocity) + dot(moment, pose.angular_velocity) + work_on_material(load, body, at);
}

}  // namespace ricochet
