// Records of impacts for the verifier.
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/impact_resolver.h"

namespace ricochet {

/// Returns the record of an impact with the state before it. A surface no longer counts as a support if an earlier part
/// of the impact has separated the particle from it.
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
