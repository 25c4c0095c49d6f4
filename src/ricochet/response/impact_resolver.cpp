#include "ricochet/response/impact_resolver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/impact_problem.h"
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

bool ImpactResolver::reflect(std::span<const ContactSurface> surfaces, bool is_fast) {
    const auto is_met = [&](const ContactSurface& surface) { return is_approached(surface); };
    if (std::none_of(surfaces.begin(), surfaces.end(), is_met)) return false;
    settle_on_supports(surfaces);
    const Vec3 before = particle_.state.velocity;
    if (scratch_.record_loads) recorder_.begin_impact(is_fast ? approach(surfaces) : 0.0);
    resolve(surfaces, Rebound::by_material);
    recorder_.end_impact();
    scratch_.supported_by.clear();  // the next impact ends no contact interval
    shatter_by(particle_.state.velocity - before);
    return true;
}

void ImpactResolver::release(Contact& contact) const {
    const auto surfaces = std::span(contact.surfaces).first(static_cast<std::size_t>(contact.count));
    const auto is_support = [](const ContactSurface& surface) { return surface.is_support; };
    if (std::none_of(surfaces.begin(), surfaces.end(), is_support)) return;
    const double rounding = kTurningAway * fastest(surfaces);
    for (ContactSurface& surface : surfaces) {
        const double separation = separation_speed(surface);
        const bool comes_back = std::min(-separation, advance_beside_path(surface)) > rounding;
        if (separation > rounding || comes_back) surface.is_support = false;
    }
}

void ImpactResolver::land(std::span<const ContactSurface> surfaces) {
    const Vec3 before = particle_.state.velocity;
    resolve(surfaces, Rebound::none);
    shatter_by(particle_.state.velocity - before);
}

void ImpactResolver::shatter_by(const Vec3& velocity_change) {
    if (outcome_.is_absorbed() || particle_.state.mass * length(velocity_change) < particle_.shatter_impulse) return;
    outcome_.end = MoveEnd::shattered;
}

void ImpactResolver::record_impulse(SurfaceId surface, const Vec3& velocity_change, bool impact,
                                    const std::optional<Vec3>& spin_change) {
    const Vec3 change = reference_.direction_in_world(velocity_change, particle_.state.time);
    recorded_change_ += change;
    scratch_.hits.push_back({surface, -particle_.state.mass * change, impact && are_hits_});
    scratch_.driven = scratch_.driven || material_of(surface).drives() || reference_.is_moving() || is_carried(surface);
    if (!scratch_.record_loads) return;
    const Vec3 particle_center = reference_.in_world({particle_.state.position, {}, {}}, particle_.state.time).position;
    angular_impulse_ += cross(particle_center - moment_center_, change);
    const std::size_t loads = scratch_.loads.size();
    recorder_.add({surface, -particle_.state.mass * change, impact}, spin_change);
    for (ColliderLoad& load : std::span(scratch_.loads).subspan(loads)) load.is_hit = are_hits_;
}

/// Of the point of a body that is touched, and of its material there.
Vec3 ImpactResolver::carried_velocity_of(const ContactSurface& surface, const Vec3& center) const {
    const MovingColliders& bodies = reference_.bodies();
    const double time = particle_.state.time;
    const BodyId body = bodies.body_of(surface.surface);
    const MovingView view(bodies, reference_.body(), {time, time, time, 0.0, 0.0});
    const PathPoint foot = view.point_at(center - particle_.state.radius * surface.normal, 0.0);
    Vec3 velocity = view.velocity_of(body, foot);
    if (bodies.is_dynamic(body))
        velocity += reference_.direction_in_frame(velocity_beside_path(body, foot.world), time);
    if (bodies.is_deforming(body)) {
        // In the axes of the frame; what that itself does there is in the velocity already.
        velocity += reference_.direction_in_frame(
            bodies.deforming().motion_at(surface.surface, foot.world, time).velocity, time);
    }
    const Material& material = material_of(surface.surface);
    if (!material.drives()) return velocity;
    const MovingView seen(bodies, body, view.clock());
    const Vec3 along = material.motion.at(view.local_position(body, foot.world, 0.0),
                                          seen.direction_from(reference_.body(), surface.normal, 0.0));
    return velocity + view.direction_from(body, along, 0.0);
}

