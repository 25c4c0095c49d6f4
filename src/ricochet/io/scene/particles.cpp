// Explicit particles, which exist from the start of a run: listed in the scene, or read from a text table.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/core/printable.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

constexpr std::size_t kMostErrors = 10;
constexpr std::uint64_t kLargestTable = std::uint64_t{16} << 30;

// Attribute column and component that a cell of a table sets.
struct AttributeComponent {
    std::size_t column = 0;
    int component = 0;
};

// A column of a table, the key of an explicit particle whose rules apply to it, and the member that it sets.
struct Column {
    std::string_view name;
    std::string_view key;  ///< empty for columns of a final state that are not used
    double& (*target)(Particle&) = nullptr;
};

const std::vector<Column>& known_columns() {
    static const std::vector<Column> columns = {
        {"x", "position", [](Particle& p) -> double& { return p.position.x; }},
        {"y", "position", [](Particle& p) -> double& { return p.position.y; }},
        {"z", "position", [](Particle& p) -> double& { return p.position.z; }},
        {"vx", "velocity", [](Particle& p) -> double& { return p.velocity.x; }},
        {"vy", "velocity", [](Particle& p) -> double& { return p.velocity.y; }},
        {"vz", "velocity", [](Particle& p) -> double& { return p.velocity.z; }},
        {"mass", "mass", [](Particle& p) -> double& { return p.mass; }},
        {"radius", "radius", [](Particle& p) -> double& { return p.radius; }},
        {"spin_x", "spin", [](Particle& p) -> double& { return p.spin.x; }},
        {"spin_y", "spin", [](Particle& p) -> double& { return p.spin.y; }},
        {"spin_z", "spin", [](Particle& p) -> double& { return p.spin.z; }},
        {"lifetime", "lifetime", [](Particle& p) -> double& { return p.lifetime; }},
        {"id", ""},
        {"age", ""},
        {"contacts", ""},
        {"resting", ""},
        {"unsimulated_time", ""},
    };
    return columns;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (;;) {
        const std::size_t comma = line.find(',');
        cells.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

std::optional<double> number_of(std::string_view cell) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

class TableParser {
public:
    TableParser(std::string_view text, const std::string& name, std::vector<AttributeDescription> declared)
        : rest_(text), name_(name) {
        table_.attributes = std::move(declared);
        if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    }

    ParticleTable parse() {
        if (!is_text()) return std::move(table_);
        const std::optional<std::string_view> header = next_line();
        if (!header || trimmed(*header).empty()) {
            fail("the first line is empty, expected the names of the columns, for example x,y,z,vx,vy,vz");
            return std::move(table_);
        }
        read_header(*header);
        if (!table_.errors.empty()) return std::move(table_);
        while (const std::optional<std::string_view> line = next_line()) {
            if (!trimmed(*line).empty()) read_particle(*line);
            if (table_.errors.size() < kMostErrors) continue;
            fail("the lines after this one were not read");
            break;
        }
        return std::move(table_);
    }

private:
    /// Returns true if the text has no NUL byte. Otherwise reports an error. A file with NUL bytes is not UTF-8 text,
    /// so all its columns would be unknown.
    bool is_text() {
        const std::size_t nul = rest_.find('\0');
        if (nul == std::string_view::npos) return true;
        constexpr std::size_t kWidestCharacter = 4;
        line_ = 1 + static_cast<std::size_t>(std::count(rest_.begin(), rest_.begin() + nul, '\n'));
        fail(nul < kWidestCharacter ? "is UTF-16 or binary, expected text in UTF-8: save the file as UTF-8"
                                    : "found a NUL byte, expected text only");
        return false;
    }

    std::optional<std::string_view> next_line() {
        if (rest_.empty()) return std::nullopt;
        ++line_;
        const std::size_t end = rest_.find('\n');
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        return line;
    }

    void fail(const std::string& what) {
        table_.errors.push_back(fmt::format("{}:{}: {}", name_, std::max<std::size_t>(line_, 1), what));
    }

    void read_header(std::string_view line) {
        std::vector<std::string_view> names;
        for (const Column& column : known_columns()) names.push_back(column.name);
        std::set<std::string_view> seen;
        for (const std::string_view cell : cells_of(line)) {
            if (table_.errors.size() >= kMostErrors) {
                fail("the columns after this one were not read");
                return;
            }
            const auto same_name = [&](const Column& column) { return column.name == cell; };
            const auto found = std::find_if(known_columns().begin(), known_columns().end(), same_name);
            if (!seen.insert(cell).second) fail(fmt::format("the column \"{}\" appears twice", cell));
            if (found == known_columns().end()) {
                if (const auto target = attribute_component(cell)) {
                    columns_.push_back(*target);
                } else {
                    refuse_column(cell, names);
                }
                continue;
            }
            columns_.push_back(&*found);
            if (found->key.empty()) table_.unused_columns.emplace_back(cell);
        }
        for (const std::string_view needed : {"x", "y", "z"}) {
            if (!seen.contains(needed)) fail(fmt::format("there is no column \"{}\", expected x, y and z", needed));
        }
    }

    // Returns the attribute component of a column, for example "temperature", or "wind_x" for a vector. Columns of
    // appearance need no declaration.
    std::optional<AttributeComponent> attribute_component(std::string_view cell) {
        const bool has_end =
            cell.size() > 2 && cell[cell.size() - 2] == '_' && cell.back() >= 'x' && cell.back() <= 'z';
        const std::string_view stem = has_end ? cell.substr(0, cell.size() - 2) : cell;
        for (const std::string_view name : {cell, stem}) {
            const int components = name == cell ? 1 : 3;
            const auto found = std::find_if(table_.attributes.begin(), table_.attributes.end(),
                                            [&](const AttributeDescription& a) { return a.name == name; });
            const bool is_declared = found != table_.attributes.end();
            const auto attribute = is_declared ? std::optional(*found) : looks_attribute(name);
            if (!attribute || attribute->components != components) continue;
            const auto column = static_cast<std::size_t>(found - table_.attributes.begin());
            if (!is_declared) table_.attributes.push_back(*attribute);
            return AttributeComponent{column, components == 3 ? cell.back() - 'x' : 0};
        }
        return std::nullopt;
    }

    void refuse_column(std::string_view cell, std::vector<std::string_view> names) {
        for (const AttributeDescription& attribute : table_.attributes) names.push_back(attribute.name);
        const std::string help = did_you_mean(nearest_names(cell, names));
        fail(fmt::format(
            "unknown column \"{}\"{}{}; attributes of one's own are declared by the scene's \"attributes\", "
            "vectors have the columns NAME_x, NAME_y and NAME_z",
            printable(cell, 60), help.empty() ? "" : ", ", help));
    }

    void read_particle(std::string_view line) {
        const std::vector<std::string_view> cells = cells_of(line);
        if (cells.size() != columns_.size()) {
            fail(fmt::format("found {} values, expected {} as in the header line", cells.size(), columns_.size()));
            return;
        }
        Particle particle;
        bool good = true;
        particle.attributes.assign(table_.attributes.size(), missing_attribute());
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (table_.errors.size() >= kMostErrors) return;
            if (const auto* const target = std::get_if<AttributeComponent>(&columns_[i])) {
                good = read_attribute(cells[i], *target, particle) && good;
            } else {
                good = read_cell(cells[i], *std::get<const Column*>(columns_[i]), particle) && good;
            }
        }
        if (good && particle.spin != Vec3{} && particle.radius == 0.0) {
            good = false;
            fail("found a spin for a point, which has none, expected a \"radius\" above 0 too");
        }
        if (good) table_.particles.push_back(particle);
    }

    bool read_attribute(std::string_view cell, const AttributeComponent& where, Particle& particle) {
        const AttributeDescription& attribute = table_.attributes[where.column];
        const std::optional<double> value = number_of(cell);
        const double most =
            attribute.name == kColorAttribute || attribute.name == kOpacityAttribute ? 1.0 : kLargestCoordinate;
        const double least = looks_attribute(attribute.name) ? 0.0 : -most;
        if (!value || *value < least || *value > most) {
            fail(fmt::format("found \"{}\" for the attribute \"{}\", expected a number from {} to {}",
                             printable(cell, 60), attribute.name, least, most));
            return false;
        }
        AttributeValue& target = particle.attributes[where.column];
        if (is_missing(target)) target = attribute.fallback;
        target[where.component] = *value;
        return true;
    }

    bool read_cell(std::string_view cell, const Column& column, Particle& particle) {
        if (column.target == nullptr) return true;
        if (column.key == "lifetime" && (cell.empty() || cell == "inf")) return true;  // for ever
        const KeySpec& rules = *find_key(particle_spec(), nullptr, column.key);
        const std::optional<double> value = number_of(cell);
        if (!value || !rules.range.contains(*value)) {
            std::string range = range_words(rules.range);
            if (value && range.empty()) range = fmt::format("of at most {} in magnitude", kLargestCoordinate);
            fail(fmt::format("found \"{}\" in column \"{}\", expected a number{}{} ({})", printable(cell, 60),
                             column.name, range.empty() ? "" : " ", range, rules.unit));
            return false;
        }
        column.target(particle) = *value;
        return true;
    }

    std::string_view rest_;
    std::string name_;
    std::size_t line_ = 0;
    std::vector<std::variant<const Column*, AttributeComponent>> columns_;
    ParticleTable table_;
};

// Reads the particles of a table. Columns of appearance in the table also declare their attributes.
std::vector<Particle> particles_from_table(const SceneContext& context, const ObjectView& view,
                                           SimulationSetup& setup) {
    if (!view.has("file")) return {};
    try {
        ParticleTable table = read_particle_table(context.file_of(view), setup.attributes);
        for (const std::string& problem : table.errors) context.error(view, "file", problem);
        if (!table.unused_columns.empty()) {
            const std::vector<std::string_view> names(table.unused_columns.begin(), table.unused_columns.end());
            context.warn(view, "file",
                         fmt::format("the columns {} are not used: particles start with new ids and without a history",
                                     quoted_list(names)));
        }
        setup.attributes = std::move(table.attributes);
        return std::move(table.particles);
    } catch (const InputError& problem) {
        context.error(view, "file", problem.what());
        return {};
    }
}

void warn_about_particles_outside(const SceneContext& context, const SimulationSetup& setup) {
    if (!setup.bounds) return;
    const auto outside = std::count_if(setup.particles.begin(), setup.particles.end(),
                                       [&](const Particle& p) { return !setup.bounds->contains(p.position); });
    if (outside == 0) return;
    context.warn(
        context.root(), "particles",
        fmt::format("{} of {} start outside the bounds and are retired at once", outside, setup.particles.size()));
}

}  // namespace

