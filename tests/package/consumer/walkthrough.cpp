// Builds a run of a hundred grains in a bowl without a scene file, queries it, changes it and saves it.
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <span>
#include <vector>

#include "ricochet/ricochet.h"

using namespace ricochet;

SimulationSetup grains_in_a_bowl(const char* mesh_file) {
    SimulationSetup setup;
    setup.options.time_step = 1.0 / 240.0;
    setup.options.duration = 4.0;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.materials.push_back({"steel", 0.6, 0.3});
    const auto mesh = std::make_shared<const TriangleMesh>(read_mesh(mesh_file).mesh);
    setup.colliders.push_back({"bowl", MeshShape{mesh, {}, mesh_file}});
    setup.colliders.push_back({"ground", PlaneShape{{0, 0, -3}, {0, 0, 1}}});
    EmitterDescription tap;
    tap.name = "tap";
    tap.shape = DiskShape{{0, 0, 2}, {0, 0, -1}, 0.3};
    tap.rate = {50.0, 0.0};
    tap.stop = 2.0;
    tap.radius = {0.02, 0.0};
    setup.emitters.push_back(tap);
    return setup;
}

void run(const char* mesh_file) {
    const ThreadLimit limit(2);  // results do not depend on the number of threads
    Simulation simulation(grains_in_a_bowl(mesh_file));

    std::size_t impacts = 0;
    simulation.on_contact([&](std::span<const ContactRecord> records) { impacts += records.size(); });

    // Find the bowl. Queries need no particles.
    if (const auto hit = simulation.collisions().first_hit({0, 0, 5}, {0, 0, -1})) {
        std::printf("below (0, 0, 5) is \"%s\" at z = %.3f m\n",
                    simulation.colliders()[hit->surface.collider].name.c_str(), hit->point.z);
    }

    // Simulate one second, then add a heavy falling ball.
    while (!simulation.finished() && simulation.time() < 1.0) simulation.step();
    Particle ball;
    ball.position = {0.2, 0, 3};
    ball.radius = 0.1;
    ball.mass = 5.0;
    const std::uint64_t id = simulation.add_particle(ball);

    // A saved state continues with the same bits in another simulation of the same setup.
    std::vector<std::byte> bytes;
    simulation.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    Simulation twin(grains_in_a_bowl(mesh_file));
    std::span<const std::byte> rest(bytes);
    twin.restore([&](std::span<std::byte> part) {
        if (part.size() > rest.size()) throw InputError("the saved state ends too early");
        std::memcpy(part.data(), rest.data(), part.size());
        rest = rest.subspan(part.size());
    });

    simulation.advance(simulation.step_count());
    twin.advance(twin.step_count());
    std::printf("%zu particles, %zu impacts, ball %llu among them; the twin is %s\n", simulation.particles().size(),
                impacts, static_cast<unsigned long long>(id),
                simulation.state_hash() == twin.state_hash() ? "the same" : "another");
}

int main(int argc, char** argv) {
    try {
        if (argc != 2) throw InputError("usage: walkthrough MESH");
        run(argv[1]);
    } catch (const InputError& error) {  // the text names the problem, its location and the expected value
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    } catch (const RunError& error) {  // for example, the disk is full or the motion has diverged
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
