/// \file
/// Where a particle is put after an impact: a representable point just before the surface, reached along certified
/// segments of which none intersects any surface. Every segment is checked exactly against the surfaces near the path.
/// A particle is only ever moved along such segments, which makes "nothing leaks" a theorem about the chain of stored
/// positions.
#pragma once

#include <optional>
#include <vector>

#include "ricochet/collision/contact_query.h"

namespace ricochet {

/// How far a path could be followed in certified segments.
struct CertifiedPath {
    WayPoint reached;                  ///< the last certified position
    std::optional<SurfaceId> blocker;  ///< what the next, shortest segment intersects; nothing at the target
};

/// Follows `path` from its start to `target`, its position at time `until`, in certified segments: the chord itself
/// when it is free, otherwise halves of the arc down to kCertificateDepth. chain: replaced by the certified positions
/// in order, the start first.
[[nodiscard]] CertifiedPath follow_path(const NearSurfaces& near, const Path& path, double until, const Vec3& target,
                                        std::vector<WayPoint>& chain);

/// A certified position next to a contact.
struct SafePosition {
    WayPoint reached;
    bool stayed = false;               ///< no certified position nearer than the path's start was found
    std::optional<SurfaceId> blocker;  ///< where the path is blocked before the contact, there: by what
};

/// A position off the surfaces of the contact along their normals by contact_offset(), by more when that fails, and
/// the last certified position on the path when nothing else is free. "Do not move" is always valid. chain: as for
/// follow_path().
[[nodiscard]] SafePosition find_safe_position(const NearSurfaces& near, const Path& path, const Contact& contact,
                                              std::vector<WayPoint>& chain);

/// For a particle that was put exactly on surfaces: a position one contact offset off them, on the side that their
/// normals point to, along a segment that leaves them and intersects no other surface. `near` is that of a path that
/// starts at p. Nothing when p is on no surface or no position was found.
[[nodiscard]] std::optional<Vec3> step_off(const NearSurfaces& near, const Vec3& p);

/// The contact that a certificate has found where the roots found none: the path slips between surfaces by rounding.
[[nodiscard]] Contact contact_with_blocker(const NearSurfaces& near, const Path& path, const CertifiedPath& followed);

}  // namespace ricochet