const ObjectSpec& particle_spec() {
    using P = Particle;
    static const ObjectSpec spec = object<P>(
        "particle", "A particle that exists from the start.",
        joined<P>(
            {{{"position", &P::position, kCoordinate, "m", "Position at the start.", kRequired},
              {"velocity", &P::velocity, kCoordinate, "m/s", "Velocity at the start."},
              {"mass", &P::mass, kMass, "kg", "Mass of the particle."},
              {"radius", &P::radius, kLengthOrZero, "m", "Radius of the particle."},
              {"spin", &P::spin, kCoordinate, "rad/s", "Angular velocity at the start, for particles with a radius."},
              {"lifetime", &P::lifetime, kNotNegative, "s", "Time after which it is retired.", Without{"for ever"}},
              {"pinned", &P::pinned, "true: it never moves. Springs can hang on it."}},
             particle_look_fields()}));
    return spec;
}

const ObjectSpec& particle_file_spec() {
    static const ObjectSpec spec = object<Unbound>(
        "particle table", "Particles from a file.",
        {{"file", ValueType::file,
          "A .csv file: a header line that names the columns, then one line per particle. The columns x, y, z are "
          "required. vx, vy, vz, mass, radius, spin_x, spin_y, spin_z and lifetime are optional.",
          kRequired}});
    return spec;
}

