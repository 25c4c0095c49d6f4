#include "kinds.h"

#include <memory>

#include <CLI/CLI.hpp>

#include "generators/drum.h"
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

/// Adds an option with its default shown in the help.
template <typename Value>
void option(CLI::App& app, const std::string& name, Value& value, const std::string& description) {
    app.add_option(name, value, description)->capture_default_str();
}

/// The builder of a shape whose parameters the command line fills in; coarse_edge gives the edge length to start from.
template <typename Shape>
SizedBuilder sized(const std::shared_ptr<Shape>& shape, TriangleMesh (*make)(const Shape&, double),
                   double (*coarse_edge)(const Shape&)) {
    return [shape, make, coarse_edge](std::size_t triangles) {
        return build_near(triangles, coarse_edge(*shape), [&](double edge) { return make(*shape, edge); });
    };
}

SizedBuilder terrain_options(CLI::App& app) {
    auto shape = std::make_shared<TerrainShape>();
    option(app, "--length", shape->length, "extent along x, downhill, m");
    option(app, "--width", shape->width, "extent along y, m");
    option(app, "--drop", shape->drop, "height of the slope's top over its foot, m");
    option(app, "--gully-depth", shape->gully_depth, "height of the flanks over the gully's bed, m");
    option(app, "--relief", shape->relief, "height of crags on the flanks, m");
    option(app, "--roughness", shape->roughness, "strength of the small-scale roughness, 0 to 3");
    option(app, "--base", shape->base, "thickness of a closed block below, m; 0: open sheet");
    option(app, "--seed", shape->seed, "another seed, another mountain");
    return sized<TerrainShape>(shape, make_terrain, [](const TerrainShape& s) { return s.length / 8.0; });
}

SizedBuilder rock_options(CLI::App& app) {
    auto shape = std::make_shared<RockShape>();
    option(app, "--radius", shape->radius, "radius before cutting and stretching, m");
    option(app, "--cuts", shape->cuts, "planes that cut facets off the ball, 0 to 200");
    option(app, "--cut-depth", shape->cut_depth, "deepest cut, fraction of the radius, 0 to 0.7");
    option(app, "--rounding", shape->rounding, "width of rounded creases, fraction of the radius, 0 to 0.5");
    option(app, "--roughness", shape->roughness, "noise on the surface, fraction of the radius, 0 to 0.5");
    option(app, "--stretch-x", shape->stretch_x, "scale along x");
    option(app, "--stretch-y", shape->stretch_y, "scale along y");
    option(app, "--stretch-z", shape->stretch_z, "scale along z");
    option(app, "--seed", shape->seed, "another seed, another rock");
    return sized<RockShape>(shape, make_rock, [](const RockShape& s) { return s.radius / 4.0; });
}

SizedBuilder cavity_options(CLI::App& app) {
    auto shape = std::make_shared<CavityShape>();
    option(app, "--radius", shape->radius, "mean radius, m");
    option(app, "--roughness", shape->roughness, "displacement, fraction of the radius, 0 to 0.8");
    option(app, "--wavelength", shape->wavelength, "size of bays and noses, fraction of the radius, 0.1 to 10");
    option(app, "--seed", shape->seed, "another seed, another cavity");
    return sized<CavityShape>(shape, make_cavity, [](const CavityShape& s) { return s.radius / 4.0; });
}

SizedBuilder bowl_options(CLI::App& app) {
    auto shape = std::make_shared<BowlShape>();
    option(app, "--radius", shape->radius, "of the inner sphere, m");
    option(app, "--thickness", shape->thickness, "of the wall, m");
    option(app, "--coverage", shape->coverage, "degrees from the lowest point to the rim, 10 to 170");
    return sized<BowlShape>(shape, make_bowl, [](const BowlShape& s) { return s.radius / 4.0; });
}

SizedBuilder funnel_options(CLI::App& app) {
    auto shape = std::make_shared<FunnelShape>();
    option(app, "--top-radius", shape->top_radius, "inner radius of the upper opening, m");
    option(app, "--throat-radius", shape->throat_radius, "inner radius of the spout, m");
    option(app, "--cone-height", shape->cone_height, "m");
    option(app, "--spout-length", shape->spout_length, "m");
    option(app, "--thickness", shape->thickness, "of the wall, measured horizontally, m");
    return sized<FunnelShape>(shape, make_funnel, [](const FunnelShape& s) { return s.top_radius / 4.0; });
}

