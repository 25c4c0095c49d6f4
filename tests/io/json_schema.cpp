#include "io/json_schema.h"

#include <fmt/core.h>

#include <functional>
#include <map>
#include <regex>
#include <stdexcept>

namespace ricochet::test {
namespace {

using Json = nlohmann::json;

bool has_type(const Json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "number") return value.is_number();
    if (type == "integer") {
        return value.is_number_integer() ||
               (value.is_number_float() && value.get<double>() == std::floor(value.get<double>()));
    }
    throw std::logic_error("unknown type " + type);
}

bool matches(const std::string& text, const std::string& pattern) {
    static std::map<std::string, std::regex> compiled;
    const auto [found, is_new] = compiled.try_emplace(pattern);
    if (is_new) found->second = std::regex(pattern);
    return std::regex_search(text, found->second);
}

class Validator {
public:
    explicit Validator(const Json& root) : root_(root) {}

    std::vector<std::string> errors(const Json& schema, const Json& value, const std::string& path) const {
        std::vector<std::string> found;
        for (const auto& [keyword, rule] : schema.items()) {
            const auto check = checks().find(keyword);
            if (check == checks().end()) throw std::logic_error("unknown keyword " + keyword);
            check->second(*this, schema, rule, value, path, found);
        }
        return found;
    }

private:
    using Errors = std::vector<std::string>;
    using Check = std::function<void(const Validator&, const Json& schema, const Json& rule, const Json& value,
                                     const std::string& path, Errors& found)>;

    bool conforms(const Json& schema, const Json& value) const { return errors(schema, value, "").empty(); }

    static Check only_if(bool (*applies)(const Json&), bool (*good)(const Json& rule, const Json& value),
                         const char* name) {
        return [=](const Validator&, const Json&, const Json& rule, const Json& value, const std::string& path,
                   Errors& found) {
            if (applies(value) && !good(rule, value)) found.push_back(path + ": " + name);
        };
    }

    static bool is_any(const Json&) { return true; }
    static bool is_number(const Json& value) { return value.is_number(); }
    static bool is_text(const Json& value) { return value.is_string(); }
    static bool is_list(const Json& value) { return value.is_array(); }
    static bool is_object(const Json& value) { return value.is_object(); }

    static std::map<std::string, Check> checks_of_any_value() {
        const Check nothing = [](const Validator&, const Json&, const Json&, const Json&, const std::string&, Errors&) {
        };
        return {
            {"$schema", nothing},
            {"$defs", nothing},
            {"title", nothing},
            {"description", nothing},
            {"default", nothing},
            {"type", only_if(
                         is_any, [](const Json& rule, const Json& v) { return has_type(v, rule); }, "type")},
            {"const", only_if(
                          is_any, [](const Json& rule, const Json& v) { return v == rule; }, "const")},
            {"enum",
             only_if(
                 is_any,
                 [](const Json& rule, const Json& v) { return std::find(rule.begin(), rule.end(), v) != rule.end(); },
                 "enum")},
        };
    }

    static std::map<std::string, Check> checks_of_numbers_and_texts() {
        return {
            {"minimum", only_if(
                            is_number, [](const Json& rule, const Json& v) { return v >= rule; }, "minimum")},
            {"maximum", only_if(
                            is_number, [](const Json& rule, const Json& v) { return v <= rule; }, "maximum")},
            {"exclusiveMinimum",
             only_if(
                 is_number, [](const Json& rule, const Json& v) { return v > rule; }, "exclusiveMinimum")},
            {"minLength",
             only_if(
                 is_text,
                 [](const Json& rule, const Json& v) { return v.get<std::string>().size() >= rule.get<std::size_t>(); },
                 "minLength")},
            {"pattern",
             only_if(
                 is_text,
                 [](const Json& rule, const Json& v) { return matches(v.get<std::string>(), rule.get<std::string>()); },
                 "pattern")},
        };
    }