Vec3 ImpactResolver::carried_angular_velocity_of(SurfaceId surface) const {
    const MovingColliders& bodies = reference_.bodies();
    const double time = particle_.state.time;
    const BodyId body = bodies.body_of(surface);
    const MovingView view(bodies, reference_.body(), {time, time, time, 0.0, 0.0});
    const Material& material = material_of(surface);
    Vec3 turning = material.drives() ? view.direction_from(body, material.motion.angular_velocity, 0.0) : Vec3{};
    Vec3 of_body = bodies.pose(body, time).angular_velocity - bodies.pose(reference_.body(), time).angular_velocity;
    if (bodies.is_deforming(body)) {
        const Vec3 center = reference_.in_world({particle_.state.position, {}, {}}, time).position;
        of_body += bodies.deforming().motion_at(surface, center, time).turning;
    }
    return turning + reference_.direction_in_frame(of_body, time);
}

ImpactSurface ImpactResolver::landing_on(const ContactSurface& surface) const {
    const Material& material = material_of(surface.surface);
    return {surface.normal,
            0.0,
            material.friction,
            material.rolling_friction,
            material.spinning_friction,
            velocity_of(surface),
            angular_velocity_of(surface.surface),
            surface_normal_speed(surface)};
}

void ImpactResolver::record(const ContactSurface& surface, const Vec3& velocity_before) {
    if (!scratch_.record_contacts || !are_hits_) return;
    scratch_.records.push_back({particle_.state.time, particle_.id, surface.surface, particle_.state.position,
                                surface.normal, velocity_before, particle_.state.velocity, particle_.state.mass,
                                particle_.state.radius, velocity_of(surface)});
}

/// What one bounce does not answer is answered by all surfaces together.
void ImpactResolver::resolve(std::span<const ContactSurface> surfaces, Rebound rebound) {
    const auto is_met = [&](const ContactSurface& surface) { return is_approached(surface); };
    const auto first = std::find_if(surfaces.begin(), surfaces.end(), is_met);
    if (first == surfaces.end()) return;
    // What chance decides, and what yields, is answered one after the other.
    const bool takes_turns = std::any_of(surfaces.begin(), surfaces.end(), [&](const ContactSurface& surface) {
        return material_of(surface.surface).is_random() || is_dynamic(surface.surface);
    });
    if (takes_turns) {
        resolve_sequentially(surfaces, rebound);
    } else if (std::count_if(surfaces.begin(), surfaces.end(), is_met) > 1 ||
               !resolve_single(surfaces, *first, rebound)) {
        resolve_simultaneously(surfaces, rebound);
    }
}

/// Bounces off one surface; false, and nothing done, when another is approached then.
bool ImpactResolver::resolve_single(std::span<const ContactSurface> surfaces, const ContactSurface& surface,
                                    Rebound rebound) {
    const Motion before{particle_.state.velocity, particle_.spin};
    RecordedImpact impact = impact_before({&surface, 1});
    reflect_off(surface, material_of(surface.surface), rebound);
    const double rounding = kProjectionRounding * length(before.velocity);
    const bool goes_on = std::any_of(surfaces.begin(), surfaces.end(), [&](const ContactSurface& other) {
        return separation_speed(other) < (other.is_support ? -rounding : 0.0);
    });
    if (goes_on) {
        particle_.state.velocity = before.velocity;
        particle_.spin = before.spin;
        return false;
    }
    record_impulse(surface.surface, particle_.state.velocity - before.velocity, true);
    record(surface, before.velocity);
    note_impact_after(std::move(impact), {&surface, 1}, rebound);
    settle_on_supports(surfaces);
    return true;
}

