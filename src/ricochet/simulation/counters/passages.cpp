#include "ricochet/simulation/counters/passages.h"

#include <algorithm>

#include "ricochet/geometry/sweep/path.h"

namespace ricochet {
namespace {

/// Returns true if the particle has met no surface from the start of its move to the end of a piece.
bool is_undisturbed_until(std::span<const FlownPiece> pieces, std::size_t piece) {
    for (std::size_t k = 0; k <= piece && k < pieces.size(); ++k) {
        if (!pieces[k].is_free) return false;
        if (k > 0 && pieces[k].start_velocity != pieces[k - 1].arrival) return false;
    }
    return true;
}

/// Sets the time, velocity and spin of a passage at s seconds from the start of a leg. The spin changes at the first
/// impact or contact of the move.
void complete_on_path(const MovedParticle& moved, std::span<const FlownPiece> pieces, const PathLeg& leg, double s,
                      Passage& passage) {
    if (leg.piece >= pieces.size()) {
        passage.time = moved.end;
        passage.spin = moved.spin_after;
        return;
    }
    const FlownPiece& piece = pieces[leg.piece];
    passage.time = piece.begin + (leg.is_gap ? 0.0 : s);
    passage.velocity = leg.is_gap ? piece.start_velocity : piece.at(passage.time).velocity;
    passage.spin = is_undisturbed_until(pieces, leg.piece) ? moved.spin_before : moved.spin_after;
}

}  // namespace

PassageFinder::PassageFinder(std::span<const CounterDescription> counters) {
    for (const CounterDescription& counter : counters) {
        if (const auto* const box = std::get_if<BoxCounter>(&counter.shape)) {
            surfaces_.emplace_back(BoxSurface(*box));
        } else if (const auto* const mesh = std::get_if<MeshCounter>(&counter.shape)) {
            surfaces_.emplace_back(MeshSurface(*mesh));
        } else if (const auto* const plane = std::get_if<PlaneCounter>(&counter.shape)) {
            surfaces_.emplace_back(FlatSurface(*plane));
        } else if (const auto* const rectangle = std::get_if<RectangleCounter>(&counter.shape)) {
            surfaces_.emplace_back(FlatSurface(*rectangle));
        } else {
            surfaces_.emplace_back(FlatSurface(std::get<DiskCounter>(counter.shape)));
        }
    }
}

bool PassageFinder::encloses(std::size_t counter) const {
    const auto* const mesh = std::get_if<MeshSurface>(&surfaces_[counter]);
    return mesh != nullptr ? mesh->is_closed() : std::holds_alternative<BoxSurface>(surfaces_[counter]);
}

template <class Complete>
void PassageFinder::trace(const MovedParticle& moved, std::span<const FlownPiece> pieces,
                          std::vector<Passage>& passages, const Complete& complete) const {
    if (!is_finite(moved.from) || !is_finite(moved.to)) return;
    for (std::uint32_t n = 0; n < surfaces_.size(); ++n) {
        const auto report = [&](const PathLeg& leg, bool is_forward, double s, const Vec3& normal) {
            Passage passage{n, is_forward, moved.id, moved.mass, moved.radius, moved.birth_time, 0.0, {}, {}, {}};
            passage.direction = is_forward ? normal : -normal;
            complete(leg, s, passage);
            passages.push_back(passage);
        };
        std::visit([&](const auto& surface) { surface.trace(moved.from, moved.to, pieces, report); }, surfaces_[n]);
    }
}

void PassageFinder::trace(const MovedParticle& moved, std::span<const FlownPiece> pieces,
                          std::vector<Passage>& passages) const {
    trace(moved, pieces, passages,
          [&](const PathLeg& leg, double s, Passage& passage) { complete_on_path(moved, pieces, leg, s, passage); });
}

void PassageFinder::trace(const MovedParticle& moved, std::span<const Segment> segments,
                          std::vector<Passage>& passages) const {
    std::vector<FlownPiece> pieces;
    std::vector<double> lengths{0.0};  // of the segments before each segment, m; the last entry is that of all
    for (const Segment& segment : segments) {
        pieces.push_back({line_path(segment.from, segment.to - segment.from, 1.0), 0.0, 1.0, {}, {}, false});
        lengths.push_back(lengths.back() + length(segment.to - segment.from));
    }
    const double duration = moved.end - moved.begin;
    trace(moved, pieces, passages, [&](const PathLeg& leg, double s, Passage& passage) {
        passage.time = moved.begin;
        passage.spin = moved.spin_after;
        if (leg.piece >= pieces.size() || !(lengths.back() > 0.0) || !(duration > 0.0)) return;
        const double before = lengths[leg.piece];
        const double own = lengths[leg.piece + 1] - before;
        passage.time += duration * ((before + (leg.is_gap ? 0.0 : s * own)) / lengths.back());
        const Segment& segment = segments[leg.piece];
        if (own > 0.0) passage.velocity = (lengths.back() / duration / own) * (segment.to - segment.from);
    });
}

}  // namespace ricochet
