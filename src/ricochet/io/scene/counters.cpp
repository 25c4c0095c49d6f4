// Counters of a scene: surfaces that count the particles passing through them.
#include <fmt/format.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

/// Keys of a mesh counter.
struct MeshCounterKeys {
    Placement placement;
};

/// Memory of a triangle of a counter's mesh: indices, corners, normal, and its share of vertices and box tree. Local:
/// an estimate for the size of this module's own data.
constexpr double kBytesPerTriangle = 300.0;

constexpr std::string_view kNormal =
    "Direction that counts as forward, of any length. The surface itself belongs to the side that it points to.";

std::vector<Variant> counter_shapes() {
    using Disk = DiskCounter;
    using Plane = PlaneCounter;
    using Rectangle = RectangleCounter;
    using Box = BoxCounter;
    return {
        variant<Disk>(
            "disk", "A disk.",
            {{"center", &Disk::center, kCoordinate, "m", "Centre of the disk.", kRequired},
             {"normal", &Disk::normal, kCoordinate, "", kNormal, kRequired, kNotZero},
             {"radius", &Disk::radius, kLength, "m", "Radius of the disk. The rim belongs to it.", kRequired}}),
        variant<Plane>("plane", "An infinite plane.",
                       {{"center", &Plane::center, kCoordinate, "m", "A point on the plane.", kRequired},
                        {"normal", &Plane::normal, kCoordinate, "", kNormal, kRequired, kNotZero}}),
        variant<Rectangle>(
            "rectangle", "A rectangle.",
            {{"center", &Rectangle::center, kCoordinate, "m", "Centre of the rectangle.", kRequired},
             {"normal", &Rectangle::normal, kCoordinate, "", kNormal, kRequired, kNotZero},
             {"along", &Rectangle::along, kCoordinate, "",
              "Direction of its first side, of any length. Its part along the normal is ignored.", kRequired, kNotZero},
             {"size", &Rectangle::size, kLength, "m",
              "Lengths of the sides, along `along` and across it. The rim belongs to the rectangle.", kRequired}}),
        variant<Box>("box",
                     "A box with edges along the axes. Entering counts as forward, leaving as backward. The faces "
                     "at the lower ends belong to the inside, the others do not.",
                     {{"center", &Box::center, kCoordinate, "m", "Centre of the box.", kRequired},
                      {"size", &Box::size, kLength, "m", "Full edge lengths.", kRequired}}),
        variant("mesh",
                "A triangle mesh from a file, open or closed. Passages from the front side, to which the normals "
                "point, count as forward. Entering a closed mesh with outward normals is thus forward.",
                joined<MeshCounterKeys>(
                    {{{"file", ValueType::file, kMeshFileMeaning, kRequired}, up_field<MeshCounterKeys>()},
                     placement_fields(&MeshCounterKeys::placement)}))};
}

RectangleCounter rectangle_of(const SceneContext& context, const ObjectView& view) {
    const auto rectangle = view.read<RectangleCounter>();
    if (view.has("normal") && view.has("along") && !has_two_sides(rectangle)) {
        context.error(view, "along", "found the direction of the normal, expected one that is not parallel to it");
    }
    return rectangle;
}

MeshCounter mesh_of(SceneContext& context, const ObjectView& view) {
    const auto mesh = context.load_mesh(view);
    if (!mesh) return {};
    if (mesh->triangles.empty()) context.error(view, "file", "the mesh has no triangles, expected at least one");
    context.add_memory(kBytesPerTriangle * static_cast<double>(mesh->triangles.size()));
    return {context.placed_mesh(view, "file", *mesh, view.read<MeshCounterKeys>().placement)};
}

CounterShape shape_of(SceneContext& context, const ObjectView& view) {
    if (view.type() == "plane") return view.read<PlaneCounter>();
    if (view.type() == "rectangle") return rectangle_of(context, view);
    if (view.type() == "box") return view.read<BoxCounter>();
    if (view.type() == "mesh") return mesh_of(context, view);
    if (view.type() == "disk") return view.read<DiskCounter>();
    return DiskCounter{};  // the type has already been reported
}

std::vector<HistogramDescription> histograms_of(const SceneContext& context, const ObjectView& counter) {
    std::vector<HistogramDescription> histograms;
    std::set<PassageQuantity> taken;
    for (const ObjectView& view : counter.objects("histogram")) {
        histograms.push_back(view.read<HistogramDescription>());
        const auto& [quantity, range, bins] = histograms.back();
        if (view.has("range") && !(range[0] < range[1])) {
            context.error(view, "range",
                          fmt::format("found [{}, {}], expected a lower end below the upper one", range[0], range[1]));
        }
        if (view.has("quantity") && !taken.insert(quantity).second) {
            context.error(view, "quantity",
                          fmt::format("the counter has another histogram of \"{}\", expected one for each quantity",
                                      name_of(quantity)));
        }
    }
    return histograms;
}

}  // namespace

const ObjectSpec& histogram_spec() {
    using H = HistogramDescription;
    using Q = PassageQuantity;
    static const ObjectSpec spec = object<H>(
        "histogram", "Numbers of passages by the value of a quantity, for each direction.",
        {{"quantity", &H::quantity, "Quantity of the passages.", kRequired,
          Choices{choice(Q::speed, "speed in m/s"),
                  choice(Q::angle, "angle between the velocity and the normal in degrees, 0 to 90"),
                  choice(Q::radius, "radius of the particle in m"),
                  choice(Q::spin, "angular speed of the particle in rad/s"),
                  choice(Q::energy, "kinetic energy of translation and spin in J"),
                  choice(Q::time, "time of the passage in s")}},
         {"range", &H::range, kCoordinate, "", "Lower and upper end of the bins, in the unit of the quantity.",
          kRequired},
         {"bins", &H::bins, between(1.0, kMostHistogramBins), "", "Number of bins. All have the same width."}});
    return spec;
}

const ObjectSpec& counter_spec() {
    using C = CounterDescription;
    static const ObjectSpec spec = object<C>(
        "counter", "A surface at rest that counts the particles whose centres pass it. Particles do not feel it.",
        {{"name", &C::name, "Name of the counter, different from the names of other counters.", kRequired},
         {"histogram", ValueType::list, "Histograms of the passages, at most one for each quantity.",
          &histogram_spec()}},
        counter_shapes(), "disk");
    return spec;
}

void build_counters(SceneContext& context, SimulationSetup& setup) {
    std::set<std::string> taken;
    for (const ObjectView& view : context.objects("counters")) {
        auto counter = view.read<CounterDescription>();
        if (view.has("name")) counter.name = context.unique_name(view, setup.counters.size(), "counter", taken);
        counter.shape = shape_of(context, view);
        counter.histograms = histograms_of(context, view);
        setup.counters.push_back(std::move(counter));
    }
}

}  // namespace ricochet::detail
