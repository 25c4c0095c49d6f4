/// \file
/// A validator for the part of JSON Schema (draft 2020-12) that the scene schema uses. An unknown keyword is an error,
/// so that no keyword is ignored.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ricochet::test {

/// Returns the violations of the schema as "/path: keyword"; empty if the value conforms.
/// Throws std::logic_error at an unknown keyword.
[[nodiscard]] std::vector<std::string> schema_errors(const nlohmann::json& schema, const nlohmann::json& value);

}  // namespace ricochet::test
