#include "generators/galton_board.h"

#include <algorithm>
#include <array>
#include <vector>

#include "generators/layered_extrusion.h"
#include "generators/placement.h"
#include "generators/require.h"

namespace ricochet::meshes {
namespace {

constexpr double kTwoPi = 6.283185307179586;
constexpr double kGap = 0.01;      // between neighbouring pieces, fraction of the spacing
constexpr double kDivider = 0.12;  // thickness of dividers, fraction of the spacing
constexpr double kWall = 0.3;      // thickness of walls, floor and plate, fraction of the spacing
constexpr int kFewestPegSides = 12;

/// Adds prisms along y, from the front to the back plate.
class Board {
public:
    Board(const GaltonBoardShape& shape, double edge_length) : shape_(shape), edge_(edge_length) {}

    /// Upright block with its lower left corner at (x, z).
    void block(double x, double z, double width, double height) { place(rectangle_region(width, height, edge_), x, z); }

    /// Block whose upper side is shifted by `lean` along x.
    void leaning_block(double x, double z, double width, double height, double lean) {
        PlanarRegion region = rectangle_region(width, height, edge_);
        for (Point2& p : region.points) p.x += lean * p.y / height;
        place(region, x, z);
    }

    void peg(double x, double z) {
        const int sides = steps_in(kTwoPi * shape_.peg_radius, edge_, kFewestPegSides);
        const int rings = steps_in(shape_.peg_radius, edge_);
        const std::vector<std::vector<Point2>> loops{circle_loop(shape_.peg_radius / rings, sides),
                                                     circle_loop(shape_.peg_radius, sides)};
        const std::array bands{Band{rings - 1, 0}};
        place(nested_region(loops, rings > 1 ? std::span<const Band>(bands) : std::span<const Band>(), 0), x, z);
    }

    /// Plate behind everything.
    void back_plate(double half_width, double height) {
        const double gap = kGap * shape_.spacing;
        const TriangleMesh plate =
            stood_up(extrusion(rectangle_region(2.0 * half_width, height, edge_), kWall * shape_.spacing, edge_));
        append(mesh_, moved(plate, {-half_width, shape_.depth + gap + kWall * shape_.spacing, 0.0}));
    }

    TriangleMesh take() { return std::move(mesh_); }

private:
    void place(const PlanarRegion& region, double x, double z) {
        append(mesh_, moved(stood_up(extrusion(region, shape_.depth, edge_)), {x, shape_.depth, z}));
    }

    const GaltonBoardShape& shape_;
    double edge_;
    TriangleMesh mesh_;
};

double lowest_row(const GaltonBoardShape& shape) { return (kWall + 1.0) * shape.spacing + shape.bin_height; }
double top_row(const GaltonBoardShape& shape) { return lowest_row(shape) + (shape.rows - 1) * shape.spacing; }
double half_width(const GaltonBoardShape& shape) { return 0.5 * (shape.rows + 3) * shape.spacing; }

/// Row r from the top has r + 1 pegs, so that all gaps are offered to what comes through the row above.
void add_pegs(Board& board, const GaltonBoardShape& shape) {
    for (int row = 0; row < shape.rows; ++row) {
        const double z = top_row(shape) - row * shape.spacing;
        for (int i = 0; i <= row; ++i) board.peg((i - 0.5 * row) * shape.spacing, z);
    }
}

/// Dividers stand below the lowest row's pegs and one more on either side: a bin for every number of turns.
void add_bins(Board& board, const GaltonBoardShape& shape) {
    const double floor = kWall * shape.spacing;
    const double gap = kGap * shape.spacing;
    const double thickness = kDivider * shape.spacing;
    for (int i = -1; i <= shape.rows; ++i) {
        const double x = (i - 0.5 * (shape.rows - 1)) * shape.spacing;
        board.block(x - 0.5 * thickness, floor + gap, thickness, shape.bin_height);
    }
}

void add_frame(Board& board, const GaltonBoardShape& shape) {
    const double wall = kWall * shape.spacing;
    const double gap = kGap * shape.spacing;
    const double half = half_width(shape);
    const double top = galton_board_entry(shape) + 2.0 * shape.spacing;
    board.block(-half, 0.0, 2.0 * half, wall);
    board.block(-half, wall + gap, wall, top - wall);
    board.block(half - wall, wall + gap, wall, top - wall);
    const double throat = 0.2 * shape.spacing;
    const double reach = half - 2.0 * wall - throat - gap;
    const double entry = galton_board_entry(shape);
    board.leaning_block(throat, entry, wall, 2.0 * shape.spacing, reach);
    board.leaning_block(-throat - wall, entry, wall, 2.0 * shape.spacing, -reach);
    board.back_plate(half, top);
}

void check(const GaltonBoardShape& shape) {
    require_between("galton-board", "rows", shape.rows, 1, 200);
    require_length("galton-board", "spacing", shape.spacing);
    require_between("galton-board", "peg-radius", shape.peg_radius, kShortest, 0.4 * shape.spacing);
    require_length("galton-board", "bin-height", shape.bin_height);
    require_length("galton-board", "depth", shape.depth);
}

}  // namespace

double galton_board_entry(const GaltonBoardShape& shape) { return top_row(shape) + 0.8 * shape.spacing; }

TriangleMesh make_galton_board(const GaltonBoardShape& shape, double edge_length) {
    check(shape);
    Board board(shape, edge_length);
    add_pegs(board, shape);
    add_bins(board, shape);
    add_frame(board, shape);
    return board.take();
}

}  // namespace ricochet::meshes
