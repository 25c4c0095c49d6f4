#include "ricochet/core/keyed_curve.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Keys = std::vector<CurveKey<double>>;
using VectorKeys = std::vector<CurveKey<Vec3>>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kInterpolations = {Interpolation::linear, Interpolation::slow_in_slow_out, Interpolation::spline,
                                        Interpolation::cubic_spline};

Keys random_keys(RandomSequence& random) {
    Keys keys;
    double time = random.uniform_around(0.0, 5.0);
    const int count = 2 + static_cast<int>(random.uniform() * 6.0);
    for (int k = 0; k < count; ++k) {
        keys.push_back({time, random.uniform_around(0.0, 3.0)});
        time += 0.05 + random.uniform();
    }
    return keys;
}

std::string message_of(const Keys& keys, CurveEnds ends = CurveEnds::hold) {
    try {
        const KeyedCurve<double> curve(keys, Interpolation::spline, ends);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(KeyedCurve, OneKeyIsTheSameValueAtAllTimes) {
    for (const Interpolation interpolation : kInterpolations) {
        const KeyedCurve<double> curve(Keys{{2.0, 7.5}}, interpolation);
        for (const double time : {-kInfinity, -1.0, 2.0, 3.0, kInfinity}) {
            EXPECT_EQ(curve.value(time), 7.5);
            EXPECT_EQ(curve.derivative(time), 0.0);
        }
    }
    EXPECT_EQ(KeyedCurve<Vec3>(Vec3{1, 2, 3}).value(9.0), Vec3(1, 2, 3));
    EXPECT_EQ(KeyedCurve<Vec3>().value(9.0), Vec3());
}

TEST(KeyedCurve, LinearIsTheStraightLineBetweenKeys) {
    const KeyedCurve<double> curve(Keys{{1.0, 10.0}, {3.0, 20.0}, {4.0, 0.0}});
    EXPECT_EQ(curve.value(1.5), 12.5);
    EXPECT_EQ(curve.derivative(1.5), 5.0);
    EXPECT_EQ(curve.value(3.25), 15.0);
    EXPECT_EQ(curve.derivative(3.25), -20.0);
    EXPECT_EQ(curve.derivative(3.0), -20.0);  // the slope of the next segment
}

TEST(KeyedCurve, SlowInSlowOutIsTheCubicEaseAtRestAtEveryKey) {
    const KeyedCurve<double> curve(Keys{{1.0, 10.0}, {3.0, 20.0}, {4.0, 0.0}}, Interpolation::slow_in_slow_out);
    EXPECT_EQ(curve.value(1.5), 10.0 + 10.0 * (3.0 / 16.0 - 2.0 / 64.0));
    EXPECT_EQ(curve.derivative(2.0), 1.5 * 10.0 / 2.0);
    for (const double time : {1.0, 3.0, 4.0}) EXPECT_EQ(curve.derivative(time), 0.0);
}

TEST(KeyedCurve, SplineOnEvenKeysIsACatmullRomSpline) {
    const Keys keys{{0.0, 1.0}, {1.0, -2.0}, {2.0, 4.0}, {3.0, 3.0}};
    const KeyedCurve<double> curve(keys, Interpolation::spline);
    for (const double s : {0.0, 0.1, 0.5, 0.75, 0.99}) {
        const double p0 = keys[0].value;
        const double p1 = keys[1].value;
        const double p2 = keys[2].value;
        const double p3 = keys[3].value;
        const double expected = 0.5 * (2.0 * p1 + (p2 - p0) * s + (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) * s * s +
                                       (3.0 * p1 - p0 - 3.0 * p2 + p3) * s * s * s);
        const double slope = 0.5 * ((p2 - p0) + 2.0 * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) * s +
                                    3.0 * (3.0 * p1 - p0 - 3.0 * p2 + p3) * s * s);
        EXPECT_NEAR(curve.value(1.0 + s), expected, 1e-14);
        EXPECT_NEAR(curve.derivative(1.0 + s), slope, 1e-13);
    }
}

TEST(KeyedCurve, SplineThroughUnevenKeysOfAParabolaIsTheParabola) {
    Keys keys;
    for (const double t : {-1.0, 0.3, 0.5, 2.0, 2.25, 4.0}) keys.push_back({t, 3.0 - 2.0 * t + 0.7 * t * t});
    const KeyedCurve<double> curve(keys, Interpolation::spline);
    for (double t = 0.3; t <= 2.25; t += 0.01) {  // the outermost segments end at rest instead
        EXPECT_NEAR(curve.value(t), 3.0 - 2.0 * t + 0.7 * t * t, 1e-14);
        EXPECT_NEAR(curve.derivative(t), -2.0 + 1.4 * t, 1e-13);
    }
}

TEST(KeyedCurve, TheDerivativeMatchesDifferencesOfTheValueInEverySegment) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        RandomSequence random(seed, 0, 0);
        const Keys keys = random_keys(random);
        for (const Interpolation interpolation : kInterpolations) {
            for (const CurveEnds ends : {CurveEnds::hold, CurveEnds::repeat}) {
                const KeyedCurve<double> curve(keys, interpolation, ends);
                const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(keys.size() - 1));
                const double h = (keys[k + 1].time - keys[k].time) / 8.0;
                const double time = keys[k].time + h * (2.0 + 4.0 * random.uniform());
                // The fourth-order central difference is exact for cubics.
                const double difference = (8.0 * (curve.value(time + h) - curve.value(time - h)) -
                                           (curve.value(time + 2.0 * h) - curve.value(time - 2.0 * h))) /
                                          (12.0 * h);
                EXPECT_NEAR(curve.derivative(time), difference, 1e-11 * (1.0 + 1.0 / h)) << "seed " << seed;
            }
        }
    }
}

