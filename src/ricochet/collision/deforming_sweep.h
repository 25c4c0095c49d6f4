/// \file
/// First contact of a path in the world with deforming meshes, between two of their keys.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/contact.h"
#include "ricochet/collision/deforming_colliders.h"
#include "ricochet/collision/surfaces_in_other_frames.h"
#include "ricochet/core/box_tools.h"
#include "ricochet/geometry/sweep/moving_separation.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Sweep of one path. All arguments must outlive the object.
class DeformingSweep {
public:
    /// `supports` and `beside`: see the members of ContactQuery with these names.
    DeformingSweep(const DeformingColliders& deforming, const Path& path, const PathClock& clock, double radius,
                   std::span<const SurfaceId> supports, double beside);

    /// Returns the first contact with any triangle, in s along the path. Calls near(triangle) for each one near it.
    template <class Near>
    [[nodiscard]] std::optional<Contact> first_contact(std::span<const SurfaceId> triangles, const Near& near) const {
        std::vector<Hit> hits;
        for (const SurfaceId surface : triangles) {
            const MovingTriangle triangle = deforming_.mesh_with(surface).between(surface, clock_.begin, clock_.end);
            if (!overlap(box_of(triangle), box_)) continue;
            near(SurfacesInOtherFrames::Deforming{surface, certified_radius(surface, triangle)});
            if (is_supported(surface)) continue;
            if (const auto hit = meet(surface, triangle)) hits.push_back(*hit);
        }
        return first_of(std::move(hits));
    }

private:
    struct Hit {
        double time = 0.0;  ///< in s along the path
        ContactSurface surface;
    };

    [[nodiscard]] bool is_supported(SurfaceId surface) const;
    [[nodiscard]] double certified_radius(SurfaceId surface, const MovingTriangle& triangle) const;
    [[nodiscard]] std::optional<Hit> meet(SurfaceId surface, const MovingTriangle& triangle) const;
    [[nodiscard]] std::optional<Hit> hit_at(SurfaceId surface, const MovingTriangle& triangle,
                                            const PossibleContact& possible_contact) const;
    [[nodiscard]] std::optional<Contact> first_of(std::vector<Hit> hits) const;

    const DeformingColliders& deforming_;
    const Path& path_;
    PathClock clock_;
    double radius_;
    double tolerance_;  ///< sphere_tolerance() of the path, in m
    std::span<const SurfaceId> supports_;
    Box3 box_;  ///< box of the path, grown by the radius and by `beside`
};

}  // namespace ricochet
