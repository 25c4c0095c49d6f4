#include "view/page/channel_encoder.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ricochet {
namespace {

constexpr std::size_t kOrders = 3;

// Returns the earlier values in the row order of this frame, with 0 for new rows.
Levels moved(const Levels& values, const std::vector<std::uint32_t>& parent) {
    Levels result(parent.size(), 0);
    for (std::size_t row = 0; row < parent.size(); ++row) {
        if (parent[row] < values.size()) result[row] = values[parent[row]];
    }
    return result;
}

}  // namespace

void RowHistory::follow(std::vector<std::uint32_t> parents) {
    std::vector<std::uint8_t> now(parents.size(), 0);
    for (std::size_t row = 0; row < parents.size(); ++row) {
        if (parents[row] != kNew) now[row] = static_cast<std::uint8_t>(std::min(known[parents[row]] + 1, 3));
    }
    parent = std::move(parents);
    known = std::move(now);
}

void RowHistory::follow_same(std::size_t count) {
    std::vector<std::uint32_t> parents(count, kNew);
    if (parent.size() == count) std::iota(parents.begin(), parents.end(), 0U);
    follow(std::move(parents));
}

void ChannelEncoder::encode(const Levels& values, const RowHistory& history, ByteWriter& out) {
    const std::int32_t half = std::int32_t{1} << (bits_ - 1);
    const std::int32_t mask = 2 * half - 1;
    for (Levels& past : past_) past = moved(past, history.parent);
    std::array<Levels, kOrders> differences;
    std::array<std::uint64_t, kOrders> cost{};
    for (Levels& list : differences) list.resize(values.size());
    for (std::size_t row = 0; row < values.size(); ++row) {
        const std::int32_t a = past_[0][row];
        const std::int32_t b = past_[1][row];
        const std::int32_t c = past_[2][row];
        const std::int32_t before = row == 0 ? 0 : values[row - 1];
        const std::array<std::int32_t, 4> by_knowledge = {before, a, 2 * a - b, 3 * a - 3 * b + c};
        for (std::size_t order = 0; order < kOrders; ++order) {
            const std::int32_t expected = by_knowledge[std::min<std::size_t>(history.known[row], order + 1)];
            const std::int32_t difference = ((values[row] - expected + half) & mask) - half;
            const std::int32_t counted = difference < 0 ? -2 * difference - 1 : 2 * difference;
            differences[order][row] = static_cast<std::uint16_t>(counted);
            cost[order] += static_cast<std::uint64_t>(counted);
        }
    }
    const auto order = static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
    out.byte(static_cast<std::uint8_t>(order));
    for (const std::uint16_t value : differences[order]) out.byte(static_cast<std::uint8_t>(value & 0xffU));
    if (bits_ > 8) {
        for (const std::uint16_t value : differences[order]) out.byte(static_cast<std::uint8_t>(value >> 8));
    }
    past_[2] = std::move(past_[1]);
    past_[1] = std::move(past_[0]);
    past_[0] = values;
}

}  // namespace ricochet