TEST(KeyedCurve, TheSecondDerivativeMatchesDifferencesOfTheDerivative) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        RandomSequence random(seed, 1, 0);
        const Keys keys = random_keys(random);
        for (const Interpolation interpolation : kInterpolations) {
            for (const CurveEnds ends : {CurveEnds::hold, CurveEnds::repeat}) {
                const KeyedCurve<double> curve(keys, interpolation, ends);
                const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(keys.size() - 1));
                const double h = (keys[k + 1].time - keys[k].time) / 4.0;
                const double time = keys[k].time + h * (1.0 + 2.0 * random.uniform());
                // The central difference of a parabola is exact.
                const double difference = (curve.derivative(time + h) - curve.derivative(time - h)) / (2.0 * h);
                EXPECT_NEAR(curve.second_derivative(time), difference, 1e-11 * (1.0 + 1.0 / (h * h)))
                    << "seed " << seed;
            }
        }
    }
    const KeyedCurve<double> ease(Keys{{1.0, 10.0}, {3.0, 20.0}, {4.0, 0.0}}, Interpolation::slow_in_slow_out);
    EXPECT_EQ(ease.second_derivative(1.0), 6.0 * 10.0 / 4.0);
    EXPECT_EQ(ease.second_derivative(2.0), 0.0);
    EXPECT_EQ(ease.second_derivative(3.0), -6.0 * 20.0);  // of the next segment
    for (const double time : {0.0, 4.0, 9.0}) EXPECT_EQ(ease.second_derivative(time), 0.0);
}

// A bound is at least the derivative at every time of the interval, and not much larger than the largest derivative.
TEST(KeyedCurve, BoundsHoldWithinTheirInterval) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        RandomSequence random(seed, 2, 0);
        const Keys keys = random_keys(random);
        for (const Interpolation interpolation : kInterpolations) {
            for (const CurveEnds ends : {CurveEnds::hold, CurveEnds::repeat}) {
                const KeyedCurve<double> curve(keys, interpolation, ends);
                const double from = keys.front().time - 1.0 + 4.0 * random.uniform();
                const double to = from + 0.01 + 4.0 * random.uniform();
                const DerivativeBounds bounds = curve.bounds(from, to);
                for (int k = 0; k <= 400; ++k) {
                    const double time = k == 400 ? to : from + (to - from) * (k / 400.0);
                    ASSERT_LE(std::fabs(curve.value(time)), bounds[0] * (1.0 + 1e-12));
                    ASSERT_LE(std::fabs(curve.derivative(time)), bounds[1] * (1.0 + 1e-12));
                    ASSERT_LE(std::fabs(curve.second_derivative(time)), bounds[2] * (1.0 + 1e-12) + 1e-12);
                    const double h = 1e-3 * (to - from);
                    if (time + h > to || curve.next_key(time) <= time + h) continue;
                    const double third = (curve.second_derivative(time + h) - curve.second_derivative(time)) / h;
                    ASSERT_LE(std::fabs(third), bounds[3] * (1.0 + 1e-9) + 1e-9 / h);
                }
                EXPECT_EQ(bounds[4], 0.0);
            }
        }
    }
}

