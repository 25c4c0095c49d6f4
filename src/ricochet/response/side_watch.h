/// \file
/// Private to the responses that test a particle at the end of a step: is it behind a surface, how deep, and which is
/// the shortest path out?
#pragma once

#include <span>
#include <vector>

#include "ricochet/collision/signed_distance.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// A collider near a particle, seen from the side that the particle belongs to.
struct Proximity {
    std::uint32_t collider = 0;
    SurfaceId surface = 0;
    Vec3 point;             ///< the collider's point nearest to the centre
    Vec3 normal;            ///< unit, from there to the particle's own side
    double distance = 0.0;  ///< m from the sphere to the surface; negative: the particle penetrates
    bool behind = false;    ///< the centre itself is on the wrong side
    int side = 0;           ///< the side that the centre is on now; 0 where that has no meaning
};

/// Lists of one thread, kept between particles so that the loop over them allocates nothing.
struct SideScratch {
    std::vector<SurfacePoint> points;
    std::vector<Proximity> seen;
    std::vector<ContactSurface> contacts;
};

/// The sides of a new particle. It has none yet (they are those that it comes from when it reaches a surface), unless
/// it is put exactly on a surface: then it is where the surface's normal points to.
void set_first_sides(const SignedDistance& distance, const Vec3& position, std::span<SideMemory> sides);

/// The sides of a child, from those of its parent: it is behind what the parent was in front of, or still behind, where
/// that lies between the start of the parent's move and the birth.
void settle_child_sides(const SignedDistance& distance, const ChildStart& start, std::span<SideMemory> sides);

/// Keeps the sides of one particle. It is behind a surface when its path there crosses the collider an odd number of
/// times; when an even number (it may have gone through an edge, or right through), when its side is another than where
/// it comes from. Behind it stays until it is seen on its own side again.
class SideWatch {
public:
    SideWatch(const SignedDistance& distance, std::span<SideMemory> sides, double radius, SideScratch& lists)
        : distance_(distance), sides_(sides), radius_(radius), points_(lists.points) {}

    /// Every collider whose distance at a position is below the margin, m, in ascending order. from: where the particle
    /// was when its sides were settled last.
    void find_near(const Vec3& position, const Vec3& from, double margin, std::vector<Proximity>& out);
    /// Queries as far as the particle may get in what comes, m: while it stays within, no query is needed where
    /// nothing is.
    void survey(const Vec3& position, double reach);
    /// Takes over what was found at a position where the particle stays.
    void settle(std::span<const Proximity> seen);
    /// True when the particle was in contact with something when its sides were settled last.
    [[nodiscard]] bool in_contact() const;
    [[nodiscard]] const SideMemory& memory(std::uint32_t collider) const { return sides_[collider]; }

private:
    [[nodiscard]] double deepest() const;
    [[nodiscard]] bool is_behind(const SurfacePoint& point, const Vec3& position, const Vec3& from) const;
    [[nodiscard]] Proximity proximity(const SurfacePoint& point, const Vec3& position, const Vec3& from) const;

    const SignedDistance& distance_;
    std::span<SideMemory> sides_;
    double radius_;
    std::vector<SurfacePoint>& points_;
    Vec3 clear_center_;
    double clear_radius_ = 0.0;  // m around it without any surface
};

}  // namespace ricochet
