#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Digits = boost::multiprecision::cpp_dec_float_50;

struct PreciseBall {
    std::array<Digits, 3> x;
    std::array<Digits, 3> v;
    Digits mass;
    Digits radius;
};

/// Smooth balls without walls. Resolves all events one after the other, in fifty digits.
class Reference {
public:
    Reference(const std::vector<Particle>& particles, const Digits& restitution) : restitution_(restitution) {
        for (const Particle& p : particles) {
            balls_.push_back({{p.position.x, p.position.y, p.position.z},
                              {p.velocity.x, p.velocity.y, p.velocity.z},
                              p.mass,
                              p.radius});
        }
    }

    /// Runs for a duration. Returns the number of impacts.
    std::size_t run(const Digits& duration) {
        std::size_t impacts = 0;
        Digits now = 0;
        const std::size_t n = balls_.size();
        std::vector<Digits> times(n * n, -1);
        for (std::size_t i = 0; i < n; ++i) update(i, now, times);
        while (true) {
            std::size_t a = n;
            std::size_t b = n;
            Digits first = duration;
            for (std::size_t i = 0; i < n; ++i) {
                for (std::size_t j = i + 1; j < n; ++j) {
                    const Digits& time = times[i * n + j];
                    if (time >= 0 && time < first) first = time, a = i, b = j;
                }
            }
            for (PreciseBall& ball : balls_) {
                for (std::size_t k = 0; k < 3; ++k) ball.x[k] += (first - now) * ball.v[k];
            }
            now = first;
            if (a == n) return impacts;
            answer(balls_[a], balls_[b]);
            ++impacts;
            update(a, now, times);
            update(b, now, times);
        }
    }

    [[nodiscard]] Vec3 position(std::size_t i) const {
        const auto& x = balls_[i].x;
        return {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
    }

private:
    static Digits dot(const std::array<Digits, 3>& a, const std::array<Digits, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    void update(std::size_t i, const Digits& now, std::vector<Digits>& times) const {
        const std::size_t n = balls_.size();
        for (std::size_t j = 0; j < n; ++j) {
            if (j != i) times[std::min(i, j) * n + std::max(i, j)] = time_of(balls_[i], balls_[j], now);
        }
    }

    /// Returns the time of impact, or -1 if the balls do not meet.
    static Digits time_of(const PreciseBall& a, const PreciseBall& b, const Digits& now) {
        std::array<Digits, 3> d;
        std::array<Digits, 3> u;
        for (std::size_t k = 0; k < 3; ++k) d[k] = b.x[k] - a.x[k], u[k] = b.v[k] - a.v[k];
        const Digits distance = a.radius + b.radius;
        const Digits half = dot(d, u);
        if (half >= 0) return -1;
        const Digits speed = dot(u, u);
        const Digits root = half * half - speed * (dot(d, d) - distance * distance);
        if (root < 0) return -1;
        return now + (-half - sqrt(root)) / speed;
    }

    void answer(PreciseBall& a, PreciseBall& b) const {
        std::array<Digits, 3> d;
        std::array<Digits, 3> u;
        for (std::size_t k = 0; k < 3; ++k) d[k] = b.x[k] - a.x[k], u[k] = b.v[k] - a.v[k];
        const Digits impulse = -(1 + restitution_) * dot(d, u) / dot(d, d) / (1 / a.mass + 1 / b.mass);
        for (std::size_t k = 0; k < 3; ++k) {
            a.v[k] -= impulse * d[k] / a.mass;
            b.v[k] += impulse * d[k] / b.mass;
        }
    }

    std::vector<PreciseBall> balls_;
    Digits restitution_;
};

/// Returns a cloud that implodes.
std::vector<Particle> imploding_cloud(std::uint64_t seed) {
    RandomSequence random(seed, 1, 0);
    std::vector<Particle> particles;
    while (particles.size() < 100) {
        const Vec3 position = random.in_unit_ball();
        const double radius = 0.03 + 0.05 * random.uniform();
        const Vec3 velocity = 0.6 * random.in_unit_ball() - position;
        const bool is_free = std::all_of(particles.begin(), particles.end(), [&](const Particle& p) {
            return length(p.position - position) > p.radius + radius;
        });
        if (!is_free) continue;
        particles.push_back(testing::particle_of(position, velocity, radius));
        particles.back().mass = 1e3 * radius * radius * radius;
    }
    return particles;
}

// Each impact multiplies an error several times. This is the error left after the same impacts in the same order.
TEST(PairReference, HundredSpheresFollowAReferenceInFiftyDigits) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::vector<Particle> particles = imploding_cloud(seed);
        const double duration = 0.9;
        Reference reference(particles, Digits("0.875"));
        const std::size_t impacts = reference.run(duration);
        EXPECT_GT(impacts, 100U);
        for (const double time_step : {0.9, 0.01}) {
            SCOPED_TRACE("time step " + std::to_string(time_step));
            SimulationSetup setup = testing::setup_of(time_step, duration);
            setup.options.resting_speed = 0.0;
            setup.options.particle_contacts = PairContactSettings{.restitution = 0.875};
            setup.particles = particles;
            Simulation simulation(std::move(setup));
            while (!simulation.finished()) simulation.step();
            EXPECT_EQ(simulation.statistics().pair_impacts, impacts);
            for (std::size_t i = 0; i < particles.size(); ++i) {
                EXPECT_LT(length(simulation.particles().position[i] - reference.position(i)), 1e-10) << i;
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
