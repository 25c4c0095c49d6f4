/// \file
/// Symmetric 3 x 3 matrices, for inertia tensors and second moments of mass.
#pragma once

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

struct SymmetricMatrix {
    double xx = 0.0;
    double yy = 0.0;
    double zz = 0.0;
    double xy = 0.0;
    double xz = 0.0;
    double yz = 0.0;

    [[nodiscard]] Vec3 operator*(const Vec3& v) const {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
    }
    [[nodiscard]] double trace() const { return xx + yy + zz; }
    [[nodiscard]] double determinant() const {
        return xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    }
    /// Returns the inverse. The determinant must not be 0.
    [[nodiscard]] SymmetricMatrix inverse() const {
        const double d = 1.0 / determinant();
        return {d * (yy * zz - yz * yz), d * (xx * zz - xz * xz), d * (xx * yy - xy * xy),
                d * (xz * yz - xy * zz), d * (xy * yz - xz * yy), d * (xy * xz - xx * yz)};
    }
    friend SymmetricMatrix operator+(const SymmetricMatrix& a, const SymmetricMatrix& b) {
        return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
    }
    friend SymmetricMatrix operator*(double f, const SymmetricMatrix& a) {
        return {f * a.xx, f * a.yy, f * a.zz, f * a.xy, f * a.xz, f * a.yz};
    }
    friend bool operator==(const SymmetricMatrix&, const SymmetricMatrix&) = default;
};

/// Returns v v^T.
[[nodiscard]] inline SymmetricMatrix outer_product(const Vec3& v) {
    return {v.x * v.x, v.y * v.y, v.z * v.z, v.x * v.y, v.x * v.z, v.y * v.z};
}
/// Returns a b^T + b a^T.
[[nodiscard]] inline SymmetricMatrix mixed_product(const Vec3& a, const Vec3& b) {
    return {2.0 * a.x * b.x,       2.0 * a.y * b.y,       2.0 * a.z * b.z,
            a.x * b.y + a.y * b.x, a.x * b.z + a.z * b.x, a.y * b.z + a.z * b.y};
}
/// Returns f times the unit matrix.
[[nodiscard]] inline SymmetricMatrix diagonal_matrix(double f) { return {f, f, f, 0.0, 0.0, 0.0}; }

/// Returns M A M^T with the linear part M of a map.
[[nodiscard]] inline SymmetricMatrix congruent(const AffineMap& map, const SymmetricMatrix& a) {
    const Vec3 x = a * map.row_x;
    const Vec3 y = a * map.row_y;
    const Vec3 z = a * map.row_z;
    return {dot(map.row_x, x), dot(map.row_y, y), dot(map.row_z, z),
            dot(map.row_x, y), dot(map.row_x, z), dot(map.row_y, z)};
}

}  // namespace ricochet
