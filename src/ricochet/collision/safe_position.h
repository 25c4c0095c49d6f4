/// \file
/// Where a particle stands after an impact: a representable point just before the surface, reached in segments of which
/// none meets any surface. Every segment is checked exactly against the candidates of the search. A particle is only
/// ever moved along such segments, which makes "nothing leaks" a theorem about the chain of stored positions.
#pragma once

#include <optional>

#include "ricochet/collision/contact_search.h"

namespace ricochet {

/// How far a path could be followed in certified segments.
struct Travel {
    Vec3 reached;                      ///< the last certified place
    double time = 0;                   ///< its time along the path, s
    std::optional<SurfaceId> blocker;  ///< what the next, shortest segment meets; nothing when the target was reached
};

/// Follows `path` from its start to `target`, which stands at time `until`, in certified segments: the chord itself
/// when it is free, otherwise halves of the arc down to kCertificateDepth.
[[nodiscard]] Travel travel(const ContactSearch& search, const Path& path, double until, const Vec3& target);

/// A certified place next to a contact.
struct SafePosition {
    Vec3 position;
    bool stayed = false;  ///< no certified place nearer than the path's start was found
};

/// Parks next to the contact: along the normals of the surfaces met by contact_offset(), wider when that fails, and at
/// the last certified place on the path when nothing else is free. "Do not move" is always valid.
[[nodiscard]] SafePosition find_safe_position(const ContactSearch& search, const Path& path, const Contact& contact);

/// For a particle that was put exactly on surfaces: a place one safe_position gap off them, on the side that their
/// normals point to, on a way that leaves them and meets no other surface. `search` has searched a path that starts at
/// p. Nothing when p is on no surface or no place was found.
[[nodiscard]] std::optional<Vec3> step_off(const ContactSearch& search, const Vec3& p);

/// The contact that a certificate found where the roots saw none: the path slips between surfaces by rounding.
[[nodiscard]] Contact contact_of_blocker(const ContactSearch& search, const Path& path, const Travel& travelled);

}  // namespace ricochet
