// Simulations are created, stepped and destroyed, and meshes are read, many times in one process. Memory, open files
// and threads must not grow.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "faults/process_use.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"
#include "support/allocation_guard.h"
#include "support/counts.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr const char* kScene = R"({
  "ricochet": 1,
  "simulation": {"time_step": 0.01, "duration": 0.05, "seed": 5},
  "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
  "materials": {"plain": {"restitution": 0.4, "friction": 0.3}},
  "colliders": [{"name": "roof", "type": "mesh", "file": "roof.off", "material": "plain"},
                {"name": "ball", "type": "sphere", "radius": 0.1, "material": "plain"}],
  "emitters": [{"type": "box", "center": [0, 0, 0.3], "size": [1, 1, 0.2], "burst": 20,
                "particle_radius": [0.01, 0.005]}],
  "output": {"contacts": true}
})";
constexpr const char* kMesh = "OFF\n4 2 0\n-1 -1 0.2\n1 -1 0.1\n1 1 0.2\n-1 1 0.1\n3 0 1 2\n3 0 2 3\n";

/// Reads the scene and the mesh, runs, saves and destroys the simulation. Returns the hash of the final state.
std::uint64_t open_and_close(const test::TemporaryFolder& folder) {
    const ImportedMesh mesh = read_mesh(folder.path("roof.off"));
    EXPECT_EQ(mesh.mesh.triangles.size(), 2U);
    Simulation simulation(read_scene(folder.path("scene.json")).setup);
    simulation.advance(simulation.step_count());
    std::size_t saved = 0;
    simulation.save([&](std::span<const std::byte> bytes) { saved += bytes.size(); });
    EXPECT_GT(saved, 0U);
    return simulation.state_hash();
}

TEST(ManyCycles, OpeningAndClosingNeedNoMoreMemoryFilesAndThreads) {
    const test::TemporaryFolder folder;
    (void)folder.write("scene.json", kScene);
    (void)folder.write("roof.off", kMesh);
    const int cycles = test::scaled(500) * test::case_factor(20);
    // After some cycles every thread has allocated its working memory, independent of the assignment of work.
    const int warm_up = cycles / 5 + 5;
    const std::uint64_t hash = open_and_close(folder);
    for (int k = 0; k < warm_up; ++k) ASSERT_EQ(open_and_close(folder), hash);
    const std::size_t resident = test::resident_bytes();
    const std::size_t in_use = test::bytes_in_use();
    const std::size_t files = test::count_in_proc("self/fd");
    const std::size_t threads = test::count_in_proc("self/task");
    for (int k = 0; k < cycles; ++k) ASSERT_EQ(open_and_close(folder), hash) << "cycle " << k;
    EXPECT_LE(test::bytes_in_use(), in_use + 4096);
    EXPECT_EQ(test::count_in_proc("self/fd"), files);
    EXPECT_LE(test::count_in_proc("self/task"), threads);
    if (!test::kSanitized) {  // sanitizers keep freed memory
        EXPECT_LE(test::resident_bytes(), resident + resident / 100) << "from " << resident << " bytes";
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
