/// \file
/// Time to find a polynomial's roots, by degree: with all roots in the interval, with none, with a double root.

#include "ricochet/geometry/sweep/polynomial.h"

#include <benchmark/benchmark.h>

#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace {

/// Returns the polynomial (s - r0) (s - r1) ... on [0, 1], plus `lift`.
Polynomial with_roots(const std::vector<double>& roots, double lift) {
    Polynomial p;
    p.duration = 1.0;
    p.degree = static_cast<int>(roots.size());
    std::vector<double> c{1.0};
    for (const double root : roots) {
        c.insert(c.begin(), 0.0);
        for (std::size_t k = 0; k + 1 < c.size(); ++k) c[k] -= root * c[k + 1];
    }
    c.front() += lift;
    for (std::size_t k = 0; k < c.size(); ++k) p.coefficients[k] = DoubleDouble{c[k]};
    return p;
}

enum class Kind { all_inside, none, double_root };

Polynomial make(Kind kind, int degree, RandomSequence& random) {
    std::vector<double> roots;
    for (int k = 0; k < degree; ++k) roots.push_back(random.uniform());
    if (kind == Kind::double_root && degree > 1) roots[1] = roots[0];
    return with_roots(roots, kind == Kind::none ? 2.0 : 0.0);
}

template <class Call>
void time(benchmark::State& state, Kind kind, const Call& call) {
    RandomSequence random(1, 0, 0);
    std::vector<Polynomial> polynomials;
    while (polynomials.size() < 1024) {
        polynomials.push_back(make(kind, static_cast<int>(state.range(0)), random));
    }
    std::size_t i = 0;
    for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(call(polynomials[i++ % polynomials.size()]));
}

const auto kSigns = [](const Polynomial& p) { return sign_changes(p); };
const auto kDescent = [](const Polynomial& p) { return first_descent(p, 0.0, p.duration); };
const auto kPositive = [](const Polynomial& p) { return is_certainly_positive(p, p.duration); };

void roots_all_inside(benchmark::State& state) { time(state, Kind::all_inside, kSigns); }
void roots_none(benchmark::State& state) { time(state, Kind::none, kSigns); }
void roots_double(benchmark::State& state) { time(state, Kind::double_root, kSigns); }
void descent_among_many(benchmark::State& state) { time(state, Kind::all_inside, kDescent); }
void certainly_positive(benchmark::State& state) { time(state, Kind::none, kPositive); }
BENCHMARK(roots_all_inside)->ArgName("degree")->DenseRange(1, 6);
BENCHMARK(roots_none)->ArgName("degree")->DenseRange(1, 6);
BENCHMARK(roots_double)->ArgName("degree")->DenseRange(2, 6);
BENCHMARK(descent_among_many)->ArgName("degree")->DenseRange(1, 6);
BENCHMARK(certainly_positive)->ArgName("degree")->DenseRange(1, 6);

}  // namespace
}  // namespace ricochet
