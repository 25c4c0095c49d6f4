/// \file
/// The contact manifold: the surfaces that a particle touches at one time, and their loads.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_interval.h"
#include "ricochet/response/response.h"

namespace ricochet {

class ImpulseLedger;
class SurfaceKinematics;

/// Returns one minus the cosine of the largest angle between the normals of an edge and of a face that a particle
/// touches at once. offset: contact offset, in m.
[[nodiscard]] inline double seam_turn(double radius, double offset) {
    return radius == 0.0 ? kSameNormal : kSeamTurn + 2.0 * kTouchingOffsets * offset / radius;
}

/// Rule for when a particle touches a surface.
struct TouchRule {
    /// Returns the standard rule: within kTouchingOffsets contact offsets of the surface.
    [[nodiscard]] static TouchRule at(const SurfaceGeometry& geometry, const Vec3& position);

    double above = 0.0;       ///< m, largest distance of the sphere (or the point) from the surface
    double overlap = 0.0;     ///< m, largest overlap of a sphere with the surface
    double beyond_rim = 0.0;  ///< m, largest distance of a point beside a flat surface from its rim
    double separation_speed =
        std::numeric_limits<double>::infinity();  ///< m/s along the normal; a faster particle has left the surface
};

/// The surfaces that a particle has touched last, at most six, in the order of their slots in a ring buffer.
class RecentSurfaces {
public:
    /// Adds a surface, in place of the oldest one if the list is full. Does nothing if the list contains the surface.
    void add(SurfaceId surface) {
        const std::span<const SurfaceId> known = all();
        if (std::ranges::find(known, surface) == known.end()) surfaces_[count_++ % kMost] = surface;
    }
    [[nodiscard]] std::span<const SurfaceId> all() const { return {surfaces_.data(), std::min(count_, kMost)}; }

private:
    static constexpr std::size_t kMost = 6;

    std::array<SurfaceId, kMost> surfaces_{};
    std::size_t count_ = 0;  // number of surfaces ever added
};

/// The contact points of one particle, at most three. More would not restrict the motion of a pressed particle further.
/// An edge with nearly the normal of a touched face is a seam, not a contact point, because seams inside a flat surface
/// must have no effect.
class ContactManifold {
public:
    /// Both arguments must outlive the manifold, which always uses the particle's present position and velocity.
    ContactManifold(const SurfaceGeometry& geometry, const ForceInput& particle)
        : geometry_(geometry), particle_(particle) {}

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    /// Returns contact point k. Requires k < size().
    [[nodiscard]] ContactSurface operator[](std::size_t k) const { return {surfaces_[k], normals_[k], flat_[k]}; }
    [[nodiscard]] std::span<const SurfaceId> surfaces() const { return {surfaces_.data(), count_}; }
    [[nodiscard]] std::span<const Vec3> normals() const { return {normals_.data(), count_}; }
    /// Returns true if one of the surfaces is curved.
    [[nodiscard]] bool is_curved() const {
        return !std::all_of(flat_.begin(), flat_.begin() + count_, [](bool flat) { return flat; });
    }
    /// Returns the contact state for the next step.
    [[nodiscard]] ContactState contact_state() const { return {surfaces_, static_cast<std::uint8_t>(count_), 0.0}; }
    /// Restores the surfaces of the last step, without normals: touch_again() must follow.
    void recall(const ContactState& contact_state);

    /// Adds a contact point, unless the manifold has one with the same normal. A face replaces its seam.
    void add(const ContactSurface& surface);
    void clear();
    void remove(std::size_t k);
    /// Removes the contact points from which the velocity leads away by more than this fraction of the speed.
    void drop_left(double part);
    /// Returns the number of the contact point that has this normal, up to rounding.
    [[nodiscard]] std::optional<std::size_t> point_of(const Vec3& normal) const;
    /// Adds a surface, if the particle touches it.
    void touch(SurfaceId surface, const TouchRule& rule);

    /// Remembers surfaces that the particle collides with. replace() tries them again.
    void remember(std::span<const ContactSurface> surfaces);
    /// Replaces the contact points by the surfaces of an impact, followed by recent surfaces that are still touched.
    void replace(std::span<const ContactSurface> surfaces, const TouchRule& rule);
    /// Does the same. If there are more than three surfaces, prefers a set that leaves no component of `pull` into any
    /// of them. pull: acceleration, in m/s^2.
    void replace(std::span<const ContactSurface> surfaces, const TouchRule& rule, const Vec3& pull);
    /// Replaces the contact points by the given contacts that are still touched, with their present normals.
    void touch_again(const ContactState& contact_state, const TouchRule& rule);
    /// Updates the present contact points.
    void touch_again(const TouchRule& rule) { touch_again(contact_state(), rule); }

    /// Sets the loads to the reactions of the contact points to an acceleration, in m/s^2.
    void load(const Vec3& pull);
    void unload() { loads_ = {}; }
    [[nodiscard]] bool is_loaded() const {
        return std::ranges::any_of(loads_, [](const Vec3& load) { return load != Vec3{}; });
    }
    /// Sets the loads to the reactions of an interval.
    void load(const ContactInterval& interval);
    /// The contact points with their materials.
    struct SupportList {
        std::array<SupportSurface, kMostSupports> surfaces;
        std::size_t count = 0;
        [[nodiscard]] std::span<const SupportSurface> all() const { return {surfaces.data(), count}; }
    };
    [[nodiscard]] SupportList supports(const SurfaceKinematics& surfaces) const;
    /// Returns the limits of friction in a step of this duration, in s. pressure: as FrictionLimits::pressure.
    [[nodiscard]] FrictionLimits grip(double pressure, double step) const;
    /// Records the velocity change, in m/s, by contact in `elapsed` seconds. Each surface after the first receives its
    /// load times `elapsed`. The first one receives the remainder.
    void record_impulse(const Vec3& velocity_change, double elapsed, ImpulseLedger& ledger) const;

private:
    static constexpr std::size_t kMostPoints = kMostSupports;
    static constexpr std::size_t kMostCandidates = 16;  // largest number of contact points, before three are chosen

    void set(std::size_t k, const ContactSurface& surface);
    void add_supports(std::span<const ContactSurface> candidates, const Vec3& pull);
    [[nodiscard]] bool is_same_point(const ContactSurface& known, const ContactSurface& surface) const;
    [[nodiscard]] std::optional<ContactSurface> touched(SurfaceId surface, const TouchRule& rule) const;

    const SurfaceGeometry& geometry_;
    const ForceInput& particle_;
    std::size_t count_ = 0;
    std::array<SurfaceId, kMostPoints> surfaces_{};  // 0 beyond count_
    std::array<Vec3, kMostPoints> normals_;
    std::array<bool, kMostPoints> flat_{};
    std::array<Vec3, kMostPoints> loads_{};  // m/s^2, reactions of the contact points
    RecentSurfaces recent_;
};

/// Returns the velocity, turned into the direction of its projection onto the planes of the given normals. The speed
/// stays the same. Returns std::nullopt if the projection is zero.
[[nodiscard]] std::optional<Vec3> turned_along(const Vec3& velocity, std::span<const Vec3> normals);

}  // namespace ricochet