/// m/s, of the surfaces and of the particle.
double ImpactResolver::fastest(std::span<const ContactSurface> surfaces) const {
    double speed = length(particle_.state.velocity);
    for (const ContactSurface& surface : surfaces) speed = std::max(speed, length(velocity_of(surface)));
    return speed;
}

/// Surfaces that close on each other leave a particle between them no velocity with which it would approach none of
/// them: impulses would grow without bound.
bool ImpactResolver::close_on_it(std::span<const ContactSurface> surfaces, const Vec3& velocity, double speed) const {
    const auto advances = [&](const ContactSurface& surface) { return surface_normal_speed(surface) > 0.0; };
    if (std::none_of(surfaces.begin(), surfaces.end(), advances)) return false;
    return std::any_of(surfaces.begin(), surfaces.end(), [&](const ContactSurface& surface) {
        return surface_normal_speed(surface) - dot(velocity, surface.normal) > kImpactResidual * speed;
    });
}

/// One impact on all surfaces, and on those that it leads to.
void ImpactResolver::resolve_simultaneously(std::span<const ContactSurface> surfaces, Rebound rebound) {
    const double rounding = kProjectionRounding * length(particle_.state.velocity);
    const double scale = fastest(surfaces);
    std::array<ImpactSurface, ImpactResult::kMostSurfaces> all;
    std::array<bool, ImpactResult::kMostSurfaces> is_met{};
    Foremost kept;
    for (int pass = 0; pass < kCornerPasses && approach(surfaces) > rounding; ++pass) {
        const std::span<const ContactSurface> met = foremost(surfaces, kept);
        RecordedImpact impact = impact_before(met);
        for (std::size_t k = 0; k < met.size(); ++k) {
            all[k] = in_problem(met[k], rebound);
            is_met[k] = pass == 0 && is_approached(met[k]);
        }
        const ImpactResult result = solve_impact({particle_.state.velocity, particle_.spin}, particle_.state.radius,
                                                 std::span(all).first(met.size()));
        if (close_on_it(met, result.after.velocity, scale)) {
            move_out_of_corner(surfaces);
            return;
        }
        for (std::size_t k = 0; k < met.size(); ++k) {
            if (result.velocity_change[k] == Vec3{}) continue;
            // Without an approach, pushes of the size of rounding are no hits.
            const bool is_hit = is_met[k] || length(result.velocity_change[k]) > kCoulombResidual * scale;
            const Vec3 before = particle_.state.velocity;
            particle_.state.velocity += result.velocity_change[k];
            record_impulse(met[k].surface, result.velocity_change[k], pass == 0 && is_hit,
                           spin_change_by(result.velocity_change[k], met[k].normal, particle_.state.radius));
            scratch_.hits.back().again = pass > 0 && is_hit && are_hits_;
            if (is_hit) record(met[k], before);
        }
        particle_.state.velocity = result.after.velocity;
        particle_.spin = result.after.spin;
        note_impact_after(std::move(impact), met, rebound);
    }
    stop_approach(surfaces);
}

ImpactSurface ImpactResolver::in_problem(const ContactSurface& surface, Rebound rebound) const {
    const Material& material = material_of(surface.surface);
    const double speed = std::max(0.0, -separation_speed(surface));
    const double restitution = rebound == Rebound::none ? 0.0 : material.restitution_at(speed);
    return {surface.normal,
            restitution,
            material.friction,
            0.0,
            0.0,
            velocity_of(surface),
            {},
            surface_normal_speed(surface),
            surface.is_support};
}

/// As many of the surfaces as one problem holds: those that are approached fastest, the first ones among equals.
std::span<const ContactSurface> ImpactResolver::foremost(std::span<const ContactSurface> surfaces,
                                                         Foremost& kept) const {
    if (surfaces.size() <= kept.size()) return surfaces;
    const auto is_before = [&](const ContactSurface& a, const ContactSurface& b) {
        const double towards_a = separation_speed(a);
        const double towards_b = separation_speed(b);
        return towards_a != towards_b ? towards_a < towards_b : a.surface < b.surface;
    };
    std::partial_sort_copy(surfaces.begin(), surfaces.end(), kept.begin(), kept.end(), is_before);
    return kept;
}

