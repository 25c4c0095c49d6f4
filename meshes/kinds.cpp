#include "kinds.h"

#include <memory>

#include "generators/drum.h"
#include "generators/fish.h"
#include "generators/galton_board.h"
#include "generators/gear.h"
#include "generators/icosphere.h"
#include "generators/primitives.h"
#include "generators/rock.h"
#include "generators/terrain.h"
#include "generators/torus_knot.h"
#include "generators/vessels.h"

namespace ricochet::meshes {
namespace {

using SizedBuilder = std::function<TriangleMesh(std::size_t)>;

/// Adds an option whose help shows its default.
template <typename Value>
void option(cli::Command command, const std::string& name, Value& value, const std::string& description) {
    command.add_option(name, value, description).show_default();
}

/// Returns the builder of a shape whose parameters the command line sets. coarse_edge gives the initial edge length.
template <typename Shape>
SizedBuilder sized(const std::shared_ptr<Shape>& shape, TriangleMesh (*make)(const Shape&, double),
                   double (*coarse_edge)(const Shape&)) {
    return [shape, make, coarse_edge](std::size_t triangles) {
        return build_near(triangles, coarse_edge(*shape), [&](double edge) { return make(*shape, edge); });
    };
}

SizedBuilder terrain_options(cli::Command command) {
    auto shape = std::make_shared<TerrainShape>();
    option(command, "--length", shape->length, "extent along x, downhill, m");
    option(command, "--width", shape->width, "extent along y, m");
    option(command, "--drop", shape->drop, "height of the slope's top over its foot, m");
    option(command, "--gully-depth", shape->gully_depth, "height of the flanks over the gully's bed, m");
    option(command, "--relief", shape->relief, "height of crags on the flanks, m");
    option(command, "--roughness", shape->roughness, "strength of the small-scale roughness, 0 to 3");
    option(command, "--base", shape->base, "thickness of a closed block below, m; 0: open sheet");
    option(command, "--seed", shape->seed, "another seed, another mountain");
    return sized<TerrainShape>(shape, make_terrain, [](const TerrainShape& s) { return s.length / 8.0; });
}

SizedBuilder rock_options(cli::Command command) {
    auto shape = std::make_shared<RockShape>();
    option(command, "--radius", shape->radius, "radius before cutting and stretching, m");
    option(command, "--cuts", shape->cuts, "planes that cut facets off the ball, 0 to 200");
    option(command, "--cut-depth", shape->cut_depth, "deepest cut, fraction of the radius, 0 to 0.7");
    option(command, "--rounding", shape->rounding, "width of rounded creases, fraction of the radius, 0 to 0.5");
    option(command, "--roughness", shape->roughness, "noise on the surface, fraction of the radius, 0 to 0.5");
    option(command, "--stretch-x", shape->stretch_x, "scale along x");
    option(command, "--stretch-y", shape->stretch_y, "scale along y");
    option(command, "--stretch-z", shape->stretch_z, "scale along z");
    option(command, "--seed", shape->seed, "another seed, another rock");
    return sized<RockShape>(shape, make_rock, [](const RockShape& s) { return s.radius / 4.0; });
}

SizedBuilder cavity_options(cli::Command command) {
    auto shape = std::make_shared<CavityShape>();
    option(command, "--radius", shape->radius, "mean radius, m");
    option(command, "--roughness", shape->roughness, "displacement, fraction of the radius, 0 to 0.8");
    option(command, "--wavelength", shape->wavelength, "size of bays and noses, fraction of the radius, 0.1 to 10");
    option(command, "--seed", shape->seed, "another seed, another cavity");
    return sized<CavityShape>(shape, make_cavity, [](const CavityShape& s) { return s.radius / 4.0; });
}

SizedBuilder bowl_options(cli::Command command) {
    auto shape = std::make_shared<BowlShape>();
    option(command, "--radius", shape->radius, "of the inner sphere, m");
    option(command, "--thickness", shape->thickness, "of the wall, m");
    option(command, "--coverage", shape->coverage, "degrees from the lowest point to the rim, 10 to 170");
    return sized<BowlShape>(shape, make_bowl, [](const BowlShape& s) { return s.radius / 4.0; });
}

SizedBuilder funnel_options(cli::Command command) {
    auto shape = std::make_shared<FunnelShape>();
    option(command, "--top-radius", shape->top_radius, "inner radius of the upper opening, m");
    option(command, "--throat-radius", shape->throat_radius, "inner radius of the spout, m");
    option(command, "--cone-height", shape->cone_height, "m");
    option(command, "--spout-length", shape->spout_length, "m");
    option(command, "--thickness", shape->thickness, "of the wall, measured horizontally, m");
    return sized<FunnelShape>(shape, make_funnel, [](const FunnelShape& s) { return s.top_radius / 4.0; });
}

SizedBuilder staircase_options(cli::Command command) {
    auto shape = std::make_shared<StaircaseShape>();
    option(command, "--steps", shape->steps, "1 to 10000");
    option(command, "--run", shape->run, "depth of a tread, m");
    option(command, "--rise", shape->rise, "height of a riser, m");
    option(command, "--width", shape->width, "m");
    return sized<StaircaseShape>(shape, make_staircase, [](const StaircaseShape& s) { return s.run; });
}

SizedBuilder torus_knot_options(cli::Command command) {
    auto shape = std::make_shared<TorusKnotShape>();
    option(command, "--radius", shape->radius, "of the torus' centre circle, m");
    option(command, "--winding", shape->winding, "radius of the torus' tube on which the knot lies, m");
    option(command, "--tube-radius", shape->tube_radius, "of the knot's own tube, m");
    option(command, "-p,--p", shape->p, "turns around the axis, 1 to 50");
    option(command, "-q,--q", shape->q, "turns around the torus' tube, 1 to 50");
    return sized<TorusKnotShape>(shape, make_torus_knot, [](const TorusKnotShape& s) { return s.tube_radius / 2.0; });
}

SizedBuilder gear_options(cli::Command command) {
    auto shape = std::make_shared<GearShape>();
    option(command, "--teeth", shape->teeth, "8 to 400");
    option(command, "--pitch-radius", shape->pitch_radius, "m");
    option(command, "--bore-radius", shape->bore_radius, "of the hole in the middle, m");
    option(command, "--width", shape->width, "along the axis, m");
    option(command, "--web-recess", shape->web_recess,
           "depth of the groove between hub and rim, fraction of the width, 0 to 0.45");
    return sized<GearShape>(shape, make_gear, [](const GearShape& s) { return s.pitch_radius / 4.0; });
}

SizedBuilder galton_board_options(cli::Command command) {
    auto shape = std::make_shared<GaltonBoardShape>();
    option(command, "--rows", shape->rows, "rows of pegs, 1 to 200");
    option(command, "--spacing", shape->spacing, "between neighbouring pegs and rows, m");
    option(command, "--peg-radius", shape->peg_radius, "m");
    option(command, "--bin-height", shape->bin_height, "m");
    option(command, "--depth", shape->depth, "of the board, along y, m");
    return sized<GaltonBoardShape>(shape, make_galton_board, [](const GaltonBoardShape& s) { return 4.0 * s.spacing; });
}

SizedBuilder drum_options(cli::Command command) {
    auto shape = std::make_shared<DrumShape>();
    option(command, "--radius", shape->radius, "inner radius, m");
    option(command, "--length", shape->length, "inner length, m");
    option(command, "--thickness", shape->thickness, "of barrel and end walls, m");
    option(command, "--lifters", shape->lifters, "bars along the barrel, 3 to 60");
    option(command, "--lifter-height", shape->lifter_height, "m");
    option(command, "--opening", shape->opening,
           "hole in the front, fraction of the radius between lifters; 0: closed");
    return sized<DrumShape>(shape, make_drum, [](const DrumShape& s) { return s.radius / 4.0; });
}

SizedBuilder fish_options(cli::Command command) {
    auto shape = std::make_shared<FishShape>();
    option(command, "--length", shape->length, "from the nose to the root of the tail fin, m");
    option(command, "--height", shape->height, "of the body, fraction of the length, 0.05 to 0.6");
    option(command, "--width", shape->width, "of the body, fraction of the length, 0.05 to 0.4");
    option(command, "--swing", shape->swing, "of the tail to each side, fraction of the length, 0 to 0.2");
    option(command, "--phase", shape->phase, "of its swimming, in periods; all phases have the same faces");
    return sized<FishShape>(shape, make_fish, [](const FishShape& s) { return s.length / 8.0; });
}

SizedBuilder box_options(cli::Command command) {
    auto shape = std::make_shared<BoxShape>();
    option(command, "--length", shape->length, "along x, m");
    option(command, "--width", shape->width, "along y, m");
    option(command, "--height", shape->height, "along z, m");
    return sized<BoxShape>(shape, make_box, [](const BoxShape& s) { return s.length + s.width + s.height; });
}

SizedBuilder icosphere_options(cli::Command command) {
    auto shape = std::make_shared<IcosphereShape>();
    option(command, "--radius", shape->radius, "m");
    return sized<IcosphereShape>(shape, make_icosphere, [](const IcosphereShape& s) { return s.radius; });
}

SizedBuilder plate_options(cli::Command command) {
    auto shape = std::make_shared<PlateShape>();
    option(command, "--length", shape->length, "along x, m");
    option(command, "--width", shape->width, "along y, m");
    return sized<PlateShape>(shape, make_plate, [](const PlateShape& s) { return s.length + s.width; });
}

SizedBuilder wedge_options(cli::Command command) {
    auto shape = std::make_shared<WedgeShape>();
    option(command, "--length", shape->length, "from the sharp edge to the back, along x, m");
    option(command, "--opening", shape->opening, "distance of the two faces at the back, along z, m");
    option(command, "--width", shape->width, "of the sharp edge, along y, m");
    return sized<WedgeShape>(shape, make_wedge, [](const WedgeShape& s) { return s.length + s.width; });
}

}  // namespace

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all{
        {"terrain", "rocky mountainside with a gully, open sheet or closed block", terrain_options},
        {"rock", "boulder: a ball cut by planes and roughened", rock_options},
        {"cavity", "closed cave-like hollow for particles inside", cavity_options},
        {"bowl", "part of a hollow sphere with a wall, open at the top", bowl_options},
        {"funnel", "cone over a spout with a wall", funnel_options},
        {"staircase", "solid flight of stairs", staircase_options},
        {"torus-knot", "closed tube along a (p, q) torus knot", torus_knot_options},
        {"gear", "spur gear with involute teeth", gear_options},
        {"galton-board", "rows of pegs over bins, in a frame with a hopper", galton_board_options},
        {"drum", "barrel with lifters, closed or open at the front", drum_options},
        {"fish", "swimming fish: a mesh for each phase, all with the same faces", fish_options},
        {"box", "box with divided faces", box_options},
        {"icosphere", "sphere as a divided icosahedron", icosphere_options},
        {"plate", "flat open sheet", plate_options},
        {"wedge", "prism with a sharp edge: two planes at an angle, closed", wedge_options},
    };
    return all;
}

}  // namespace ricochet::meshes