ParticleTable parse_particle_table(std::string_view text, const std::string& name,
                                   std::vector<AttributeDescription> declared) {
    return TableParser(text, name, std::move(declared)).parse();
}

ParticleTable read_particle_table(const std::filesystem::path& path, std::vector<AttributeDescription> declared) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (ending == ".ply" || ending == ".vtp") {
        throw InputError(
            fmt::format("a {} file of particles is part of the scene format but not built in this version, "
                        "expected a .csv file",
                        ending));
    }
    if (ending != ".csv") throw InputError(fmt::format("found {}, expected a .csv file", path.string()));
    const std::string text = read_bytes(path, kLargestTable);
    const auto lines = static_cast<double>(std::count(text.begin(), text.end(), '\n'));
    require_memory(lines * sizeof(Particle), fmt::format("{}: {:.0f} lines", path.string(), lines));
    return parse_particle_table(text, path.string(), std::move(declared));
}

void build_particles(SceneContext& context, SimulationSetup& setup) {
    const JsonNode& node = context.root().node("particles");
    if (node.object() != nullptr) {
        setup.particles = particles_from_table(context, ObjectView(node, particle_file_spec(), "particles"), setup);
    }
    for (const ObjectView& view : context.objects("particles")) {
        setup.particles.push_back(view.read<Particle>());
        const Particle& particle = setup.particles.back();
        if (particle.spin != Vec3{} && particle.radius == 0.0) {
            context.error(view, "spin", "found for a point, which has none, expected a \"radius\" above 0 too");
        }
        setup.particles.back().attributes = particle_values(context, setup, view);
    }
    warn_about_particles_outside(context, setup);
}

}  // namespace ricochet::detail
