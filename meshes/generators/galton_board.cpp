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
constexpr double kHopper = 2.0;    // height of the hopper, spacings
constexpr double kThroat = 0.2;    // half width of its opening, spacings
constexpr int kMinPegSides = 12;

/// Builder that adds prisms along y, from the front to the back plate.
class Board {
public:
    Board(const GaltonBoardShape& shape, double edge_length) : shape_(shape), edge_(edge_length) {}

    /// Adds a prism over the region from the board's front to its back, with the region's origin at (x, z).
    void place(const PlanarRegion& region, double x, double z) {
        append(mesh_, moved(stood_up(extrusion(region, shape_.depth, edge_)), {x, shape_.depth, z}));
    }

    /// Adds a block whose upper side is shifted by `lean` along x.
    void leaning_block(double x, double z, double width, double height, double lean) {
        PlanarRegion region = rectangle_region(width, height, edge_);
        for (Point2& p : region.points) p.x += lean * p.y / height;
        place(region, x, z);
    }

    void peg(double x, double z) {
        const int sides = steps_in(kTwoPi * shape_.peg_radius, edge_, kMinPegSides);
        const int rings = steps_in(shape_.peg_radius, edge_);
        const std::vector<std::vector<Point2>> loops{circle_loop(shape_.peg_radius / rings, sides),
                                                     circle_loop(shape_.peg_radius, sides)};
        const std::array bands{Band{rings - 1, 0}};
        place(nested_region(loops, rings > 1 ? std::span<const Band>(bands) : std::span<const Band>(), 0), x, z);
    }

    /// Adds the plate behind all other parts.
    void back_plate(double half_width, double height) {
        const double gap = kGap * shape_.spacing;
        const TriangleMesh plate =
            stood_up(extrusion(rectangle_region(2.0 * half_width, height, edge_), kWall * shape_.spacing, edge_));
        append(mesh_, moved(plate, {-half_width, shape_.depth + gap + kWall * shape_.spacing, 0.0}));
    }

    TriangleMesh take() { return std::move(mesh_); }

private:
    const GaltonBoardShape& shape_;
    double edge_;
    TriangleMesh mesh_;
};

double lowest_row(const GaltonBoardShape& shape) { return (kWall + 1.0) * shape.spacing + shape.bin_height; }
double top_row(const GaltonBoardShape& shape) { return lowest_row(shape) + (shape.rows - 1) * shape.spacing; }
double half_width(const GaltonBoardShape& shape) { return 0.5 * (shape.rows + 3) * shape.spacing; }

/// Adds the pegs. Every row spans the board, so that no particle runs down beside the pegs. Each row is shifted by half
/// a spacing against the next, and the lowest one is above the dividers.
void add_pegs(Board& board, const GaltonBoardShape& shape) {
    for (int row = 0; row < shape.rows; ++row) {
        const double z = top_row(shape) - row * shape.spacing;
        const int pegs = shape.rows + 1 + (shape.rows - row) % 2;
        for (int i = 0; i < pegs; ++i) board.peg((i - 0.5 * (pegs - 1)) * shape.spacing, z);
    }
}

/// Section of the frame along x, with the height of the solid on the floor.
struct Section {
    double width = 0.0;
    double height = 0.0;  // over the floor; 0 for the bare floor
};

/// Returns the sections from the left wall over the dividers to the right wall. There is a divider below each peg of
/// the lowest row and one more on either side, so there is a bin for every number of turns.
std::vector<Section> frame_sections(const GaltonBoardShape& shape, double wall_height) {
    const double wall = kWall * shape.spacing;
    const double thickness = kDivider * shape.spacing;
    const double bin = shape.spacing - thickness;
    const double first = half_width(shape) - wall - 0.5 * (shape.rows + 1) * shape.spacing - 0.5 * thickness;
    std::vector<Section> sections{{wall, wall_height}, {first, 0.0}};
    for (int divider = 0; divider < shape.rows + 2; ++divider) {
        if (divider > 0) sections.push_back({bin, 0.0});
        sections.push_back({thickness, shape.bin_height});
    }
    sections.push_back({first, 0.0});
    sections.push_back({wall, wall_height});
    return sections;
}

void append_steps(std::vector<double>& lines, double last, double edge_length) {
    const std::vector<double> steps = even_steps(lines.back(), last, edge_length);
    lines.insert(lines.end(), steps.begin() + 1, steps.end());
}

/// Returns floor, walls and dividers in one piece: a comb without slits that points could slide through.
PlanarRegion frame_region(const GaltonBoardShape& shape, double wall_height, double edge_length) {
    const double floor = kWall * shape.spacing;
    std::vector<double> xs{-half_width(shape)};
    std::vector<double> tops;  // top of the solid in every column of cells
    double x = xs.back();
    for (const Section& section : frame_sections(shape, wall_height)) {
        x += section.width;
        append_steps(xs, x, edge_length);
        tops.resize(xs.size() - 1, floor + section.height);
    }
    std::vector<double> zs{0.0};
    for (const double z : {floor, floor + shape.bin_height, floor + wall_height}) append_steps(zs, z, edge_length);
    return lattice_region(xs, zs, [&](std::size_t i, std::size_t j) { return zs[j] < tops[i]; });
}

void add_frame(Board& board, const GaltonBoardShape& shape, double edge_length) {
    const double wall = kWall * shape.spacing;
    const double half = half_width(shape);
    const double entry = galton_board_entry(shape);
    const double top = entry + kHopper * shape.spacing;
    board.place(frame_region(shape, top - wall, edge_length), 0.0, 0.0);
    const double throat = kThroat * shape.spacing;
    const double reach = half - 2.0 * wall - throat - kGap * shape.spacing;
    board.leaning_block(throat, entry, wall, kHopper * shape.spacing, reach);
    board.leaning_block(-throat - wall, entry, wall, kHopper * shape.spacing, -reach);
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
    add_frame(board, shape, edge_length);
    return board.take();
}

}  // namespace ricochet::meshes
