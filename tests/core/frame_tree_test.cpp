#include "ricochet/core/frame_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/emitter.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Real = long double;

// Number with its time derivative.
struct Dual {
    Real value = 0;
    Real rate = 0;
};
Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.rate + b.rate}; }
Dual operator*(const Dual& a, const Dual& b) { return {a.value * b.value, a.value * b.rate + a.rate * b.value}; }
Dual sine(const Dual& a) { return {std::sin(a.value), std::cos(a.value) * a.rate}; }
Dual cosine(const Dual& a) { return {std::cos(a.value), -std::sin(a.value) * a.rate}; }

using Matrix = std::array<std::array<Dual, 4>, 4>;

Matrix identity() {
    Matrix m{};
    for (std::size_t i = 0; i < 4; ++i) m[i][i] = {1, 0};
    return m;
}

Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix m{};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            for (std::size_t k = 0; k < 4; ++k) m[i][j] = m[i][j] + a[i][k] * b[k][j];
        }
    }
    return m;
}

Matrix moved_by(const std::array<Dual, 3>& oscillation) {
    Matrix m = identity();
    for (std::size_t i = 0; i < 3; ++i) m[i][3] = oscillation[i];
    return m;
}

// Returns I + sin K + (1 - cos) K^2 for the unit axis, with the angle in degrees.
Matrix turned_by(const Vec3& axis, const Dual& degrees) {
    const Real size = std::sqrt(static_cast<Real>(axis.x) * axis.x + static_cast<Real>(axis.y) * axis.y +
                                static_cast<Real>(axis.z) * axis.z);
    const std::array<Real, 3> k = {axis.x / size, axis.y / size, axis.z / size};
    const std::array<std::array<Real, 3>, 3> skew = {{{0, -k[2], k[1]}, {k[2], 0, -k[0]}, {-k[1], k[0], 0}}};
    const Dual angle = degrees * Dual{std::acos(Real{-1}) / 180, 0};
    const Dual s = sine(angle);
    const Dual rest = Dual{1, 0} + cosine(angle) * Dual{-1, 0};
    Matrix m = identity();
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            Real square = 0;
            for (std::size_t n = 0; n < 3; ++n) square += skew[i][n] * skew[n][j];
            m[i][j] = m[i][j] + s * Dual{skew[i][j], 0} + rest * Dual{square, 0};
        }
    }
    return m;
}

// Returns the slope at a key of the parabola through the key and its neighbours, by Lagrange's formula. The slope is 0
// at both ends.
Real slope_at(const std::vector<CurveKey<double>>& keys, std::size_t k) {
    if (k == 0 || k + 1 == keys.size()) return 0;
    const std::array<Real, 3> t = {keys[k - 1].time, keys[k].time, keys[k + 1].time};
    return keys[k - 1].value * (t[1] - t[2]) / ((t[0] - t[1]) * (t[0] - t[2])) +
           keys[k].value * (2 * t[1] - t[0] - t[2]) / ((t[1] - t[0]) * (t[1] - t[2])) +
           keys[k + 1].value * (t[1] - t[0]) / ((t[2] - t[0]) * (t[2] - t[1]));
}

// Evaluates the curve independently, as Hermite polynomials of a dual time.
Dual curve_at(const KeyedCurve<double>& curve, double time) {
    const auto& keys = curve.keys();
    if (time < keys.front().time) return {keys.front().value, 0};
    if (time >= keys.back().time) return {keys.back().value, 0};
    std::size_t k = 0;
    while (keys[k + 1].time <= time) ++k;
    const Real span = static_cast<Real>(keys[k + 1].time) - keys[k].time;
    const Dual s{(static_cast<Real>(time) - keys[k].time) / span, 1 / span};
    const auto number = [](Real x) { return Dual{x, 0}; };
    const Dual s2 = s * s;
    const Dual s3 = s2 * s;
    if (curve.interpolation() == Interpolation::linear) {
        return number(keys[k].value) + s * number(static_cast<Real>(keys[k + 1].value) - keys[k].value);
    }
    const bool spline = curve.interpolation() == Interpolation::spline;
    const Real m0 = spline ? span * slope_at(keys, k) : 0;
    const Real m1 = spline ? span * slope_at(keys, k + 1) : 0;
    return (number(1) + number(-3) * s2 + number(2) * s3) * number(keys[k].value) +
           (number(3) * s2 + number(-2) * s3) * number(keys[k + 1].value) + (s + number(-2) * s2 + s3) * number(m0) +
           (s3 + number(-1) * s2) * number(m1);
}