    static std::map<std::string, Check> checks_of_lists_and_objects() {
        return {
            {"minItems",
             only_if(
                 is_list, [](const Json& rule, const Json& v) { return v.size() >= rule.get<std::size_t>(); },
                 "minItems")},
            {"maxItems",
             only_if(
                 is_list, [](const Json& rule, const Json& v) { return v.size() <= rule.get<std::size_t>(); },
                 "maxItems")},
            {"required", only_if(
                             is_object,
                             [](const Json& rule, const Json& v) {
                                 return std::all_of(rule.begin(), rule.end(), [&](const Json& key) {
                                     return v.contains(key.get<std::string>());
                                 });
                             },
                             "required")},
            {"dependentRequired", only_if(
                                      is_object,
                                      [](const Json& rule, const Json& v) {
                                          for (const auto& [key, needs] : rule.items()) {
                                              for (const Json& need : needs) {
                                                  if (v.contains(key) && !v.contains(need.get<std::string>()))
                                                      return false;
                                              }
                                          }
                                          return true;
                                      },
                                      "dependentRequired")},
        };
    }

    static void add_nested_checks(std::map<std::string, Check>& checks) {
        checks["$ref"] = [](const Validator& self, const Json&, const Json& rule, const Json& value,
                            const std::string& path, Errors& found) {
            const Json& target = self.root_.at(Json::json_pointer(rule.get<std::string>().substr(1)));
            for (std::string& error : self.errors(target, value, path)) found.push_back(std::move(error));
        };
        checks["not"] = [](const Validator& self, const Json&, const Json& rule, const Json& value,
                           const std::string& path, Errors& found) {
            if (self.conforms(rule, value)) found.push_back(path + ": not");
        };
        checks["oneOf"] = [](const Validator& self, const Json&, const Json& rule, const Json& value,
                             const std::string& path, Errors& found) {
            const auto matching = std::count_if(rule.begin(), rule.end(),
                                                [&](const Json& choice) { return self.conforms(choice, value); });
            if (matching != 1) found.push_back(path + ": oneOf");
        };
        checks["items"] = [](const Validator& self, const Json& schema, const Json& rule, const Json& value,
                             const std::string& path, Errors& found) {
            if (schema.contains("prefixItems")) throw std::logic_error("items beside prefixItems");
            if (!value.is_array()) return;
            for (std::size_t i = 0; i < value.size(); ++i) self.append(rule, value[i], path, std::to_string(i), found);
        };
        checks["prefixItems"] = [](const Validator& self, const Json&, const Json& rule, const Json& value,
                                   const std::string& path, Errors& found) {
            if (!value.is_array()) return;
            for (std::size_t i = 0; i < std::min(rule.size(), value.size()); ++i) {
                self.append(rule[i], value[i], path, std::to_string(i), found);
            }
        };
        checks["properties"] = [](const Validator& self, const Json&, const Json& rule, const Json& value,
                                  const std::string& path, Errors& found) {
            if (!value.is_object()) return;
            for (const auto& [key, member] : value.items()) {
                if (rule.contains(key)) self.append(rule[key], member, path, key, found);
            }
        };
        checks["additionalProperties"] = [](const Validator& self, const Json& schema, const Json& rule,
                                            const Json& value, const std::string& path, Errors& found) {
            if (!value.is_object()) return;
            for (const auto& [key, member] : value.items()) {
                if (schema.contains("properties") && schema["properties"].contains(key)) continue;
                if (rule.is_boolean()) {
                    if (!rule.get<bool>()) found.push_back(fmt::format("{}/{}: additionalProperties", path, key));
                } else {
                    self.append(rule, member, path, key, found);
                }
            }
        };
        checks["propertyNames"] = [](const Validator& self, const Json&, const Json& rule, const Json& value,
                                     const std::string& path, Errors& found) {
            if (!value.is_object()) return;
            for (const auto& [key, member] : value.items()) self.append(rule, key, path, key, found);
        };
    }

    static const std::map<std::string, Check>& checks() {
        static const std::map<std::string, Check> all = [] {
            std::map<std::string, Check> table = checks_of_any_value();
            table.merge(checks_of_numbers_and_texts());
            table.merge(checks_of_lists_and_objects());
            add_nested_checks(table);
            return table;
        }();
        return all;
    }

    void append(const Json& schema, const Json& value, const std::string& path, const std::string& step,
                Errors& found) const {
        for (std::string& error : errors(schema, value, fmt::format("{}/{}", path, step)))
            found.push_back(std::move(error));
    }

    const Json& root_;
};

}  // namespace

std::vector<std::string> schema_errors(const Json& schema, const Json& value) {
    return Validator(schema).errors(schema, value, "");
}

}  // namespace ricochet::test