TEST(KeyedCurve, BoundsWithinOneSegmentAreExact) {
    const Keys keys{{1.0, 10.0}, {3.0, 20.0}, {4.0, 0.0}};
    const KeyedCurve<double> line(keys);
    EXPECT_EQ(line.bounds(1.2, 2.0), (DerivativeBounds{11.0 + 5.0 * 0.8, 5.0, 0, 0, 0}));
    EXPECT_EQ(line.bounds(2.0, 3.5)[1], 20.0);
    EXPECT_EQ(line.bounds(5.0, 6.0), (DerivativeBounds{0, 0, 0, 0, 0}));
    EXPECT_EQ(line.bounds(0.0, 1.0), (DerivativeBounds{10, 0, 0, 0, 0}));
    const KeyedCurve<double> ease(keys, Interpolation::slow_in_slow_out);
    const DerivativeBounds bounds = ease.bounds(1.0, 3.0);
    EXPECT_EQ(bounds[1], 1.5 * 5.0);
    EXPECT_EQ(bounds[2], 6.0 * 5.0 / 2.0);
    EXPECT_EQ(bounds[3], 12.0 * 5.0 / 4.0);
}

// exp(a t) times exp(b t) is exp((a + b) t). By the binomial theorem, its derivatives are the powers of a + b.
TEST(DerivativeBounds, FollowTheLeibnizRuleForProducts) {
    const auto powers = [](double a) { return DerivativeBounds{1.0, a, a * a, a * a * a, a * a * a * a}; };
    EXPECT_EQ(product(powers(2.0), powers(3.0)), powers(5.0));
    EXPECT_EQ(product(powers(0.5), powers(0.25)), powers(0.75));
    EXPECT_EQ(product({7, 1, 2, 3, 4}, {1, 0, 0, 0, 0}), (DerivativeBounds{7, 1, 2, 3, 4}));
}

TEST(KeyedCurve, TheNextKeyIsTheFirstOneAfterTheTime) {
    const Keys keys{{1.0, 10.0}, {3.0, 20.0}, {4.0, 0.0}};
    const KeyedCurve<double> held(keys);
    EXPECT_EQ(held.next_key(-5.0), 1.0);
    EXPECT_EQ(held.next_key(1.0), 3.0);
    EXPECT_EQ(held.next_key(2.9), 3.0);
    EXPECT_EQ(held.next_key(3.0), 4.0);
    EXPECT_EQ(held.next_key(4.0), kInfinity);
    EXPECT_EQ(KeyedCurve<double>(2.0).next_key(-1.0), 0.0);  // one key, at 0 s
    const KeyedCurve<double> repeated(keys, Interpolation::spline, CurveEnds::repeat);
    std::vector<double> times;
    for (double time = 1.0; times.size() < 7; time = times.back()) times.push_back(repeated.next_key(time));
    EXPECT_EQ(times, (std::vector<double>{3, 4, 6, 7, 9, 10, 12}));
    EXPECT_EQ(repeated.next_key(-0.5), 0.0);
    EXPECT_EQ(repeated.next_key(-2.0), 0.0);
    EXPECT_EQ(repeated.next_key(-2.5), -2.0);
}

TEST(KeyedCurve, PassesThroughEveryKeyAndSmoothCurvesHaveContinuousDerivatives) {
    constexpr double kEpsilon = 1e-9;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        RandomSequence random(seed, 1, 0);
        const Keys keys = random_keys(random);
        for (const Interpolation interpolation : kInterpolations) {
            const KeyedCurve<double> curve(keys, interpolation);
            for (const auto& key : keys) {
                EXPECT_EQ(curve.value(key.time), key.value) << "seed " << seed;
                EXPECT_NEAR(curve.value(key.time - kEpsilon), key.value, 1e-6) << "seed " << seed;
                if (interpolation == Interpolation::linear) continue;
                EXPECT_NEAR(curve.derivative(key.time - kEpsilon), curve.derivative(key.time + kEpsilon), 1e-4)
                    << "seed " << seed;
            }
            EXPECT_EQ(curve.value(keys.front().time - 1.0), keys.front().value);
            EXPECT_EQ(curve.value(keys.back().time + 1.0), keys.back().value);
            EXPECT_EQ(curve.derivative(keys.back().time), 0.0);
        }
    }
}

