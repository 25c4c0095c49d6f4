#include "golden/random_scene.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>

namespace ricochet::golden {
namespace {

/// Random numbers whose bits the C++ standard fixes. Distributions of the standard library would differ between
/// systems. An expression draws at most once, because compilers evaluate operands and arguments in different orders.
class Numbers {
public:
    explicit Numbers(int seed) : engine_(static_cast<std::uint64_t>(seed) + 1) {}

    double between(double a, double b) { return a + (b - a) * (static_cast<double>(engine_() >> 11) * 0x1p-53); }
    bool chance(double p) { return between(0.0, 1.0) < p; }

private:
    std::mt19937_64 engine_;
};

std::string text(double value) {
    std::array<char, 32> buffer{};
    const int length = std::snprintf(buffer.data(), buffer.size(), "%.17g", value);
    return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string vector(double x, double y, double z) { return "[" + text(x) + ", " + text(y) + ", " + text(z) + "]"; }

std::string vector(Numbers& numbers, double size) {
    const double x = numbers.between(-size, size);
    const double y = numbers.between(-size, size);
    const double z = numbers.between(-size, size);
    return vector(x, y, z);
}

bool has_flow(int number) { return number % 16 == 3 || number % 16 == 11; }
bool has_springs(int number) { return number % 8 == 2; }
bool has_children(int number) { return number % 8 == 1; }
bool has_spheres(int number) { return number / 8 % 2 == 1; }

std::string response(int number) {
    switch (number % 8) {
        case 4:
            return R"("response": "rollback")";
        case 5:
            return R"("response": "rollback", "rollback": {"global": true, "time_tolerance": 1e-8})";
        case 6:
            return R"("response": "project", "project": {"offset": 1e-5})";
        case 7:
            return R"("response": "penalty", "penalty": {"substeps": 20})";
        default:
            return R"("response": "exact")";
    }
}

std::string integrator(int number) {
    constexpr std::array kForces{"ballistic",     "symplectic_euler", "midpoint",       "rk4",
                                 "forward_euler", "velocity_verlet",  "dormand_prince", "implicit_euler"};
    constexpr std::array kFlow{"rk4", "midpoint", "dormand_prince", "forward_euler"};
    const auto n = static_cast<std::size_t>(number);
    if (has_flow(number)) return kFlow[n / 16 % 4];
    const std::size_t kind = (n + n / 8) % 8;
    const bool takes_equal_steps = number % 8 == 5 || number % 8 == 7;  // global rollback, penalty
    return kForces[takes_equal_steps ? kind % 6 : kind];
}

std::string simulation(int number, Numbers& numbers) {
    const double step = numbers.between(0.004, 0.016);
    const double duration = numbers.between(0.5, 0.9);
    std::string out = R"("simulation": {"time_step": )" + text(has_springs(number) ? 0.1 * step : step);
    out += R"(, "duration": )" + text(has_springs(number) ? 0.3 * duration : duration);
    out += R"(, "seed": )" + std::to_string(number);
    out += R"(, "integrator": ")" + integrator(number) + R"(", )" + response(number);
    if (numbers.chance(0.3)) out += R"(, "resting_speed": 0.05)";
    out += R"(, "bounce_budget": )" + std::to_string(kRandomSceneBudget) + R"(, "max_depth": 2, "most_particles": 600)";
    if (has_flow(number)) {
        out += R"(, "motion": "flow", "flow": "stream", "walls": )";
        out += number % 16 == 3 ? R"("slide")" : R"("stop")";
    }
    return out + "},\n";
}

std::string forces(int number, Numbers& numbers) {
    if (has_flow(number)) {
        return R"("flows": {"stream": {"type": "sum", "parts": [{"type": "uniform", "velocity": )" +
               vector(numbers, 1.5) +
               R"(}, {"type": "turbulence", "speed": 0.8, "length": 0.7, "octaves": 2, "rate": 0.5}]}},)"
               "\n";
    }
    std::string out = R"("forces": [)";
    std::string comma;
    const auto add = [&](const std::string& force) {
        out += comma + force;
        comma = ", ";
    };
    if (numbers.chance(0.8)) add(R"({"type": "gravity", "acceleration": [0.3, 0, -9.81]})");
    if (numbers.chance(0.3)) add(R"({"type": "drag", "coefficient": 0.2})");
    if (numbers.chance(0.15)) add(R"({"type": "quadratic_drag", "coefficient": 0.05})");
    if (numbers.chance(0.15)) {
        add(R"({"type": "point_gravity", "attractors": [{"position": [0.1, 0.2, 0], "strength": 2, "softening": 0.2}]})");
    }
    if (numbers.chance(0.15)) add(R"({"type": "swirl", "axis": [0, 0, 1], "acceleration": 3, "core_radius": 0.4})");
    if (numbers.chance(0.15)) {
        add(R"({"type": "lorentz", "charge": 0.5, "electric": [1, 0, 0], "magnetic": [0, 0, 4]})");
    }
    return out + "],\n";
}

std::string material(const std::string& name, Numbers& numbers) {
    constexpr std::array kRestitution{1.0, 0.9, 0.5, 0.0};
    const double e = kRestitution[static_cast<std::size_t>(numbers.between(0.0, 4.0))];
    std::string out = "\"" + name + R"(": {"restitution": )" + text(e);
    out += R"(, "friction": )" + text(numbers.chance(0.3) ? 0.0 : numbers.between(0.0, 1.2));
    if (numbers.chance(0.3)) out += R"(, "rolling_friction": )" + text(numbers.between(0.0, 0.2));
    if (numbers.chance(0.2)) out += R"(, "restitution_threshold": )" + text(numbers.between(0.1, 1.0));
    return out + "}";
}

/// Returns the materials. Materials that draw random numbers work with the exact response only.
std::string materials(int number, Numbers& numbers) {
    const std::string body = material("body", numbers);
    const std::string wall = material("wall", numbers);
    std::string out = R"("materials": {)" + wall + ", " + body;
    out += R"(, "noisy": {"restitution": 0.8, "friction": 0.1)";
    if (number % 8 < 2) out += R"(, "diffuse": 0.5, "absorption": 0.1)";
    return out + "}},\n";
}

std::string placement(Numbers& numbers) {
    std::string out = R"("position": )" + vector(numbers, 0.6) + R"(, "rotation": {"axis": )";
    const double z = numbers.between(-1.0, 1.0);
    const double y = numbers.between(-1.0, 1.0);
    const double x = numbers.between(0.1, 1.0);
    out += vector(x, y, z);
    return out + R"(, "degrees": )" + text(numbers.between(0.0, 180.0)) + "}";
}

/// Returns a closed room with one or two bodies of different kinds in its lower half.
std::string colliders(int number, Numbers& numbers) {
    std::string out = R"("colliders": [)";
    out += R"({"name": "room", "type": "mesh", "file": "../meshes/box.obj", "scale": [3, 3.2, 4], "material": "wall"})";
    out += R"(, {"name": "ground", "type": "plane", "point": [0, 0, -1.8], "normal": [)" +
           text(numbers.between(-0.1, 0.1)) + R"(, 0.05, 1], "material": "body"})";
    constexpr std::array kMeshes{"rock_1", "rock_3", "torus_knot", "gear", "rock_5"};
    const auto n = static_cast<std::size_t>(number);
    const bool is_small = number % 8 == 5;  // the global rollback costs the square of the other responses
    if (number % 3 == 0 && !is_small) {
        out += R"(, {"name": "mesh", "type": "mesh", "file": "../meshes/)" + std::string(kMeshes[n / 3 % 5]) +
               R"(.obj", "scale": 0.4, "material": "noisy", )" + placement(numbers) + "}";
    }
    if (number % 3 == 1) {
        const std::string where = placement(numbers);
        const std::string scale = numbers.chance(0.5) ? "1" : vector(1.3, 0.8, 0.6);
        out += R"(, {"name": "ball", "type": "sphere", "radius": 0.5, "scale": )" + scale;
        out += R"(, "material": "body", )" + where + "}";
    }
    if (number % 3 == 2) {
        out += R"(, {"name": "drum", "type": "cylinder", "radius": 0.4, "height": 0.9, "material": "body", )" +
               placement(numbers) + "}";
    }
    if (numbers.chance(0.5)) {
        out += R"(, {"name": "block", "type": "box", "size": [0.7, 0.5, 0.4], "material": "noisy", )" +
               placement(numbers) + "}";
    }
    return out + "],\n";
}