std::array<Dual, 3> way_at(const KeyedCurve<Vec3>& oscillation, double time) {
    std::array<Dual, 3> result;
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<CurveKey<double>> keys;
        for (const auto& key : oscillation.keys()) keys.push_back({key.time, key.value[axis]});
        result[static_cast<std::size_t>(axis)] = curve_at(KeyedCurve<double>(keys, oscillation.interpolation()), time);
    }
    return result;
}

Matrix chain_at(const std::vector<FrameDescription>& frames, double time) {
    Matrix m = identity();
    for (const FrameDescription& frame : frames) {
        const Vec3& t = frame.translation;
        m = m * moved_by({Dual{t.x, 0}, Dual{t.y, 0}, Dual{t.z, 0}});
        m = m * turned_by(frame.rotation_axis, {frame.rotation_degrees, 0});
        for (const FrameMotion& motion : frame.motions) {
            const auto wave = [&](double frequency, double phase) {
                const Real whole = 2 * std::acos(Real{-1});
                return sine({whole * (frequency * static_cast<Real>(time) + phase / Real{360}), whole * frequency});
            };
            if (const auto* turn = std::get_if<KeyedRotation>(&motion)) {
                m = m * turned_by(turn->axis, curve_at(turn->degrees, time));
            } else if (const auto* spin = std::get_if<Spin>(&motion)) {
                m = m * turned_by(spin->axis, {static_cast<Real>(spin->rate) * time, spin->rate});
            } else if (const auto* swing = std::get_if<Swing>(&motion)) {
                m = m * turned_by(swing->axis, Dual{swing->amplitude, 0} * wave(swing->frequency, swing->phase));
            } else if (const auto* oscillation = std::get_if<Oscillation>(&motion)) {
                const Dual s = wave(oscillation->frequency, oscillation->phase);
                const Vec3& a = oscillation->amplitude;
                m = m * moved_by({Dual{a.x, 0} * s, Dual{a.y, 0} * s, Dual{a.z, 0} * s});
            } else {
                m = m * moved_by(way_at(std::get<KeyedTranslation>(motion).path, time));
            }
        }
    }
    return m;
}

KeyedCurve<double> angles(RandomSequence& random, Interpolation interpolation) {
    std::vector<CurveKey<double>> keys;
    for (int k = 0; k < 6; ++k) keys.push_back({k + 0.4 * random.uniform(), random.uniform_around(0.0, 200.0)});
    return KeyedCurve<double>(keys, interpolation);
}

KeyedCurve<Vec3> ways(RandomSequence& random, Interpolation interpolation) {
    std::vector<CurveKey<Vec3>> keys;
    for (int k = 0; k < 6; ++k) keys.push_back({k + 0.4 * random.uniform(), random.unit_vector()});
    return KeyedCurve<Vec3>(keys, interpolation);
}

