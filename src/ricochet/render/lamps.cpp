#include "ricochet/render/lamps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "ricochet/core/box3.h"
#include "ricochet/render/tone.h"

namespace ricochet {
namespace {

// What a cell of the grid holds.
struct Cell {
    Vec3 intensity;
    Vec3 moment;          // of the positions, weighted by brightness
    double weight = 0.0;  // sum of the brightness
    double spread = 0.0;  // of the squared positions
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

Lamp lamp_of(const Cell& cell) {
    const Vec3 middle = cell.moment / cell.weight;
    const double variance = std::max(0.0, cell.spread / cell.weight - dot(middle, middle));
    return {middle, cell.intensity, std::sqrt(variance)};
}

}  // namespace

std::vector<Lamp> lamps_of(const Sprites& sprites, std::size_t most) {
    Box3 box;
    double largest = 0.0;
    for (std::size_t i = 0; i < sprites.centers.size(); ++i) {
        if (!shines(sprites, i)) continue;
        box.include(sprites.centers[i]);
        largest = std::max(largest, sprites.radii[i]);
    }
    if (!(largest > 0.0)) return {};
    double size = std::max(largest, max_abs(box.upper - box.lower) / 64.0);
    for (;; size *= 2.0) {
        std::map<CellIndex, Cell> cells;
        for (std::size_t i = 0; i < sprites.centers.size() && cells.size() <= most; ++i) {
            if (!shines(sprites, i)) continue;
            const Vec3 p = sprites.centers[i] - box.lower;
            const double radius = sprites.radii[i];
            const Vec3 intensity = std::clamp(sprites.opacities[i], 0.0, 1.0) * radius * radius * sprites.colors[i];
            Cell& cell = cells[cell_at(sprites.centers[i], box.lower, size)];
            const double bright = luminance(intensity);
            cell.intensity += intensity;
            cell.moment += bright * p;
            cell.weight += bright;
            cell.spread += bright * (dot(p, p) + radius * radius);
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
