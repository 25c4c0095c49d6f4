#include "cli/collider_quantity.h"

#include <gtest/gtest.h>

#include "cli/run_program.h"
#include "run/vtp_reader.h"
#include "support/temporary_folder.h"

namespace ricochet::cli {
namespace RICOCHET_FILE {

using test::run_ricochet;
using test::TemporaryFolder;

TEST(ColliderQuantity, ItsTextDefinesItsUnit) {
    const auto unit = [](const char* text) { return collider_quantity_from(text)->unit(); };
    EXPECT_EQ(unit("hits"), "");
    EXPECT_EQ(unit("hits/area"), "1/m2");
    EXPECT_EQ(unit("impulse/time"), "N s/s");
    EXPECT_EQ(unit("energy/area/time"), "J/(m2 s)");
    EXPECT_EQ(unit("energy/time/area"), "J/(m2 s)");
    for (const char* wrong : {"", "hit", "hits/", "hits/mass", "energy/area/area", "impulse/areatime"}) {
        EXPECT_FALSE(collider_quantity_from(wrong)) << wrong;
    }
}

// A point of 2 kg hits a box of 2 m x 2 m at 3 m/s and leaves at half that speed.
TEST(ColliderQuantity, EnergyIsTheLossOfTheParticleInTheImpact) {
    const TemporaryFolder folder;
    const auto scene = folder.write("s.json", R"({"ricochet": 1, "simulation": {"time_step": 0.1, "duration": 1},
        "materials": {"m": {"restitution": 0.5}},
        "colliders": [{"name": "box", "type": "box", "size": [2, 2, 2], "material": "m"}],
        "particles": [{"position": [0.2, 0.3, 2], "velocity": [0, 0, -3], "mass": 2}],
        "output": {"every": 10, "contacts": true}})");
    const std::string output = folder.path("out").string();
    ASSERT_EQ(run_ricochet({"run", scene.string(), "--output", output, "--quiet"}).exit_code, 0);
    const RunFolder run = open_run_folder(output);
    const TriangleEnergies energies = triangle_energies(run);
    const VtkPolyData box = read_vtp(run.colliders[0]);
    const auto sum = [&](const char* text) {
        double total = 0.0;
        for (const double value :
             quantity_values(*collider_quantity_from(text), box, run.info.colliders[0], 0, energies, box.time)) {
            total += value;
        }
        return total;
    };
    EXPECT_NEAR(sum("energy"), 0.5 * 2.0 * (9.0 - 2.25), 1e-12);
    EXPECT_NEAR(sum("energy/area/time"), 6.75 / 2.0 / 1.0, 1e-9);  // its triangle has half the area of the face
    EXPECT_NEAR(sum("impulse"), 2.0 * 4.5, 1e-6);
    EXPECT_EQ(sum("hits"), 1.0);
}

TEST(ColliderQuantity, TheUpperEndOfTheRangeExcludesAHundredthOfTheArea) {
    EXPECT_EQ(upper_value({}), 1.0);
    EXPECT_EQ(upper_value({{0.0, 5.0}}), 1.0);
    EXPECT_EQ(upper_value({{3.0, 1.0}, {1e9, 1e-4}, {2.0, 1.0}, {0.0, 100.0}}), 3.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::cli