SizedBuilder staircase_options(CLI::App& app) {
    auto shape = std::make_shared<StaircaseShape>();
    option(app, "--steps", shape->steps, "1 to 10000");
    option(app, "--run", shape->run, "depth of a tread, m");
    option(app, "--rise", shape->rise, "height of a riser, m");
    option(app, "--width", shape->width, "m");
    return sized<StaircaseShape>(shape, make_staircase, [](const StaircaseShape& s) { return s.run; });
}

SizedBuilder torus_knot_options(CLI::App& app) {
    auto shape = std::make_shared<TorusKnotShape>();
    option(app, "--radius", shape->radius, "of the torus' centre circle, m");
    option(app, "--winding", shape->winding, "radius of the torus' tube on which the knot lies, m");
    option(app, "--tube-radius", shape->tube_radius, "of the knot's own tube, m");
    app.add_option("-p,--p", shape->p, "turns around the axis, 1 to 50")->capture_default_str();
    app.add_option("-q,--q", shape->q, "turns around the torus' tube, 1 to 50")->capture_default_str();
    return sized<TorusKnotShape>(shape, make_torus_knot, [](const TorusKnotShape& s) { return s.tube_radius / 2.0; });
}

SizedBuilder gear_options(CLI::App& app) {
    auto shape = std::make_shared<GearShape>();
    option(app, "--teeth", shape->teeth, "8 to 400");
    option(app, "--pitch-radius", shape->pitch_radius, "m");
    option(app, "--bore-radius", shape->bore_radius, "of the hole in the middle, m");
    option(app, "--width", shape->width, "along the axis, m");
    option(app, "--web-recess", shape->web_recess,
           "depth of the groove between hub and rim, fraction of the width, 0 to 0.45");
    return sized<GearShape>(shape, make_gear, [](const GearShape& s) { return s.pitch_radius / 4.0; });
}

SizedBuilder galton_board_options(CLI::App& app) {
    auto shape = std::make_shared<GaltonBoardShape>();
    option(app, "--rows", shape->rows, "rows of pegs, 1 to 200");
    option(app, "--spacing", shape->spacing, "between neighbouring pegs and rows, m");
    option(app, "--peg-radius", shape->peg_radius, "m");
    option(app, "--bin-height", shape->bin_height, "m");
    option(app, "--depth", shape->depth, "of the board, along y, m");
    return sized<GaltonBoardShape>(shape, make_galton_board, [](const GaltonBoardShape& s) { return 4.0 * s.spacing; });
}

SizedBuilder drum_options(CLI::App& app) {
    auto shape = std::make_shared<DrumShape>();
    option(app, "--radius", shape->radius, "inner radius, m");
    option(app, "--length", shape->length, "inner length, m");
    option(app, "--thickness", shape->thickness, "of barrel and end walls, m");
    option(app, "--lifters", shape->lifters, "bars along the barrel, 3 to 60");
    option(app, "--lifter-height", shape->lifter_height, "m");
    option(app, "--opening", shape->opening, "hole in the front, fraction of the radius between lifters; 0: closed");
    return sized<DrumShape>(shape, make_drum, [](const DrumShape& s) { return s.radius / 4.0; });
}

SizedBuilder box_options(CLI::App& app) {
    auto shape = std::make_shared<BoxShape>();
    option(app, "--length", shape->length, "along x, m");
    option(app, "--width", shape->width, "along y, m");
    option(app, "--height", shape->height, "along z, m");
    return sized<BoxShape>(shape, make_box, [](const BoxShape& s) { return s.length + s.width + s.height; });
}

SizedBuilder icosphere_options(CLI::App& app) {
    auto shape = std::make_shared<IcosphereShape>();
    option(app, "--radius", shape->radius, "m");
    return sized<IcosphereShape>(shape, make_icosphere, [](const IcosphereShape& s) { return s.radius; });
}

SizedBuilder plate_options(CLI::App& app) {
    auto shape = std::make_shared<PlateShape>();
    option(app, "--length", shape->length, "along x, m");
    option(app, "--width", shape->width, "along y, m");
    return sized<PlateShape>(shape, make_plate, [](const PlateShape& s) { return s.length + s.width; });
}

SizedBuilder wedge_options(CLI::App& app) {
    auto shape = std::make_shared<WedgeShape>();
    option(app, "--length", shape->length, "from the sharp edge to the back, along x, m");
    option(app, "--opening", shape->opening, "distance of the two faces at the back, along z, m");
    option(app, "--width", shape->width, "of the sharp edge, along y, m");
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
        {"box", "box with divided faces", box_options},
        {"icosphere", "sphere as a divided icosahedron", icosphere_options},
        {"plate", "flat open sheet", plate_options},
        {"wedge", "prism with a sharp edge: two planes at an angle, closed", wedge_options},
    };
    return all;
}

}  // namespace ricochet::meshes
