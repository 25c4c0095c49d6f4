#include "ricochet/collision/safe_position.h"

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Certifies a path by chords: halves it until they are free, or until a blocked one cannot be halved further.
class PathCertifier {
public:
    PathCertifier(const NearSurfaces& near, const Path& path, const PathPoint& start, std::vector<PathPoint>& chain)
        : near_(near), path_(path), chain_(chain), certified_{start, std::nullopt} {
        chain_.assign(1, start);
    }

    bool certify_to(const PathPoint& target, int depth) {
        const PathPoint& from = certified_.reached;
        const double time = target.time;
        const double middle = 0.5 * (from.time + time);
        const bool is_shortest = depth == 0 || middle <= from.time || middle >= time;
        if ((is_shortest || near_.covers_chord(path_, from.time, time)) && near_.is_segment_free(from, target)) {
            certified_.reached = target;
            chain_.push_back(target);
            return true;
        }
        if (is_shortest) {
            certified_.blocker = near_.segment_blocker(from, target);
            return false;
        }
        return certify_to(near_.point_at(path_.position(middle), middle), depth - 1) && certify_to(target, depth - 1);
    }

    [[nodiscard]] const CertifiedPath& certified() const { return certified_; }

private:
    const NearSurfaces& near_;
    const Path& path_;
    std::vector<PathPoint>& chain_;
    CertifiedPath certified_;
};

/// The normals along which a particle is moved off the surfaces that it has hit. At most three are used.
struct Normals {
    std::array<Vec3, 3> n;
    int count = 0;

    bool add(const Vec3& normal) {
        for (int k = 0; k < count; ++k) {
            if (dot(n[static_cast<std::size_t>(k)], normal) > 1.0 - kSameSafeNormal) return false;
        }
        if (count == 3) return false;
        n[static_cast<std::size_t>(count++)] = normal;
        return true;
    }
};

/// Returns the shortest displacement that increases the distance from every plane by one unit (the minimum-norm
/// solution of n_i . d = 1). Returns the sum of the normals if this displacement would be too long.
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

/// Returns the displacement along the normal that moves the position at the contact to `radius` from the first surface.
Vec3 correction_at(const NearSurfaces& near, const PathPoint& at, const Contact& contact) {
    const SurfaceId surface = contact.first().surface;
    if (near.radius() == 0.0) return -near.signed_distance_from(surface, at) * near.unit_normal_of(surface, at);
    return (near.radius() - near.nearest(surface, at).distance) * contact.first().normal;
}

/// Returns the position on the path at the contact, moved by correction_at(). The position is not moved if a sphere
/// overlaps the surface, or if the correction exceeds half the slack of the query. The latter occurs near the origin,
/// where the distance from a large triangle has a large rounding error.
Vec3 position_at(const NearSurfaces& near, const PathPoint& on_path, const Contact& contact) {
    const Vec3& position = on_path.position;
    const Vec3 correction = correction_at(near, on_path, contact);
    const bool overlaps =
        near.radius() > 0.0 && dot(correction, contact.first().normal) > near.radius() * kContactMismatch;
    if (overlaps || length(correction) > 0.5 * near.slack()) return position;
    return flush_tiny(position + correction);
}

}  // namespace

CertifiedPath certify_path(const NearSurfaces& near, const Path& path, double until, const Vec3& target,
                           std::vector<PathPoint>& chain) {
    // Most paths are free as a whole.
    if (near.other_frames() == nullptr && (path.degree == 1 || near.covers_chord(path, 0.0, until)) &&
        near.is_free(path.c[0], target)) {
        chain.resize(2);
        chain[0] = {path.c[0], 0.0, path.c[0]};
        chain[1] = {target, until, target};
        return {chain[1], std::nullopt};
    }
    PathCertifier certifier(near, path, near.start(), chain);
    (void)certifier.certify_to(near.point_at(target, until),
                               path.degree > 1 || near.other_frames() ? kCertificateDepth : 0);
    return certifier.certified();
}

SafePosition find_safe_position(const NearSurfaces& near, const Path& path, const Contact& contact,
                                std::vector<PathPoint>& chain) {
    const PathPoint on_path = near.point_at(path.position(contact.time), contact.time);
    const Vec3 position = position_at(near, on_path, contact);
    Normals normals;
    for (const ContactSurface& surface : contact.all()) normals.add(surface.normal);
    double offset = near.offset_at({position, contact.time, on_path.world});
    const double longest = kLargestContactOffsetUlps / kContactOffsetUlps * offset;
    for (int attempt = 0; attempt < kSafePositionAttempts;) {
        const Vec3 step = offset * escape_direction(normals);
        if (!(length(step) <= longest)) break;
        const Vec3 safe = flush_tiny(position + step);
        if (length(safe - on_path.position) > near.slack()) break;
        const CertifiedPath followed = certify_path(near, path, contact.time, safe, chain);
        const std::optional<SurfaceId> obstacle =
            followed.blocker ? followed.blocker : near.overlap_deepened_by(on_path, followed.reached);
        if (!obstacle) return {followed.reached, false, std::nullopt};
        const Vec3 normal = near.facing_surface(*obstacle, followed.reached).normal;
        if (normal != Vec3{} && normals.add(normal)) continue;
        offset *= kContactOffsetWidening;
        ++attempt;
    }
    PathCertifier certifier(near, path, near.start(), chain);
    const PathPoint corrected = near.point_at(position, contact.time);
    (void)certifier.certify_to(near.overlap_deepened_by(on_path, corrected) ? on_path : corrected, kCertificateDepth);
    const CertifiedPath& followed = certifier.certified();
    return {followed.reached, followed.reached.position == path.c[0], followed.blocker};
}

std::optional<Vec3> step_off(const NearSurfaces& near, const Vec3& p) {
    Normals normals;
    for (const SurfaceId surface : near.surfaces_at(p)) normals.add(near.geometry().unit_normal_of(surface, p));
    if (normals.count == 0) return std::nullopt;
    double offset = near.offset_at(near.start());
    for (int attempt = 0; attempt < kSafePositionAttempts; ++attempt, offset *= kContactOffsetWidening) {
        const Vec3 position = flush_tiny(p + offset * escape_direction(normals));
        if (length(position - p) > near.slack()) break;
        if (near.is_free_after(p, position)) return position;
    }
    return std::nullopt;
}

Contact contact_with_blocker(const NearSurfaces& near, const Path& path, const CertifiedPath& followed) {
    Contact contact;
    contact.time = followed.reached.time;
    contact.count = 1;
    contact.surfaces[0] = near.facing_surface(*followed.blocker, followed.reached);
    if (contact.surfaces[0].normal == Vec3{}) {
        const PathPoint& reached = followed.reached;
        contact.surfaces[0].normal =
            facing_normal(near.unit_normal_of(*followed.blocker, reached), 0, path.velocity(reached.time));
    }
    return contact;
}

}  // namespace ricochet
