/// \file
/// JSON Schema and reference of scene files. Both are generated from the tables of keys that the scene reader uses.
#pragma once

#include <string>

namespace ricochet {

/// Returns the JSON Schema (draft 2020-12) of scene files, which docs/scene.schema.json contains. The reader also
/// checks relations between values (names, files, orders), which a schema cannot express.
[[nodiscard]] std::string scene_schema();

/// Returns the reference of the scene format in Markdown, which docs/scene-format.md contains.
[[nodiscard]] std::string scene_reference();

}  // namespace ricochet