double ImpactResolver::approach(std::span<const ContactSurface> surfaces) const {
    double largest = 0.0;
    for (const ContactSurface& surface : surfaces) {
        largest = std::max(largest, -separation_speed(surface));
    }
    return largest;
}

/// Takes away the rounding by which surfaces are still approached.
void ImpactResolver::stop_approach(std::span<const ContactSurface> surfaces) {
    for (int pass = 0; pass < kCornerPasses && approach(surfaces) > 0.0; ++pass) {
        for (const ContactSurface& surface : surfaces) {
            const double speed = -separation_speed(surface);
            if (speed > 0.0) particle_.state.velocity += speed * surface.normal;
        }
    }
    if (approach(surfaces) > kProjectionRounding * fastest(surfaces)) move_out_of_corner(surfaces);
}

/// Bounces off every surface of the contact that is approached, until none is: where chance decides what each does.
/// Surfaces that hold the particle take what the others press onto them, without a rebound.
void ImpactResolver::resolve_sequentially(std::span<const ContactSurface> surfaces, Rebound rebound) {
    const double rounding = kProjectionRounding * fastest(surfaces);
    for (int pass = 0; pass < kCornerPasses; ++pass) {
        bool approached = false;
        for (const ContactSurface& surface : surfaces) {
            if (!(separation_speed(surface) < (surface.is_support ? -rounding : 0.0))) continue;
            approached = true;
            const Vec3 before = particle_.state.velocity;
            RecordedImpact impact = impact_before({&surface, 1});
            const Rebound own = surface.is_support ? Rebound::none : rebound;
            reflect_off(surface, material_of(surface.surface), own);
            record_impulse(surface.surface, particle_.state.velocity - before, pass == 0);
            scratch_.hits.back().again = pass > 0 && are_hits_;
            record(surface, before);
            note_impact_after(std::move(impact), {&surface, 1}, own);
            if (outcome_.is_absorbed()) return;
        }
        if (!approached) return settle_on_supports(surfaces);
    }
    move_out_of_corner(surfaces);
}

void ImpactResolver::reflect_off(const ContactSurface& surface, const Material& material, Rebound rebound) {
    const double approach = -separation_speed(surface);
    const double restitution = rebound == Rebound::none ? 0.0 : material.restitution_at(approach);
    if (is_dynamic(surface.surface)) {
        bounce_off_body(surface, material, restitution);
        return;
    }
    // As it is seen from the surface's own material.
    const Vec3 carried = velocity_of(surface);
    const bool is_driven = carried != Vec3{};
    Motion motion{particle_.state.velocity, particle_.spin};
    if (is_driven) motion.velocity -= carried;
    motion = material.is_random()
                 ? random_reflection(motion, surface, material, restitution)
                 : bounce(motion, particle_.state.radius, surface.normal, restitution, material.friction);
    if (is_driven && !outcome_.is_absorbed()) motion.velocity += carried;
    particle_.state.velocity = motion.velocity;
    particle_.spin = motion.spin;
}

void ImpactResolver::bounce_off_body(const ContactSurface& surface, const Material& material, double restitution) {
    const ForceInput& state = particle_.state;
    const Mobility body = reference_.bodies().mobility(reference_.bodies().body_of(surface.surface), state.time);
    const DynamicSurface dynamic{surface.normal, restitution, material.friction, velocity_of(surface), body};
    const Motion after = ricochet::bounce({state.velocity, particle_.spin}, state, dynamic);
    const Vec3 impulse = state.mass * (particle_.state.velocity - after.velocity);
    particle_.state.velocity = after.velocity;
    particle_.spin = after.spin;
    const Vec3 where = state.position - state.radius * surface.normal;
    given_.push_back({reference_.bodies().body_of(surface.surface), {impulse, cross(where - body.center, impulse)}});
}

