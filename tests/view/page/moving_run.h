/// \file
/// Run folders made by hand, in the layout that runs write.
#pragma once

#include <cmath>
#include <functional>
#include <string>

#include "ricochet/core/transform.h"
#include "ricochet/io/vtk.h"
#include "run/run_folder.h"
#include "support/temporary_folder.h"

namespace ricochet::test {

/// Returns a box from lower to upper, with outward normals.
inline TriangleMesh box_mesh(const Vec3& lower, const Vec3& upper) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.vertices.push_back(
            {(i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y, (i & 4) != 0 ? upper.z : lower.z});
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// Returns a rotation about z by an angle, followed by a translation.
inline AffineMap turned(double angle, const Vec3& shift) {
    AffineMap map;
    map.row_x = {std::cos(angle), -std::sin(angle), 0};
    map.row_y = {std::sin(angle), std::cos(angle), 0};
    map.translation = shift;
    return map;
}

/// A run folder with frames of particles and, for add_moving(), moving colliders.
class MadeRun {
public:
    using Points = std::function<std::vector<Vec3>(const std::vector<Vec3>& points, int frame)>;

    /// Adds a moving collider from its mesh and a function for its vertices in a frame.
    void add_moving(const std::string& name, TriangleMesh mesh, Points where) {
        const auto number = static_cast<std::uint32_t>(colliders_.size());
        write_collider(name, mesh, true);
        moving_.push_back({number, std::move(mesh), std::move(where)});
    }
    void add_still(const std::string& name, const TriangleMesh& mesh) { write_collider(name, mesh, false); }
    /// Adds a plane through the origin with an upward normal.
    void add_plane(const std::string& name) {
        const TriangleMesh square{{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {{0, 1, 2}, {0, 2, 3}}};
        write_collider(name, square, false, {{"plane_normal", {0, 0, 1}}});
    }

    /// Writes a frame of these particles, 0.1 s after the previous frame.
    void add_frame(VtkPolyData particles) {
        const auto step = static_cast<std::uint64_t>(frames_);
        particles.time = 0.1 * frames_;
        write_vtp(folder.path(frame_file_name(step)), particles);
        if (!moving_.empty()) write_vtp(folder.path(moving_file_name(step)), moving_frame());
        ++frames_;
    }
    /// Writes run.json and lists the folder.
    [[nodiscard]] RunFolder finish(const std::string& scene = "made.json") const {
        RunInfo info;
        info.version = "0";
        info.scene = scene;
        info.colliders = colliders_;
        (void)folder.write(kRunInfoFile, run_info_text(info));
        return open_run_folder(folder.path(""));
    }

    TemporaryFolder folder;

private:
    struct Moving {
        std::uint32_t number;
        TriangleMesh mesh;
        Points where;
    };

    void write_collider(const std::string& name, const TriangleMesh& mesh, bool moves,
                        std::vector<VtkField> fields = {}) {
        VtkPolyData data;
        data.fields = std::move(fields);
        data.points = mesh.vertices;
        data.triangles = mesh.triangles;
        std::vector<std::int64_t> hits;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) hits.push_back(static_cast<std::int64_t>(t * t));
        data.cell_arrays = list_of(VtkArray{"hits", std::move(hits)});
        const std::string file = collider_file_name(colliders_.size(), name);
        write_vtp(folder.path(file), data);
        colliders_.push_back({name, "mesh", file, 0, moves});
    }
    [[nodiscard]] VtkPolyData moving_frame() const {
        VtkPolyData data;
        std::vector<std::uint32_t> numbers;
        for (const Moving& moving : moving_) {
            const auto base = static_cast<std::uint32_t>(data.points.size());
            for (const Vec3& point : moving.where(moving.mesh.vertices, frames_)) data.points.push_back(point);
            for (const auto& [a, b, c] : moving.mesh.triangles) {
                data.triangles.push_back({base + a, base + b, base + c});
                numbers.push_back(moving.number);
            }
        }
        data.cell_arrays = list_of(VtkArray{"collider", std::move(numbers)});
        return data;
    }

    std::vector<ColliderInfo> colliders_;
    std::vector<Moving> moving_;
    int frames_ = 0;
};

/// Returns a frame of points with these ids and no other data.
inline VtkPolyData point_frame(std::vector<Vec3> points, std::vector<std::int64_t> ids) {
    VtkPolyData frame;
    frame.points = std::move(points);
    frame.point_arrays = list_of(VtkArray{"id", std::move(ids)});
    return frame;
}

}  // namespace ricochet::test
