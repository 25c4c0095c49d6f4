/// \file
/// Private to the simulation: particles that have passed a counter, and particles in its volume.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "ricochet/core/binary_archive.h"

namespace ricochet {

/// Particles that have passed a counter forward, and the times at which particles have entered its volume.
class Visits {
public:
    /// Records a forward passage of a particle. Returns true if it is the first one.
    bool pass(std::uint64_t particle);
    /// Records that a particle enters the volume at a time, in s.
    void enter(std::uint64_t particle, double time) { entered_[particle] = time; }
    /// Records that a particle leaves the volume. Returns the time, in s, at which it has entered; nothing if it has
    /// not entered since the start of the run.
    [[nodiscard]] std::optional<double> leave(std::uint64_t particle);

    /// Returns true if a run can have led to these visits.
    [[nodiscard]] bool is_sound() const;

    /// Saves or restores the visits. a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        a(passed_);
        std::vector<std::pair<std::uint64_t, double>> entered(entered_.begin(), entered_.end());
        archive_entries(a, entered, [&](auto& entry) { a(entry.first), a(entry.second); });
        if constexpr (Archive::kReads) entered_ = {entered.begin(), entered.end()};
    }

private:
    std::vector<std::uint64_t> passed_;  // one bit for each particle, by id: true if it has passed forward
    std::map<std::uint64_t, double> entered_;
};

}  // namespace ricochet
