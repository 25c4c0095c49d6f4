/// \file
/// Time of one call of the exact predicates, by the deciding stage: the filter, double-double, or expansions.

#include "ricochet/geometry/predicates/predicates.h"

#include <benchmark/benchmark.h>

#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace {

struct SegmentTriangle {
    Vec3 p, q, a, b, c;
};

class Cases {
public:
    /// Returns case i of 4096 cases with keep(case). change(case, random) makes each case special first.
    template <typename Change, typename Keep>
    Cases(const Change& change, const Keep& keep) {
        while (cases_.size() < 4096) {
            SegmentTriangle s{point(), point(), point(), point(), point()};
            change(s, random_);
            if (keep(s)) cases_.push_back(s);
        }
    }

    template <typename Call>
    void time(benchmark::State& state, const Call& call) const {
        std::size_t i = 0;
        for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(call(cases_[i++ % cases_.size()]));
    }

private:
    Vec3 point() { return 2.0 * random_.in_unit_ball(); }

    RandomSequence random_{1, 0, 0};
    std::vector<SegmentTriangle> cases_;
};

const auto kUnchanged = [](SegmentTriangle&, RandomSequence&) {};
const auto kAny = [](const SegmentTriangle&) { return true; };
const auto kMeets = [](const SegmentTriangle& s) { return segment_intersects_triangle(s.p, s.q, s.a, s.b, s.c); };

bool on_one_side(const SegmentTriangle& s) { return orient3d(s.a, s.b, s.c, s.p) == orient3d(s.a, s.b, s.c, s.q); }

/// Rounds an end into the triangle's plane.
void put_end_into_plane(SegmentTriangle& s, RandomSequence& random) {
    const double u = random.uniform();
    const double v = (1.0 - u) * random.uniform();
    s.p = s.a + u * (s.b - s.a) + v * (s.c - s.a);
}

void aim_at_vertex(SegmentTriangle& s, RandomSequence&) { s.q = s.a + (s.a - s.p); }

void flatten(SegmentTriangle& s, RandomSequence&) {
    for (Vec3* point : {&s.p, &s.q, &s.a, &s.b, &s.c}) point->z = 0.3;
}

void meets_same_side(benchmark::State& state) { Cases(kUnchanged, on_one_side).time(state, kMeets); }
void meets_past_the_rim(benchmark::State& state) {
    Cases(kUnchanged, [](const SegmentTriangle& s) { return !on_one_side(s) && !kMeets(s); }).time(state, kMeets);
}
void meets_hit(benchmark::State& state) { Cases(kUnchanged, kMeets).time(state, kMeets); }
void meets_end_in_plane(benchmark::State& state) { Cases(put_end_into_plane, kAny).time(state, kMeets); }
void meets_at_vertex(benchmark::State& state) { Cases(aim_at_vertex, kAny).time(state, kMeets); }
void meets_coplanar(benchmark::State& state) { Cases(flatten, kAny).time(state, kMeets); }
BENCHMARK(meets_same_side);
BENCHMARK(meets_past_the_rim);
BENCHMARK(meets_hit);
BENCHMARK(meets_end_in_plane);
BENCHMARK(meets_at_vertex);
BENCHMARK(meets_coplanar);

const auto kFraction = [](const SegmentTriangle& s) { return crossing_fraction(s.p, s.q, s.a, s.b, s.c); };
void fraction_hit(benchmark::State& state) { Cases(kUnchanged, kMeets).time(state, kFraction); }
void fraction_end_in_plane(benchmark::State& state) { Cases(put_end_into_plane, kMeets).time(state, kFraction); }
BENCHMARK(fraction_hit);
BENCHMARK(fraction_end_in_plane);

void normal_generic(benchmark::State& state) {
    Cases(kUnchanged, kAny).time(state, [](const SegmentTriangle& s) { return unit_normal(s.a, s.b, s.c); });
}
BENCHMARK(normal_generic);

}  // namespace
}  // namespace ricochet
