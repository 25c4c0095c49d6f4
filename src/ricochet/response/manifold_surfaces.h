/// \file
/// Private to the exact response: the surfaces that hold a particle on its way along them, and the seams between them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// The surfaces of the contact manifold and, at a seam or where one of them bends, all others that are touched at its
/// points: the triangles around an edge or a vertex.
class ManifoldSurfaces {
public:
    /// Both must outlive it.
    ManifoldSurfaces(const ParticleStep& step, ContactManifold& manifold) : step_(step), manifold_(manifold) {}

    /// Looks for them where the particle is, for a way that begins there.
    void find();
    /// For paths along them.
    [[nodiscard]] std::span<const SurfaceId> all() const { return surfaces_; }

    /// True where, on the way, another part of a surface is touched, or another surface where this one is.
    [[nodiscard]] bool touches_next_piece(const Vec3& position) const;
    /// True where it overlaps surfaces that are touched beside those of the manifold.
    [[nodiscard]] bool overlaps(const Vec3& position) const;
    /// True where a face of the manifold has ended.
    [[nodiscard]] bool has_left_face(const Vec3& position) const;

    /// A contact at the end of the way. With what continues the surfaces, such as the next triangle of a plane, it is
    /// none, and that holds the particle too from now on; in an impact on something else they take part.
    void meet(std::optional<Contact>& contact);
    /// Adds the surfaces of the manifold to an impact on something else, where they are touched. They and their
    /// continuations are marked as holding the particle.
    void join_impact(Contact& contact) const;
    /// The manifold as it is touched now, of what was touched before; and at a point on the way where another part
    /// began.
    void touch_again(const Vec3& turning_point);

private:
    /// A surface that is touched at a contact point of the manifold.
    struct Beside {
        SurfaceId surface = 0;
        std::size_t point = 0;
    };

    void find_beside();
    [[nodiscard]] bool is_beyond_rim(SurfaceId surface, const Vec3& position) const;
    [[nodiscard]] bool goes_on(const ContactSurface& surface) const;
    [[nodiscard]] bool goes_on_along(const Contact& contact);

    [[nodiscard]] const SurfaceGeometry& geometry() const { return step_.geometry(); }
    [[nodiscard]] const ForceInput& state() const { return step_.state(); }

    const ParticleStep& step_;
    ContactManifold& manifold_;
    std::vector<SurfaceId> surfaces_;
    std::vector<Beside> beside_;
    bool crosses_seam_ = false;  // the next way begins there
    int seams_ = 0;              // at which the step has met the next part of a surface
};

/// Between its ends the path of a point, or of a sphere that is small next to what it touches, can be behind curved
/// surfaces by the cubic's error, where it would be stopped: lifts it, by 3 s (1 - s) of a height over the path's
/// duration, where the error is 16 s^2 (1 - s)^2.
void lift_middle(const SurfaceGeometry& geometry, const ContactManifold& manifold, double radius, Path& path);

}  // namespace ricochet