std::string emitters(int number, Numbers& numbers) {
    const int burst = number % 8 == 5 ? 12 : 40;
    std::string out = R"("emitters": [{"name": "source", "type": "box", "center": [0, 0, 1.4], "size": [2, 2, 0.8])";
    out += R"(, "burst": )" + std::to_string(burst) + R"(, "rate": )" + std::to_string(burst);
    out += R"(, "speed": )" + text(numbers.between(0.5, 6.0)) + R"(, "mass": [1.5, 1])";
    if (has_spheres(number)) out += R"(, "particle_radius": [0.06, 0.05])";
    if (numbers.chance(0.3)) out += R"(, "lifetime": [0.5, 0.3])";
    out += "}";
    if (has_children(number)) {
        const char* event = number / 8 % 3 == 0 ? "impact" : number / 8 % 3 == 1 ? "life" : "death";
        out += R"(, {"name": "child", "type": "child", "parent": "source", "speed": 1, "on": ")" + std::string(event);
        out += number / 8 % 3 == 1 ? R"(", "rate": 8)" : R"(", "count": [3, 1])";
        if (number / 8 % 3 == 0) out += R"(, "threshold_impulse": 2)";
        out += "}";
    }
    return out + "]";
}

std::string springs(int number) {
    if (!has_springs(number)) return "";
    return R"(,
"springs": [{"type": "rope", "from": [-1, 0.3, 1.2], "to": [1, 0.3, 1.2], "nodes": 16, "length": 2.6, "mass": 0.8,
  "radius": )" +
           std::string(has_spheres(number) ? "0.03" : "0") +
           R"(, "axial_stiffness": 80, "damping": 0.4, "pinned": "both"},
 {"type": "sheet", "corner": [-0.5, -0.5, 0.9], "side_u": [1, 0, 0], "side_v": [0, 1, 0], "cells_u": 4, "cells_v": 4,
  "mass_per_area": 0.5, "radius": 0.02, "stiffness": 60, "bending_stiffness": 0.5, "damping": 0.1}])";
}

}  // namespace

std::string random_scene(int number) {
    Numbers numbers(number);
    std::string out = "{\"ricochet\": 1,\n";
    out += simulation(number, numbers);
    out += forces(number, numbers);
    out += materials(number, numbers);
    out += colliders(number, numbers);
    out += emitters(number, numbers);
    out += springs(number);
    return out + "}\n";
}

}  // namespace ricochet::golden
