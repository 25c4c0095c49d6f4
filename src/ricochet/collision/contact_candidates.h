/// \file
/// The few triangles that a particle on a foreseen way comes near next.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "ricochet/geometry/acceleration/triangle_clusters.h"

namespace ricochet {

/// All triangles that come near a particle's way in one step to come, where they are known and few. They serve speed
/// only: the step that they are for needs not ask the hierarchy which triangles there are.
class ContactCandidates {
public:
    static constexpr std::size_t kMost = 4;

    /// Nothing is known.
    constexpr ContactCandidates() { triangles_.fill(kUnknown); }
    /// No triangle comes near.
    [[nodiscard]] static constexpr ContactCandidates none() {
        ContactCandidates candidates;
        candidates.triangles_.fill(kNoTriangle);
        return candidates;
    }

    [[nodiscard]] bool is_known() const { return triangles_[0] != kUnknown; }
    /// Only when is_known().
    [[nodiscard]] std::span<const std::uint32_t> triangles() const {
        std::size_t count = 0;
        while (count < kMost && triangles_[count] != kNoTriangle) ++count;
        return {triangles_.data(), count};
    }
    /// One more; with more than kMost nothing is known any longer. Only when is_known().
    void add(std::uint32_t triangle) {
        const std::size_t count = triangles().size();
        if (count == kMost) {
            *this = ContactCandidates{};
        } else {
            triangles_[count] = triangle;
        }
    }

private:
    static constexpr std::uint32_t kUnknown = kNoTriangle - 1;

    std::array<std::uint32_t, kMost> triangles_;
};

}  // namespace ricochet
