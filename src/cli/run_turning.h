// Rotation of a run's particles at any time. The rotation starts at a random value and is integrated with the spins in
// the frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/io/vtk.h"
#include "run/run_folder.h"
#include "view/render/turning.h"

namespace ricochet::cli {

/// Rotations of particles. If the requested times increase, each frame is read only once. The results do not depend on
/// earlier requests.
class RunTurning {
public:
    RunTurning() = default;
    explicit RunTurning(std::vector<FrameFile> frames) : files_(std::move(frames)) {}

    /// Returns the rotation of each particle that has a spin. Between two frames, the spin changes linearly. Throws
    /// InputError for invalid files.
    [[nodiscard]] std::vector<Turn> turns(const VtkPolyData& moment);
    /// Returns the rotation of each particle. Particles without a spin rotate about a random axis. turning_of(i)
    /// returns the mean and spread of their rate, in rad/s.
    [[nodiscard]] std::vector<Turn> shown_turns(const VtkPolyData& moment,
                                                const std::function<MeanSpread(std::size_t)>& turning_of);

private:
    struct Spinning {
        Turn turn;
        Vec3 spin;
    };

    void go_on(const VtkPolyData& frame);
    [[nodiscard]] Turn turn_at(std::int64_t id, const Vec3& spin, double age, double time) const;

    std::vector<FrameFile> files_;
    std::size_t next_ = 0;               // next frame to read
    std::optional<double> next_time_{};  // time of that frame, if known
    double time_ = 0.0;                  // time of the last frame read
    std::unordered_map<std::int64_t, Spinning> known_;
};

}  // namespace ricochet::cli
