#include "ricochet/collision/safe_position.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Halves [from, to] of the path until its chords are free; stops at the first that is not.
struct Walker {
    const ContactSearch& search;
    const Path& path;
    Travel state;

    Walker(const ContactSearch& search_in, const Path& path_in)
        : search(search_in), path(path_in), state{path_in.c[0], 0.0, std::nullopt} {
        search.chain().assign(1, path.c[0]);
    }

    bool walk_to(double time, const Vec3& target, int depth) {
        const double middle = 0.5 * (state.time + time);
        const bool is_shortest = depth == 0 || middle <= state.time || middle >= time;
        if ((is_shortest || search.covers_chord(path, state.time, time)) && search.is_free(state.reached, target)) {
            state.reached = target;
            state.time = time;
            search.chain().push_back(target);
            return true;
        }
        if (is_shortest) {
            state.blocker = search.blocker(state.reached, target);
            return false;
        }
        return walk_to(middle, path.position(middle), depth - 1) && walk_to(time, target, depth - 1);
    }
};

/// The normals along which a particle is moved off the surfaces it has met; at most three matter in space.
struct Normals {
    std::array<Vec3, 3> n;
    int count = 0;

    bool add(const Vec3& normal) {
        for (int k = 0; k < count; ++k) {
            if (dot(n[static_cast<std::size_t>(k)], normal) > 1.0 - 1e-9) return false;
        }
        if (count == 3) return false;
        n[static_cast<std::size_t>(count++)] = normal;
        return true;
    }
};

/// The shortest displacement that gains one unit of distance from every plane (the minimum-norm solution of n_i . d =
/// 1); the plain sum of the normals where the planes are too sharp or too parallel for that.
Vec3 escape_direction(const Normals& normals) {
    const auto& n = normals.n;
    if (normals.count == 1) return n[0];
    Vec3 sum = n[0] + n[1];
    Vec3 direction = sum / (1.0 + dot(n[0], n[1]));
    if (normals.count == 3) {
        sum += n[2];
        direction = (cross(n[1], n[2]) + cross(n[2], n[0]) + cross(n[0], n[1])) / dot(n[0], cross(n[1], n[2]));
    }
    return kContactOffsetUlps * length(direction) <= kLargestContactOffsetUlps ? direction : sum;
}

/// What moves a place on the path at the contact along the normal until it is exactly `radius` from the surface met
/// first.
Vec3 correction_at(const ContactSearch& search, const Vec3& place, const Contact& contact) {
    const SurfaceId surface = contact.first().surface;
    if (search.radius() == 0.0) {
        return -search.signed_distance_from(surface, place) * search.unit_normal_of(surface, place);
    }
    const double distance = search.nearest(surface, place).distance;
    return (search.radius() - distance) * contact.first().normal;
}

/// The place on the path at the contact, put right. A sphere that overlaps is left as it is, and so is a place next to
/// the origin whose distance from a large triangle has a rounding error beyond all that the path's search has covered.
Vec3 place_of_contact(const ContactSearch& search, const Path& path, const Contact& contact) {
    const Vec3 place = path.position(contact.time);
    const Vec3 correction = correction_at(search, place, contact);
    const bool overlaps =
        search.radius() > 0.0 && dot(correction, contact.first().normal) > search.radius() * kContactMismatch;
    if (overlaps || length(correction) > 0.5 * search.slack()) return place;
    return flush_tiny(place + correction);
}

/// Normal of a blocking surface at p, facing p; zero when p lies in its plane.
ContactSurface facing_surface(const ContactSearch& search, SurfaceId surface, const Vec3& p) {
    const CollisionWorld& world = search.world();
    if (search.radius() > 0.0) {
        const auto nearest = search.nearest(surface, p);
        return {surface, nearest.normal, nearest.flat};
    }
    const int side = world.side_of_surface(surface, p);
    return {surface, static_cast<double>(side) * search.unit_normal_of(surface, p), true};
}

}  // namespace

Travel travel(const ContactSearch& search, const Path& path, double until, const Vec3& target) {
    Walker walker(search, path);
    const int depth = path.degree > 1 ? kCertificateDepth : 0;
    (void)walker.walk_to(until, target, depth);
    return walker.state;
}

SafePosition find_safe_position(const ContactSearch& search, const Path& path, const Contact& contact) {
    const Vec3 on_path = path.position(contact.time);
    const Vec3 place = place_of_contact(search, path, contact);
    Normals normals;
    for (const ContactSurface& surface : contact.all()) normals.add(surface.normal);
    double gap = contact_offset(place);
    const double longest = kLargestContactOffsetUlps / kContactOffsetUlps * gap;
    for (int attempt = 0; attempt < kSafePositionAttempts;) {
        const Vec3 way = gap * escape_direction(normals);
        if (!(length(way) <= longest)) break;
        const Vec3 parked = flush_tiny(place + way);
        if (length(parked - on_path) > search.slack()) break;
        const Travel travelled = travel(search, path, contact.time, parked);
        if (!travelled.blocker) return {parked, false};
        const Vec3 normal = facing_surface(search, *travelled.blocker, travelled.reached).normal;
        if (normal != Vec3{} && normals.add(normal)) continue;
        gap *= kContactOffsetWidening;
        ++attempt;
    }
    Walker walker(search, path);
    (void)walker.walk_to(contact.time, place, kCertificateDepth);
    return {walker.state.reached, walker.state.reached == path.c[0]};
}

std::optional<Vec3> step_off(const ContactSearch& search, const Vec3& p) {
    Normals normals;
    for (const SurfaceId surface : search.surfaces_at(p)) normals.add(search.unit_normal_of(surface, p));
    if (normals.count == 0) return std::nullopt;
    double gap = contact_offset(p);
    for (int attempt = 0; attempt < kSafePositionAttempts; ++attempt, gap *= kContactOffsetWidening) {
        const Vec3 place = flush_tiny(p + gap * escape_direction(normals));
        if (length(place - p) > search.slack()) break;
        if (search.is_free_after(p, place)) return place;
    }
    return std::nullopt;
}

Contact contact_of_blocker(const ContactSearch& search, const Path& path, const Travel& travelled) {
    Contact contact;
    contact.time = travelled.time;
    contact.count = 1;
    contact.surfaces[0] = facing_surface(search, *travelled.blocker, travelled.reached);
    if (contact.surfaces[0].normal == Vec3{}) {
        contact.surfaces[0].normal =
            facing_normal(search.world(), *travelled.blocker, 0, travelled.reached, path.velocity(travelled.time));
    }
    return contact;
}

}  // namespace ricochet
