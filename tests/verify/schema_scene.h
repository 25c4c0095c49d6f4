/// \file
/// Random scenes over all keys of the scene schema, for runs that verify themselves.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "ricochet/core/random.h"
#include "ricochet/io/scene.h"

namespace ricochet::test {

/// Draws scenes from the JSON Schema of scene files. Each optional key is drawn with a probability. The ranges of
/// numbers make the objects of a scene collide. The same seed gives the same scene on every system.
class SchemaScene {
public:
    SchemaScene(const nlohmann::json& schema, std::uint64_t seed);

    /// Returns the next scene. It may break rules that a schema cannot express; see accepted().
    [[nodiscard]] nlohmann::json draw();

private:
    using Json = nlohmann::json;

    [[nodiscard]] Json value(const Json& rule, const std::string& owner, const std::string& key);
    [[nodiscard]] Json object(const Json& rule, const std::string& owner);
    [[nodiscard]] Json named_values(const Json& rule, const std::string& owner, const std::string& key);
    [[nodiscard]] Json list(const Json& rule, const std::string& owner, const std::string& key);
    [[nodiscard]] Json number(const Json& rule, const std::string& owner, const std::string& key);
    [[nodiscard]] Json text(const std::string& owner, const std::string& key);
    [[nodiscard]] const Json& alternative(const Json& rule, const std::string& key);
    [[nodiscard]] bool is_drawn(const std::string& owner, const std::string& key);
    void settle(const std::string& name, Json& made);
    void keep_one(Json& made, const std::string& first, const std::string& second);
    void make_flow_scene(Json& scene);
    void make_heatable(Json& scene);
    [[nodiscard]] bool chance(double p) { return random_.uniform() < p; }
    [[nodiscard]] double between(double low, double high) { return low + (high - low) * random_.uniform(); }
    [[nodiscard]] std::uint64_t below(std::uint64_t count);
    [[nodiscard]] std::string one_of(const std::string& prefix, std::uint64_t count);

    const Json& schema_;
    RandomSequence random_;
    double duration_ = 0.0;  ///< s
    double step_ = 0.0;      ///< s
    int depth_ = 0;          ///< nesting depth of flows in flows
};

/// Returns the names that a scene gives to the values of an object such as `materials` or `frames`.
[[nodiscard]] std::vector<std::string> names_of(const std::string& owner, const std::string& key);

/// Appends the keys of a scene as OWNER.KEY. The owner is a definition of the schema; a definition of several types has
/// its type in brackets: `emitter(box).size`.
void add_keys(const nlohmann::json& schema, const nlohmann::json& scene, std::set<std::string>& keys);

/// Returns all keys of the schema, named as in add_keys().
[[nodiscard]] std::set<std::string> all_keys(const nlohmann::json& schema);

/// Returns the reason why a key is never drawn, or nothing if it is. Keys are named as in add_keys().
[[nodiscard]] std::string reason_not_drawn(const std::string& key);

/// Repeatedly removes the values that the reader refuses by path. Returns the accepted scene, or nothing. folder: the
/// folder of the files from write_scene_files().
[[nodiscard]] std::optional<SceneDescription> accepted(nlohmann::json& scene, const std::filesystem::path& folder);

/// Writes the meshes, tables and fields that drawn scenes name.
void write_scene_files(const std::filesystem::path& folder);

}  // namespace ricochet::test
