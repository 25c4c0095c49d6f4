// Counters of a scene: disks that count the particles passing through them.
#include <set>
#include <string>
#include <utility>

#include "ricochet/io/scene/context.h"

namespace ricochet::detail {

const ObjectSpec& counter_spec() {
    using C = CounterDescription;
    static const ObjectSpec spec = object<C>(
        "counter", "A disk at rest that counts the particles whose centres pass it. Particles do not feel it.",
        {{"name", &C::name, "Name of the counter, different from the names of other counters.", kRequired},
         {"center", &C::center, kCoordinate, "m", "Centre of the disk.", kRequired},
         {"normal", &C::normal, kCoordinate, "",
          "Direction that counts as forward, of any length. The disk itself belongs to the side that it points to.",
          kRequired, kNotZero},
         {"radius", &C::radius, kLength, "m", "Radius of the disk. The rim belongs to it.", kRequired}});
    return spec;
}

void build_counters(const SceneContext& context, SimulationSetup& setup) {
    std::set<std::string> taken;
    for (const ObjectView& view : context.objects("counters")) {
        auto counter = view.read<CounterDescription>();
        if (view.has("name")) counter.name = context.unique_name(view, setup.counters.size(), "counter", taken);
        setup.counters.push_back(std::move(counter));
    }
}

}  // namespace ricochet::detail