// Returns a rotating base, an upper arm, and a forearm with a sliding hand.
std::vector<FrameDescription> random_arm(RandomSequence& random, Interpolation interpolation) {
    std::vector<FrameDescription> arm(3);
    arm[0] = {"base", "", {1, -2, 0.5}, random.unit_vector(), random.uniform_around(0, 180), {}};
    arm[1] = {"upper arm", "base", {0, 0, 0.8}, random.unit_vector(), random.uniform_around(0, 180), {}};
    arm[2] = {"forearm", "upper arm", {1.2, 0, 0}, {0, 1, 0}, 0.0, {}};
    arm[0].motions.emplace_back(KeyedRotation{{0, 0, 2}, angles(random, interpolation)});
    arm[1].motions.emplace_back(KeyedRotation{random.unit_vector(), angles(random, interpolation)});
    arm[1].motions.emplace_back(KeyedTranslation{ways(random, interpolation)});
    arm[2].motions.emplace_back(KeyedTranslation{ways(random, interpolation)});
    arm[2].motions.emplace_back(KeyedRotation{random.unit_vector(), angles(random, interpolation)});
    arm[2].motions.emplace_back(Spin{random.unit_vector(), random.uniform_around(0, 400)});
    arm[2].motions.emplace_back(Oscillation{random.unit_vector(), random.uniform(), random.uniform_around(0, 180)});
    arm[2].motions.emplace_back(KeyedRotation{random.unit_vector(), angles(random, interpolation)});
    arm[1].motions.emplace_back(
        Swing{random.unit_vector(), random.uniform_around(0, 90), 2.0 * random.uniform(), 30.0});
    return arm;
}

TEST(FrameTree, MatchesTheMatrixChainAndItsDerivativeOnAThreeLinkArm) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        for (const Interpolation interpolation :
             {Interpolation::linear, Interpolation::slow_in_slow_out, Interpolation::spline}) {
            RandomSequence random(seed, 0, 0);
            const std::vector<FrameDescription> arm = random_arm(random, interpolation);
            const FrameTree tree(arm);
            Particle particle;
            particle.position = random.unit_vector();
            particle.velocity = 3.0 * random.unit_vector();
            particle.birth_time = 6.0 * random.uniform() - 0.3;
            const Particle born = launched_from(tree, 2, particle);
            const Matrix m = chain_at(arm, particle.birth_time);
            Real worst = 0;
            Real speed = 1;
            for (std::size_t i = 0; i < 3; ++i) {
                Dual place = m[i][3];
                Real velocity = 0;
                for (std::size_t j = 0; j < 3; ++j) {
                    place = place + m[i][j] * Dual{particle.position[static_cast<int>(j)], 0};
                    velocity += m[i][j].value * particle.velocity[static_cast<int>(j)];
                }
                velocity += place.rate;
                speed = std::max(speed, std::fabs(velocity));
                worst = std::max(worst, std::fabs(velocity - born.velocity[static_cast<int>(i)]));
                EXPECT_NEAR(static_cast<double>(place.value), born.position[static_cast<int>(i)], 1e-13);
            }
            EXPECT_LT(static_cast<double>(worst / speed), 1e-12) << "seed " << seed;
        }
    }
}

TEST(FrameTree, TheAngularVelocityIsTheDerivativeOfTheAxes) {
    RandomSequence random(9, 0, 0);
    const std::vector<FrameDescription> arm = random_arm(random, Interpolation::spline);
    const FrameTree tree(arm);
    for (double time = 0.05; time < 6.0; time += 0.1) {
        const MovingPose pose = tree.at(2, time);
        const Matrix m = chain_at(arm, time);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 direction;
            Vec3 rate;
            for (int i = 0; i < 3; ++i) {
                const Dual& entry = m[static_cast<std::size_t>(i)][static_cast<std::size_t>(axis)];
                direction[i] = static_cast<double>(entry.value);
                rate[i] = static_cast<double>(entry.rate);
            }
            EXPECT_LT(length(cross(pose.angular_velocity, direction) - rate), 1e-11) << time;
        }
    }
}

