#include "ricochet/response/impact_resolver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/two_body_impact.h"

namespace ricochet {
namespace {

/// Boltzmann constant, in J/K (exact by the SI of 2019).
constexpr double kBoltzmann = 1.380649e-23;

}  // namespace

bool can_be_followed(const Path& path) {
    double reach = max_abs(path.c[0]);
    double power = path.duration;
    for (int k = 1; k <= path.degree; ++k, power *= path.duration) {
        const double coefficient = max_abs(path.c[static_cast<std::size_t>(k)]);
        if (!(coefficient <= kLargestPathCoefficient)) return false;
        reach += power * coefficient;
    }
    return reach <= kLargestCoordinate && max_abs(path.c[1]) <= kLargestCoordinate && is_finite(path.end);
}

void ImpactResolver::release(Contact& contact) const {
    const std::span<ContactSurface> surfaces = surfaces_of(contact);
    if (std::ranges::none_of(surfaces, &ContactSurface::is_support)) return;
    const double rounding = kTurningAway * surfaces_.fastest(surfaces);
    for (ContactSurface& surface : surfaces) {
        const double separation = surfaces_.separation_speed(surface);
        const bool comes_back = std::min(-separation, surfaces_.advance_beside_path(surface)) > rounding;
        if (separation > rounding || comes_back) surface.is_support = false;
    }
}

// On a single surface: resolve(), try_single(), apply_bounce(), bounce() of contact_motion.h.
bool ImpactResolver::reflect(std::span<const ContactSurface> surfaces, bool ends_substep) {
    const auto is_met = [&](const ContactSurface& surface) { return surfaces_.is_approached(surface); };
    if (std::ranges::none_of(surfaces, is_met)) return false;
    settle_on_supports(surfaces);
    const Vec3 before = particle_.state.velocity;
    if (scratch_.record_loads) ledger_.begin_impact(ends_substep ? surfaces_.approach(surfaces) : 0.0);
    resolve(surfaces, Rebound::by_material);
    ledger_.end_impact();
    scratch_.supported_by.clear();  // the next impact ends no contact interval
    shatter_by(particle_.state.velocity - before);
    return true;
}

/// Resolves an impact as a bounce off one surface if that does not lead into another surface. Otherwise resolves one
/// impact on all surfaces together. Random reflections and impacts on dynamic bodies are resolved one after another.
void ImpactResolver::resolve(std::span<const ContactSurface> surfaces, Rebound rebound) {
    const auto is_met = [&](const ContactSurface& surface) { return surfaces_.is_approached(surface); };
    const auto first = std::ranges::find_if(surfaces, is_met);
    if (first == surfaces.end()) return;
    const bool is_sequential = std::ranges::any_of(surfaces, [&](const ContactSurface& surface) {
        return surfaces_.material_of(surface.surface).is_random() || surfaces_.is_dynamic(surface.surface);
    });
    if (is_sequential) {
        resolve_sequentially(surfaces, rebound);
    } else if (std::ranges::count_if(surfaces, is_met) > 1 || !try_single(surfaces, *first, rebound)) {
        resolve_simultaneously(surfaces, rebound);
    }
}

/// Resolves a bounce off one surface. Returns false, and changes nothing, if that leads into another surface.
bool ImpactResolver::try_single(std::span<const ContactSurface> surfaces, const ContactSurface& surface,
                                Rebound rebound) {
    const Motion before = particle_.motion();
    RecordedImpact impact = impact_before({&surface, 1});
    apply_bounce(surface, rebound);
    const double rounding = kProjectionRounding * length(before.velocity);
    const bool meets_another = std::ranges::any_of(surfaces, [&](const ContactSurface& other) {
        return surfaces_.separation_speed(other) < (other.is_support ? -rounding : 0.0);
    });
    if (meets_another) {
        particle_.set_motion(before);
        return false;
    }
    ledger_.record_impulse(surface.surface, particle_.state.velocity - before.velocity, true);
    ledger_.log_contact(surface, before.velocity);
    record_impact(std::move(impact), {&surface, 1}, rebound);
    settle_on_supports(surfaces);
    return true;
}

/// Returns the coefficients of an impact on a surface. A landing without a rebound has only friction.
ImpactLaw ImpactResolver::law_of(const ContactSurface& surface, Rebound rebound) const {
    const Material& material = surfaces_.material_of(surface.surface);
    if (rebound == Rebound::none) return {0.0, material.friction, 0.0, 1.0, material.sticking_friction()};
    const double approach = std::max(0.0, -surfaces_.separation_speed(surface));
    return material.at_impact(approach, material.has_impact_law() ? surfaces_.speed_along(surface) : 0.0);
}

/// Applies bounce() relative to the surface's motion, or the rules of random reflection and dynamic bodies.
void ImpactResolver::apply_bounce(const ContactSurface& surface, Rebound rebound) {
    const Material& material = surfaces_.material_of(surface.surface);
    const ImpactLaw law = law_of(surface, rebound);
    if (surfaces_.is_dynamic(surface.surface)) {
        bounce_off_body(surface, law);
        return;
    }
    // The bounce is computed relative to the surface's material.
    const Vec3 carried = surfaces_.velocity_of(surface);
    const bool is_driven = carried != Vec3{};
    Motion motion = particle_.motion();
    if (is_driven) motion.velocity -= carried;
    motion = material.is_random() ? random_reflection(motion, surface, material, law)
                                  : bounce(motion, particle_.state.radius, surface.normal, law);
    if (is_driven && !outcome_.is_absorbed()) motion.velocity += carried;
    particle_.set_motion(motion);
}

/// Absorbs the particle, or reflects it diffusely or as a mirror, by the particle's own random numbers. Source: J. C.
/// Maxwell, "On stresses in rarified gases", Phil. Trans. 170, 1879.
Motion ImpactResolver::random_reflection(Motion motion, const ContactSurface& surface, const Material& material,
                                         const ImpactLaw& law) {
    RandomSequence random(rules_.settings.seed, kImpactStream, particle_.id, particle_.draws);
    if (material.absorption > 0.0 && random.uniform() < material.absorption) {
        outcome_.end = MoveEnd::absorbed;
        motion = {};
    } else if (material.diffuse > 0.0 && random.uniform() < material.diffuse) {
        scratch_.driven = scratch_.driven || material.wall_temperature.has_value();
        motion.velocity =
            material.wall_temperature
                ? thermal_velocity(surface.normal,
                                   std::sqrt(kBoltzmann * *material.wall_temperature / particle_.state.mass), random)
                : length(motion.velocity) * cosine_direction(surface.normal, random);
    } else {
        motion = bounce(motion, particle_.state.radius, surface.normal, law);
    }
    particle_.draws = random.draws();
    return motion;
}

void ImpactResolver::bounce_off_body(const ContactSurface& surface, const ImpactLaw& law) {
    const ForceInput& state = particle_.state;
    const BodyId body = rules_.bodies.body_of(surface.surface);
    const Mobility mobility = rules_.bodies.mobility(body, state.time);
    const DynamicSurface dynamic{surface.normal, law, surfaces_.velocity_of(surface), mobility};
    const Motion after = bounce_off_dynamic({state.velocity, particle_.spin}, state, dynamic);
    const Vec3 impulse = state.mass * (particle_.state.velocity - after.velocity);
    particle_.set_motion(after);
    const Vec3 point = state.position - state.radius * surface.normal;
    surfaces_.note_given(body, {impulse, cross(point - mobility.center, impulse)});
}

/// Removes approach speeds towards supporting surfaces, which are rounding errors. This impulse belongs to no impact.
void ImpactResolver::settle_on_supports(std::span<const ContactSurface> surfaces) {
    ShortestShift change;
    const ContactSurface* support = nullptr;
    for (const ContactSurface& surface : surfaces) {
        const double approach = -surfaces_.separation_speed(surface);
        if (!surface.is_support || !(approach > 0.0)) continue;
        change.add(surface.normal, approach);
        if (support == nullptr) support = &surface;
    }
    if (support == nullptr) return;
    particle_.state.velocity += change.vector();
    ledger_.record_impulse(support->surface, change.vector(), false, Vec3{});
}

void ImpactResolver::shatter_by(const Vec3& velocity_change) {
    if (outcome_.is_absorbed() || particle_.state.mass * length(velocity_change) < particle_.shatter_impulse) return;
    outcome_.end = MoveEnd::shattered;
}

/// Resolves one impact on all surfaces, and the further impacts that result from it.
void ImpactResolver::resolve_simultaneously(std::span<const ContactSurface> surfaces, Rebound rebound) {
    const double rounding = kProjectionRounding * length(particle_.state.velocity);
    const double scale = surfaces_.fastest(surfaces);
    std::array<ImpactSurface, ImpactResult::kMostSurfaces> all;
    std::array<bool, ImpactResult::kMostSurfaces> is_met{};
    Foremost chosen;
    for (int pass = 0; pass < kCornerPasses && surfaces_.approach(surfaces) > rounding; ++pass) {
        const std::span<const ContactSurface> met = foremost(surfaces, chosen);
        RecordedImpact impact = impact_before(met);
        for (std::size_t k = 0; k < met.size(); ++k) {
            all[k] = in_problem(met[k], rebound);
            is_met[k] = pass == 0 && surfaces_.is_approached(met[k]);
        }
        const ImpactResult result =
            solve_impact(particle_.motion(), particle_.state.radius, std::span(all).first(met.size()));
        if (leave_no_way_out(met, result.after.velocity, scale)) {
            move_out_of_corner(surfaces);
            return;
        }
        apply(result, met, is_met, scale, pass);
        record_impact(std::move(impact), met, rebound);
    }
    stop_approach(surfaces);
}

/// Returns the surfaces with the fastest approach, as many as one problem can contain.
std::span<const ContactSurface> ImpactResolver::foremost(std::span<const ContactSurface> surfaces,
                                                         Foremost& chosen) const {
    if (surfaces.size() <= chosen.size()) return surfaces;
    const auto is_before = [&](const ContactSurface& a, const ContactSurface& b) {
        const double separation_a = surfaces_.separation_speed(a);
        const double separation_b = surfaces_.separation_speed(b);
        return separation_a != separation_b ? separation_a < separation_b : a.surface < b.surface;
    };
    std::partial_sort_copy(surfaces.begin(), surfaces.end(), chosen.begin(), chosen.end(), is_before);
    return chosen;
}

ImpactSurface ImpactResolver::in_problem(const ContactSurface& surface, Rebound rebound) const {
    const ImpactLaw law = law_of(surface, rebound);
    return {surface.normal,
            law.restitution,
            law.friction,
            0.0,
            0.0,
            surfaces_.velocity_of(surface),
            {},
            surfaces_.surface_normal_speed(surface),
            surface.is_support,
            law.tangential_restitution,
            law.tangential_factor,
            law.static_friction};
}

/// Returns true if the particle approaches a closing surface at every velocity. Impulses would grow without bound.
bool ImpactResolver::leave_no_way_out(std::span<const ContactSurface> surfaces, const Vec3& velocity,
                                      double speed) const {
    const auto advances = [&](const ContactSurface& surface) { return surfaces_.surface_normal_speed(surface) > 0.0; };
    if (std::ranges::none_of(surfaces, advances)) return false;
    return std::ranges::any_of(surfaces, [&](const ContactSurface& surface) {
        return surfaces_.surface_normal_speed(surface) - dot(velocity, surface.normal) > kImpactResidual * speed;
    });
}

/// Applies and records the result of an impact on several surfaces. scale: speed of the particle and the surfaces, m/s.
void ImpactResolver::apply(const ImpactResult& result, std::span<const ContactSurface> met,
                           std::span<const bool> is_met, double scale, int pass) {
    for (std::size_t k = 0; k < met.size(); ++k) {
        if (result.velocity_change[k] == Vec3{}) continue;
        // If the surface was not approached, an impulse within rounding does not count as a hit.
        const bool is_hit = is_met[k] || length(result.velocity_change[k]) > kCoulombResidual * scale;
        const Vec3 before = particle_.state.velocity;
        particle_.state.velocity += result.velocity_change[k];
        ledger_.record_impulse(met[k].surface, result.velocity_change[k], pass == 0 && is_hit,
                               spin_change_by(result.velocity_change[k], met[k].normal, particle_.state.radius));
        if (pass > 0 && is_hit) ledger_.mark_as_repeated();
        if (is_hit) ledger_.log_contact(met[k], before);
    }
    if (result.slowing != Vec3{}) {
        ledger_.record_impulse(met[result.slowed_by].surface, result.slowing, false, Vec3{});
    }
    particle_.set_motion(result.after);
}

/// Removes the remaining approach speeds, which are rounding errors.
void ImpactResolver::stop_approach(std::span<const ContactSurface> surfaces) {
    for (int pass = 0; pass < kCornerPasses && surfaces_.approach(surfaces) > 0.0; ++pass) {
        for (const ContactSurface& surface : surfaces) {
            const double speed = -surfaces_.separation_speed(surface);
            if (speed > 0.0) particle_.state.velocity += speed * surface.normal;
        }
    }
    if (surfaces_.approach(surfaces) > kProjectionRounding * surfaces_.fastest(surfaces)) move_out_of_corner(surfaces);
}

/// Bounces off every approached surface in turn, until none is approached. Supporting surfaces do not rebound.
void ImpactResolver::resolve_sequentially(std::span<const ContactSurface> surfaces, Rebound rebound) {
    const double rounding = kProjectionRounding * surfaces_.fastest(surfaces);
    for (int pass = 0; pass < kCornerPasses; ++pass) {
        bool is_approached = false;
        for (const ContactSurface& surface : surfaces) {
            if (!(surfaces_.separation_speed(surface) < (surface.is_support ? -rounding : 0.0))) continue;
            is_approached = true;
            const Vec3 before = particle_.state.velocity;
            RecordedImpact impact = impact_before({&surface, 1});
            const Rebound own = surface.is_support ? Rebound::none : rebound;
            apply_bounce(surface, own);
            ledger_.record_impulse(surface.surface, particle_.state.velocity - before, pass == 0);
            if (pass > 0) ledger_.mark_as_repeated();
            ledger_.log_contact(surface, before);
            record_impact(std::move(impact), {&surface, 1}, own);
            if (outcome_.is_absorbed()) return;
        }
        if (!is_approached) return settle_on_supports(surfaces);
    }
    move_out_of_corner(surfaces);
}

void ImpactResolver::move_out_of_corner(std::span<const ContactSurface> surfaces) {
    std::array<Vec3, 3> normals;
    std::size_t count = 0;
    for (const ContactSurface& surface : surfaces) {
        if (count < normals.size()) normals[count++] = surface.normal;
    }
    const ContactSurface& first = surfaces.front();
    const Vec3 before = particle_.state.velocity;
    const Vec3 carried = surfaces_.is_carried(first.surface) ? surfaces_.velocity_of(first) : Vec3{};
    particle_.state.velocity = project_off(before - carried, {normals.data(), count}) + carried;
    ledger_.record_impulse(first.surface, particle_.state.velocity - before, false);
    ledger_.log_contact(first, before);
}

void ImpactResolver::land(std::span<const ContactSurface> surfaces) {
    const Vec3 before = particle_.state.velocity;
    resolve(surfaces, Rebound::none);
    shatter_by(particle_.state.velocity - before);
}

void ImpactResolver::go_with_paths(std::span<const ContactSurface> surfaces) {
    for (const ContactSurface& surface : surfaces) {
        const double approach = surfaces_.approach_of_path(surface);
        if (!(approach > 0.0)) continue;
        const Vec3 change = approach * surface.normal;
        particle_.state.velocity += change;
        ledger_.record_impulse(surface.surface, change, false, Vec3{});
    }
}

/// Returns the record of an impact with the state before it. A surface no longer counts as a support if an earlier part
/// of the impact has separated the particle from it.
RecordedImpact ImpactResolver::impact_before(std::span<const ContactSurface> surfaces) const {
    RecordedImpact impact;
    if (!scratch_.record_motions) return impact;
    impact.time = particle_.state.time;
    impact.supported_by = scratch_.supported_by;
    impact.before = particle_.recorded_motion();
    const double rounding = kTurningAway * surfaces_.fastest(surfaces);
    for (const ContactSurface& surface : surfaces) {
        const Material& material = surfaces_.material_of(surface.surface);
        impact.surfaces.push_back({surface.surface,
                                   surface.normal,
                                   surfaces_.velocity_of(surface),
                                   {},
                                   material.nominal_restitution(std::max(0.0, -surfaces_.separation_speed(surface)),
                                                                surfaces_.speed_along(surface)),
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
    if (std::ranges::any_of(surfaces, is_random)) return;
    impact.after = particle_.recorded_motion();
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        impact.surfaces[k].velocity_after = surfaces_.velocity_of(surfaces[k]);
    }
    scratch_.impacts.push_back(std::move(impact));
}

}  // namespace ricochet
