#include "ricochet/response/surface_kinematics.h"

#include "ricochet/core/tolerances.h"

namespace ricochet {

void add_support(Contact& impact, ContactSurface surface) {
    const auto is_it = [&](const ContactSurface& known) { return known.surface == surface.surface; };
    if (impact.count == Contact::kMostSurfaces || std::ranges::any_of(impact.all(), is_it)) return;
    surface.is_support = true;
    impact.surfaces[static_cast<std::size_t>(impact.count++)] = surface;
}

double SurfaceKinematics::approach(std::span<const ContactSurface> surfaces) const {
    double largest = 0.0;
    for (const ContactSurface& surface : surfaces) largest = std::max(largest, -separation_speed(surface));
    return largest;
}

double SurfaceKinematics::fastest(std::span<const ContactSurface> surfaces) const {
    double speed = length(particle_.state.velocity);
    for (const ContactSurface& surface : surfaces) speed = std::max(speed, length(velocity_of(surface)));
    return speed;
}

ImpactSurface SurfaceKinematics::landing_on(const ContactSurface& surface) const {
    const Material& material = material_of(surface.surface);
    return {surface.normal,
            0.0,
            material.friction,
            material.rolling_friction,
            material.spinning_friction,
            velocity_of(surface),
            angular_velocity_of(surface.surface),
            surface_normal_speed(surface),
            false,
            0.0,
            1.0,
            material.sticking_friction()};
}

/// Returns the velocity of a body's point at the contact, plus that of the material relative to the body.
Vec3 SurfaceKinematics::carried_velocity_of(const ContactSurface& surface, const Vec3& center) const {
    const BodyId body = rules_.bodies.body_of(surface.surface);
    const SurfacesInTime now(rules_.bodies, reference_.body(), particle_.state.time);
    const PathPoint foot = now.point_at(center - particle_.state.radius * surface.normal, 0.0);
    Vec3 velocity = now.velocity_of(surface.surface, foot);
    if (rules_.bodies.is_dynamic(body)) {
        velocity += now.direction_from(kWorldBody, velocity_beside_path(body, foot.world), 0.0);
    }
    const Material& material = material_of(surface.surface);
    if (!material.drives()) return velocity;
    const SurfacesInTime seen(rules_.bodies, body, particle_.state.time);
    const Vec3 along = material.motion.at(seen.stored(foot.world).position,
                                          seen.direction_from(reference_.body(), surface.normal, 0.0));
    return velocity + now.direction_from(body, along, 0.0);
}

Vec3 SurfaceKinematics::carried_angular_velocity_of(SurfaceId surface) const {
    const double time = particle_.state.time;
    const SurfacesInTime now(rules_.bodies, reference_.body(), time);
    const Material& material = material_of(surface);
    const Vec3 of_material =
        material.drives() ? now.direction_from(rules_.bodies.body_of(surface), material.motion.angular_velocity, 0.0)
                          : Vec3{};
    const Vec3& center = particle_.state.position;
    const Vec3 world = reference_.in_world({center, {}, {}}, time).position;
    return of_material + now.angular_velocity_of(surface, {center, 0.0, world});
}

/// Returns the velocity of a body's point relative to the body's planned path, in world coordinates. It has two causes:
/// impulses that the particle has given to the body, and an angular velocity in addition to that of the path.
Vec3 SurfaceKinematics::velocity_beside_path(BodyId body, const Vec3& point) const {
    const double time = particle_.state.time;
    const Vec3 turning = rules_.bodies.turning_beside_path(body, time);
    const Mobility mobility = rules_.bodies.mobility(body, time);
    Vec3 velocity;
    if (turning != Vec3{}) velocity = cross(turning, point - mobility.center);
    for (const Given& given : given_) {
        if (given.body == body) velocity += mobility.change_at(point, given.wrench);
    }
    return velocity;
}

double SurfaceKinematics::advance_beside_path(const ContactSurface& surface) const {
    if (!is_dynamic(surface.surface)) return 0.0;
    const double time = particle_.state.time;
    const Vec3 foot = particle_.state.position - particle_.state.radius * surface.normal;
    const Vec3 point = reference_.in_world({foot, {}, {}}, time).position;
    const Vec3 beside = velocity_beside_path(rules_.bodies.body_of(surface.surface), point);
    return dot(reference_.direction_in_frame(beside, time), surface.normal);
}

double SurfaceKinematics::approach_of_path(const ContactSurface& surface) const {
    if (!is_dynamic(surface.surface)) return 0.0;
    return -separation_speed(surface) - advance_beside_path(surface);
}

double SurfaceKinematics::approach_of_paths(std::span<const ContactSurface> surfaces) const {
    double largest = 0.0;
    for (const ContactSurface& surface : surfaces) largest = std::max(largest, approach_of_path(surface));
    return largest;
}

bool SurfaceKinematics::approaches_pushed_body(std::span<const ContactSurface> surfaces) const {
    return !given_.empty() && std::ranges::any_of(surfaces, [&](const ContactSurface& surface) {
        if (!is_dynamic(surface.surface)) return false;
        const Vec3 point = particle_.state.position - particle_.state.radius * surface.normal;
        const Vec3 given = velocity_beside_path(rules_.bodies.body_of(surface.surface), point);
        const double rounding = kStopRounding * (length(particle_.state.velocity) + length(velocity_of(surface)));
        return separation_speed(surface) + dot(given, surface.normal) < rounding;
    });
}

}  // namespace ricochet
