#include "view/render/lamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "ricochet/core/box3.h"
#include "view/render/tone.h"

namespace ricochet {
namespace {

// Sums over the light sources in one cell of the grid.
struct Cell {
    Vec3 intensity;
    Vec3 moment;          // sum of the positions times the brightness
    double weight = 0.0;  // sum of the brightness
    double spread = 0.0;  // sum of (squared position + squared radius) times the brightness
};

using CellIndex = std::array<long, 3>;

CellIndex cell_at(const Vec3& p, const Vec3& lower, double size) {
    const Vec3 at = (p - lower) / size;
    return {static_cast<long>(std::floor(at.x)), static_cast<long>(std::floor(at.y)),
            static_cast<long>(std::floor(at.z))};
}

bool shines(const Sprites& sprites, std::size_t i) {
    return is_finite(sprites.centers[i]) && sprites.radii[i] > 0.0 && sprites.opacities[i] > 0.0 &&
           luminance(sprites.colors[i]) > 0.0;
}

// A small light source.
struct Shining {
    Vec3 center;
    double radius = 0.0;  // m
    Vec3 intensity;
};

std::vector<Shining> shining_discs(const Sprites& sprites) {
    std::vector<Shining> all;
    for (std::size_t i = 0; i < sprites.centers.size(); ++i) {
        if (!shines(sprites, i)) continue;
        const double radius = sprites.radii[i];
        all.push_back({sprites.centers[i], radius,
                       std::clamp(sprites.opacities[i], 0.0, 1.0) * radius * radius * sprites.colors[i]});
    }
    return all;
}

// Splits a line into equal pieces, each at most as long as a cell, and divides the line's light equally among the
// pieces.
void cut_up(const GlowingLine& line, double size, std::vector<Shining>& all) {
    const double pieces = std::max(1.0, std::ceil(length(line.to - line.from) / size));
    for (double k = 0.5; k < pieces; k += 1.0) {
        all.push_back({line.from + k / pieces * (line.to - line.from), line.radius, line.intensity / pieces});
    }
}

Lamp lamp_of(const Cell& cell) {
    const Vec3 middle = cell.moment / cell.weight;
    const double variance = std::max(0.0, cell.spread / cell.weight - dot(middle, middle));
    return {middle, cell.intensity, std::sqrt(variance)};
}

}  // namespace

std::vector<Lamp> lamps_of(const Sprites& sprites, std::span<const GlowingLine> lines, std::size_t most) {
    std::vector<Shining> all = shining_discs(sprites);
    Box3 box;
    double largest = 0.0;
    for (const Shining& one : all) {
        box.include(one.center);
        largest = std::max(largest, one.radius);
    }
    for (const GlowingLine& line : lines) {
        box.include(line.from);
        box.include(line.to);
        largest = std::max(largest, line.radius);
    }
    if (!(largest > 0.0)) return {};
    double size = std::max(largest, max_abs(box.upper - box.lower) / 64.0);
    for (const GlowingLine& line : lines) cut_up(line, size, all);
    for (;; size *= 2.0) {
        std::map<CellIndex, Cell> cells;
        for (std::size_t i = 0; i < all.size() && cells.size() <= most; ++i) {
            const Shining& one = all[i];
            const Vec3 p = one.center - box.lower;
            Cell& cell = cells[cell_at(one.center, box.lower, size)];
            const double bright = luminance(one.intensity);
            cell.intensity += one.intensity;
            cell.moment += bright * p;
            cell.weight += bright;
            cell.spread += bright * (dot(p, p) + one.radius * one.radius);
        }
        if (cells.size() > most) continue;
        std::vector<Lamp> lamps;
        for (const auto& [index, cell] : cells) {
            lamps.push_back(lamp_of(cell));
            lamps.back().position += box.lower;
        }
        return lamps;
    }
}

}  // namespace ricochet
