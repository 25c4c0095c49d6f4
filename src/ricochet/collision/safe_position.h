/// \file
/// Safe position of a particle after an impact: a representable point just before the surface, reached along certified
/// segments. Each segment is proven exactly to intersect no surface near the path. Particles move only along such
/// segments, so no particle passes through a surface.
#pragma once

#include <optional>
#include <vector>

#include "ricochet/collision/contact_query.h"

namespace ricochet {

/// Result of following a path in certified segments.
struct CertifiedPath {
    PathPoint reached;  ///< the last certified position
    std::optional<SurfaceId>
        blocker;  ///< surface that blocks the shortest segment after `reached`; empty if the target was reached
};

/// Follows `path` from its start to `target`, its position at time `until`, in certified segments: the chord if it is
/// free, otherwise halves down to kCertificateDepth. Sets `chain` to the certified positions, the start first.
[[nodiscard]] CertifiedPath certify_path(const NearSurfaces& near, const Path& path, double until, const Vec3& target,
                                         std::vector<PathPoint>& chain);

/// A certified position next to a contact.
struct SafePosition {
    PathPoint reached;
    bool stayed = false;  ///< true: no certified position nearer to the surface than the path's start was found
    std::optional<SurfaceId> blocker;  ///< surface that blocks the path at `reached`, if `reached` is before the
                                       ///< contact
};

/// Returns a certified position near the contact. It is moved off the surfaces of the contact along their normals, by
/// contact_offset(), or by more if that fails. If no such position is free, it is the last certified position on the
/// path. The start of the path is always valid. `chain`: as for certify_path().
[[nodiscard]] SafePosition find_safe_position(const NearSurfaces& near, const Path& path, const Contact& contact,
                                              std::vector<PathPoint>& chain);

/// Returns a position for a particle that was put exactly on surfaces: at least one contact offset away from them,
/// along their normals. The segment to it intersects no other surface. `near`: of a query for a path that starts at p.
/// Returns nothing if p is on no surface or no position was found.
[[nodiscard]] std::optional<Vec3> step_off(const NearSurfaces& near, const Vec3& p);

/// Returns the contact with the surface that blocks a certificate, for which rounding hid the root of the path.
[[nodiscard]] Contact contact_with_blocker(const NearSurfaces& near, const Path& path, const CertifiedPath& followed);

}  // namespace ricochet