// Bounds of steady motions are exact: the n-th derivative of a rotation is w^n, and w^n r on a circle.
TEST(FrameTree, BoundsOfSteadyTurnsAndOscillationsAreExact) {
    constexpr double kDegrees = 3.14159265358979323846 / 180.0;
    const FrameTree tree({{"hub", "", {9, 9, 9}, {0, 0, 1}, 45.0, {Spin{{1, 2, 2}, -200.0}}},
                          {"rim", "hub", {0, 3, 4}, {0, 0, 1}, 0.0, {}},
                          {"shaker", "", {}, {0, 0, 1}, 0.0, {Oscillation{{0.3, 0, 0.4}, -2.0, 10.0}}}});
    double w = 1.0;
    double shake = 0.5;
    for (std::size_t n = 1; n < 5; ++n) {
        w *= 200.0 * kDegrees;
        shake *= 4.0 * 180.0 * kDegrees;
        EXPECT_NEAR(tree.bounds(0, 1.0, 2.0).rotation[n], w, 1e-14 * w);
        EXPECT_EQ(tree.bounds(0, 1.0, 2.0).origin[n], 0.0);
        EXPECT_NEAR(tree.bounds(1, 1.0, 2.0).origin[n], 5.0 * w, 1e-13 * w);
        EXPECT_NEAR(tree.bounds(1, 1.0, 2.0).rotation[n], w, 1e-14 * w);
        EXPECT_NEAR(tree.bounds(2, 1.0, 2.0).origin[n], shake, 1e-14 * shake);
        EXPECT_EQ(tree.bounds(2, 1.0, 2.0).rotation[n], 0.0);
    }
    EXPECT_EQ(tree.bounds(1, 1.0, 2.0).rotation[0], 1.0);
}

/// Returns n! times the n-th divided difference at times h apart. Along its own direction it equals the n-th derivative
/// at some time between (the mean value theorem). No valid bound is smaller.
Vec3 difference_quotient(const std::array<Vec3, 5>& values, std::size_t n, double h) {
    std::array<Vec3, 5> d = values;
    for (std::size_t k = 1; k <= n; ++k) {
        for (std::size_t i = 0; i + k <= n; ++i) d[i] = (d[i + 1] - d[i]) / h;
    }
    return d[0];
}

TEST(FrameTree, BoundsHoldBetweenKeys) {
    const double h = 0.01;
    std::array<double, 5> largest{};  // largest derivative found, relative to its bound
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        for (const Interpolation interpolation : {Interpolation::linear, Interpolation::slow_in_slow_out,
                                                  Interpolation::spline, Interpolation::cubic_spline}) {
            RandomSequence random(seed, 0, 0);
            const FrameTree tree(random_arm(random, interpolation));
            const Vec3 point = random.unit_vector();
            for (std::size_t frame = 0; frame < 3; ++frame) {
                const double from = 5.0 * random.uniform();
                if (tree.next_key(frame, from) <= from + 4.0 * h) continue;
                const MotionBounds bounds = tree.bounds(frame, from, from + 4.0 * h);
                std::array<Vec3, 5> origins;
                std::array<Vec3, 5> directions;
                for (std::size_t k = 0; k < 5; ++k) {
                    const AffineMap map = tree.at(frame, from + static_cast<double>(k) * h).world_from_frame;
                    origins[k] = map.translation;
                    directions[k] = map.direction(point);
                }
                for (std::size_t n = 1; n < 5; ++n) {
                    const double rounding = 1e-13 / std::pow(h, static_cast<double>(n));
                    const double oscillation = length(difference_quotient(origins, n, h));
                    EXPECT_LE(oscillation, bounds.origin[n] + rounding) << "seed " << seed << ", order " << n;
                    const double turn = length(difference_quotient(directions, n, h));
                    EXPECT_LE(turn, bounds.rotation[n] + rounding) << "seed " << seed << ", order " << n;
                    if (bounds.rotation[n] > 0.0) largest[n] = std::max(largest[n], turn / bounds.rotation[n]);
                }
                const MovingPose pose = tree.at(frame, from);
                EXPECT_LE(length(pose.velocity), bounds.origin[1] * (1.0 + 1e-12));
                EXPECT_LE(length(pose.acceleration), bounds.origin[2] * (1.0 + 1e-12));
                EXPECT_LE(length(pose.angular_velocity), bounds.rotation[1] * (1.0 + 1e-12));
            }
        }
    }
    // The bounds are not far above the derivatives found.
    for (std::size_t n = 1; n < 5; ++n) EXPECT_GT(largest[n], 0.3) << n;
}

