#include "cli/run_turning.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

#include "view/export/frame_reader.h"

namespace ricochet::cli {
namespace {

template <class Value>
const std::vector<Value>* column(const VtkPolyData& frame, const char* name) {
    const VtkArray* array = find_array(frame.point_arrays, name);
    return array == nullptr ? nullptr : std::get_if<std::vector<Value>>(&array->values);
}

}  // namespace

Turn RunTurning::turn_at(std::int64_t id, const Vec3& spin, double age, double time) const {
    const auto found = known_.find(id);
    if (found == known_.end()) return rotation_after(random_turn(static_cast<std::uint64_t>(id)), spin, age);
    const Spinning& before = found->second;
    return rotation_after(before.turn, 0.5 * (before.spin + spin), time - time_);
}

void RunTurning::go_on(const VtkPolyData& frame) {
    std::unordered_map<std::int64_t, Spinning> now;
    const auto* ids = column<std::int64_t>(frame, "id");
    const auto* spins = column<Vec3>(frame, "spin");
    const auto* ages = column<double>(frame, "age");
    if (ids != nullptr && spins != nullptr && ages != nullptr) {
        for (std::size_t i = 0; i < ids->size(); ++i) {
            now.emplace((*ids)[i], Spinning{turn_at((*ids)[i], (*spins)[i], (*ages)[i], frame.time), (*spins)[i]});
        }
    }
    known_ = std::move(now);
    time_ = frame.time;
}

std::vector<Turn> RunTurning::turns(const VtkPolyData& moment) {
    if (next_ > 0 && moment.time < time_) {
        next_ = 0;
        known_.clear();
        next_time_.reset();
    }
    while (next_ < files_.size() && (!next_time_ || *next_time_ <= moment.time)) {
        const VtkPolyData frame = read_frame(files_[next_].path);
        next_time_ = frame.time;
        if (frame.time > moment.time) break;
        go_on(frame);
        ++next_;
        next_time_.reset();
    }
    std::vector<Turn> turns(moment.points.size());
    const auto* ids = column<std::int64_t>(moment, "id");
    const auto* spins = column<Vec3>(moment, "spin");
    const auto* ages = column<double>(moment, "age");
    if (ids == nullptr || spins == nullptr || ages == nullptr) return turns;
    for (std::size_t i = 0; i < turns.size(); ++i) {
        turns[i] = turn_at((*ids)[i], (*spins)[i], (*ages)[i], moment.time);
    }
    return turns;
}

std::vector<Turn> RunTurning::shown_turns(const VtkPolyData& moment,
                                          const std::function<MeanSpread(std::size_t)>& turning_of) {
    const bool spins = find_array(moment.point_arrays, "spin") != nullptr;
    std::vector<Turn> all = spins ? turns(moment) : std::vector<Turn>(moment.points.size());
    const auto* ids = column<std::int64_t>(moment, "id");
    const auto* ages = column<double>(moment, "age");
    const auto* radii = column<double>(moment, "radius");
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (spins && radii != nullptr && (*radii)[i] > 0.0) continue;
        const auto id = static_cast<std::uint64_t>(ids != nullptr ? (*ids)[i] : static_cast<std::int64_t>(i));
        const ParticleTurning own = particle_turning(id);
        const MeanSpread turning = turning_of(i);
        const double rate = turning.mean + own.spread * turning.spread;
        all[i] = rotation_after(random_turn(id), rate * own.axis, ages != nullptr ? (*ages)[i] : 0.0);
    }
    return all;
}

}  // namespace ricochet::cli
