/// \file
/// Time of one draw of each kind of random number.

#include "ricochet/core/random.h"

#include <benchmark/benchmark.h>

namespace ricochet {
namespace {

template <class Draw>
void time(benchmark::State& state, const Draw& draw) {
    RandomSequence random(1, 2, 3);
    for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(draw(random));
}

void philox(benchmark::State& state) {
    std::uint32_t counter = 0;
    for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(philox4x32({counter++, 0, 0, 0}, {1, 2}));
}
void uniform(benchmark::State& state) {
    time(state, [](RandomSequence& random) { return random.uniform(); });
}
void unit_vector(benchmark::State& state) {
    time(state, [](RandomSequence& random) { return random.unit_vector(); });
}
void in_unit_disk(benchmark::State& state) {
    time(state, [](RandomSequence& random) { return random.in_unit_disk(); });
}
void in_unit_ball(benchmark::State& state) {
    time(state, [](RandomSequence& random) { return random.in_unit_ball(); });
}
/// Draws like an emitter: a separate sequence for every particle, and some draws.
void new_sequence(benchmark::State& state) {
    std::uint64_t id = 0;
    for ([[maybe_unused]] auto _ : state) {
        RandomSequence random(1, 2, id++);
        benchmark::DoNotOptimize(random.in_unit_ball());
    }
}
BENCHMARK(philox);
BENCHMARK(uniform);
BENCHMARK(unit_vector);
BENCHMARK(in_unit_disk);
BENCHMARK(in_unit_ball);
BENCHMARK(new_sequence);

}  // namespace
}  // namespace ricochet
