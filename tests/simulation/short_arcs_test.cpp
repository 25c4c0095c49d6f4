// Arcs that end after almost no time.
#include <gtest/gtest.h>

#include <memory>

#include "ricochet/core/transform.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

// A marble in the bowl of scenes/hopper.json reaches the rim of its surface 3e-86 s after it landed there. The cubic
// between two positions that differ by rounding has coefficients of 1e239.
TEST(ShortArcs, ArcsOfAlmostNoTimeEndAtOnce) {
    Placement parts;
    parts.scale = {0.7, 0.7, 0.6};
    SimulationSetup setup = setup_of(0.002, 0.06, {"", 0.3, 0.4}, {0, 0, -9.81});
    setup.options.verify = true;
    auto mesh = std::make_shared<const TriangleMesh>(
        transformed(read_mesh(RICOCHET_SOURCE_DIR "/meshes/bowl.obj").mesh, parts));
    setup.colliders = {{"bowl", MeshShape{mesh, {}, "", {}}, 0}};
    Particle marble =
        particle_of({-0.10961507149467316, -0.22141907577870804, 0.10668257857079685},
                    {-0.81164339392908624, -1.2370234794113923, 0.52266322250028285}, 0.029424134892779404);
    marble.spin = {45.8604227056694, -26.807995849692219, 7.7682696142206815};
    setup.particles.push_back(marble);
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.particles().frozen[0], 0);
    EXPECT_EQ(simulation.statistics().frozen, 0U);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
