// Tests of memory that runs out at any allocation of a simulation. The simulation reports an error and loses only the
// object under construction. A repetition in the same process gives the same bits.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "support/allocation_guard.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::AllocationFault;

constexpr std::uint64_t kNoFault = std::uint64_t{1} << 60U;
constexpr std::uint64_t kSavedStep = 12;
constexpr std::uint64_t kSteps = 24;

/// Returns a verified scene with a mesh, a floor, drops with a limited lifetime, and a chain of springs.
SimulationSetup busy_setup() {
    SimulationSetup setup;
    setup.options.time_step = 0.02;
    setup.options.duration = 0.02 * kSteps;
    setup.options.seed = 3;
    setup.options.record_contacts = true;
    setup.options.verify = true;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    Material rough;
    rough.restitution = 0.4;
    rough.friction = 0.3;
    setup.materials.push_back(rough);
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    MeshShape box;
    box.mesh = std::make_shared<const TriangleMesh>(testing::box_mesh({-0.2, -0.2, 0.1}, {0.2, 0.2, 0.3}));
    setup.colliders.push_back({"box", box, 0});
    setup.attributes.push_back({"temperature", 1, {300.0, 0, 0}});
    EmitterDescription emitter;
    emitter.shape = DiskShape{{0, 0, 1}, {0, 0, -1}, 0.5};
    emitter.rate = {200.0, 60.0};
    emitter.lifetime = {0.3, 0.1};
    emitter.radius = {0.01, 0.005};
    setup.emitters.push_back(emitter);
    for (int i = 0; i < 4; ++i) {
        Particle particle;
        particle.position = {0.2 * i, 1.0, 0.4};
        particle.pinned = i == 0;
        setup.particles.push_back(particle);
        if (i > 0) setup.springs.push_back({static_cast<std::uint64_t>(i - 1), static_cast<std::uint64_t>(i), 0.2, 60});
    }
    return setup;
}

using Bytes = std::vector<std::byte>;

Bytes saved(const Simulation& simulation) {
    Bytes bytes;
    simulation.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    return bytes;
}

void restore(Simulation& simulation, const Bytes& bytes) {
    std::size_t at = 0;
    simulation.restore([&](std::span<std::byte> part) {
        if (bytes.size() - at < part.size()) throw InputError("the bytes end too early");
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
}

/// Creates a simulation, steps it, saves it, restores it in another one and steps that to the end. Returns the hash of
/// the final state.
std::uint64_t run_all() {
    Bytes bytes;
    {
        Simulation first(busy_setup());
        while (first.step_index() < kSavedStep) first.step();
        bytes = saved(first);
    }
    Simulation second(busy_setup());
    restore(second, bytes);
    second.advance(kSteps);
    return second.state_hash();
}

/// Returns the hash, or nothing if the lack of memory was reported. The report comes either from Ricochet or from
/// Embree through Ricochet.
std::optional<std::uint64_t> run_without(std::uint64_t allocation, AllocationFault::Later later,
                                         bool* by_embree = nullptr) {
    const AllocationFault fault(allocation, later);
    try {
        return run_all();
    } catch (const std::bad_alloc&) {
        return std::nullopt;
    } catch (const RunError&) {
        if (by_embree != nullptr) *by_embree = true;
        return std::nullopt;
    }
}

std::uint64_t count_allocations() {
    AllocationFault fault(kNoFault);
    (void)run_all();
    return fault.calls();
}

// Returns the distance between tested allocations: every one in a long run, otherwise an even sample.
std::uint64_t stride(std::uint64_t allocations) { return test::is_long_run() ? 1 : allocations / 60 + 1; }

TEST(NoMemory, AtAnyAllocationOfASimulationIsReportedAndTheNextOneHasTheSameBits) {
    const std::uint64_t hash = run_all();
    const std::uint64_t allocations = count_allocations();
    ASSERT_GT(allocations, 500U);
    int told = 0;
    for (std::uint64_t at = 1; at <= allocations; at += stride(allocations)) {
        const auto later = at % 2 == 0 ? AllocationFault::Later::fail : AllocationFault::Later::succeed;
        SCOPED_TRACE("allocation " + std::to_string(at) + " of " + std::to_string(allocations));
        const std::optional<std::uint64_t> disturbed = run_without(at, later);
        EXPECT_EQ(disturbed.value_or(hash), hash);
        if (!disturbed) ++told;
        EXPECT_EQ(run_all(), hash);
    }
    EXPECT_GT(told, 10);
}

// Uses one thread, because the working memory of threads grows with the blocks they happen to process.
TEST(NoMemory, AtAnyAllocationOfASimulationLeavesNoMemoryInUse) {
    const ThreadLimit limit(1);
    const std::uint64_t allocations = count_allocations();
    (void)run_all();
    std::size_t before = test::bytes_in_use();
    for (std::uint64_t at = 1; at <= allocations; at += stride(allocations)) {
        bool by_embree = false;
        (void)run_without(at, AllocationFault::Later::succeed, &by_embree);
        (void)run_all();
        const std::size_t after = test::bytes_in_use();
        if (by_embree && after > before && after - before < 1000) before = after;  // Embree 3 keeps 48 bytes of a build
        ASSERT_EQ(after, before) << "allocation " << at << " of " << allocations;
    }
}

/// Steps to the end while memory fails. Returns true if it reached the end.
bool steps_through(Simulation& simulation, std::uint64_t allocation) {
    const AllocationFault fault(allocation);
    try {
        simulation.advance(kSteps);
        return true;
    } catch (const std::bad_alloc&) {
        return false;
    } catch (const RunError&) {
        return false;
    }
}

TEST(NoMemory, InsideAStepLetsASimulationResumeFromASavedState) {
    Simulation reference(busy_setup());
    while (reference.step_index() < kSavedStep) reference.step();
    const Bytes bytes = saved(reference);
    std::uint64_t allocations = 0;
    {
        AllocationFault fault(kNoFault);
        reference.advance(kSteps);
        allocations = fault.calls();
    }
    ASSERT_GT(allocations, 20U);
    int failed = 0;
    for (std::uint64_t at = 1; at <= allocations; at += stride(allocations)) {
        SCOPED_TRACE("allocation " + std::to_string(at) + " of " + std::to_string(allocations));
        Simulation simulation(busy_setup());
        restore(simulation, bytes);
        if (!steps_through(simulation, at)) ++failed;
        Simulation other(busy_setup());
        restore(other, bytes);
        other.advance(kSteps);
        EXPECT_EQ(other.state_hash(), reference.state_hash());
        if (!simulation.finished()) {
            // A simulation that failed inside a step reports it. A simulation that failed between two steps can be
            // queried and continues.
            try {
                simulation.advance(kSteps);
                EXPECT_EQ(simulation.state_hash(), reference.state_hash());
            } catch (const RunError&) {
            }
        }
    }
    EXPECT_GT(failed, 0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
