// Records of impacts for the verifier, and the part that supporting surfaces take in an impact.
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/impact_resolver.h"

namespace ricochet {

/// Removes the rounding by which supporting surfaces are approached. This impulse belongs to no impact.
void ImpactResolver::settle_on_supports(std::span<const ContactSurface> surfaces) {
    std::array<Vec3, Contact::kMostSurfaces> normals;
    std::array<double, Contact::kMostSurfaces> missing{};
    std::size_t count = 0;
    const ContactSurface* support = nullptr;
    for (const ContactSurface& surface : surfaces) {
        const double approach = -surfaces_.separation_speed(surface);
        if (!surface.is_support || !(approach > 0.0) || count == normals.size()) continue;
        normals[count] = surface.normal;
        missing[count++] = approach;
        if (support == nullptr) support = &surface;
    }
    if (support == nullptr) return;
    const Vec3 change = shift_by(std::span(normals).first(count), std::span(missing).first(count));
    particle_.state.velocity += change;
    ledger_.record_impulse(support->surface, change, false, Vec3{});
}

/// Returns the record of an impact as it begins. A surface from which an earlier part of the impact has led the
/// particle away supports it no longer.
RecordedImpact ImpactResolver::impact_before(std::span<const ContactSurface> surfaces) const {
    RecordedImpact impact;
    if (!scratch_.record_motions) return impact;
    impact.time = particle_.state.time;
    impact.supported_by = scratch_.supported_by;
    impact.before = {particle_.state.position, particle_.state.velocity, particle_.spin};
    const double rounding = kTurningAway * surfaces_.fastest(surfaces);
    for (const ContactSurface& surface : surfaces) {
        const Material& material = surfaces_.material_of(surface.surface);
        impact.surfaces.push_back({surface.surface,
                                   surface.normal,
                                   surfaces_.velocity_of(surface),
                                   {},
                                   material.restitution,
                                   material.restitution_threshold,
                                   surface.is_support && surfaces_.separation_speed(surface) <= rounding});
    }
    return impact;
}

/// Completes the record of an impact. Random reflections and landings without a rebound are not recorded.
void ImpactResolver::record_impact(RecordedImpact impact, std::span<const ContactSurface> surfaces, Rebound rebound) {
    scratch_.supported_by.clear();
    if (!scratch_.record_motions || rebound == Rebound::none) return;
    const auto is_random = [&](const ContactSurface& surface) {
        return surfaces_.material_of(surface.surface).is_random();
    };
    if (std::any_of(surfaces.begin(), surfaces.end(), is_random)) return;
    impact.after = {particle_.state.position, particle_.state.velocity, particle_.spin};
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        impact.surfaces[k].velocity_after = surfaces_.velocity_of(surfaces[k]);
    }
    scratch_.impacts.push_back(std::move(impact));
}

}  // namespace ricochet