TEST(KeyedCurve, RepeatsFromTheEndOfTheLastCycle) {
    const Keys keys{{1.0, 0.0}, {2.0, 5.0}, {3.0, 1.0}};
    for (const Interpolation interpolation : kInterpolations) {
        const KeyedCurve<double> curve(keys, interpolation, CurveEnds::repeat);
        for (const double time : {1.0, 1.25, 1.5, 2.0, 2.75}) {
            for (const int round : {-3, -1, 1, 2, 1000}) {
                EXPECT_EQ(curve.value(time + 2.0 * round), curve.value(time) + round);
                EXPECT_EQ(curve.derivative(time + 2.0 * round), curve.derivative(time));
            }
        }
        EXPECT_NEAR(curve.value(3.0 - 1e-9), curve.value(3.0), 1e-7);
        if (interpolation != Interpolation::linear) {
            EXPECT_NEAR(curve.derivative(3.0 - 1e-9), curve.derivative(3.0), 1e-6);
        }
    }
    const KeyedCurve<double> turning(Keys{{0.0, 0.0}, {2.0, 360.0}}, Interpolation::spline, CurveEnds::repeat);
    EXPECT_NEAR(turning.value(1001.0), 180180.0, 1e-9);  // constant rate
    EXPECT_NEAR(turning.derivative(1001.3), 180.0, 1e-12);
}

TEST(KeyedCurve, ASplineAlongASineFollowsItWithThirdOrderInItsKeys) {
    const auto largest_error = [](int count) {
        Keys keys;
        for (int k = 0; k <= count; ++k) {
            const double t = 2.0 * std::numbers::pi * k / count;
            keys.push_back({t, std::sin(t)});
        }
        const KeyedCurve<double> curve(keys, Interpolation::spline, CurveEnds::repeat);
        double error = 0.0;
        for (double t = 0.0; t < 6.2; t += 0.01) error = std::max(error, std::fabs(curve.value(t) - std::sin(t)));
        return error;
    };
    EXPECT_LT(largest_error(64), 1e-4);
    EXPECT_GT(largest_error(32) / largest_error(64), 7.0);
}

/// Returns the second derivative beside a time, from one-sided differences of the derivative. It is linear in each
/// segment.
double second_derivative(const KeyedCurve<double>& curve, double time, double side) {
    const double h = side * 1e-4;
    const double near = (curve.derivative(time + 2.0 * h) - curve.derivative(time + h)) / h;
    const double far = (curve.derivative(time + 4.0 * h) - curve.derivative(time + 3.0 * h)) / h;
    return near - 0.75 * (far - near);  // extrapolates from time + 1.5 h and + 3.5 h to the time itself
}

TEST(KeyedCurve, TheSecondDerivativeOfACubicSplineIsContinuousAtEveryKey) {
    RandomSequence random(11, 1, 0);
    for (int round = 0; round < 50; ++round) {
        const Keys keys = random_keys(random);
        for (const CurveEnds ends : {CurveEnds::hold, CurveEnds::repeat}) {
            const KeyedCurve<double> curve(keys, Interpolation::cubic_spline, ends);
            for (std::size_t k = 1; k + 1 < keys.size() + (ends == CurveEnds::repeat ? 1 : 0); ++k) {
                const double before = second_derivative(curve, keys[k].time, -1.0);
                const double after = second_derivative(curve, keys[k].time, 1.0);
                EXPECT_NEAR(before, after, 1e-7 * (1.0 + std::fabs(before))) << round << ", key " << k;
            }
        }
    }
}

