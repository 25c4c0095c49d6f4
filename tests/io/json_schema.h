/// \file
/// A validator for the part of JSON Schema (draft 2020-12) that the scene schema uses. A keyword it does not know is a
/// failure of its own, so that nothing is passed over.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ricochet::test {

/// What of the value the schema does not allow, as "/path: keyword"; empty when it conforms.
/// Throws std::logic_error at an unknown keyword.
[[nodiscard]] std::vector<std::string> schema_errors(const nlohmann::json& schema, const nlohmann::json& value);

}  // namespace ricochet::test
