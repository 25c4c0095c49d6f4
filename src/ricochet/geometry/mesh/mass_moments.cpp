#include "ricochet/geometry/mesh/mass_moments.h"

#include <cmath>
#include <numbers>

namespace ricochet {
namespace {

/// Returns the moments of a body that is centred at the origin and then transformed by a map. volume: volume after the
/// map. second: second moments before the map, multiplied by the map's determinant.
MassMoments placed(double volume, const SymmetricMatrix& second, const AffineMap& map) {
    const Vec3& center = map.translation;
    return {volume, volume * center, congruent(map, second) + volume * outer_product(center)};
}

}  // namespace

SymmetricMatrix MassMoments::inertia() const {
    const SymmetricMatrix about_center = second + (-volume) * outer_product(center());
    return diagonal_matrix(about_center.trace()) + (-1.0) * about_center;
}

MassMoments moments_of(const TriangleMesh& mesh) {
    if (mesh.vertices.empty()) return {};
    // All tetrahedra have a vertex of the mesh as apex, which reduces cancellation.
    const Vec3 apex = mesh.vertices.front();
    double volume = 0.0;
    Vec3 first;
    SymmetricMatrix second;
    for (const Triangle& triangle : mesh.triangles) {
        const Vec3 a = mesh.vertices[triangle[0]] - apex;
        const Vec3 b = mesh.vertices[triangle[1]] - apex;
        const Vec3 c = mesh.vertices[triangle[2]] - apex;
        const double six = dot(a, cross(b, c));
        const Vec3 sum = a + b + c;
        volume += six / 6.0;
        first += (six / 24.0) * sum;
        second = second + (six / 120.0) * (outer_product(a) + outer_product(b) + outer_product(c) + outer_product(sum));
    }
    // Moves the moments back to the origin: x = apex + y.
    return {volume, first + volume * apex, second + mixed_product(apex, first) + volume * outer_product(apex)};
}

MassMoments moments_of_ball(const AffineMap& world_from_unit) {
    const double volume = 4.0 / 3.0 * std::numbers::pi * std::fabs(world_from_unit.determinant());
    return placed(volume, diagonal_matrix(volume / 5.0), world_from_unit);
}

MassMoments moments_of_cylinder(const AffineMap& world_from_unit) {
    const double volume = 2.0 * std::numbers::pi * std::fabs(world_from_unit.determinant());
    return placed(volume, {volume / 4.0, volume / 4.0, volume / 3.0, 0.0, 0.0, 0.0}, world_from_unit);
}

}  // namespace ricochet
