/// \file
/// First contact of a path with the world, and the exact certificate of the legs that are really travelled.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/geometry/path.h"

namespace ricochet {

/// A surface that takes part in an impact.
struct ContactSurface {
    SurfaceId surface = 0;
    Vec3 normal;  ///< unit, facing the side that the path comes from
};

/// The first contact of a path: all surfaces met at the same time (kSimultaneousUlps), the smallest number first.
struct Contact {
    static constexpr int kMostSurfaces = 8;

    double time = 0.0;  ///< s along the path
    std::array<ContactSurface, kMostSurfaces> surfaces;
    int count = 0;  ///< at least 1; of more than kMostSurfaces the smallest numbers are kept

    [[nodiscard]] std::span<const ContactSurface> all() const {
        return {surfaces.data(), static_cast<std::size_t>(count)};
    }
    [[nodiscard]] const ContactSurface& first() const { return surfaces[0]; }
};

/// Unit normal of a surface that a particle comes to from `side` (+1, -1) with velocity v. A particle that runs exactly
/// in the surface's plane (side 0) has met its rim head-on: the normal is then against the motion.
[[nodiscard]] Vec3 facing_normal(const CollisionWorld& world, SurfaceId surface, int side, const Vec3& v);

/// Scratch memory of one thread, kept between queries so that the loop over particles allocates nothing.
struct ContactScratch {
    struct Found {
        double time;
        SurfaceId surface;
        int side;
    };
    std::vector<std::uint32_t> triangles;  ///< candidates whose plane the path does not clear
    std::vector<std::uint32_t> planes;     ///< the same, indices into CollisionWorld::planes()
    std::vector<Found> found;
};

/// Answers for one path at a time: search() gathers the surfaces near the path and finds the first contact; the other
/// questions are then about places on or next to that path, up to that contact.
class ContactSearch {
public:
    ContactSearch(const CollisionWorld& world, ContactScratch& scratch) : world_(world), scratch_(scratch) {}

    /// First contact under the order (time, collider, triangle). `path` must be finite.
    [[nodiscard]] std::optional<Contact> search(const Path& path);

    /// The smallest numbered surface that the closed segment [p, q] meets, decided exactly. p and q lie on the searched
    /// path, or within the parking distance of it.
    [[nodiscard]] std::optional<SurfaceId> blocker(const Vec3& p, const Vec3& q) const;
    [[nodiscard]] bool is_free(const Vec3& p, const Vec3& q) const;
    /// The same for a segment that starts on surfaces: true when it leaves all of them and meets no other.
    [[nodiscard]] bool is_free_after(const Vec3& p, const Vec3& q) const;
    /// All gathered surfaces on which the point lies exactly.
    [[nodiscard]] std::vector<SurfaceId> surfaces_at(const Vec3& p) const;

    /// True when the surfaces gathered include all that the path's chord from time `from` to `to` may meet. Longer
    /// chords of a curved path may pass through places that the search has not looked at.
    [[nodiscard]] bool covers_chord(const Path& path, double from, double to) const;

    [[nodiscard]] const CollisionWorld& world() const { return world_; }

private:
    void search_planes(const Path& path);
    void search_triangles(const Path& path, double from, double to, int depth);
    void search_all_triangles(const Path& path);
    [[nodiscard]] bool may_reach_triangles(const Path& path, double from, double to) const;
    [[nodiscard]] std::vector<SurfaceId> gathered() const;
    double look_at_triangle(const Path& path, std::uint32_t triangle);
    [[nodiscard]] Contact first_of_found(const Path& path) const;

    const CollisionWorld& world_;
    ContactScratch& scratch_;
    double slack_ = 0.0;
    double first_time_ = 0.0;
    bool all_triangles_ = false;  // every triangle is a candidate
};

}  // namespace ricochet
