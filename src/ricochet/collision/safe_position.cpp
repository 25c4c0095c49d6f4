#include "ricochet/collision/safe_position.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Follows a path: halves it until its chords are free, and stops at the first that is not.
class PathFollower {
public:
    PathFollower(const NearSurfaces& near, const Path& path, std::vector<Vec3>& chain)
        : near_(near), path_(path), chain_(chain), followed_{path.c[0], 0.0, std::nullopt} {
        chain_.assign(1, path.c[0]);
    }

    bool follow_to(double time, const Vec3& target, int depth) {
        const double middle = 0.5 * (followed_.time + time);
        const bool is_shortest = depth == 0 || middle <= followed_.time || middle >= time;
        const Vec3& from = followed_.reached;
        if ((is_shortest || near_.covers_chord(path_, followed_.time, time)) && near_.is_free(from, target)) {
            followed_.reached = target;
            followed_.time = time;
            chain_.push_back(target);
            return true;
        }
        if (is_shortest) {
            followed_.blocker = near_.blocker(from, target);
            return false;
        }
        return follow_to(middle, path_.position(middle), depth - 1) && follow_to(time, target, depth - 1);
    }

    [[nodiscard]] const CertifiedPath& followed() const { return followed_; }

private:
    const NearSurfaces& near_;
    const Path& path_;
    std::vector<Vec3>& chain_;
    CertifiedPath followed_;
};

/// The normals along which a particle is moved off the surfaces it has hit; at most three matter in space.
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

/// What moves a position on the path at the contact along the normal until it is exactly `radius` from the first
/// surface.
Vec3 correction_at(const NearSurfaces& near, const Vec3& position, const Contact& contact) {
    const SurfaceId surface = contact.first().surface;
    const SurfaceGeometry& geometry = near.geometry();
    if (near.radius() == 0.0) {
        return -geometry.signed_distance_from(surface, position) * geometry.unit_normal_of(surface, position);
    }
    const double distance = geometry.nearest(surface, position).distance;
    return (near.radius() - distance) * contact.first().normal;
}

/// The position on the path at the contact, corrected. A sphere that overlaps is left as it is, and so is a position
/// next to the origin whose distance from a large triangle has a rounding error beyond all that the query has covered.
Vec3 position_at(const NearSurfaces& near, const Path& path, const Contact& contact) {
    const Vec3 position = path.position(contact.time);
    const Vec3 correction = correction_at(near, position, contact);
    const bool overlaps =
        near.radius() > 0.0 && dot(correction, contact.first().normal) > near.radius() * kContactMismatch;
    if (overlaps || length(correction) > 0.5 * near.slack()) return position;
    return flush_tiny(position + correction);
}

/// Normal of a blocking surface at p, facing p; zero when p lies in its plane.
ContactSurface facing_surface(const NearSurfaces& near, SurfaceId surface, const Vec3& p) {
    if (near.radius() > 0.0) {
        const auto nearest = near.geometry().nearest(surface, p);
        return {surface, nearest.normal, nearest.flat};
    }
    const int side = near.world().side_of_surface(surface, p);
    return {surface, static_cast<double>(side) * near.geometry().unit_normal_of(surface, p),
            near.world().is_flat(surface)};
}

}  // namespace

CertifiedPath follow_path(const NearSurfaces& near, const Path& path, double until, const Vec3& target,
                          std::vector<Vec3>& chain) {
    PathFollower follower(near, path, chain);
    (void)follower.follow_to(until, target, path.degree > 1 ? kCertificateDepth : 0);
    return follower.followed();
}

SafePosition find_safe_position(const NearSurfaces& near, const Path& path, const Contact& contact,
                                std::vector<Vec3>& chain) {
    const Vec3 on_path = path.position(contact.time);
    const Vec3 position = position_at(near, path, contact);
    Normals normals;
    for (const ContactSurface& surface : contact.all()) normals.add(surface.normal);
    double offset = contact_offset(position);
    const double longest = kLargestContactOffsetUlps / kContactOffsetUlps * offset;
    for (int attempt = 0; attempt < kSafePositionAttempts;) {
        const Vec3 step = offset * escape_direction(normals);
        if (!(length(step) <= longest)) break;
        const Vec3 safe = flush_tiny(position + step);
        if (length(safe - on_path) > near.slack()) break;
        const CertifiedPath followed = follow_path(near, path, contact.time, safe, chain);
        if (!followed.blocker) return {safe, false, std::nullopt, contact.time};
        const Vec3 normal = facing_surface(near, *followed.blocker, followed.reached).normal;
        if (normal != Vec3{} && normals.add(normal)) continue;
        offset *= kContactOffsetWidening;
        ++attempt;
    }
    PathFollower follower(near, path, chain);
    (void)follower.follow_to(contact.time, position, kCertificateDepth);
    const CertifiedPath& followed = follower.followed();
    return {followed.reached, followed.reached == path.c[0], followed.blocker, followed.time};
}

std::optional<Vec3> step_off(const NearSurfaces& near, const Vec3& p) {
    Normals normals;
    for (const SurfaceId surface : near.surfaces_at(p)) normals.add(near.geometry().unit_normal_of(surface, p));
    if (normals.count == 0) return std::nullopt;
    double offset = contact_offset(p);
    for (int attempt = 0; attempt < kSafePositionAttempts; ++attempt, offset *= kContactOffsetWidening) {
        const Vec3 position = flush_tiny(p + offset * escape_direction(normals));
        if (length(position - p) > near.slack()) break;
        if (near.is_free_after(p, position)) return position;
    }
    return std::nullopt;
}

Contact contact_with_blocker(const NearSurfaces& near, const Path& path, const CertifiedPath& followed) {
    Contact contact;
    contact.time = followed.time;
    contact.count = 1;
    contact.surfaces[0] = facing_surface(near, *followed.blocker, followed.reached);
    if (contact.surfaces[0].normal == Vec3{}) {
        contact.surfaces[0].normal =
            facing_normal(near.world(), *followed.blocker, 0, followed.reached, path.velocity(followed.time));
    }
    return contact;
}

}  // namespace ricochet
