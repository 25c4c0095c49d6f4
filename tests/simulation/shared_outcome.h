/// \file
/// Runs shared by ranks, which are threads of the test, and their complete outcome. Scenes for such runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"
#include "support/thread_ranks.h"

namespace ricochet::testing {

using Bytes = std::vector<std::byte>;

/// The complete outcome of a run.
struct Outcome {
    std::uint64_t state = 0;
    std::uint64_t contacts = 0;  ///< hash of all contact records in order
    Bytes saved;                 ///< counters, particles, totals, loads
    bool operator==(const Outcome&) const = default;
};

/// A state: either complete, or split into the particles of each rank and the rest.
struct State {
    Bytes rest;
    std::vector<Bytes> particles;
};

inline Bytes saved(const Simulation& simulation) {
    Bytes bytes;
    simulation.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    return bytes;
}

inline ByteSource source_of(const Bytes& bytes) {
    return [&bytes, at = std::size_t{0}](std::span<std::byte> part) mutable {
        if (bytes.size() - at < part.size()) throw InputError("the state ends too early");
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    };
}

inline void add(StateHash& hash, const ContactRecord& record) {
    hash.add(record.time), hash.add(record.particle), hash.add(std::uint64_t{record.surface});
    hash.add(record.position), hash.add(record.velocity_before), hash.add(record.velocity_after);
}

using MakeSetup = std::function<SimulationSetup()>;

/// Runs at most `until` steps. Returns the outcome of the first rank.
inline Outcome run(const MakeSetup& make, const std::shared_ptr<Ranks>& ranks, const State& from = {},
                   std::uint64_t until = ~std::uint64_t{0}) {
    SimulationSetup setup = make();
    setup.options.record_contacts = true;
    setup.ranks = ranks;
    Simulation simulation(std::move(setup));
    if (!from.rest.empty()) simulation.restore(source_of(from.rest));
    for (const Bytes& part : from.particles) simulation.restore_particles(source_of(part));
    Outcome outcome;
    StateHash contacts;
    while (!simulation.finished() && simulation.step_index() < until) {
        const auto after_step = [&] {
            simulation.show_whole(Shown::contacts, [&] {
                for (const ContactRecord& record : simulation.contact_records()) add(contacts, record);
            });
            return true;
        };
        simulation.advance(std::min<std::uint64_t>(7, until - simulation.step_index()), after_step);
        simulation.show_whole(Shown::particles, [&] { (void)simulation.particles().size(); });
    }
    simulation.show_whole(Shown::all, [&] {
        outcome.state = simulation.state_hash();
        outcome.saved = saved(simulation);
    });
    outcome.contacts = contacts.value();
    return outcome;
}

inline Outcome run_on(std::size_t count, const MakeSetup& make, const State& from = {},
                      std::uint64_t until = ~std::uint64_t{0}) {
    Outcome outcome;
    on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
        const Outcome mine = run(make, ranks, from, until);
        if (ranks->rank() == 0) outcome = mine;
    });
    return outcome;
}

/// Returns the state after the given number of steps, as each rank saves it.
inline State saved_by_each(std::size_t count, const MakeSetup& make, std::uint64_t steps) {
    State state;
    state.particles.resize(count);
    on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
        SimulationSetup setup = make();
        setup.options.record_contacts = true;
        setup.ranks = ranks;
        Simulation simulation(std::move(setup));
        simulation.advance(steps);
        simulation.save_particles([&](std::span<const std::byte> bytes) {
            Bytes& part = state.particles[ranks->rank()];
            part.insert(part.end(), bytes.begin(), bytes.end());
        });
        simulation.show_whole(Shown::all_but_particles, [&] { state.rest = saved(simulation); });
    });
    return state;
}

/// Returns the message of a run that diverges, or "none" if it does not.
inline std::string divergence_of(const MakeSetup& make, const std::shared_ptr<Ranks>& ranks) {
    try {
        (void)run(make, ranks);
    } catch (const DivergedError& error) {
        return error.what();
    }
    return "none";
}

