#include "ricochet/response/impulse_ledger.h"

#include <span>

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
    const Vec3 center = reference_.in_world({particle_.state.position, {}, {}}, particle_.state.time).position;
    angular_impulse_ += cross(center - moment_center_, change);
    const std::size_t loads = scratch_.loads.size();
    recorder_.add({surface, -mass * change, impact}, spin_change);
    for (ColliderLoad& load : std::span(scratch_.loads).subspan(loads)) load.is_hit = are_hits_;
}

void ImpulseLedger::log_contact(const ContactSurface& surface, const Vec3& velocity_before) {
    if (!scratch_.record_contacts || !are_hits_) return;
    scratch_.records.push_back({particle_.state.time, particle_.id, surface.surface, particle_.state.position,
                                surface.normal, velocity_before, particle_.state.velocity, particle_.state.mass,
                                particle_.state.radius, surfaces_.velocity_of(surface)});
}

}  // namespace ricochet
