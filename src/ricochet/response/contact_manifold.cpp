#include "ricochet/response/contact_manifold.h"

#include <cmath>
#include <initializer_list>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/impulse_ledger.h"
#include "ricochet/response/surface_kinematics.h"

namespace ricochet {
TouchRule TouchRule::at(const SurfaceGeometry& geometry, const Vec3& position) {
    const double reach = kTouchingOffsets * geometry.contact_offset(position);
    return {reach, reach, reach};
}

bool ContactManifold::is_same_point(const ContactSurface& known, const ContactSurface& surface) const {
    const double turn = 1.0 - dot(known.normal, surface.normal);
    return !(turn > kSameNormal) || (known.flat != surface.flat &&
                                     turn <= seam_turn(particle_.radius, geometry_.contact_offset(particle_.position)));
}

void ContactManifold::add(const ContactSurface& surface) {
    for (std::size_t k = 0; k < count_; ++k) {
        if (!is_same_point((*this)[k], surface)) continue;
        if (surface.flat && !flat_[k]) set(k, surface);
        return;
    }
    if (count_ < kMostPoints) set(count_++, surface);
}

void ContactManifold::clear() {
    count_ = 0;
    surfaces_ = {};
}

void ContactManifold::recall(const ContactState& contact_state) {
    surfaces_ = contact_state.surfaces;
    count_ = contact_state.count;
}

void ContactManifold::remove(std::size_t k) {
    for (--count_; k < count_; ++k) set(k, (*this)[k + 1]);
    surfaces_[count_] = 0;
}

void ContactManifold::set(std::size_t k, const ContactSurface& surface) {
    surfaces_[k] = surface.surface;
    normals_[k] = surface.normal;
    flat_[k] = surface.flat;
}

void ContactManifold::remember(std::span<const ContactSurface> surfaces) {
    for (const ContactSurface& surface : surfaces) {
        if (geometry_.world().owns(surface.surface)) recent_.add(surface.surface);
    }
}

void ContactManifold::replace(std::span<const ContactSurface> surfaces, const TouchRule& rule) {
    clear();
    for (const ContactSurface& surface : surfaces) add(surface);
    for (const SurfaceId recent : recent_.all()) {
        if (const auto surface = touched(recent, rule)) add(*surface);
    }
}

void ContactManifold::replace(std::span<const ContactSurface> surfaces, const TouchRule& rule, const Vec3& pull) {
    std::array<ContactSurface, kMostCandidates> all;
    std::size_t count = 0;
    const auto consider = [&](const ContactSurface& surface) {
        for (ContactSurface& known : std::span(all).first(count)) {
            if (!is_same_point(known, surface)) continue;
            if (surface.flat && !known.flat) known = surface;
            return;
        }
        if (count < all.size()) all[count++] = surface;
    };
    for (const ContactSurface& surface : surfaces) consider(surface);
    for (const SurfaceId recent : recent_.all()) {
        if (const auto surface = touched(recent, rule)) consider(*surface);
    }
    const std::span<const ContactSurface> candidates = std::span(all).first(count);
    clear();
    if (count > kMostPoints) add_supports(candidates, pull);
    for (const ContactSurface& surface : candidates) add(surface);
}

/// Adds the first of the smallest sets of candidates, at most three, that leave no component of `pull` into any.
void ContactManifold::add_supports(std::span<const ContactSurface> candidates, const Vec3& pull) {
    const double rounding = kProjectionRounding * length(pull);
    std::array<Vec3, kMostPoints> normals;
    const auto is_enough = [&](std::initializer_list<std::size_t> chosen) {
        std::size_t count = 0;
        for (const std::size_t k : chosen) normals[count++] = candidates[k].normal;
        const Vec3 left = project_off(pull, std::span(normals).first(count));
        const bool enough = std::ranges::all_of(
            candidates, [&](const ContactSurface& surface) { return dot(left, surface.normal) >= -rounding; });
        for (const std::size_t k : chosen) {
            if (enough) add(candidates[k]);
        }
        return enough;
    };
    const std::size_t n = candidates.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (is_enough({i})) return;
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            if (is_enough({i, j})) return;
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            for (std::size_t k = j + 1; k < n; ++k) {
                if (is_enough({i, j, k})) return;
            }
        }
    }
}