/// m/s, in the world, of a body's point, by what it has been given and by how it turns beside its path.
Vec3 ImpactResolver::velocity_beside_path(BodyId body, const Vec3& where) const {
    const double time = particle_.state.time;
    const Vec3 turning = reference_.bodies().turning_beside_path(body, time);
    const Mobility mobility = reference_.bodies().mobility(body, time);
    Vec3 velocity;
    if (turning != Vec3{}) velocity = cross(turning, where - mobility.center);
    for (const Given& given : given_) {
        if (given.body == body) velocity += mobility.change_at(where, given.wrench);
    }
    return velocity;
}

double ImpactResolver::advance_beside_path(const ContactSurface& surface) const {
    if (!is_dynamic(surface.surface)) return 0.0;
    const double time = particle_.state.time;
    const Vec3 foot = particle_.state.position - particle_.state.radius * surface.normal;
    const Vec3 where = reference_.in_world({foot, {}, {}}, time).position;
    const Vec3 beside = velocity_beside_path(reference_.bodies().body_of(surface.surface), where);
    return dot(reference_.direction_in_frame(beside, time), surface.normal);
}

/// m/s, towards a surface whose body goes on along its path, whatever it has been given.
double ImpactResolver::approach_of_path(const ContactSurface& surface) const {
    if (!is_dynamic(surface.surface)) return 0.0;
    return -separation_speed(surface) - advance_beside_path(surface);
}

double ImpactResolver::approach_of_paths(std::span<const ContactSurface> surfaces) const {
    double largest = 0.0;
    for (const ContactSurface& surface : surfaces) largest = std::max(largest, approach_of_path(surface));
    return largest;
}

void ImpactResolver::go_with_paths(std::span<const ContactSurface> surfaces) {
    for (const ContactSurface& surface : surfaces) {
        const double approach = approach_of_path(surface);
        if (!(approach > 0.0)) continue;
        const Vec3 change = approach * surface.normal;
        particle_.state.velocity += change;
        record_impulse(surface.surface, change, false, Vec3{});
    }
}

bool ImpactResolver::waits_for(std::span<const ContactSurface> surfaces) const {
    return !given_.empty() && std::any_of(surfaces.begin(), surfaces.end(), [&](const ContactSurface& surface) {
        if (!is_dynamic(surface.surface)) return false;
        const Vec3 where = particle_.state.position - particle_.state.radius * surface.normal;
        const Vec3 given = velocity_beside_path(reference_.bodies().body_of(surface.surface), where);
        const double towards = kStopRounding * (length(particle_.state.velocity) + length(velocity_of(surface)));
        return separation_speed(surface) + dot(given, surface.normal) < towards;
    });
}

/// Absorbs, or reflects by the cosine law or as a mirror, as this particle's own random numbers say (Maxwell's model:
/// J. C. Maxwell, "On stresses in rarified gases", Phil. Trans. 170, 1879).
Motion ImpactResolver::random_reflection(Motion motion, const ContactSurface& surface, const Material& material,
                                         double restitution) {
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
        motion = bounce(motion, particle_.state.radius, surface.normal, restitution, material.friction);
    }
    particle_.draws = random.draws();
    return motion;
}

void ImpactResolver::move_out_of_corner(std::span<const ContactSurface> surfaces) {
    std::array<Vec3, 3> normals;
    std::size_t count = 0;
    for (const ContactSurface& surface : surfaces) {
        if (count < normals.size()) normals[count++] = surface.normal;
    }
    const Vec3 before = particle_.state.velocity;
    const Vec3 carried = is_carried(surfaces.front().surface) ? velocity_of(surfaces.front()) : Vec3{};
    particle_.state.velocity = project_off(before - carried, {normals.data(), count}) + carried;
    record_impulse(surfaces.front().surface, particle_.state.velocity - before, false);
    record(surfaces.front(), before);
}

}  // namespace ricochet