/// Describes the difference in words, for a message.
inline std::string difference(const Outcome& a, const Outcome& b) {
    if (a.state != b.state) return "states differ";
    if (a.contacts != b.contacts) return "contacts differ";
    if (a.saved.size() != b.saved.size()) return "saved states have different lengths";
    for (std::size_t k = 0; k < a.saved.size(); ++k) {
        if (a.saved[k] != b.saved[k]) return "saved states differ at byte " + std::to_string(k);
    }
    return "none";
}

/// Returns drops that bounce, burst and spawn others in flight, with a limit below their number.
inline SimulationSetup busy_setup() {
    Material rough;
    rough.restitution = 0.6;
    rough.friction = 0.3;
    rough.diffuse = 0.2;
    rough.absorption = 0.02;
    SimulationSetup setup = setup_of(0.01, 1.2, rough, {0, 0, -9.81});
    setup.options.seed = 5;
    setup.options.most_particles = 300;
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    setup.attributes.push_back({"temperature", 1, {300.0, 0, 0}});
    setup.bounds = Box3{{-4, -4, -1}, {4, 4, 5}};
    EmitterDescription rain;
    rain.name = "rain";
    rain.shape = DiskShape{{0, 0, 1}, {0, 0, -1}, 0.5};
    rain.rate = {400.0, 80.0};
    rain.burst = 70;
    rain.lifetime = {0.7, 0.2};
    rain.radius = {0.01, 0.005};
    setup.emitters.push_back(rain);
    for (const BirthEvent on : {BirthEvent::life, BirthEvent::impact, BirthEvent::death}) {
        EmitterDescription children;
        children.parent.emplace();
        children.parent->on = on;
        children.parent->count = {1.5, 1.0};
        children.parent->share = on == BirthEvent::death;
        children.speed = {1.0, 0.5};
        children.lifetime = {0.2, 0.1};
        if (on == BirthEvent::life) children.rate = {3.0, 1.0};
        setup.emitters.push_back(children);
    }
    for (int i = 0; i < 100; ++i) setup.particles.push_back(particle_of({0.05 * i - 2.5, 1.0, 0.3}, {0, 0.1 * i, 0}));
    return setup;
}

/// Returns particles that rest, sleep and wake on a belt, and some that spend their bounce budget in a wedge.
inline SimulationSetup belt_setup() {
    Material belt;
    belt.restitution = 0.3;
    belt.friction = 0.5;
    belt.motion.velocity = {0.7, 0, 0};
    SimulationSetup setup = setup_of(0.02, 1.5, belt, {0, 0, -9.81});
    setup.materials.push_back(Material{});
    setup.options.bounce_budget = 3;
    setup.colliders.push_back({"belt", PlaneShape{{}, {0, 0, 1}}, 0});
    setup.colliders.push_back({"left", PlaneShape{{0, 0, 0.2}, {0, 1, 0.05}}, 1});
    setup.colliders.push_back({"right", PlaneShape{{0, 0.1, 0.2}, {0, -1, 0.05}}, 1});
    for (int i = 0; i < 150; ++i) {
        setup.particles.push_back(particle_of({0.1 * i, 0.05, 0.3 + 0.001 * i}, {0, 9.0 + 0.1 * i, 0}, i % 2 * 0.01));
    }
    for (int i = 0; i < 40; ++i) setup.particles.push_back(particle_of({0.1 * i, 5.0, 0.2}, {0.01 * i, 0, 0}));
    return setup;
}

/// Returns a run of mostly children of few parents. They live on the ranks of their parents.
inline SimulationSetup family_setup() {
    Material soft;
    soft.restitution = 0.5;
    soft.friction = 0.4;
    SimulationSetup setup = setup_of(0.01, 1.0, soft, {0, 0, -9.81});
    setup.options.seed = 11;
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    EmitterDescription pair;
    pair.name = "parents";
    pair.shape = DiskShape{{0, 0, 0.1}, {0, 0, -1}, 0.5};
    pair.burst = 4;
    pair.speed = {1.0, 0.2};
    pair.lifetime = {0.5, 0.0};
    setup.emitters.push_back(pair);
    EmitterDescription children;
    children.parent.emplace();
    children.parent->on = BirthEvent::life;
    children.rate = {300.0, 50.0};
    children.speed = {0.3, 0.2};
    children.radius = {0.005, 0.002};
    setup.emitters.push_back(children);
    return setup;
}

}  // namespace ricochet::testing
