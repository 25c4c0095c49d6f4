#include "view/page/page_budget.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ricochet {
namespace {

constexpr std::size_t kFewFrames = 50;    // least number of frames that are kept before particles are thinned
constexpr double kFewParticles = 2000.0;  // least number of particles after thinning
constexpr std::array kBits = {std::array{16, 16}, std::array{16, 8}, std::array{14, 8}, std::array{12, 8},
                              std::array{11, 8}};  // bits of positions and of attributes

constexpr double kMostOff = 0.1;  // largest distance by which rounding moves a sphere, relative to its radius

}  // namespace

std::vector<PageDetail> detail_ladder(std::size_t frames, std::uint64_t most_particles, int least_bits) {
    std::vector<PageDetail> ladder;
    for (const auto& [position_bits, value_bits] : kBits) {
        const PageDetail detail{std::max(position_bits, least_bits), value_bits, 1, 1.0};
        const bool is_new = ladder.empty() || detail.position_bits < ladder.back().position_bits ||
                            detail.value_bits < ladder.back().value_bits;
        if (is_new) ladder.push_back(detail);
    }
    PageDetail detail = ladder.back();
    const auto thin_frames = [&](std::size_t least) {
        while (frames / (detail.every_frame + 1) + 1 >= least) {
            detail.every_frame += std::max<std::size_t>(1, detail.every_frame / 3);
            if (frames / detail.every_frame + 1 < least) break;
            ladder.push_back(detail);
        }
        detail.every_frame = ladder.back().every_frame;
    };
    thin_frames(kFewFrames);
    for (double part = 0.75; part * static_cast<double>(most_particles) >= kFewParticles; part *= 0.75) {
        detail.particles = part;
        ladder.push_back(detail);
    }
    thin_frames(2);
    return ladder;
}

int needed_position_bits(double radius, double longest_edge) {
    if (!(radius > 0.0)) return kLeastPositionBits;
    int bits = kLeastPositionBits;
    const auto off = [&] { return rounding_distance(longest_edge / (std::exp2(bits) - 1.0)); };
    while (bits < kMostPositionBits && off() > kMostOff * radius) ++bits;
    return bits;
}

std::size_t first_fitting(const std::vector<PageDetail>& ladder, std::size_t begin, double budget,
                          const std::function<double(const PageDetail&)>& bytes) {
    std::size_t low = begin;  // no level before this index fits
    std::size_t high = ladder.size();
    if (low < high && bytes(ladder[low]) <= budget) return low;
    ++low;
    while (low < high) {
        const std::size_t middle = low + (high - low) / 2;
        if (bytes(ladder[middle]) <= budget) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

}  // namespace ricochet
