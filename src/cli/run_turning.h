// How the particles of a run are turned at any of its times: from a turn of its own each, on by the spins of the
// frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/io/run_folder.h"
#include "ricochet/io/vtk.h"
#include "view/render/turning.h"

namespace ricochet::cli {

/// Reads the frames up to a time once, as long as times go on. The same turns whatever was asked for before.
class RunTurning {
public:
    RunTurning() = default;
    explicit RunTurning(std::vector<FrameFile> frames) : files_(std::move(frames)) {}

    /// Of each particle of a moment that has spins: between two frames a spin changes evenly. Throws InputError for
    /// files that are not a run's.
    [[nodiscard]] std::vector<Turn> turns(const VtkPolyData& moment);
    /// Of each particle of any moment: those without a spin turn about an axis of their own, at a rate, rad/s, of which
    /// turning_of(i) says mean and spread.
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
    std::size_t next_ = 0;               // frame that has not been read
    std::optional<double> next_time_{};  // of that frame, where it is known
    double time_ = 0.0;                  // of the last one that has been
    std::unordered_map<std::int64_t, Spinning> known_;
};

}  // namespace ricochet::cli