// The next key belongs to the frame or to any frame that carries it.
TEST(FrameTree, TheNextKeyIsTheFirstOfItsChain) {
    const KeyedCurve<double> turns({{0.5, 0.0}, {2.0, 90.0}});
    const KeyedCurve<Vec3> oscillation({{0.0, {}}, {1.5, {1, 0, 0}}, {3.0, {1, 1, 0}}}, Interpolation::spline);
    const FrameTree tree({{"base", "", {}, {0, 0, 1}, 0.0, {Spin{}, KeyedRotation{{0, 0, 1}, turns}}},
                          {"arm", "base", {}, {0, 0, 1}, 0.0, {Swing{}, KeyedTranslation{oscillation}}},
                          {"other", "", {}, {0, 0, 1}, 0.0, {Oscillation{{1, 0, 0}, 1.0, 0.0}}}});
    std::vector<double> times;
    for (double time = -1.0; std::isfinite(time); time = tree.next_key(1, time)) times.push_back(time);
    EXPECT_EQ(times, (std::vector<double>{-1.0, 0.0, 0.5, 1.5, 2.0, 3.0}));
    EXPECT_EQ(tree.next_key(0, 0.0), 0.5);
    EXPECT_EQ(tree.next_key(0, 2.0), HUGE_VAL);
    EXPECT_EQ(tree.next_key(2, -1.0), HUGE_VAL);
}

TEST(FrameTree, TheHashDependsOnTheMotionAndNotOnNames) {
    RandomSequence random(4, 0, 0);
    std::vector<FrameDescription> arm = random_arm(random, Interpolation::linear);
    const FrameTree tree(arm);
    EXPECT_NE(tree.hash(0), tree.hash(1));
    arm[0].name = arm[1].parent = "ground";
    std::swap(arm[0], arm[2]);
    const FrameTree renamed(arm);
    EXPECT_EQ(renamed.hash(0), tree.hash(2));
    EXPECT_EQ(renamed.hash(1), tree.hash(1));
    std::get<Spin>(arm[0].motions[2]).rate += 1e-9;
    EXPECT_NE(FrameTree(arm).hash(0), tree.hash(2));
    EXPECT_EQ(FrameTree(arm).hash(1), tree.hash(1));
}

TEST(FrameTree, AWheelsRimMovesByItsOwnSpinAndWithTheCart) {
    const KeyedCurve<Vec3> road({{0.0, {0, 0, 0}}, {10.0, {20, 0, 0}}});
    const KeyedCurve<double> turns({{0.0, 0.0}, {10.0, 3600.0}});
    const FrameTree tree({{"cart", "", {0, 0, 1}, {0, 0, 1}, 0.0, {KeyedTranslation{road}}},
                          {"wheel", "cart", {}, {0, 0, 1}, 0.0, {KeyedRotation{{0, 1, 0}, turns}}}});
    const MovingPose pose = tree.at(*tree.find("wheel"), 2.5);  // half a turn
    const double w = 2.0 * std::acos(-1.0);
    const Vec3 place = pose.world_from_frame.point({0, 0, 1});
    EXPECT_LT(length(place - Vec3(5, 0, 0)), 1e-14);
    EXPECT_LT(length(pose.velocity_of({0, 0, 1}) - Vec3(2.0 - w, 0, 0)), 1e-13);
    EXPECT_LT(length(pose.angular_velocity - Vec3(0, w, 0)), 1e-13);
}

