#include "ricochet/response/move_lists.h"

#include <algorithm>
#include <vector>

namespace ricochet {
namespace {

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
    list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

void MoveLists::clear() {
    hits.clear(), records.clear(), segments.clear(), motions.clear(), impacts.clear(), loads.clear();
}

void MoveLists::take(MoveScratch& scratch) {
    hits.swap(scratch.hits), records.swap(scratch.records), segments.swap(scratch.segments);
    motions.swap(scratch.motions), impacts.swap(scratch.impacts), loads.swap(scratch.loads);
    scratch.hits.clear(), scratch.records.clear(), scratch.segments.clear();
    scratch.motions.clear(), scratch.impacts.clear(), scratch.loads.clear();
}

void MoveLists::append(const MoveLists& more) {
    ricochet::append(hits, more.hits);
    ricochet::append(records, more.records);
    ricochet::append(segments, more.segments);
    ricochet::append(motions, more.motions);
    ricochet::append(impacts, more.impacts);
    ricochet::append(loads, more.loads);
}

void add(MoveOutcome& sum, const MoveOutcome& next) {
    MoveOutcome outcome = next;
    outcome.bounces += sum.bounces;
    outcome.touches += sum.touches;
    outcome.unsimulated_time += sum.unsimulated_time;
    outcome.stayed += sum.stayed;
    outcome.squeezed = std::max(outcome.squeezed, sum.squeezed);
    outcome.trials += sum.trials;
    sum = outcome;
}

}  // namespace ricochet
