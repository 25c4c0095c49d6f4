/// \file
/// Results of contact queries: the first contact of a path, and the triangles that come near it next.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/acceleration/triangle_clusters.h"

namespace ricochet {

/// A surface that takes part in an impact.
struct ContactSurface {
    SurfaceId surface = 0;
    Vec3 normal;       ///< unit, facing the side that the path comes from; for spheres from the surface to the centre
    bool flat = true;  ///< true: a plane, cap or face of a triangle; false: an edge, a vertex or a curved surface
    /// True if the particle already slides, rolls or rests on it. The normal speed is then only a rounding error.
    bool is_support = false;
};

/// The first contact of a path: all surfaces that it reaches at once (kSimultaneousUlps), ascending by number.
struct Contact {
    static constexpr int kMostSurfaces = 8;

    double time = 0.0;  ///< time of impact, in s, from the start of the path
    std::array<ContactSurface, kMostSurfaces> surfaces;
    int count = 0;  ///< at least 1; if more than kMostSurfaces are hit, those with the smallest numbers are kept

    [[nodiscard]] std::span<const ContactSurface> all() const {
        return {surfaces.data(), static_cast<std::size_t>(count)};
    }
    [[nodiscard]] const ContactSurface& first() const { return surfaces[0]; }
};

/// Returns the unit normal of a surface that a point at p with velocity v reaches from `side` (+1 or -1). Side 0 means
/// that the point moves exactly in the surface's plane and hits the surface's boundary head-on. The result is then the
/// direction opposite to v. `normal` is the surface's unit normal at p.
[[nodiscard]] Vec3 facing_normal(const Vec3& normal, int side, const Vec3& v);

/// Removes edges and vertices beside a face of the same normal, which are seams of flat surfaces. Changes the order.
template <class Surface>
void drop_seams(std::vector<Surface>& list) {
    const auto faces_end = std::partition(list.begin(), list.end(), [](const Surface& one) { return one.flat; });
    const auto is_seam = [&](const Surface& edge) {
        return std::any_of(list.begin(), faces_end, [&](const Surface& face) {
            return length_squared(face.normal - edge.normal) < 2.0 * kSeamTurn;
        });
    };
    list.erase(std::remove_if(faces_end, list.end(), is_seam), list.end());
}

/// All triangles that come near a path in one later step, if they are known and few. They save a broad phase.
class ContactCandidates {
public:
    static constexpr std::size_t kMost = 4;

    /// Creates a list of unknown candidates.
    constexpr ContactCandidates() { triangles_.fill(kUnknown); }
    /// Returns an empty list: no triangle comes near.
    [[nodiscard]] static constexpr ContactCandidates none() {
        ContactCandidates candidates;
        candidates.triangles_.fill(kNoTriangle);
        return candidates;
    }

    [[nodiscard]] bool is_known() const { return triangles_[0] != kUnknown; }
    /// Returns the triangles. Requires is_known().
    [[nodiscard]] std::span<const std::uint32_t> triangles() const {
        std::size_t count = 0;
        while (count < kMost && triangles_[count] != kNoTriangle) ++count;
        return {triangles_.data(), count};
    }
    /// Adds a triangle. If there are more than kMost, the candidates become unknown. Requires is_known().
    void add(std::uint32_t triangle) {
        const std::size_t count = triangles().size();
        if (count == kMost) {
            *this = ContactCandidates{};
        } else {
            triangles_[count] = triangle;
        }
    }

private:
    static constexpr std::uint32_t kUnknown = kNoTriangle - 1;

    std::array<std::uint32_t, kMost> triangles_;
};

}  // namespace ricochet