TEST(FrameTree, AQuarterTurnIsExact) {
    const FrameTree tree({{"a", "", {1, 2, 3}, {0, 0, 1}, 90.0, {}}});
    EXPECT_EQ(tree.at(0, 7.0).world_from_frame.translation, Vec3(1, 2, 3));
    EXPECT_LT(length(tree.at(0, 7.0).world_from_frame.point({2, 0, 0}) - Vec3(1, 4, 3)), 1e-15);
    EXPECT_EQ(tree.at(0, 7.0).velocity_of({2, 0, 0}), Vec3());
}

std::string message_of(std::vector<FrameDescription> frames) {
    try {
        const FrameTree tree(std::move(frames));
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

FrameDescription named(const char* name, const char* parent = "") {
    FrameDescription frame;
    frame.name = name;
    frame.parent = parent;
    return frame;
}

TEST(FrameTree, RefusesInvalidTreesAndNamesTheFrame) {
    EXPECT_EQ(message_of({named("a", "b"), named("b"), named("c", "a")}), "");  // any order
    EXPECT_EQ(message_of({named("a", "x")}), "frame 'a': there is no parent 'x'");
    EXPECT_EQ(message_of({named("c", "a"), named("a", "b"), named("b", "a")}),
              "frame 'a': its parents lead back to it");
    EXPECT_EQ(message_of({named("a", "a")}), "frame 'a': its parents lead back to it");
    EXPECT_EQ(message_of({named("a"), named("a")}), "frame 'a': the name is taken");
    EXPECT_EQ(message_of({named("")}), "frame 0 has no name");
    FrameDescription flat = named("a");
    flat.rotation_axis = {};
    EXPECT_EQ(message_of({flat}), "frame 'a': the rotation's axis has no length, expected a direction");
}

// Emitters on frames.

EmitterDescription nozzle() {
    EmitterDescription emitter;
    emitter.name = "nozzle";
    emitter.shape = DiskShape{{0.1, 0, 0}, {1, 0, 0}, 0.05};
    emitter.rate = {150.0, 20.0};
    emitter.cone_degrees = 10.0;
    emitter.speed = {3.0, 0.5};
    emitter.velocity = {0, 0, 1};
    emitter.radius = {0.02, 0.005};
    emitter.mass = {1.0, 0.2};
    return emitter;
}

std::vector<Particle> births_in_steps(const EmitterDescription& description, double step, int steps) {
    Emitter emitter(description, 5, 0);
    std::vector<Particle> all;
    for (int k = 0; k < steps; ++k) {
        for (const Particle& p : emitter.births(k * step, (k + 1) * step)) all.push_back(p);
    }
    return all;
}

TEST(FrameEmitter, TheTimeStepChangesNoBitOfASpawnedParticle) {
    RandomSequence random(2, 0, 0);
    EmitterDescription description = nozzle();
    description.frames = std::make_shared<const FrameTree>(random_arm(random, Interpolation::slow_in_slow_out));
    description.frame = 2;
    const std::vector<Particle> coarse = births_in_steps(description, 0.125, 32);
    const std::vector<Particle> fine = births_in_steps(description, 0.125 / 7.0, 7 * 32);
    ASSERT_GT(coarse.size(), 500U);
    ASSERT_EQ(coarse.size(), fine.size());
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        EXPECT_EQ(coarse[i].birth_time, fine[i].birth_time);
        EXPECT_EQ(coarse[i].position, fine[i].position);
        EXPECT_EQ(coarse[i].velocity, fine[i].velocity);
        EXPECT_EQ(coarse[i].spin, fine[i].spin);
    }
}

TEST(FrameEmitter, OnAFrameAtRestEqualsAnEmitterPlacedByHand) {
    EmitterDescription description = nozzle();
    const std::vector<Particle> local = births_in_steps(description, 0.5, 4);
    FrameDescription frame = named("stand");
    frame.translation = {3, -1, 2};
    frame.rotation_axis = {1, 2, -1};
    frame.rotation_degrees = 71.0;
    description.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
    const std::vector<Particle> placed = births_in_steps(description, 0.5, 4);
    Placement placement;
    placement.position = frame.translation;
    placement.rotation_axis = frame.rotation_axis;
    placement.rotation_degrees = frame.rotation_degrees;
    const AffineMap map = world_from_local(placement);
    ASSERT_EQ(local.size(), placed.size());
    for (std::size_t i = 0; i < local.size(); ++i) {
        EXPECT_LT(length(placed[i].position - map.point(local[i].position)), 2e-15);
        EXPECT_LT(length(placed[i].velocity - map.direction(local[i].velocity)), 5e-15);
        EXPECT_EQ(placed[i].mass, local[i].mass);
        EXPECT_EQ(placed[i].radius, local[i].radius);
        EXPECT_EQ(placed[i].spin, Vec3());
    }
    description.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{named("world")});
    const std::vector<Particle> still = births_in_steps(description, 0.5, 4);
    for (std::size_t i = 0; i < local.size(); ++i) {
        EXPECT_EQ(still[i].position, local[i].position);
        EXPECT_EQ(still[i].velocity, local[i].velocity);
    }
}

