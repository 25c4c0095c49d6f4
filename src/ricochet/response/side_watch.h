/// \file
/// Tests of a particle at the end of a step: whether it is behind a surface, how deep, and the shortest path out.
#pragma once

#include <span>
#include <vector>

#include "ricochet/collision/signed_distance.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// A collider near a particle, described relative to the particle's own side.
struct Proximity {
    std::uint32_t collider = 0;
    SurfaceId surface = 0;
    Vec3 point;             ///< the collider's point nearest to the centre
    Vec3 normal;            ///< unit, from that point to the particle's own side
    double distance = 0.0;  ///< m, from the sphere to the surface; negative: the particle penetrates
    bool behind = false;    ///< true: the centre itself is on the wrong side
    int side = 0;           ///< present side of the centre; 0 if it is not defined
};

/// Scratch lists of one thread, kept between particles so that their loop allocates no memory.
struct SideScratch {
    std::vector<SurfacePoint> points;
    std::vector<Proximity> seen;
    std::vector<Proximity> stage;  ///< at a stage of an integrator
    std::vector<ContactSurface> contacts;
};

/// Sets the sides of a new particle to unknown. Its side of a surface becomes known when it first reaches the surface.
/// A particle exactly on a surface gets the side of the surface's normal.
void set_first_sides(const SignedDistance& distance, const Vec3& position, std::span<SideMemory> sides);

/// Sets the sides of a child from its parent's sides. The child is behind a surface if the surface lies between the
/// start of the parent's move and the birth. It is also behind a surface if the parent was behind it.
void settle_child_sides(const SignedDistance& distance, const ChildStart& start, std::span<SideMemory> sides);

/// Keeps the sides of one particle. A particle gets behind a surface if its path crosses the collider an odd number of
/// times. After an even number of crossings, it may have passed through an edge, or through the whole collider. It is
/// then behind if its side differs from the one at the start. It stays behind until it is found on its own side again.
class SideWatch {
public:
    SideWatch(const SignedDistance& distance, std::span<SideMemory> sides, double radius, SideScratch& lists)
        : distance_(distance), sides_(sides), radius_(radius), points_(lists.points) {}

    /// Finds every collider whose distance at a position is below the margin, in m, in ascending order. from: position
    /// of the particle when its sides were settled last.
    void find_near(const Vec3& position, const Vec3& from, double margin, std::vector<Proximity>& out);
    /// Queries all surfaces within a distance, in m, that the particle may cover next. find_near() makes no query while
    /// the particle stays inside the ball without surfaces that this query has found.
    void survey(const Vec3& position, double reach);
    /// Updates the sides from the results of find_near() at the particle's new position.
    void settle(std::span<const Proximity> seen);
    /// Returns true if the particle was in contact when its sides were settled last.
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
    double clear_radius_ = 0.0;  // m, radius without any surface around clear_center_
};

/// Base of the responses that keep sides.
class SidedResponse : public Response {
public:
    explicit SidedResponse(const ResponseRules& rules) : Response(rules), distance_(rules.world) {}

    [[nodiscard]] bool keeps_sides() const override { return true; }
    void first_sides(const Vec3& position, std::span<SideMemory> sides) const override {
        set_first_sides(distance_, position, sides);
    }
    void inherit_sides(const ChildStart& start, std::span<SideMemory> sides) const override {
        settle_child_sides(distance_, start, sides);
    }

protected:
    SignedDistance distance_;  // NOLINT(misc-non-private-member-variables-in-classes)
};

}  // namespace ricochet
