/// \file
/// Galton board: rows of pegs over bins, in a frame with a hopper.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Shape of a Galton board.
struct GaltonBoardShape {
    int rows = 12;             ///< rows of pegs, 1 to 200
    double spacing = 0.1;      ///< between neighbouring pegs and rows, metres
    double peg_radius = 0.02;  ///< metres, at most 0.4 spacing
    double bin_height = 0.6;   ///< metres
    double depth = 0.1;        ///< of the board, along y, metres
};

/// Returns a board in the plane of x and z, symmetric in x, floor at z = 0, front at y = 0 and back plate behind y =
/// depth. Each peg, the frame, each side of the hopper and the back plate is a separate closed shell. No shell touches
/// another. The frame has floor, walls and dividers in one piece. The sides of pegs, dividers and walls are exactly
/// parallel to y: a particle that moves in a plane of constant y stays in it. Throws InputError for parameters out of
/// range.
[[nodiscard]] TriangleMesh make_galton_board(const GaltonBoardShape& shape, double edge_length);

/// Returns the height of the lowest point of the hopper's opening over z = 0, in metres. Particles start above it.
[[nodiscard]] double galton_board_entry(const GaltonBoardShape& shape);

}  // namespace ricochet::meshes