void ContactManifold::touch_again(const ContactState& contact_state, const TouchRule& rule) {
    clear();
    for (std::size_t k = 0; k < contact_state.count; ++k) {
        recent_.add(contact_state.surfaces[k]);
        if (const auto surface = touched(contact_state.surfaces[k], rule)) add(*surface);
    }
}

void ContactManifold::drop_left(double part) {
    for (std::size_t k = count_; k-- > 0;) {
        if (dot(particle_.velocity, normals_[k]) > part * length(particle_.velocity)) remove(k);
    }
}

std::optional<std::size_t> ContactManifold::point_of(const Vec3& normal) const {
    for (std::size_t k = 0; k < count_; ++k) {
        if (1.0 - dot(normals_[k], normal) <= seam_turn(particle_.radius, geometry_.contact_offset(particle_.position)))
            return k;
    }
    return std::nullopt;
}

void ContactManifold::touch(SurfaceId surface, const TouchRule& rule) {
    if (const auto point = touched(surface, rule)) add(*point);
}

/// Returns the present contact with a surface, or nothing if the particle does not touch it.
std::optional<ContactSurface> ContactManifold::touched(SurfaceId surface, const TouchRule& rule) const {
    const Vec3& p = particle_.position;
    const CollisionWorld& world = geometry_.world();
    const CollisionWorld::Nearest nearest = geometry_.nearest(surface, p);
    const bool is_point = particle_.radius == 0.0;
    const bool is_beside_rim = is_point && nearest.rim;
    const double above = nearest.distance - particle_.radius;
    if (above > (is_beside_rim ? rule.beyond_rim : rule.above) || above < -rule.overlap) return std::nullopt;
    if (dot(particle_.velocity, nearest.normal) > rule.separation_speed) return std::nullopt;
    if (!is_beside_rim) return ContactSurface{surface, nearest.normal, nearest.flat};
    // For a point next to a rim, the direction from the rim consists of rounding errors, so the plane's normal is used.
    const double distance = geometry_.signed_distance_from(surface, p);
    if (rule.beyond_rim > rule.above && std::fabs(distance) > rule.above) return std::nullopt;
    const Vec3 normal = geometry_.unit_normal_of(surface, p);
    return ContactSurface{surface, distance < 0.0 ? -normal : normal, world.is_flat(surface)};
}

void ContactManifold::load(const Vec3& pull) {
    const auto accelerations = normal_accelerations(pull, normals());
    unload();
    for (std::size_t k = 0; k < count_; ++k) loads_[k] = accelerations[k] * normals_[k];
}

void ContactManifold::load(const ContactInterval& interval) { loads_ = interval.reaction; }

ContactManifold::SupportList ContactManifold::supports(const SurfaceKinematics& surfaces) const {
    SupportList supports;
    for (std::size_t k = 0; k < count_; ++k) {
        const Material& material = surfaces.material_of(surfaces_[k]);
        supports.surfaces[supports.count++] = {normals_[k],
                                               material.friction,
                                               material.rolling_friction,
                                               material.spinning_friction,
                                               surfaces.velocity_of((*this)[k]),
                                               surfaces.angular_velocity_of(surfaces_[k]),
                                               material.drives() ? &material.motion : nullptr};
        supports.surfaces[supports.count - 1].static_friction = material.sticking_friction();
    }
    return supports;
}

FrictionLimits ContactManifold::grip(double pressure, double step) const {
    return {pressure, step / kShortestIntervals, kTouchingOffsets * geometry_.contact_offset(particle_.position)};
}

void ContactManifold::record_impulse(const Vec3& velocity_change, double elapsed, ImpulseLedger& ledger) const {
    Vec3 left = velocity_change;
    for (std::size_t k = 1; k < count_; ++k) {
        if (loads_[k] == Vec3{}) continue;
        const Vec3 part = elapsed * loads_[k];
        ledger.record_impulse(surfaces_[k], part, false);
        left -= part;
    }
    ledger.record_impulse(surfaces_[0], left, false);
}

std::optional<Vec3> turned_along(const Vec3& velocity, std::span<const Vec3> normals) {
    const Vec3 along = project_off(velocity, normals);
    const double left = length(along);
    if (left == 0.0) return std::nullopt;
    return (length(velocity) / left) * along;
}

}  // namespace ricochet
