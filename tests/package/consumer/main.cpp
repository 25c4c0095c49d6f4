#include <cstdio>

#include "ricochet/ricochet.h"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    ricochet::Simulation simulation(ricochet::read_scene(argv[1]).setup);
    simulation.advance(simulation.step_count());
    std::printf("%zu particles after %g s, state %016lx\n", simulation.particles().size(), simulation.time(),
                simulation.state_hash());
}
