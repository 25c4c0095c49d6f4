/// \file
/// Private to the simulation: the record of a particle's move, and the interface of modules that read it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/core/motion_part.h"
#include "ricochet/core/recorded_impact.h"
#include "ricochet/core/segment.h"
#include "ricochet/dynamics/coupled_member.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/response/response.h"

namespace ricochet {

struct BlockRecord;

/// Parts of a MoveReport that moves record only on request.
struct MoveParts {
    bool pieces = false;    ///< only the response `exact` has pieces; others have segments
    bool segments = false;  ///< certified, of all responses
    bool motions = false;   ///< motions and impacts, only of the response `exact`

    [[nodiscard]] bool has_path() const { return pieces || segments; }
};

/// Record of the move of one particle in a substep, before the store has its new state. Parts that nobody has requested
/// may be empty.
struct MoveReport {
    std::size_t index = 0;       ///< of the particle
    const Particles& particles;  ///< has the particle's state before the move
    const ForceInput& moved;     ///< state after the move
    RecordedMotion before{};     ///< empty for free flights, sleepers and the global `rollback`
    RecordedMotion after{};      ///< empty for free flights, sleepers and the global `rollback`
    double end = 0.0;            ///< s, end of the particle's life in the substep
    /// Time at which the particle has its new position, in s. It is earlier than `end` if the particle is stalled. Only
    /// the response `exact` sets it.
    double stored_time = 0.0;
    std::span<const FlownPiece> pieces{};       ///< the path in the order of time
    std::span<const Segment> segments{};        ///< the path in the order of time
    std::span<const MotionPart> motions{};      ///< flights, impacts and contact intervals in the order of time
    std::span<const RecordedImpact> impacts{};  ///< impacts with a rebound
    std::span<const ContactRecord> contacts{};  ///< filled if RunRecorder::collects_contacts()
    std::span<const ColliderLoad> loads{};      ///< filled if RunRecorder::collects_loads()
};

/// Base class of modules, which can read the record of each move.
class MoveObserver {
public:
    MoveObserver() = default;
    virtual ~MoveObserver() = default;
    MoveObserver(const MoveObserver&) = delete;
    MoveObserver& operator=(const MoveObserver&) = delete;

    /// Returns the parts that observe() reads. Without any part, observe() is not called.
    [[nodiscard]] virtual MoveParts needs() const { return {}; }
    /// Reads the record of a move, and writes results into the record of its block. Free flights and particles at rest
    /// are reported only if an observer needs paths. Threads call this function at once for different particles.
    virtual void observe(const MoveReport& /*move*/, BlockRecord& /*block*/) {}
};

/// The objects that read the records of moves, and the parts that they need together.
class MoveObservers {
public:
    /// Adds an object, which must outlive this one.
    void add(MoveObserver& observer) {
        const MoveParts parts = observer.needs();
        if (!parts.has_path() && !parts.motions) return;
        observers_.push_back(&observer);
        needs_.pieces = needs_.pieces || parts.pieces;
        needs_.segments = needs_.segments || parts.segments;
        needs_.motions = needs_.motions || parts.motions;
    }
    [[nodiscard]] bool empty() const { return observers_.empty(); }
    [[nodiscard]] const MoveParts& needs() const { return needs_; }
    /// Gives all objects the record of a move.
    void report(const MoveReport& move, BlockRecord& block) const {
        for (MoveObserver* const observer : observers_) observer->observe(move, block);
    }

private:
    std::vector<MoveObserver*> observers_;
    MoveParts needs_;
};

}  // namespace ricochet
