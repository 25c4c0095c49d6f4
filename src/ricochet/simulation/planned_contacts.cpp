#include "ricochet/simulation/planned_contacts.h"

#include <algorithm>

#include "ricochet/collision/contact_query.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Members per unit of parallel work.
constexpr std::size_t kPlannedContactsBlock = 64;

/// Part of a solid sphere's slip that friction must remove for rolling: 1 / (1 + 5/2). A mathematical constant.
constexpr double kRollingShare = 2.0 / 7.0;

/// Displacement by a linearly growing force, divided by final acceleration and squared step. A mathematical constant.
constexpr double kLedBy = 1.0 / 6.0;

std::optional<Contact> contact_along(const CollisionWorld& world, const Path& path, double radius) {
    thread_local ContactScratch scratch;
    const SurfaceGeometry geometry(world, scratch.plane_cache);
    return find_first_contact(geometry, {path, radius}, scratch).contact;
}

}  // namespace

/// Planned motion of a member along a straight line.
struct PlannedContacts::Flown {
    Vec3 before;    ///< m/s, at the start of the step
    Vec3 velocity;  ///< m/s, along the line
    Vec3 spin;      ///< rad/s
    double radius;
    double duration;          ///< s
    double least_compliance;  ///< lower bound of SupportConstraints::yield, m/s
};

std::vector<SupportConstraints> PlannedContacts::find(const ParticleSystem& system, std::span<const Vec3> velocities,
                                                      std::span<const Vec3> spins, double duration,
                                                      double least_compliance) const {
    std::vector<SupportConstraints> result(system.size());
    double fastest = 0.0;
    for (const Vec3& v : velocities) fastest = std::max(fastest, max_abs(v));
    parallel_for(system.size(), kPlannedContactsBlock, [&](std::size_t k) {
        const Vec3& from = system.positions()[k];
        const Path path = line_path(from, velocities[k], duration);
        if (system.is_pinned(k) || !is_finite(path.end) || max_abs(path.end) > kLargestCoordinate) return;
        const double radius = system.input(k, 0.0, from, {}).radius;
        const auto contact = contact_along(world_, path, radius);
        if (!contact) return;
        const Flown flown{system.velocities()[k],    velocities[k], spins[k], radius, duration,
                          least_compliance * fastest};
        result[k] = find_supports(flown, *contact);
    });
    return result;
}

std::vector<Vec3> PlannedContacts::find_curvature_deviations(const ParticleSystem& system, const SystemStep& step,
                                                             std::span<const SupportConstraints> supports) const {
    std::vector<Vec3> result(system.size());
    parallel_for(system.size(), kPlannedContactsBlock, [&](std::size_t k) {
        if (supports[k].count != 1) return;
        const Vec3& n = supports[k].directions[0];
        const Vec3& at = step.positions[k];
        const double pressing = dot(step.velocities[k] - step.free_velocities[k], n);  // m/s
        const double reach = step.duration * length(supports[k].across(step.velocities[k]));
        if (!(reach > 2.0 * contact_offset(at))) return;
        const Vec3 turned_over = (-pressing * step.duration * kLedBy) * n;
        result[k] = turned_over;
        const double radius = system.input(k, 0.0, at, {}).radius;
        const Path path = line_path(at + reach * n, -2.0 * reach * n, 1.0);
        const auto contact = contact_along(world_, path, radius);
        if (!contact) return;
        const Vec3& turned = contact->first().normal;
        result[k] = path.position(contact->time) - at + turned_over - dot(turned_over, turned) * turned;
    });
    return result;
}

/// Returns the support constraints of a contact. Along the normals, the member moves to the surface and perhaps
/// rebounds. From the impact on, friction stops a point or makes a sphere roll, within the friction limit. It removes a
/// share of the slip without friction, so it is proportional to the remaining slip.
SupportConstraints PlannedContacts::find_supports(const Flown& flown, const Contact& contact) const {
    SupportConstraints supports;
    const double part = contact.time / flown.duration;
    const Vec3& v = flown.velocity;
    double pressed = 0.0;  // m/s, sum over all normals
    double friction = 0.0;
    for (const ContactSurface& surface : contact.all()) {
        if (supports.count == supports.directions.size()) break;
        const double approach = -dot(v, surface.normal);
        const Vec3 across = supports.across(surface.normal);
        if (!(approach > 0.0) || !(length(across) > kIndependentSupport)) continue;
        const Material& material = materials_[world_.material_of(surface.surface)];
        // The change of the velocity by forces in this step does not count as impact speed.
        const double arriving = std::max(0.0, std::min(approach, -dot(flown.before, surface.normal)));
        double rebound = material.restitution_at(arriving) * arriving;
        rebound = rebound < resting_speed_ ? 0.0 : material.restitution_at(approach) * approach;
        const Vec3 n = normalized(across);
        const double along = (1.0 - part) * rebound - part * approach;  // along the surface's normal
        supports.directions[supports.count++] = n;
        supports.velocity += ((along - dot(supports.velocity, surface.normal)) / dot(n, surface.normal)) * n;
        pressed += approach + rebound;
        friction = std::max(friction, material.friction);
    }
    if (supports.count == 0) return supports;
    const bool is_point = flown.radius == 0.0;
    supports.grip = (1.0 - part) * friction * pressed;
    if (!(supports.grip > 0.0)) return supports;
    supports.spin_slip = supports.across(cross(flown.spin, flown.radius * contact.first().normal));
    const double share = (1.0 - part) * (is_point ? 1.0 : kRollingShare);
    supports.yield = std::max(supports.grip * (1.0 - share) / share, flown.least_compliance);
    return supports;
}

}  // namespace ricochet
