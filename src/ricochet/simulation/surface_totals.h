/// \file
/// Private to the simulation: hits and impulses of every surface, added up from any number of threads to the same bits.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Sums since the start of the run, one entry a surface.
class SurfaceTotals {
public:
    /// surfaces: how many; 0 where nothing is to be kept.
    explicit SurfaceTotals(std::size_t surfaces) : entries_(surfaces) {}

    [[nodiscard]] bool empty() const { return entries_.empty(); }
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

    /// Adds hits; returns how many of them had an impulse that is too large for the sums. Nothing when empty(). From
    /// any number of threads.
    std::uint64_t add(std::span<const SurfaceHit> hits);
    [[nodiscard]] std::uint64_t hits(std::size_t surface) const {
        return entries_[surface].hits.load(std::memory_order_relaxed);
    }
    /// N s, given to the surface.
    [[nodiscard]] Vec3 impulse(std::size_t surface) const;

    /// Saves or restores the sums; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        for (Entry& entry : entries_) {
            std::uint64_t hits = entry.hits.load(std::memory_order_relaxed);
            a(hits);
            if constexpr (Archive::kReads) entry.hits.store(hits, std::memory_order_relaxed);
            for (FixedPointSum* sum : {&entry.x, &entry.y, &entry.z}) {
                auto words = sum->words();
                a(words);
                if constexpr (Archive::kReads) sum->set_words(words);
            }
        }
    }

private:
    struct Entry {
        std::atomic<std::uint64_t> hits{0};
        FixedPointSum x;
        FixedPointSum y;
        FixedPointSum z;
    };

    std::vector<Entry> entries_;
};

}  // namespace ricochet
