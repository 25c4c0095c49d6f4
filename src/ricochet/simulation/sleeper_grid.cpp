#include "ricochet/simulation/sleeper_grid.h"

namespace ricochet {

void SleeperGrid::update(const PairTraces& traces, const Particles& particles, std::size_t first) {
    if (version_ == traces.version && is_asleep_ == traces.is_asleep) return;
    is_asleep_ = traces.is_asleep;
    version_ = traces.version;
    boxes_.assign(is_asleep_.size(), {});
    bounds_ = {};
    for (std::size_t k = 0; k < is_asleep_.size(); ++k) {
        if (is_asleep_[k] == 0) continue;
        boxes_[k] = ball_box(particles.position[first + k], particles.radius[first + k]);
        bounds_.include(boxes_[k]);
    }
    static_cast<void>(grid_.find_pairs(boxes_));
}

}  // namespace ricochet
