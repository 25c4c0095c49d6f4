/// \file
/// Closed meshes with dents and holes, for tests of sides.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {

/// Returns a torus about the z axis, wound outward, of `around` x `across` quadrilaterals of two triangles.
inline TriangleMesh torus_mesh(double ring, double tube, std::uint32_t around, std::uint32_t across) {
    constexpr double kTurn = 6.283185307179586;
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < across; ++j) {
            const double u = kTurn * i / around;
            const double v = kTurn * j / across;
            const double r = ring + tube * std::cos(v);
            mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
        }
    }
    const auto vertex = [&](std::uint32_t i, std::uint32_t j) { return (i % around) * across + j % across; };
    for (std::uint32_t i = 0; i < around; ++i) {
        for (std::uint32_t j = 0; j < across; ++j) {
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    return mesh;
}

/// Returns a sphere of radius 1 with smooth bumps and dents.
inline TriangleMesh bumpy_sphere_mesh(int levels) {
    TriangleMesh mesh = sphere_mesh({}, 1.0, levels);
    for (Vec3& p : mesh.vertices) {
        p *= 1.0 + 0.15 * std::sin(5.0 * p.x + 0.3) * std::sin(5.0 * p.y + 0.7) * std::cos(4.0 * p.z);
    }
    return mesh;
}

/// Returns a mesh by name. The name appears in the message of a failing test.
inline TriangleMesh solid(const std::string& name) {
    if (name == "torus") return torus_mesh(0.9, 0.4, 32, 16);
    return name == "bumpy_sphere" ? bumpy_sphere_mesh(3) : sphere_mesh({}, 1.0, 3);
}

inline constexpr std::array kSolids{"sphere", "bumpy_sphere", "torus"};

}  // namespace ricochet::testing
