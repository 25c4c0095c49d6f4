/// \file
/// The surfaces of several frames, and of deforming meshes, that touch a particle at one time.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// A surface that touches the particle, in world coordinates.
struct SharedSurface {
    ContactSurface surface;
    BodyId body = kWorldBody;
    Vec3 velocity;  ///< m/s, of the surface and its material at the contact
    Vec3 turning;   ///< rad/s, angular velocity of the body
    /// Other surfaces at the same contact: DeformedContact::all, or triangles with the same rim.
    std::vector<SurfaceId> others;
};

/// The surfaces that touch a particle, at most kMostSupports. The particle's state must be in world coordinates.
class SharedSurfaces {
public:
    /// The step must outlive the object.
    explicit SharedSurfaces(const ParticleStep& step) : step_(step) {}

    /// Finds the surfaces that touch the particle and from which it does not separate.
    void gather();
    /// Keeps the surfaces for whose index keep(k) is true.
    template <class Keep>
    void keep_if(const Keep& keep) {
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            if (keep(k)) surfaces_[kept++] = surfaces_[k];
        }
        count_ = kept;
    }

    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] const SharedSurface& operator[](std::size_t k) const { return surfaces_[k]; }
    [[nodiscard]] std::span<const SharedSurface> all() const { return {surfaces_.data(), count_}; }
    [[nodiscard]] bool deforms(const SharedSurface& touched) const { return bodies().is_deforming(touched.body); }
    [[nodiscard]] bool is_any_deforming() const;
    /// Returns the speed, in m/s, at which the particle separates from a surface along its normal.
    [[nodiscard]] double separation_speed(const SharedSurface& touched) const {
        return dot(step_.state().velocity - touched.velocity, touched.surface.normal);
    }
    /// Returns the contact state for the next step.
    [[nodiscard]] ContactState contact_state() const;

    /// Returns the surface as a constraint in a frame that moves with the velocity `shift`, in m/s. The second
    /// derivative of the gap to a rigid surface is n . (a - a_s) + 2 (omega x n) . (v - w), plus a curvature term. w
    /// and a_s are the velocity and the acceleration of the surface point at the contact.
    [[nodiscard]] SupportSurface constraint(const SharedSurface& touched, const Vec3& shift) const;

    /// Position of a particle's centre relative to a surface.
    struct Height {
        Vec3 normal;
        double above = 0.0;   ///< m, height of the centre
        double offset = 0.0;  ///< m, twice the contact offset there
    };
    [[nodiscard]] Height height_above(const SharedSurface& touched, const Vec3& position, double time) const;

    /// Returns a time, in s, in which no surface rotates much, and no curved surface's normal turns much.
    [[nodiscard]] double longest_interval() const;
    /// Returns the time, in s, of the next velocity jump of a touched body within the step, if there is one.
    [[nodiscard]] std::optional<double> next_jump() const;
    /// Returns the surfaces along which a path leads, in ascending order. At a rim, other triangles with the same rim
    /// are included if the sphere does not overlap them at the end of the path.
    [[nodiscard]] std::vector<SurfaceId> supporting(const Path& path) const;
    /// Adds the surfaces, marked as supports, to an impact on another surface.
    void join_impact(Contact& contact) const;

    [[nodiscard]] const DeformingColliders& deforming() const { return bodies().deforming(); }

private:
    void gather_in(BodyId body);
    void gather_deforming();
    [[nodiscard]] bool continues_one(const ContactSurface& surface) const;
    SharedSurface& add(const ContactSurface& surface);
    [[nodiscard]] SurfacesInTime surfaces_at(double time) const { return {bodies(), kWorldBody, time}; }
    [[nodiscard]] const MovingColliders& bodies() const { return step_.rules().bodies; }
    [[nodiscard]] const SurfaceKinematics& kinematics() const { return step_.impact().surfaces(); }

    const ParticleStep& step_;
    std::array<SharedSurface, kMostSupports> surfaces_;
    std::size_t count_ = 0;
};

}  // namespace ricochet