TEST(FrameEmitter, OnlySpheresInheritTheSpinOfTheFrame) {
    const KeyedCurve<double> turns({{0.0, 0.0}, {10.0, 3600.0}});
    const FrameTree tree({{"wheel", "", {}, {0, 0, 1}, 0.0, {KeyedRotation{{0, 0, 1}, turns}}}});
    Particle particle;
    particle.birth_time = 1.3;
    EXPECT_EQ(launched_from(tree, 0, particle).spin, Vec3());
    particle.radius = 0.1;
    EXPECT_NEAR(launched_from(tree, 0, particle).spin.z, 2.0 * std::acos(-1.0), 1e-14);
}

TEST(FrameEmitter, RefusesAMissingFrame) {
    EmitterDescription description = nozzle();
    description.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{named("a")});
    description.frame = 1;
    EXPECT_THROW(Emitter(description, 0, 0), InputError);
}

// Work that grew with the cube of the number of frames would not finish here. Separate chains for all frames would need
// 3 GB.
TEST(FrameTree, IsBuiltInLinearTimeForALongChain) {
    constexpr std::size_t kFrames = 30000;
    std::vector<FrameDescription> frames;
    for (std::size_t i = 0; i < kFrames; ++i) {
        FrameDescription& frame = frames.emplace_back();
        frame.name = "frame " + std::to_string(i);
        if (i + 1 < kFrames) frame.parent = "frame " + std::to_string(i + 1);
        frame.translation = {1, 0, 0};
    }
    const FrameTree tree(frames);
    EXPECT_EQ(tree.at(0, 0.0).world_from_frame.translation, Vec3(kFrames, 0, 0));
    EXPECT_EQ(tree.at(kFrames - 1, 0.0).world_from_frame.translation, Vec3(1, 0, 0));
    EXPECT_EQ(tree.find("frame 7"), 7U);
    frames.back().parent = "frame 20000";
    EXPECT_EQ(frame_in_circle(frames), 20000U);
}

TEST(FrameTree, FindsTheFirstFrameOfACycleAndNoneBeforeIt) {
    const auto circle_of = [](const std::vector<std::string>& parents) {
        std::vector<FrameDescription> frames;
        for (std::size_t i = 0; i < parents.size(); ++i) {
            FrameDescription& frame = frames.emplace_back();
            frame.name = std::string(1, static_cast<char>('a' + i));
            frame.parent = parents[i];
        }
        return frame_in_circle(frames);
    };
    EXPECT_EQ(circle_of({"", "a", "b"}), std::nullopt);
    EXPECT_EQ(circle_of({"b", "c", "d", "b"}), 1U);  // a is attached to the cycle
    EXPECT_EQ(circle_of({"d", "a", "e", "", "f", "c"}), 2U);
    EXPECT_EQ(circle_of({"unknown", "b"}), 1U);
    EXPECT_EQ(circle_of({"f", "c", "b", "e", "d", ""}), 1U);  // the first of two cycles
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
