/// \file
/// Private to the responses: the contact manifold, the surfaces that a particle touches at one time, and how hard each
/// surface holds it.
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

/// When a particle touches a surface.
struct TouchRule {
    /// Within kTouchingOffsets contact offsets of the surface.
    [[nodiscard]] static TouchRule at(const SurfaceGeometry& geometry, const Vec3& position);

    double above = 0.0;       ///< m, largest distance of the sphere (or the point) from the surface
    double overlap = 0.0;     ///< m, by how much a sphere may overlap the surface
    double beyond_rim = 0.0;  ///< m, largest distance of a point from the rim of a flat surface that it is beside
    double separation_speed =
        std::numeric_limits<double>::infinity();  ///< m/s along the normal, above which it has left
};

/// The surfaces that a particle has touched last, at most six, in the order of their places in a ring.
class RecentSurfaces {
public:
    /// Replaces the oldest one, unless the surface is known.
    void add(SurfaceId surface) {
        const std::span<const SurfaceId> known = all();
        if (std::find(known.begin(), known.end(), surface) == known.end()) surfaces_[count_++ % kMost] = surface;
    }
    [[nodiscard]] std::span<const SurfaceId> all() const { return {surfaces_.data(), std::min(count_, kMost)}; }

private:
    static constexpr std::size_t kMost = 6;

    std::array<SurfaceId, kMost> surfaces_{};
    std::size_t count_ = 0;  // ever added
};

/// The contact points of one particle, at most three: more do not matter to where a pressed particle can go. An edge
/// that lies within reach beside a face is that face's own seam and no contact point of its own: on a flat surface it
/// must not be felt.
class ContactManifold {
public:
    /// Both must outlive it; positions and velocities are the particle's present ones.
    ContactManifold(const SurfaceGeometry& geometry, const ForceInput& particle)
        : geometry_(geometry), particle_(particle) {}

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    /// k < size().
    [[nodiscard]] ContactSurface operator[](std::size_t k) const { return {surfaces_[k], normals_[k], flat_[k]}; }
    [[nodiscard]] std::span<const Vec3> normals() const { return {normals_.data(), count_}; }
    /// True when one of the surfaces does.
    [[nodiscard]] bool is_curved() const {
        return !std::all_of(flat_.begin(), flat_.begin() + count_, [](bool flat) { return flat; });
    }
    /// True when one of the surfaces moves and grips.
    [[nodiscard]] bool is_driven(const SurfaceKinematics& surfaces) const;
    /// True when the velocity of one that does is not the same everywhere.
    [[nodiscard]] bool is_turned(const SurfaceKinematics& surfaces) const;
    /// What the next step begins with.
    [[nodiscard]] ContactState contact_state() const { return {surfaces_, static_cast<std::uint8_t>(count_), 0.0}; }
    /// What the last step has kept, without normals yet: touch_again() has to follow.
    void recall(const ContactState& contact_state);

    /// Adds a contact point, unless one with the same normal, or the face whose seam it is, is there already.
    void add(const ContactSurface& surface);
    void clear();
    void remove(std::size_t k);
    /// Removes the contact points that the velocity leaves by more than this part of it.
    void drop_left(double part);
    /// The number of the contact point that has this normal, but for rounding.
    [[nodiscard]] std::optional<std::size_t> point_of(const Vec3& normal) const;
    /// Adds a surface, if it is touched.
    void touch(SurfaceId surface, const TouchRule& rule);

    /// Keeps surfaces that the particle collides with in mind: replace() tries them again.
    void remember(std::span<const ContactSurface> surfaces);
    /// The surfaces of an impact, then the latest others that are still touched. They replace what was touched before.
    void replace(std::span<const ContactSurface> surfaces, const TouchRule& rule);
    /// The same; of more than three those come first that leave nothing of `pull` into any of them.
    void replace(std::span<const ContactSurface> surfaces, const TouchRule& rule, const Vec3& pull);
    /// Of the surfaces kept those that are still touched, as they are touched now. They replace what was touched
    /// before.
    void touch_again(const ContactState& contact_state, const TouchRule& rule);
    /// The same of what was touched before.
    void touch_again(const TouchRule& rule) { touch_again(contact_state(), rule); }

    /// Distributes over the contact points what a pull, m/s^2, presses onto them.
    void load(const Vec3& pull);
    void unload() { loads_ = {}; }
    [[nodiscard]] bool is_loaded() const {
        return std::any_of(loads_.begin(), loads_.end(), [](const Vec3& load) { return load != Vec3{}; });
    }
    /// The same as an interval says it.
    void load(const ContactInterval& interval);
    /// The contact points with their materials.
    struct SupportList {
        std::array<SupportSurface, kMostSupports> surfaces;
        std::size_t count = 0;
        [[nodiscard]] std::span<const SupportSurface> all() const { return {surfaces.data(), count}; }
    };
    [[nodiscard]] SupportList supports(const SurfaceKinematics& surfaces) const;
    /// How they grip, in a step of this duration, s. pressure: as FrictionLimits::pressure.
    [[nodiscard]] FrictionLimits grip(double pressure, double step) const;
    /// Records what contact has changed the velocity by in `elapsed` seconds: each surface its part by its load, what
    /// is left on the first.
    void record_impulse(const Vec3& velocity_change, double elapsed, ImpulseLedger& ledger) const;

private:
    static constexpr std::size_t kMostPoints = kMostSupports;
    static constexpr std::size_t kMostCandidates = 16;  // of contact points, before three are chosen

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
    std::array<Vec3, kMostPoints> loads_{};  // m/s^2 with which each holds the particle
    RecentSurfaces recent_;
};

/// The velocity turned along planes of the given normals, at the same speed; nothing where none of it is along them.
[[nodiscard]] std::optional<Vec3> turned_along(const Vec3& velocity, std::span<const Vec3> normals);

}  // namespace ricochet
