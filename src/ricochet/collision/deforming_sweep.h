/// \file
/// The first contact of a path in the world with meshes that deform, between two of their keys.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/contact.h"
#include "ricochet/collision/deforming_colliders.h"
#include "ricochet/collision/surfaces_in_other_frames.h"
#include "ricochet/geometry/sweep/moving_separation.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// The simulation times of a path's ends, s.
struct PathTimes {
    double begin = 0.0;
    double end = 0.0;
};

/// One path. What it is given must outlive it.
class DeformingSweep {
public:
    /// held: as ContactQuery::held. beside: m, as far beside the path positions may be asked about.
    DeformingSweep(const DeformingColliders& deforming, const Path& path, const PathTimes& times, double radius,
                   std::span<const SurfaceId> supports, double beside);

    /// The first contact with any of the triangles, in times of the path. Calls near(triangle) for each that comes near
    /// the path, in their order.
    template <class Near>
    [[nodiscard]] std::optional<Contact> first_contact(std::span<const SurfaceId> triangles, const Near& near) const {
        std::vector<Hit> hits;
        for (const SurfaceId surface : triangles) {
            const MovingTriangle triangle = deforming_.between(surface, times_.begin, times_.end);
            if (!comes_near(triangle)) continue;
            near(SurfacesInOtherFrames::Deforming{surface, certified_radius(surface, triangle)});
            if (is_supported(surface)) continue;
            if (const auto hit = meet(surface, triangle)) hits.push_back(*hit);
        }
        return first_of(std::move(hits));
    }

private:
    struct Hit {
        double time = 0.0;  ///< s along the path
        ContactSurface surface;
    };

    [[nodiscard]] bool is_supported(SurfaceId surface) const;
    [[nodiscard]] bool comes_near(const MovingTriangle& triangle) const;
    [[nodiscard]] double certified_radius(SurfaceId surface, const MovingTriangle& triangle) const;
    [[nodiscard]] std::optional<Hit> meet(SurfaceId surface, const MovingTriangle& triangle) const;
    [[nodiscard]] std::optional<Hit> hit_at(SurfaceId surface, const MovingTriangle& triangle,
                                            const Meeting& meeting) const;
    [[nodiscard]] std::optional<Contact> first_of(std::vector<Hit> hits) const;

    const DeformingColliders& deforming_;
    const Path& path_;
    PathTimes times_;
    double radius_;
    double tolerance_;  ///< m, sphere_tolerance() of the path
    std::span<const SurfaceId> supports_;
    Box3 box_;  ///< of the path, with all that may be asked about
};

}  // namespace ricochet
