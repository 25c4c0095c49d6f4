#include "ricochet/simulation/return_point.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "ricochet/core/error.h"

namespace ricochet {

namespace {

double seconds_from(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Ends the writing of a state that is too large.
struct TooLarge {};

}  // namespace

bool ReturnPoint::is_due() const {
    if (!has_tried_) return true;
    if (is_valid_ && steps_ == 0) return false;
    return seconds_from(tried_at_) >= std::max(kShortestInterval, kCostInterval * cost_);
}

void ReturnPoint::keep(const std::function<void(const ByteSink&)>& save, Beside beside) {
    const Clock::time_point start = Clock::now();
    bytes_.clear();
    is_valid_ = true;
    has_tried_ = true;
    try {
        save([this](std::span<const std::byte> part) {
            if (part.size() > kMostBytes - bytes_.size()) throw TooLarge();
            bytes_.insert(bytes_.end(), part.begin(), part.end());
        });
    } catch (const TooLarge&) {
        is_valid_ = false;
        bytes_ = {};
    }
    beside_ = std::move(beside);
    steps_ = 0;
    seconds_ = 0.0;
    cost_ = seconds_from(start);
    tried_at_ = Clock::now();
}

ByteSource ReturnPoint::source() const {
    const auto at = std::make_shared<std::size_t>(0);
    return [this, at](std::span<std::byte> part) {
        if (part.size() > bytes_.size() - *at) throw RunError("the state that was kept ends too early");
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(*at), part.size(), part.begin());
        *at += part.size();
    };
}

}  // namespace ricochet
