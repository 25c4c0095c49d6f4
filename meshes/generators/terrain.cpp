#include "generators/terrain.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "generators/lattice_noise.h"
#include "generators/planar_region.h"
#include "generators/require.h"
#include "ricochet/core/parallel.h"

namespace ricochet::meshes {
namespace {

constexpr std::size_t kRowsPerBlock = 4;
constexpr double kNaturalWidth = 90.0;  // metres; the size of features scales with the width relative to it
constexpr double kShelfHeight = 0.59;   // of a shelf of rock, fraction of the relief

/// Returns a smooth step from 0 (t <= low) to 1 (t >= high).
double smooth_step(double low, double high, double t) {
    const double s = std::clamp((t - low) / (high - low), 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
}

/// Returns the height profile of the slope, steep at the top (u = 0) and flat at the foot (u = 1).
double slope_profile(double u) {
    const double v = 1.0 - u;
    return v * (0.14 + 0.86 * v);
}

/// Returns the distance from the gully's winding line as a fraction of half the width; 0 on the line.
double gully_distance(const TerrainShape& shape, double u, double y) {
    const double bend = fractal_noise({2.6 * u, 0.37, 0.71}, Octaves{3, 2.0, 0.45}, shape.seed + 11);
    const double line = 0.8 * shape.width * bend * smooth_step(0.0, 0.25, u) * smooth_step(1.15, 0.6, u);
    return std::fabs(y - line) / (0.5 * shape.width);
}

/// Returns the height with shelves like weathered rock layers: treads and risers with a vertical period, blended in by
/// strength.
double shelved(double height, double period, double strength) {
    const double level = height / period;
    const double tread = std::floor(level);
    const double riser = smooth_step(0.55, 0.95, level - tread);
    return height + strength * period * (tread + riser - level);
}

}  // namespace

double terrain_height(const TerrainShape& shape, double x, double y) {
    const double u = x / shape.length;
    const double scale = shape.width / kNaturalWidth;
    const Vec3 p{x / scale, y / scale, 0.0};
    const Vec3 bend{fractal_noise(p / 17.0, Octaves{4}, shape.seed + 21),
                    fractal_noise(p / 17.0, Octaves{4}, shape.seed + 22), 0.0};
    const Vec3 q = p + 7.0 * bend;

    const double distance = gully_distance(shape, u, y + 3.0 * scale * bend.y);
    const double bed = 0.05 + 0.22 * u * u;
    const double flank = smooth_step(bed, bed + 0.55 + 0.3 * u, distance);
    const double fading = 1.0 - 0.7 * smooth_step(0.5, 1.0, u);
    const double crags = ridged_noise(q / 30.0, Octaves{8, 2.05, 0.52}, shape.seed + 31);
    const double folds = eroded_noise(q / 16.0, Octaves{8, 2.02, 0.55}, shape.seed + 41);
    const double grain = fractal_noise(p / 2.9, Octaves{5, 2.1, 0.6}, shape.seed + 51);

    double height = shape.drop * slope_profile(u);
    height += shape.gully_depth * fading * flank;
    height += shape.relief * fading * ((0.1 + 1.9 * flank) * (crags - 0.4) + 0.8 * folds);
    const double dip = 0.35 * p.y + 0.2 * p.x + 6.0 * bend.x;  // the layers of rock are inclined
    const double strength = 0.7 * fading * flank * smooth_step(-0.1, 0.35, folds + 0.6 * bend.y);
    if (shape.relief > 0.0) height = shelved(height + dip, kShelfHeight * shape.relief, strength) - dip;
    const double rubble = ridged_noise(p / 7.0 + bend, Octaves{6, 2.1, 0.6}, shape.seed + 61) - 0.4;
    return height + shape.roughness * scale * ((0.4 + 0.4 * flank) * grain + 1.1 * rubble);
}

namespace {

/// Vertex grid of the sheet: rows of constant y, x fastest.
struct Sheet {
    std::uint32_t columns = 0;
    std::uint32_t rows = 0;
    TriangleMesh mesh;

