/// \file
/// Private to the exact response: the surfaces that hold a particle on a path along them, and the seams between them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// The surfaces of the contact manifold. At a seam, or if one of them is curved, also all others that touch the
/// particle at the same contact points: the triangles around an edge or a vertex.
class ManifoldSurfaces {
public:
    /// Both must outlive it.
    ManifoldSurfaces(const ParticleStep& step, ContactManifold& manifold) : step_(step), manifold_(manifold) {}

    /// Finds the surfaces at the particle's position, for a path that begins there.
    void find();
    /// Returns the surfaces along which a path leads.
    [[nodiscard]] std::span<const SurfaceId> all() const { return surfaces_; }

    /// Returns true if the particle, at a position on the path, touches another part of a surface than at the start.
    /// Also true for another surface in its place.
    [[nodiscard]] bool touches_next_piece(const Vec3& position) const;
    /// Returns true if the particle overlaps one of the touched surfaces that are not in the manifold.
    [[nodiscard]] bool overlaps(const Vec3& position) const;
    /// Returns true if the particle is beyond the end of one of the manifold's faces.
    [[nodiscard]] bool has_left_face(const Vec3& position) const;

    /// Handles a contact at the end of a path. A contact with a continuation of the surfaces, such as the next triangle
    /// of a plane, is removed. The continuation then holds the particle, too. In an impact on any other surface, the
    /// manifold's surfaces take part.
    void meet(std::optional<Contact>& contact);
    /// Adds the manifold's touched surfaces to an impact on another surface. These and their continuations are marked
    /// as supports.
    void join_impact(Contact& contact) const;
    /// Updates the manifold to the surfaces that still touch the particle. Adds those at a turning point of the path,
    /// where another part of a surface begins.
    void touch_again(const Vec3& turning_point);

private:
    /// A surface that touches the particle at a contact point of the manifold.
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
    bool crosses_seam_ = false;  // the next path begins at a seam
    int seams_ = 0;              // parts of surfaces that the step has reached over a seam
};

/// Lifts the middle of a path that lies behind curved surfaces, where the particle would be stopped. By the cubic's
/// error, this happens to the path of a point, or of a sphere that is small next to the surface. Over the path's
/// duration, the lift is 4 s (1 - s) of a height, and the error 16 s^2 (1 - s)^2.
void lift_middle(const SurfaceGeometry& geometry, const ContactManifold& manifold, double radius, Path& path);

}  // namespace ricochet
