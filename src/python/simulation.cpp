// ricochet._core.Simulation: scenes, steps, and the state of a simulation.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "python/arrays.h"
#include "python/help_texts.h"
#include "python/made_objects.h"
#include "python/simulation_handle.h"
#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/queries/mesh_queries.h"
#include "run/counter_tables.h"

namespace ricochet::python {
namespace {

using Handle = SimulationHandle;

py::object result(const char* name) { return py::module_::import("ricochet._results").attr(name); }

// Particles.

py::object particles_of(const Handle& handle) {
    const std::shared_ptr<LentParticles> lent = handle.share_particles();
    const Particles& p = *lent->shown;
    const std::size_t n = p.size();
    const auto flags = [&](const std::vector<std::uint8_t>& list) { return lent_flags(list.data(), n, lent); };
    return result("Particles")(python::lent(p.id.data(), n, lent), python::lent(p.position.data(), n, lent),
                               python::lent(p.velocity.data(), n, lent), python::lent(p.spin.data(), n, lent),
                               python::lent(p.mass.data(), n, lent), python::lent(p.radius.data(), n, lent),
                               python::lent(p.birth_time.data(), n, lent), python::lent(p.lifetime.data(), n, lent),
                               python::lent(p.contacts.data(), n, lent), flags(p.resting), flags(p.frozen));
}

py::dict attributes_of(const Handle& handle) {
    return handle.read([](const Simulation& simulation) {
        const AttributeTable shown = simulation.shown_attributes();
        py::dict columns;
        for (std::size_t c = 0; c < shown.columns().size(); ++c) {
            std::vector<Vec3> list(shown.size());
            for (std::size_t i = 0; i < list.size(); ++i) list[i] = shown.value(c, i);
            py::object column = given(std::move(list));
            if (shown.columns()[c].components == 1) column = column[py::make_tuple(py::ellipsis(), 0)];
            columns[py::str(shown.columns()[c].name)] = column;
        }
        return columns;
    });
}

/// Returns the value for entry i. The list has either one value for all entries, or one value for each entry.
double value_of(const Doubles& list, std::size_t i) { return list.size() == 1 ? *list.data() : list.data()[i]; }

Doubles one_or_each(const py::handle& object, const char* name, std::size_t count) {
    if (object.is_none())
        throw InputError(fmt::format("{}: found None, expected a number or one row of numbers", name));
    Doubles list = numbers_or_one(object, name);
    if (list.size() != 1) require_same_length(static_cast<std::size_t>(list.size()), count, name);
    return list;
}

std::vector<Vec3> vectors_or_zero(const py::handle& object, const char* name, std::size_t count) {
    if (object.is_none()) return std::vector<Vec3>(count);
    const Doubles list = numbers(object, name, 3);
    require_same_length(static_cast<std::size_t>(list.shape(0)), count, name);
    return {points(list).begin(), points(list).end()};
}

py::array add_particles(Handle& handle, const py::object& position, const py::object& velocity, const py::object& mass,
                        const py::object& radius, const py::object& spin, const py::object& lifetime) {
    const Doubles places = numbers(position, "position", 3);
    const auto count = static_cast<std::size_t>(places.shape(0));
    if (count > kFewNumbers) {
        require_memory(static_cast<double>(count) * (sizeof(Particle) + 2 * sizeof(Vec3)),
                       fmt::format("add_particles: {} particles", count));
    }
    const std::vector<Vec3> velocities = vectors_or_zero(velocity, "velocity", count);
    const std::vector<Vec3> spins = vectors_or_zero(spin, "spin", count);
    const Doubles masses = one_or_each(mass, "mass", count);
    const Doubles radii = one_or_each(radius, "radius", count);
    const Doubles lives = one_or_each(lifetime, "lifetime", count);
    std::vector<Particle> particles(count);
    for (std::size_t i = 0; i < count; ++i) {
        particles[i].position = points(places)[i];
        particles[i].velocity = velocities[i];
        particles[i].spin = spins[i];
        particles[i].mass = value_of(masses, i);
        particles[i].radius = value_of(radii, i);
        particles[i].lifetime = value_of(lives, i);
    }
    return given(handle.change([&](Simulation& simulation) { return simulation.add_particles(particles); }));
}

std::size_t remove_particles(Handle& handle, const py::object& ids) {
    const std::vector<std::uint64_t> list = whole_numbers(ids, "ids", 0);
    return handle.change([&](Simulation& simulation) { return simulation.remove_particles(list); });
}

// Contacts and totals.

/// Contact in the memory layout of NumPy's structured array.
struct Contact {
    double time;
    std::uint64_t particle;
    std::uint32_t collider;
    std::uint32_t triangle;
    Vec3 position;
    Vec3 normal;
    Vec3 velocity_before;
    Vec3 velocity_after;
    double mass;
    double radius;
};

py::dtype contact_type() {
    py::list names;
    py::list formats;
    py::list offsets;
    const auto add = [&](const char* name, const char* format, std::size_t offset) {
        names.append(name);
        formats.append(format);
        offsets.append(offset);
    };
    add("time", "f8", offsetof(Contact, time));
    add("particle", "u8", offsetof(Contact, particle));
    add("collider", "u4", offsetof(Contact, collider));
    add("triangle", "u4", offsetof(Contact, triangle));
    add("position", "(3,)f8", offsetof(Contact, position));
    add("normal", "(3,)f8", offsetof(Contact, normal));
    add("velocity_before", "(3,)f8", offsetof(Contact, velocity_before));
    add("velocity_after", "(3,)f8", offsetof(Contact, velocity_after));
    add("mass", "f8", offsetof(Contact, mass));
    add("radius", "f8", offsetof(Contact, radius));
    py::dict description;
    description["names"] = names;
    description["formats"] = formats;
    description["offsets"] = offsets;
    description["itemsize"] = sizeof(Contact);
    return py::dtype::from_args(description);
}

ContactsObject take_contacts(Handle& handle) {
    const std::vector<ContactRecord> records = handle.take_contacts();
    auto contacts = std::make_shared<std::vector<Contact>>();
    contacts->reserve(records.size());
    handle.read([&](const Simulation& simulation) {
        for (const ContactRecord& r : records) {
            const SurfaceName surface = simulation.surface_name(r.surface);
            contacts->push_back({r.time, r.particle, surface.collider, surface.triangle, r.position, r.normal,
                                 r.velocity_before, r.velocity_after, r.mass, r.radius});
        }
    });
    const py::capsule owner(new std::shared_ptr<const void>(contacts),
                            [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
    const py::array array(contact_type(), {static_cast<py::ssize_t>(contacts->size())}, {}, contacts->data(), owner);
    return py::object(array.attr("view")(result("Contacts")));
}

/// Returns the index of a collider. `which` is its index or its name.
std::size_t collider_of(const Simulation& simulation, const py::handle& which) {
    const auto& colliders = simulation.colliders();
    if (py::isinstance<py::str>(which)) {
        const std::string name = py::cast<std::string>(which);
        for (std::size_t i = 0; i < colliders.size(); ++i) {
            if (colliders[i].name == name) return i;
        }
        throw InputError(fmt::format("collider: found \"{}\", expected one of the colliders' names", name));
    }
    long long number = -1;
    try {
        number = py::cast<long long>(which);
    } catch (const py::cast_error&) {
        throw InputError("collider: expected a number or a name");
    }
    if (number < 0) throw InputError(fmt::format("collider: found {}, expected a number of at least 0", number));
    require_index(static_cast<std::size_t>(number), colliders.size(), "collider");
    return static_cast<std::size_t>(number);
}

TriangleTotalsObject triangle_totals(const Handle& handle, const py::object& collider) {
    return handle.read([&](const Simulation& simulation) -> TriangleTotalsObject {
        TriangleTotals totals = simulation.triangle_totals(collider_of(simulation, collider));
        return result("TriangleTotals")(given(std::move(totals.hits)), given(std::move(totals.impulse)));
    });
}

py::object collider_mesh(const Handle& handle, const py::object& collider) {
    return handle.read([&](const Simulation& simulation) -> py::object {
        auto mesh = simulation.collider_mesh(collider_of(simulation, collider));
        return mesh ? py::cast(MeshQueries(std::move(*mesh))) : py::none();
    });
}

py::list colliders_of(const Handle& handle) {
    return handle.read([](const Simulation& simulation) {
        py::list names;
        for (const ColliderDescription& collider : simulation.colliders()) names.append(collider.name);
        return names;
    });
}

py::tuple vector_of(const Vec3& v) { return py::make_tuple(v.x, v.y, v.z); }

py::list bodies_of(const Handle& handle) {
    return handle.read([](const Simulation& simulation) {
        py::list list;
        for (const BodyState& body : simulation.bodies()) {
            py::dict entry;
            entry["frame"] = body.frame;
            entry["center"] = vector_of(body.center);
            entry["velocity"] = vector_of(body.velocity);
            entry["angular_velocity"] = vector_of(body.angular_velocity);
            entry["angular_momentum"] = vector_of(body.angular_momentum);
            entry["mass"] = body.mass;
            entry["coordinate"] = body.coordinate;
            entry["rate"] = body.rate;
            entry["kinetic_energy"] = body.kinetic_energy;
            list.append(entry);
        }
        return list;
    });
}

py::list counters_of(const Handle& handle) {
    return handle.read([](const Simulation& simulation) {
        const py::object loads = py::module_::import("json").attr("loads");
        py::list list;
        for (const CounterTotals& counter : simulation.counters()) list.append(loads(counter_json(counter)));
        return list;
    });
}

py::dict statistics_of(const Handle& handle) {
    const auto [statistics, is_verified] = handle.read(
        [](const Simulation& simulation) { return std::pair(simulation.statistics(), simulation.options().verify); });
    py::dict dictionary;
    for (const Statistic& line : kStatistics) {
        const auto value_of = [&, &found = statistics](auto member) { return py::cast(std::invoke(member, found)); };
        const bool is_unknown = !is_verified && is_found_by_verification(line);
        dictionary[py::str(std::string(line.name))] =
            is_unknown ? py::object(py::none()) : std::visit(value_of, line.member);
    }
    return dictionary;
}

std::string text_on_statistics() {
    std::string text = "Dictionary of counts over the run so far:\n";
    for (const Statistic& line : kStatistics) text += fmt::format("\n{}: {}", line.name, line.meaning);
    return text;
}

// Steps.

/// Returns the number of steps from the current state to a time, in s.
std::uint64_t steps_to(const Simulation& simulation, double time) {
    if (!(time >= 0.0)) throw InputError(fmt::format("until: found {}, expected a time of at least 0 s", time));
    const double steps = std::ceil(time / simulation.options().time_step - 1e-6);
    const auto last = static_cast<double>(simulation.step_count());
    const auto wanted = static_cast<std::uint64_t>(std::min(steps, last));
    return wanted > simulation.step_index() ? wanted - simulation.step_index() : 0;
}

template <class Value>
auto reader(Value (Simulation::*function)() const) {
    return [function](const Handle& handle) {
        return handle.read([function](const Simulation& simulation) { return (simulation.*function)(); });
    };
}

std::unique_ptr<Handle> made(std::string text, std::string file, std::vector<std::string> overrides, bool contacts,
                             bool verify, const std::vector<py::object>& forces) {
    UserForces own;
    for (std::size_t k = 0; k < forces.size(); ++k) own.push_back(force_of(forces[k], k));
    return std::make_unique<Handle>(std::move(text), std::move(file), std::move(overrides), contacts, verify,
                                    std::move(own));
}

/// Returns the simulation in a Python object, or null if its __init__ has not run.
Handle* handle_in(PyObject* object) {
    auto* const instance = reinterpret_cast<py::detail::instance*>(object);
    return static_cast<Handle*>(instance->get_value_and_holder().value_ptr());
}

int traverse(PyObject* object, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(object));
    const Handle* const handle = handle_in(object);
    return handle == nullptr ? 0 : visit_functions(handle->forces(), visit, arg);
}

int clear(PyObject* object) {
    if (const Handle* const handle = handle_in(object)) release_functions(handle->forces());
    return 0;
}

void deallocate(PyObject* object) {
    PyObject_GC_UnTrack(object);
    py::detail::pybind11_object_dealloc(object);
}

/// Enables garbage collection of cycles. Reason: a force can be a method of the object that owns the simulation.
void take_part_in_garbage_collection(PyHeapTypeObject* heap_type) {
    PyTypeObject& type = heap_type->ht_type;
    type.tp_flags |= Py_TPFLAGS_HAVE_GC;
    type.tp_traverse = &traverse;
    type.tp_clear = &clear;
    type.tp_dealloc = &deallocate;
}

void bind_state(py::class_<Handle>& type) {
    type.def_property_readonly("time", reader(&Simulation::time), "Simulation time, in seconds.")
        .def_property_readonly("step_index", reader(&Simulation::step_index), "Number of steps done.")
        .def_property_readonly("step_count", reader(&Simulation::step_count), "Number of steps of the whole run.")
        .def_property_readonly("finished", reader(&Simulation::finished), "True if the last step is done.")
        .def_property_readonly("kinetic_energy", reader(&Simulation::kinetic_energy), "Kinetic energy, in joule.")
        .def_property_readonly("potential_energy", reader(&Simulation::potential_energy),
                               "Potential energy, in joule; None if a force has no potential.")
        .def_property_readonly(
            "state_hash",
            [](const Handle& handle) {
                return fmt::format("{:016x}", handle.read([](const Simulation& s) { return s.state_hash(); }));
            },
            "Hash of id, position and velocity of all particles: equal for equal bits. The tool prints the same hash.")
        .def_property_readonly(
            "warnings",
            [](const Handle& handle) {
                std::vector<std::string> all = handle.scene().warnings;
                const auto own = handle.read([](const Simulation& s) { return s.warnings(); });
                all.insert(all.end(), own.begin(), own.end());
                return all;
            },
            "List of the warnings that the tool would print.")
        .def_property_readonly("particles", &particles_of,
                               "ricochet.Particles: the particles as read-only arrays, without a copy. They keep their "
                               "values when the simulation continues.")
        .def_property_readonly("attributes", &attributes_of,
                               "Dictionary of arrays: the visible attributes of particles, by name.")
        .def_property_readonly("statistics", &statistics_of, text_on_statistics().c_str())
        .def_property_readonly("colliders", &colliders_of, "List of the colliders' names.")
        .def_property_readonly("bodies", &bodies_of,
                               "List with a dictionary for each dynamic body: position and motion, in SI units.")
        .def_property_readonly("counters", &counters_of,
                               "List with a dictionary for each counter of the scene, with the fields of its entry in "
                               "summary.json: passages forward and backward, masses in kg, statistics, transmission, "
                               "first passage, residence and histograms.")
        .def("__len__",
             [](const Handle& handle) { return handle.read([](const Simulation& s) { return s.particles().size(); }); })
        .def("__repr__", [](const Handle& handle) {
            return handle.read([](const Simulation& s) {
                return fmt::format("<ricochet.Simulation: {} particles at {:g} s, step {} of {}>", s.particles().size(),
                                   s.time(), s.step_index(), s.step_count());
            });
        });
}

void bind_changes(py::class_<Handle>& type) {
    using py::arg;
    type.def("_advance", &Handle::advance, arg("steps"), arg("progress"))
        .def(
            "_steps_to",
            [](const Handle& handle, double time) {
                return handle.read([&](const Simulation& simulation) { return steps_to(simulation, time); });
            },
            arg("time"))
        .def("add_particles", &add_particles, arg("position"), arg("velocity") = py::none(), arg("mass") = 1.0,
             arg("radius") = 0.0, arg("spin") = py::none(), arg("lifetime") = std::numeric_limits<double>::infinity(),
             "Adds particles, all or none, and returns their ids. Vectors have shape (n, 3). Other arguments are one "
             "number for all or one each.")
        .def("remove_particles", &remove_particles, arg("ids"),
             "Removes particles, and returns the number of ids that existed.")
        .def("take_contacts", &take_contacts,
             "Returns the contacts since the last call as a structured array, ordered by time. Requires contacts=True.")
        .def("triangle_totals", &triangle_totals, arg("collider"),
             "Returns hits and impulses on each triangle of a collider, by its number or name.")
        .def("collider_mesh", &collider_mesh, arg("collider"),
             "Returns the mesh of a collider, by its number or name; None for planes.")
        .def(
            "save", [](const Handle& handle) { return py::bytes(handle.save()); },
            "Returns the whole state, for restore() in a simulation of the same scene.")
        .def(
            "restore",
            [](Handle& handle, const py::buffer& state) {
                const auto bytes = py::reinterpret_steal<py::object>(PyBytes_FromObject(state.ptr()));
                if (!bytes) throw py::error_already_set();
                handle.restore(py::cast<std::string>(bytes));
            },
            arg("state"), "Restores a state from save(), in a simulation of the same scene and forces.");
}

}  // namespace

void bind_simulation(py::module_& module) {
    using py::arg;
    py::class_<Handle> type(module, "Simulation", "A simulation of a scene that is given as text.",
                            py::custom_type_setup(&take_part_in_garbage_collection));
    type.def(py::init(&made), arg("text"), arg("file"), arg("overrides"), arg("contacts"), arg("verify"),
             arg("forces"));
    bind_state(type);
    bind_changes(type);
    bind_picture(type);
}

}  // namespace ricochet::python