    [[nodiscard]] std::uint32_t vertex(std::uint32_t column, std::uint32_t row) const { return row * columns + column; }
    [[nodiscard]] double height(std::uint32_t vertex_index) const { return mesh.vertices[vertex_index].z; }
};

Sheet sample_heights(const TerrainShape& shape, double edge_length) {
    const std::vector<double> xs = even_steps(0.0, shape.length, edge_length);
    const std::vector<double> ys = even_steps(-0.5 * shape.width, 0.5 * shape.width, edge_length);
    Sheet sheet{static_cast<std::uint32_t>(xs.size()), static_cast<std::uint32_t>(ys.size()), {}};
    sheet.mesh.vertices.resize(xs.size() * ys.size());
    parallel_for_blocks(ys.size(), kRowsPerBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
            for (std::size_t column = 0; column < xs.size(); ++column) {
                const double height = terrain_height(shape, xs[column], ys[row]);
                sheet.mesh.vertices[row * xs.size() + column] = {xs[column], ys[row], height};
            }
        }
    });
    return sheet;
}

/// Adds two triangles per cell, split along the diagonal whose ends differ less in height. This keeps crests and beds
/// sharp.
void add_cells(Sheet& sheet) {
    sheet.mesh.triangles.reserve(2 * std::size_t{sheet.columns - 1} * (sheet.rows - 1));
    for (std::uint32_t row = 0; row + 1 < sheet.rows; ++row) {
        for (std::uint32_t column = 0; column + 1 < sheet.columns; ++column) {
            const std::uint32_t a = sheet.vertex(column, row);
            const std::uint32_t b = sheet.vertex(column + 1, row);
            const std::uint32_t c = sheet.vertex(column + 1, row + 1);
            const std::uint32_t d = sheet.vertex(column, row + 1);
            if (std::fabs(sheet.height(a) - sheet.height(c)) <= std::fabs(sheet.height(b) - sheet.height(d))) {
                sheet.mesh.triangles.push_back({a, b, c});
                sheet.mesh.triangles.push_back({a, c, d});
            } else {
                sheet.mesh.triangles.push_back({a, b, d});
                sheet.mesh.triangles.push_back({b, c, d});
            }
        }
    }
}

/// Returns the sheet's border vertices, counter-clockwise seen from above.
std::vector<std::uint32_t> border(const Sheet& sheet) {
    std::vector<std::uint32_t> loop;
    const std::uint32_t last_column = sheet.columns - 1;
    const std::uint32_t last_row = sheet.rows - 1;
    for (std::uint32_t i = 0; i < last_column; ++i) loop.push_back(sheet.vertex(i, 0));
    for (std::uint32_t j = 0; j < last_row; ++j) loop.push_back(sheet.vertex(last_column, j));
    for (std::uint32_t i = last_column; i > 0; --i) loop.push_back(sheet.vertex(i, last_row));
    for (std::uint32_t j = last_row; j > 0; --j) loop.push_back(sheet.vertex(0, j));
    return loop;
}

/// Adds walls from the border down to a flat floor, and the floor as a fan about its centre.
void close_below(Sheet& sheet, double floor) {
    TriangleMesh& mesh = sheet.mesh;
    const std::vector<std::uint32_t> rim = border(sheet);
    const auto count = static_cast<std::uint32_t>(rim.size());
    const auto foot = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::uint32_t v : rim) mesh.vertices.push_back({mesh.vertices[v].x, mesh.vertices[v].y, floor});
    const auto center = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({0.5 * (mesh.vertices.front().x + mesh.vertices[sheet.columns - 1].x), 0.0, floor});
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t next = (i + 1) % count;
        mesh.triangles.push_back({foot + i, foot + next, rim[next]});
        mesh.triangles.push_back({foot + i, rim[next], rim[i]});
        mesh.triangles.push_back({center, foot + next, foot + i});
    }
}

void check(const TerrainShape& shape) {
    require_length("terrain", "length", shape.length);
    require_length("terrain", "width", shape.width);
    require_between("terrain", "drop", shape.drop, 0.0, kLongest);
    require_between("terrain", "gully-depth", shape.gully_depth, 0.0, kLongest);
    require_between("terrain", "relief", shape.relief, 0.0, kLongest);
    require_between("terrain", "roughness", shape.roughness, 0.0, 3.0);
    require_between("terrain", "base", shape.base, 0.0, kLongest);
}

}  // namespace

TriangleMesh make_terrain(const TerrainShape& shape, double edge_length) {
    check(shape);
    Sheet sheet = sample_heights(shape, edge_length);
    add_cells(sheet);
    if (shape.base > 0.0) {
        double lowest = sheet.mesh.vertices.front().z;
        for (const Vec3& p : sheet.mesh.vertices) lowest = std::min(lowest, p.z);
        close_below(sheet, lowest - shape.base);
    }
    return std::move(sheet.mesh);
}

}  // namespace ricochet::meshes