TEST(KeyedCurve, ACubicSplineThroughUnevenKeysOfACubicAtRestAtItsEndsIsTheCubic) {
    Keys keys;
    for (const double s : {0.0, 0.1, 0.15, 0.4, 0.75, 0.8, 1.0}) keys.push_back({3.0 * s, s * s * (3.0 - 2.0 * s)});
    const KeyedCurve<double> curve(keys, Interpolation::cubic_spline);
    for (double s = 0.0; s <= 1.0; s += 0.01) {
        EXPECT_NEAR(curve.value(3.0 * s), s * s * (3.0 - 2.0 * s), 1e-14);
        EXPECT_NEAR(curve.derivative(3.0 * s), 6.0 * s * (1.0 - s) / 3.0, 1e-13);
    }
}

TEST(KeyedCurve, ARepeatedCubicSplineAlongASineFollowsItWithFourthOrderInItsKeys) {
    const auto error = [](int count) {
        Keys keys;
        for (int k = 0; k <= count; ++k) keys.push_back({1.0 * k, std::sin(2.0 * 3.14159265358979323846 * k / count)});
        keys.back().value = keys.front().value;
        const KeyedCurve<double> curve(keys, Interpolation::cubic_spline, CurveEnds::repeat);
        double largest = 0.0;
        for (double t = -3.0; t < 2.0 * count; t += 0.0371) {
            largest = std::max(largest, std::fabs(curve.value(t) - std::sin(2.0 * 3.14159265358979323846 * t / count)));
        }
        return largest;
    };
    EXPECT_LT(error(12), 3e-4);
    EXPECT_LT(error(24), error(12) / 13.0);
}

TEST(KeyedCurve, ARepeatedCubicSplineOfTwoKeysIsAStraightLine) {
    const KeyedCurve<double> curve({{0.0, 1.0}, {2.0, 4.0}}, Interpolation::cubic_spline, CurveEnds::repeat);
    for (double t = -5.0; t < 5.0; t += 0.3) {
        EXPECT_NEAR(curve.value(t), 1.0 + 1.5 * t, 1e-14);
        EXPECT_NEAR(curve.derivative(t), 1.5, 1e-14);
    }
}

TEST(KeyedCurve, VectorsAreTheirComponents) {
    RandomSequence random(3, 0, 0);
    VectorKeys keys;
    std::array<Keys, 3> parts;
    for (int k = 0; k < 5; ++k) {
        const double time = k + 0.3 * random.uniform();
        keys.push_back({time, random.unit_vector()});
        for (int axis = 0; axis < 3; ++axis) {
            parts[static_cast<std::size_t>(axis)].push_back({time, keys.back().value[axis]});
        }
    }
    for (const Interpolation interpolation : kInterpolations) {
        const KeyedCurve<Vec3> curve(keys, interpolation);
        for (double time = -1.0; time < 6.0; time += 0.05) {
            for (int axis = 0; axis < 3; ++axis) {
                const KeyedCurve<double> part(parts[static_cast<std::size_t>(axis)], interpolation);
                EXPECT_EQ(curve.value(time)[axis], part.value(time));
                EXPECT_EQ(curve.derivative(time)[axis], part.derivative(time));
            }
        }
    }
}

TEST(KeyedCurve, RefusesBadKeysAndSaysWhich) {
    EXPECT_EQ(message_of({}), "a curve has no keys, expected at least one");
    EXPECT_EQ(message_of({{0, 1}, {1, kInfinity}}), "key 1 of a curve is not finite");
    EXPECT_EQ(message_of({{std::nan(""), 1}}), "key 0 of a curve is not finite");
    EXPECT_EQ(message_of({{0, 1}, {2, 1}, {2, 3}}), "key 2 of a curve is at 2 s, expected a time after key 1's 2 s");
    EXPECT_EQ(message_of({{0, 1}, {2, 1}, {1, 3}}), "key 2 of a curve is at 1 s, expected a time after key 1's 2 s");
    EXPECT_EQ(message_of({{0, -1e300}, {1e-300, 1e300}}),
              "keys 0 and 1 of a curve are too near in time for their values");
    EXPECT_EQ(message_of({{0, 1}}, CurveEnds::repeat), "a curve that repeats has one key, expected at least two");
}

TEST(KeyedCurve, InterpolationsHaveNames) {
    EXPECT_EQ(name_of(Interpolation::linear), "linear");
    EXPECT_EQ(name_of(Interpolation::slow_in_slow_out), "slow_in_slow_out");
    EXPECT_EQ(name_of(Interpolation::spline), "spline");
    EXPECT_EQ(name_of(Interpolation::cubic_spline), "cubic_spline");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
