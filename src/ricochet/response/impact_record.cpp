// Records of impacts for the verifier, and the part of holding surfaces in an impact.
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/impact_resolver.h"

namespace ricochet {

/// Takes away the rounding by which surfaces that hold the particle are approached. The impulse is none of an impact.
void ImpactResolver::settle_on_supports(std::span<const ContactSurface> surfaces) {
    std::array<Vec3, Contact::kMostSurfaces> normals;
    std::array<double, Contact::kMostSurfaces> missing{};
    std::size_t count = 0;
    const ContactSurface* holder = nullptr;
    for (const ContactSurface& surface : surfaces) {
        const double towards = -separation_speed(surface);
        if (!surface.is_support || !(towards > 0.0) || count == normals.size()) continue;
        normals[count] = surface.normal;
        missing[count++] = towards;
        if (holder == nullptr) holder = &surface;
    }
    if (holder == nullptr) return;
    const Vec3 change = shift_by(std::span(normals).first(count), std::span(missing).first(count));
    particle_.state.velocity += change;
    record_impulse(holder->surface, change, false, Vec3{});
}

/// The impact as it begins. What an earlier part of it has led away from a surface, that surface holds no more.
RecordedImpact ImpactResolver::impact_before(std::span<const ContactSurface> surfaces) const {
    RecordedImpact impact;
    if (!scratch_.record_motions) return impact;
    impact.time = particle_.state.time;
    impact.supported_by = scratch_.supported_by;
    impact.before = {particle_.state.position, particle_.state.velocity, particle_.spin};
    const double rounding = kTurningAway * fastest(surfaces);
    for (const ContactSurface& surface : surfaces) {
        const Material& material = material_of(surface.surface);
        impact.surfaces.push_back({surface.surface,
                                   surface.normal,
                                   velocity_of(surface),
                                   {},
                                   material.restitution,
                                   material.restitution_threshold,
                                   surface.is_support && separation_speed(surface) <= rounding});
    }
    return impact;
}

/// Records the impact with its end. Random reflections and landings without a rebound are left out.
void ImpactResolver::note_impact_after(RecordedImpact impact, std::span<const ContactSurface> surfaces,
                                       Rebound rebound) {
    scratch_.supported_by.clear();
    if (!scratch_.record_motions || rebound == Rebound::none) return;
    const auto is_random = [&](const ContactSurface& surface) { return material_of(surface.surface).is_random(); };
    if (std::any_of(surfaces.begin(), surfaces.end(), is_random)) return;
    impact.after = {particle_.state.position, particle_.state.velocity, particle_.spin};
    for (std::size_t k = 0; k < surfaces.size(); ++k) impact.surfaces[k].velocity_after = velocity_of(surfaces[k]);
    scratch_.impacts.push_back(std::move(impact));
}

}  // namespace ricochet
