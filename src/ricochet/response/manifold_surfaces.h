/// \file
/// The surfaces that support a particle on a path along them, and the seams between them.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// The surfaces of the contact manifold. At a seam, or if one of the surfaces is curved, this includes all others that
/// touch the particle at the same contact points. These are the triangles around an edge or a vertex.
class ManifoldSurfaces {
public:
    /// Both arguments must outlive the object.
    ManifoldSurfaces(const ParticleStep& step, ContactManifold& manifold) : step_(step), manifold_(manifold) {}

    /// Finds the surfaces at the particle's position, for a path that begins there.
    void find();
    /// Returns the surfaces along which a path leads.
    [[nodiscard]] std::span<const SurfaceId> all() const { return surfaces_; }

    /// Returns true if the particle would touch a different part of a surface, or a different surface, than at the
    /// start of the path. position: a position on the path.
    [[nodiscard]] bool touches_next_piece(const Vec3& position) const;
    /// Returns true if the particle overlaps one of the touched surfaces that are not in the manifold.
    [[nodiscard]] bool overlaps(const Vec3& position) const;
    /// Returns true if the particle is beyond the end of one of the manifold's faces.
    [[nodiscard]] bool has_left_face(const Vec3& position) const;

    /// Handles a contact at the end of a path. Removes a contact with a continuation of the surfaces, such as the next
    /// triangle of a plane, which then supports the particle. Otherwise calls join_impact().
    void meet(std::optional<Contact>& contact);
    /// Adds the touched surfaces to an impact on another surface. Marks them and their continuations as supports.
    void join_impact(Contact& contact) const;
    /// Updates the manifold to the surfaces that still touch the particle. Adds faces that touch it at `turning_point`,
    /// the point of the path where another part of a surface begins.
    void touch_again(const Vec3& turning_point);

private:
    /// A surface that touches the particle at a contact point of the manifold.
    struct Beside {
        SurfaceId surface = 0;
        std::size_t point = 0;
    };

    void find_beside();
    [[nodiscard]] bool is_beyond_rim(SurfaceId surface, const Vec3& position) const;
    [[nodiscard]] bool is_continuation(const ContactSurface& surface) const;
    [[nodiscard]] bool continue_along(const Contact& contact);

    [[nodiscard]] const SurfaceGeometry& geometry() const { return step_.geometry(); }
    [[nodiscard]] const ForceInput& state() const { return step_.state(); }

    const ParticleStep& step_;
    ContactManifold& manifold_;
    std::vector<SurfaceId> surfaces_;
    std::vector<Beside> beside_;
    bool crosses_seam_ = false;  // true if the next path begins at a seam
    int seams_ = 0;              // number of seams that the particle has crossed in the step
};

/// Lifts the middle of a path that lies behind curved surfaces, where the particle would be stopped, by the error of
/// the cubic for a point or a small sphere. With s from 0 to 1 along the path, the lift is 4 s (1 - s) times a height.
/// The error is 16 s^2 (1 - s)^2 times a height.
void lift_middle(const SurfaceGeometry& geometry, const ContactManifold& manifold, double radius, Path& path);

}  // namespace ricochet
