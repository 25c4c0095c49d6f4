// Checks every closed shape, coarse and fine: closed, wound outward, of the right topology, without degenerate
// triangles.
#include <functional>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "generators/build_near.h"
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
#include "meshes/mesh_checks.h"

namespace ricochet::meshes {
namespace RICOCHET_FILE {

struct ClosedShape {
    std::string name;
    ShapeBuilder build;
    double coarse_edge;
    std::size_t shell_count;
    long handles;
};

// The name is GoogleTest's. NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const ClosedShape& shape, std::ostream* out) { *out << shape.name; }

template <typename Shape>
ShapeBuilder with(const Shape& shape, TriangleMesh (*make)(const Shape&, double)) {
    return [shape, make](double edge) { return make(shape, edge); };
}

RockShape rugged_rock() {
    RockShape shape;
    shape.cut_depth = 0.7;
    shape.rounding = 0.0;
    shape.roughness = 0.5;
    shape.stretch_x = 3.0;
    shape.seed = 9;
    return shape;
}

FishShape fish_of_phase(double phase) {
    FishShape shape;
    shape.swing = 0.15;
    shape.phase = phase;
    return shape;
}

DrumShape shut_drum() {
    DrumShape shape;
    shape.opening = 0.0;
    return shape;
}

GearShape flat_gear_with_many_teeth() {
    GearShape shape;
    shape.teeth = 60;  // the root circle lies outside the base circle
    shape.web_recess = 0.0;
    return shape;
}

TorusKnotShape five_two_knot() {
    TorusKnotShape shape;
    shape.p = 5;
    shape.q = 2;
    shape.tube_radius = 0.1;
    return shape;
}

TerrainShape terrain_block() {
    TerrainShape shape;
    shape.base = 5.0;
    return shape;
}

std::size_t galton_shells(const GaltonBoardShape& shape) {
    const auto rows = static_cast<std::size_t>(shape.rows);
    const std::size_t pegs = rows * (rows + 1) + (rows + 1) / 2;  // every other row has one peg more
    return pegs + 1 + 2 + 1;                                      // frame, sides of the hopper, plate
}

std::vector<ClosedShape> closed_shapes() {
    return {
        {"Rock", with(RockShape{}, make_rock), 0.5, 1, 0},
        {"RuggedRock", with(rugged_rock(), make_rock), 0.5, 1, 0},
        {"Cavity", with(CavityShape{}, make_cavity), 0.5, 1, 0},
        {"Bowl", with(BowlShape{}, make_bowl), 0.3, 1, 0},
        {"Funnel", with(FunnelShape{}, make_funnel), 0.3, 1, 1},
        {"Staircase", with(StaircaseShape{}, make_staircase), 0.3, 1, 0},
        {"TorusKnot", with(TorusKnotShape{}, make_torus_knot), 0.15, 1, 1},
        {"FiveTwoKnot", with(five_two_knot(), make_torus_knot), 0.1, 1, 1},
        {"Gear", with(GearShape{}, make_gear), 0.3, 1, 1},
        {"FlatGearWithManyTeeth", with(flat_gear_with_many_teeth(), make_gear), 0.3, 1, 1},
        {"GaltonBoard", with(GaltonBoardShape{}, make_galton_board), 0.4, galton_shells({}), 0},
        {"Drum", with(DrumShape{}, make_drum), 0.3, 1, 0},
        {"ShutDrum", with(shut_drum(), make_drum), 0.3, 2, 0},
        {"Fish", with(fish_of_phase(0.0), make_fish), 0.1, 1, 0},
        {"FishAThirdOfAPeriodLater", with(fish_of_phase(1.0 / 3.0), make_fish), 0.1, 1, 0},
        {"Box", with(BoxShape{}, make_box), 0.5, 1, 0},
        {"Icosphere", with(IcosphereShape{}, make_icosphere), 1.0, 1, 0},
        {"Wedge", with(WedgeShape{}, make_wedge), 0.3, 1, 0},
        {"TerrainBlock", with(terrain_block(), make_terrain), 12.0, 1, 0},
    };
}

class ClosedShapes : public testing::TestWithParam<ClosedShape> {};

void expect_sound(const TriangleMesh& mesh, const ClosedShape& shape) {
    EXPECT_EQ(unpaired_edges(mesh), 0U);
    EXPECT_EQ(unused_vertices(mesh), 0U);
    EXPECT_EQ(degenerate_triangles(mesh), 0U);
    EXPECT_EQ(shells(mesh), shape.shell_count);
    EXPECT_EQ(euler_characteristic(mesh), 2 * static_cast<long>(shape.shell_count) - 2 * shape.handles);
    EXPECT_GT(signed_volume(mesh), 0.0);
}

TEST_P(ClosedShapes, AreSoundAtTheirCoarsestAndDoNotCrossThemselves) {
    const TriangleMesh mesh = GetParam().build(GetParam().coarse_edge);
    expect_sound(mesh, GetParam());
    EXPECT_EQ(self_intersections(mesh), 0U);
}

TEST_P(ClosedShapes, AreSoundAtAboutAHundredThousandTriangles) {
    const TriangleMesh mesh = build_near(100'000, GetParam().coarse_edge, GetParam().build);
    EXPECT_NEAR(static_cast<double>(mesh.triangles.size()), 100'000.0, 8'000.0);
    expect_sound(mesh, GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, ClosedShapes, testing::ValuesIn(closed_shapes()),
                         [](const auto& test) { return test.param.name; });

TEST(MeshChecks, SeeAHoleAFlippedTriangleAndACrossing) {
    TriangleMesh box = make_box({}, 1.0);
    TriangleMesh holed = box;
    holed.triangles.pop_back();
    EXPECT_EQ(unpaired_edges(holed), 3U);
    TriangleMesh flipped = box;
    std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
    EXPECT_GT(unpaired_edges(flipped), 0U);
    TriangleMesh crossing = box;
    const auto offset = static_cast<std::uint32_t>(box.vertices.size());
    for (const Vec3& p : box.vertices) crossing.vertices.push_back(p + Vec3{0.3, 0.2, 0.1});
    for (const Triangle& t : box.triangles) crossing.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    EXPECT_GT(self_intersections(crossing), 0U);
    EXPECT_EQ(shells(crossing), 2U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::meshes
