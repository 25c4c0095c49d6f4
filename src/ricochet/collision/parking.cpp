#include "ricochet/collision/parking.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates.h"

namespace ricochet {
namespace {

/// Halves [from, to] of the path until its chords are free; stops at the first that is not.
struct Walker {
    const ContactSearch& search;
    const Path& path;
    Travel state;

    bool walk_to(double time, const Vec3& target, int depth) {
        const double middle = 0.5 * (state.time + time);
        const bool is_shortest = depth == 0 || middle <= state.time || middle >= time;
        if ((is_shortest || search.covers_chord(path, state.time, time)) && search.is_free(state.reached, target)) {
            state.reached = target;
            state.time = time;
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
    return kParkingGapUlps * length(direction) <= kLongestParkingUlps ? direction : sum;
}

/// The contact point, moved onto the plane of the surface that was met.
Vec3 point_on_surface(const CollisionWorld& world, const Path& path, const Contact& contact) {
    Vec3 point = path.position(contact.time);
    const SurfaceId surface = contact.first().surface;
    return flush_tiny(point - world.signed_distance_from(surface, point) * world.unit_normal_of(surface));
}

}  // namespace

Travel travel(const ContactSearch& search, const Path& path, double until, const Vec3& target) {
    Walker walker{search, path, {path.c[0], 0.0, std::nullopt}};
    const int depth = path.degree > 1 ? kCertificateDepth : 0;
    (void)walker.walk_to(until, target, depth);
    return walker.state;
}

Parking park(const ContactSearch& search, const Path& path, const Contact& contact) {
    const CollisionWorld& world = search.world();
    const Vec3 point = point_on_surface(world, path, contact);
    Normals normals;
    for (const ContactSurface& surface : contact.all()) normals.add(surface.normal);
    double gap = parking_gap(point);
    const double longest = kLongestParkingUlps / kParkingGapUlps * gap;
    for (int attempt = 0; attempt < kParkingAttempts;) {
        const Vec3 way = gap * escape_direction(normals);
        if (!(length(way) <= longest)) break;
        const Vec3 place = flush_tiny(point + way);
        const Travel travelled = travel(search, path, contact.time, place);
        if (!travelled.blocker) return {place, false};
        const int side = world.side_of_surface(*travelled.blocker, travelled.reached);
        const bool new_normal =
            side != 0 && normals.add(facing_normal(world, *travelled.blocker, side, path.velocity(contact.time)));
        if (new_normal) continue;
        gap *= kParkingWidening;
        ++attempt;
    }
    Walker walker{search, path, {path.c[0], 0.0, std::nullopt}};
    (void)walker.walk_to(contact.time, point, kCertificateDepth);
    return {walker.state.reached, walker.state.reached == path.c[0]};
}

std::optional<Vec3> step_off(const ContactSearch& search, const Vec3& p) {
    Normals normals;
    for (const SurfaceId surface : search.surfaces_at(p)) normals.add(search.world().unit_normal_of(surface));
    if (normals.count == 0) return std::nullopt;
    double gap = parking_gap(p);
    for (int attempt = 0; attempt < kParkingAttempts; ++attempt, gap *= kParkingWidening) {
        const Vec3 place = flush_tiny(p + gap * escape_direction(normals));
        if (search.is_free_after(p, place)) return place;
    }
    return std::nullopt;
}

Contact contact_of_blocker(const ContactSearch& search, const Path& path, const Travel& travelled) {
    const int side = search.world().side_of_surface(*travelled.blocker, travelled.reached);
    Contact contact;
    contact.time = travelled.time;
    contact.count = 1;
    contact.surfaces[0] = {*travelled.blocker,
                           facing_normal(search.world(), *travelled.blocker, side, path.velocity(travelled.time))};
    return contact;
}

}  // namespace ricochet
