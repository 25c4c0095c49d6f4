/// \file Meshes that deform by given functions, for several tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "ricochet/geometry/mesh/mesh_motion.h"
#include "ricochet/simulation.h"

namespace ricochet::testing {

/// Returns evenly spaced times from begin to end, in s.
[[nodiscard]] inline std::vector<double> evenly(double begin, double end, int parts) {
    std::vector<double> times;
    for (int k = 0; k <= parts; ++k) times.push_back(begin + (end - begin) * k / parts);
    return times;
}

using Deform = std::function<Vec3(const Vec3& vertex, double time)>;

/// Returns a mesh whose vertices follow a function. If the motion repeats, the last key has exactly the positions of
/// the first.
[[nodiscard]] inline MeshShape deforming(const TriangleMesh& mesh, const Deform& deform, std::vector<double> times,
                                         MeshEnds ends = MeshEnds::hold) {
    const double first = times.front();
    const double last = times.back();
    const auto positions_at = [&](double time) {
        const double seen = ends == MeshEnds::repeat && time == last ? first : time;
        std::vector<Vec3> positions;
        for (const Vec3& vertex : mesh.vertices) positions.push_back(deform(vertex, seen));
        return positions;
    };
    MeshShape shape{std::make_shared<const TriangleMesh>(mesh), {}, "", {}};
    shape.motion = std::make_shared<const MeshMotion>(sampled_motion(positions_at, std::move(times), ends));
    return shape;
}

/// Returns a sheet z = 0 over the square |x|, |y| <= half.
[[nodiscard]] inline TriangleMesh sheet(double half, int parts) {
    TriangleMesh mesh;
    for (int j = 0; j <= parts; ++j) {
        for (int i = 0; i <= parts; ++i) {
            mesh.vertices.push_back({half * (2.0 * i / parts - 1.0), half * (2.0 * j / parts - 1.0), 0.0});
        }
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (parts + 1) + i); };
    for (int j = 0; j < parts; ++j) {
        for (int i = 0; i < parts; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

/// Returns the position of a vertex at a time, for a shape that grows, shrinks and is sheared.
[[nodiscard]] inline Vec3 breathing(const Vec3& vertex, double time) {
    const double size = 1.0 + 0.25 * std::sin(7.0 * time);
    return size * vertex + 0.05 * std::sin(11.0 * time) * Vec3{vertex.y, vertex.z, vertex.x};
}

/// Returns the position of a vertex at a time, for a sheet with waves in both directions.
[[nodiscard]] inline Vec3 waving(const Vec3& v, double time) {
    return {v.x + 0.05 * std::sin(5.0 * v.y + 4.0 * time), v.y,
            0.2 * std::sin(4.0 * v.x - 9.0 * time) + 0.1 * std::cos(3.0 * v.y + 5.0 * time)};
}

/// Returns the position of a vertex at a time, for a strip that folds about the y axis. The flat strip becomes a narrow
/// valley and opens again.
[[nodiscard]] inline Vec3 folding(const Vec3& v, double time) {
    const double angle = 1.3 * std::pow(std::sin(2.0 * time), 2);
    return {v.x * std::cos(angle), v.y, std::fabs(v.x) * std::sin(angle)};
}

/// Returns the z coordinate of a sheet at (x, y). The sheet must have one height at every such point.
[[nodiscard]] inline double height_of(const TriangleMesh& mesh, double x, double y) {
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.vertices[t[0]];
        const Vec3 u = mesh.vertices[t[1]] - a;
        const Vec3 v = mesh.vertices[t[2]] - a;
        const double area = u.x * v.y - u.y * v.x;
        const double s = ((x - a.x) * v.y - (y - a.y) * v.x) / area;
        const double r = (u.x * (y - a.y) - u.y * (x - a.x)) / area;
        if (s >= -1e-12 && r >= -1e-12 && s + r <= 1.0 + 1e-12) return a.z + s * u.z + r * v.z;
    }
    return std::nan("");
}

/// Expects that the verifier found no violation and that no particle was frozen.
inline void expect_sound(const Simulation& simulation) {
    const SimulationStatistics& statistics = simulation.statistics();
    EXPECT_EQ(statistics.violations, 0U);
    EXPECT_EQ(statistics.energy_violations, 0U);
    EXPECT_EQ(statistics.frozen, 0U);
}

}  // namespace ricochet::testing
