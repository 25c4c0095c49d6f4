// Checks a document against the tables of keys.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "ricochet/core/printable.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/core/vec3.h"
#include "ricochet/io/scene/context.h"
#include "ricochet/io/scene/diagnostics.h"
#include "ricochet/io/scene/keys.h"

namespace ricochet::detail {
namespace {

// Smallest magnitude of a direction. A direction must be long enough that its square does not underflow in the
// normalization. Local: a limit of input values.
constexpr double kShortestDirection = 1e-75;

using Problem = std::optional<std::string>;

std::string found_expected(const JsonNode& node, const KeySpec& key) {
    return fmt::format("found {}, expected {}", described(node), expectation(key));
}

std::string number_text(double x) { return fmt::format("{}", x); }

// Returns the message for a number out of range. The message contains the largest coordinate only if the number exceeds
// it.
std::string out_of_range(const std::string& found, const KeySpec& key, double value) {
    if (std::fabs(value) > kLargestCoordinate && std::fabs(key.range.upper) == kLargestCoordinate) {
        return fmt::format("found {}, expected at most {} in magnitude", found, kLargestCoordinate);
    }
    return fmt::format("found {}, expected {}", found, expectation(key));
}

Problem number_problem(const JsonNode& node, const KeySpec& key) {
    const std::optional<double> value = node.number();
    if (!value) return found_expected(node, key);
    if (!key.range.contains(*value)) return out_of_range(number_text(*value), key, *value);
    return std::nullopt;
}

Problem integer_problem(const JsonNode& node, const KeySpec& key) {
    const std::optional<std::uint64_t> value = node.whole_number();
    if (!value || !key.range.contains(static_cast<double>(*value))) return found_expected(node, key);
    return std::nullopt;
}

Problem choice_problem(const JsonNode& node, const KeySpec& key) {
    if (node.text() == nullptr) return found_expected(node, key);
    std::vector<std::string_view> names;
    for (const Choice& choice : key.choices) {
        if (choice.name == *node.text()) return std::nullopt;
        names.push_back(choice.name);
    }
    const std::string meant = names.size() == 1 ? "" : did_you_mean(nearest_names(*node.text(), names));
    return found_expected(node, key) + (meant.empty() ? "" : "; " + meant);
}

// Sets the components from a list of three numbers. Returns the problem if the node is not a list of three numbers.
Problem components_problem(const JsonNode& node, const KeySpec& key, Vec3& components) {
    const JsonNode::Array* items = node.array();
    if (items == nullptr || items->size() != 3) return found_expected(node, key);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::optional<double> value = (*items)[axis].number();
        if (!value) {
            return fmt::format("found {} in the list, expected {}", described((*items)[axis]), expectation(key));
        }
        if (!key.range.contains(*value)) {
            return out_of_range(number_text(*value) + " in the list", key, *value);
        }
        components[static_cast<int>(axis)] = *value;
    }
    return std::nullopt;
}

Problem vector_problem(const JsonNode& node, const KeySpec& key) {
    Vec3 components;
    if (Problem problem = components_problem(node, key, components)) return problem;
    if (!key.not_zero || max_abs(components) >= kShortestDirection) return std::nullopt;
    return fmt::format("found a vector of no length, expected {}", expectation(key));
}

Problem two_numbers_problem(const JsonNode& node, const KeySpec& key) {
    const JsonNode::Array* items = node.array();
    if (items == nullptr || items->size() != 2) return found_expected(node, key);
    for (const JsonNode& item : *items) {
        const std::optional<double> value = item.number();
        if (!value) return fmt::format("found {} in the list, expected {}", described(item), expectation(key));
        if (!key.range.contains(*value)) return out_of_range(number_text(*value) + " in the list", key, *value);
    }
    return std::nullopt;
}

Problem scale_problem(const JsonNode& node, const KeySpec& key) {
    Vec3 factors(1, 1, 1);
    if (const std::optional<double> factor = node.number()) {
        if (!key.range.contains(*factor)) return out_of_range(number_text(*factor), key, *factor);
        factors.x = *factor;
    } else if (Problem problem = components_problem(node, key, factors)) {
        return problem;
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (std::fabs(factors[axis]) < kShortestDirection) {
            return fmt::format("found the factor {}, expected {}", factors[axis], expectation(key));
        }
    }
    return std::nullopt;
}

Problem pair_problem(const JsonNode& node, const KeySpec& key) {
    const JsonNode* mean = &node;
    double spread = 0.0;
    if (const JsonNode::Array* items = node.array()) {
        if (items->size() != 2 || !(*items)[0].number() || !(*items)[1].number()) return found_expected(node, key);
        mean = items->data();
        spread = *(*items)[1].number();
        if (!(spread >= 0.0)) return fmt::format("found the spread {}, expected {}", spread, expectation(key));
    }
    if (Problem problem = number_problem(*mean, key)) return problem;
    if (!std::isfinite(*mean->number() + spread) || spread > key.range.upper) {
        return fmt::format("found the spread {}, expected a smaller one", spread);
    }
    if (key.low_end.contains(*mean->number() - spread)) return std::nullopt;
    return fmt::format("found [{}, {}], so down to {}; expected {}", *mean->number(), spread, *mean->number() - spread,
                       expectation(key));
}

Problem integers_problem(const JsonNode& node, const KeySpec& key) {
    const JsonNode::Array* items = node.array();
    if (items == nullptr || items->empty()) return found_expected(node, key);
    for (const JsonNode& item : *items) {
        if (!item.whole_number()) {
            return fmt::format("found {} in the list, expected {}", described(item), expectation(key));
        }
    }
    return std::nullopt;
}

bool has_control_character(const std::string& text) {
    return std::ranges::any_of(
        text, [](char c) { return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f; });
}

Problem text_problem(const JsonNode& node, const KeySpec& key) {
    const std::string* text = node.text();
    if (text == nullptr || text->empty()) return found_expected(node, key);
    if (has_control_character(*text))
        return fmt::format("{} contains a control character, expected plain text", described(node));
    return std::nullopt;
}

// Returns the problem of a number or a vector.
Problem quantity_problem(const JsonNode& node, const KeySpec& key) {
    return node.number() ? number_problem(node, key) : vector_problem(node, key);
}

// Returns the first problem of the two values in a list, or that of a single value.
Problem pair_of_problem(const JsonNode& node, const KeySpec& key,
                        Problem (*problem_of)(const JsonNode&, const KeySpec&)) {
    const JsonNode::Array* items = node.array();
    if (items == nullptr || items->size() != 2) return problem_of(node, key);
    const Problem first = problem_of((*items)[0], key);
    return first ? first : problem_of((*items)[1], key);
}

// Returns the problem of a number, a vector, or a pair of two numbers or two vectors.
Problem spread_problem(const JsonNode& node, const KeySpec& key) {
    if (Problem problem = pair_of_problem(node, key, &quantity_problem)) return problem;
    const JsonNode::Array* items = node.array();
    if (items == nullptr || items->size() != 2) return std::nullopt;
    const JsonNode& spread = (*items)[1];
    if (((*items)[0].array() == nullptr) != (spread.array() == nullptr)) {
        return fmt::format("found {}, expected mean and spread alike: two numbers or two of [x, y, z]",
                           described(spread));
    }
    bool negative = spread.number().value_or(0.0) < 0.0;
    if (spread.array() != nullptr) {
        for (const JsonNode& item : *spread.array()) negative = negative || item.number().value_or(0.0) < 0.0;
    }
    if (negative) return fmt::format("found {}, expected a spread >= 0", described(spread));
    return std::nullopt;
}

// Returns the problem of a value that contains no objects.
Problem plain_problem(const JsonNode& node, const KeySpec& key) {
    switch (key.type) {
        case ValueType::number:
            return number_problem(node, key);
        case ValueType::integer:
            return integer_problem(node, key);
        case ValueType::boolean:
            return std::holds_alternative<bool>(node.value) ? Problem{} : found_expected(node, key);
        case ValueType::text:
        case ValueType::file:
            return text_problem(node, key);
        case ValueType::choice:
            return choice_problem(node, key);
        case ValueType::integers:
            return integers_problem(node, key);
        case ValueType::vector:
            return vector_problem(node, key);
        case ValueType::two_numbers:
            return two_numbers_problem(node, key);
        case ValueType::scale:
            return scale_problem(node, key);
        case ValueType::pair:
            return pair_problem(node, key);
        case ValueType::quantity:
            return quantity_problem(node, key);
        case ValueType::vector_pair:
            return pair_of_problem(node, key, &vector_problem);
        default:
            return std::nullopt;
    }
}

std::vector<std::string_view> names_of(const std::vector<const KeySpec*>& keys) {
    std::vector<std::string_view> names;
    for (const KeySpec* key : keys) names.push_back(key->name);
    return names;
}

bool is_in(const std::vector<std::string_view>& names, std::string_view name) {
    return std::ranges::find(names, name) != names.end();
}

class Checker {
public:
    explicit Checker(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

    void check_object(JsonNode& node, const ObjectSpec& spec, const std::string& path) {
        if (node.object() == nullptr) {
            refuse(node, path, fmt::format("found {}, expected an object {{...}} ({})", described(node), spec.title));
            return;
        }
        const Variant* variant = spec.variants.empty() ? nullptr : checked_variant(node, spec, path);
        if (variant == nullptr && !spec.variants.empty()) return check_only_names(node, spec, path);
        check_members(node, spec, variant, path);
    }

private:
    void refuse(JsonNode& node, const std::string& path, const std::string& what) {
        diagnostics_.error(node.location, path, what);
        node.value = std::monostate{};
    }

    void check_value(JsonNode& node, const KeySpec& key, const std::string& path) {
        switch (key.type) {
            case ValueType::object:
                return check_object(node, *key.content, path);
            case ValueType::named_object:
                return check_named_object(node, key, path);
            case ValueType::drawn:
                return check_drawn(node, key, path);
            case ValueType::list:
                return check_list(node, key, path);
            case ValueType::list_or_file:
                if (node.object() != nullptr) return check_object(node, particle_file_spec(), path);
                return check_list(node, key, path);
            case ValueType::table:
            case ValueType::text_table:
            case ValueType::quantity_table:
                return check_table(node, key, path);
            default:
                if (const Problem problem = plain_problem(node, key)) refuse(node, path, *problem);
        }
    }

    void check_named_object(JsonNode& node, const KeySpec& key, const std::string& path) {
        if (node.object() != nullptr) {
            check_object(node, *key.content, path);
        } else if (const Problem problem = text_problem(node, key)) {
            refuse(node, path, *problem);
        }
    }

    void check_drawn(JsonNode& node, const KeySpec& key, const std::string& path) {
        if (node.object() != nullptr) {
            check_object(node, *key.content, path);
        } else if (const Problem problem = pair_problem(node, key)) {
            refuse(node, path, *problem);
        }
    }

    void check_list(JsonNode& node, const KeySpec& key, const std::string& path) {
        JsonNode::Array* items = node.array();
        if (items == nullptr || items->size() < key.least) {
            refuse(node, path, found_expected(node, key));
            return;
        }
        for (std::size_t i = 0; i < items->size(); ++i) check_object((*items)[i], *key.content, path_of_item(path, i));
    }

    void check_table(JsonNode& node, const KeySpec& key, const std::string& path) {
        JsonNode::Object* members = node.object();
        if (members == nullptr) {
            refuse(node, path, found_expected(node, key));
            return;
        }
        const KeySpec text{.name = "", .type = ValueType::text, .description = ""};
        for (JsonMember& member : *members) {
            if (member.key.empty())
                diagnostics_.error(member.key_location, path, "found an empty name, expected a name");
            // Names from a mesh file can have any characters. Names in a scene appear as columns and lines of reports,
            // so control characters are not allowed.
            if (key.type != ValueType::text_table && has_control_character(member.key)) {
                diagnostics_.error(member.key_location, path,
                                   fmt::format("the name \"{}\" contains a control character, expected plain text",
                                               printable(member.key, 60)));
            }
            const std::string member_path = path_of_key(path, member.key);
            if (key.type == ValueType::table) {
                check_object(member.value, *key.content, member_path);
            } else if (key.type == ValueType::quantity_table) {
                const KeySpec value{.name = "", .type = ValueType::quantity, .description = "", .range = key.range};
                if (const Problem problem = spread_problem(member.value, value))
                    refuse(member.value, member_path, *problem);
            } else {
                check_value(member.value, text, member_path);
            }
        }
    }

    // Returns the variant that the key "type" selects, and reports errors of this key.
    const Variant* checked_variant(JsonNode& node, const ObjectSpec& spec, const std::string& path) {
        correct_type_key(node, spec, path);
        KeySpec key{.name = "type", .type = ValueType::choice, .description = "", .required = true};
        for (const Variant& variant : spec.variants) key.choices.push_back({variant.name, variant.description});
        JsonNode* type = node.find("type");
        if (type == nullptr && !spec.default_type.empty()) return variant_of(node, spec);
        if (type == nullptr) {
            diagnostics_.error(node.location, path_of_key(path, "type"), "missing, expected " + expectation(key));
            return nullptr;
        }
        check_value(*type, key, path_of_key(path, "type"));
        return variant_of(node, spec);
    }

    // Corrects a misspelt key "type" before all other keys, because the known names of the other keys depend on the
    // type.
    void correct_type_key(JsonNode& node, const ObjectSpec& spec, const std::string& path) {
        if (node.find("type") != nullptr) return;
        const std::vector<std::string_view> known = all_names(spec);
        for (JsonMember& member : *node.object()) {
            if (is_in(known, member.key)) continue;
            const auto nearest = nearest_absent(member.key, known, node);
            if (nearest.size() != 1 || nearest[0] != "type") continue;
            report_unknown(member, path, nearest, known, spec);
            member.key = "type";
            return;
        }
    }

    // Returns the names of all keys of an object with variants.
    static std::vector<std::string_view> all_names(const ObjectSpec& spec) {
        std::vector<std::string_view> names = names_of(keys_of(spec, nullptr));
        names.emplace_back("type");
        for (const Variant& variant : spec.variants) {
            for (const KeySpec& key : variant.keys) {
                if (!is_in(names, key.name)) names.push_back(key.name);
            }
        }
        return names;
    }

    // Returns the known names nearest to a word. Names that the object already has are omitted if other names remain.
    static std::vector<std::string_view> nearest_absent(const std::string& word,
                                                        const std::vector<std::string_view>& known,
                                                        const JsonNode& node) {
        std::vector<std::string_view> nearest = nearest_names(word, known);
        const auto is_there = [&](std::string_view name) { return node.find(name) != nullptr; };
        if (!std::ranges::all_of(nearest, is_there)) {
            nearest.erase(std::remove_if(nearest.begin(), nearest.end(), is_there), nearest.end());
        }
        return nearest;
    }

    // Returns the path to a key with this name in a nested object, for example simulation.duration for duration.
    static std::optional<std::string> key_below(std::string_view name, const ObjectSpec& spec) {
        for (const KeySpec& key : spec.keys) {
            if (key.type != ValueType::object || key.content == nullptr) continue;
            if (find_key(*key.content, nullptr, name) != nullptr) return fmt::format("{}.{}", key.name, name);
        }
        return std::nullopt;
    }

    void report_unknown(const JsonMember& member, const std::string& path, const std::vector<std::string_view>& nearest,
                        const std::vector<std::string_view>& known, const ObjectSpec& spec) {
        std::string help = nearest.empty() ? "known keys: " + quoted_list(known) : did_you_mean(nearest);
        if (const auto below = key_below(member.key, spec); below && nearest.empty()) help = did_you_mean({*below});
        diagnostics_.error(member.key_location, path_of_key(path, member.key), "unknown key; " + help);
    }

    // Checks only the names of keys in an object without a valid type. The values of such an object cannot be checked.
    void check_only_names(JsonNode& node, const ObjectSpec& spec, const std::string& path) {
        const std::vector<std::string_view> known = all_names(spec);
        for (const JsonMember& member : *node.object()) {
            if (!is_in(known, member.key))
                report_unknown(member, path, nearest_absent(member.key, known, node), known, spec);
        }
        node.value = std::monostate{};
    }

    void check_members(JsonNode& node, const ObjectSpec& spec, const Variant* variant, const std::string& path) {
        std::set<std::string_view> excused;
        for (JsonMember& member : *node.object()) {
            if (variant != nullptr && member.key == "type") continue;
            correct_key(member, node, spec, variant, path, excused);
            if (const KeySpec* key = find_key(spec, variant, member.key)) {
                check_value(member.value, *key, path_of_key(path, member.key));
            } else {
                member.value.value = std::monostate{};  // no rule applies to an unknown key
            }
        }
        const std::vector<const KeySpec*> keys = keys_of(spec, variant);
        for (const KeySpec* key : keys) {
            if (key->required && node.find(key->name) == nullptr && !excused.contains(key->name)) {
                diagnostics_.error(node.location, path_of_key(path, key->name),
                                   "missing, expected " + expectation(*key));
            }
        }
        if (variant != nullptr) check_alternatives(node, *variant, path, excused);
        for (const KeySpec* key : keys) check_company(node, *key, path, excused);
    }

    // Reports a key if it is unknown. If only one correction is possible, the key gets the corrected name.
    void correct_key(JsonMember& member, const JsonNode& node, const ObjectSpec& spec, const Variant* variant,
                     const std::string& path, std::set<std::string_view>& excused) {
        if (find_key(spec, variant, member.key) != nullptr) return;
        if (const std::string owners = variants_with(spec, member.key); !owners.empty()) {
            const std::string help = did_you_mean(longer_names(member.key, names_of(keys_of(spec, variant))));
            diagnostics_.error(member.key_location, path_of_key(path, member.key),
                               fmt::format("not a key of type \"{}\", it belongs to {}{}{}", variant->name, owners,
                                           help.empty() ? "" : "; ", help));
            return;
        }
        std::vector<std::string_view> known = names_of(keys_of(spec, variant));
        const std::vector<std::string_view> nearest = nearest_absent(member.key, known, node);
        if (variant != nullptr) known.emplace_back("type");
        report_unknown(member, path, nearest, known, spec);
        excused.insert(nearest.begin(), nearest.end());
        if (nearest.size() == 1 && node.find(nearest[0]) == nullptr) member.key = nearest[0];
    }

    // Returns the known names that end with "_" and the word, for example particle_size for size.
    static std::vector<std::string_view> longer_names(const std::string& word,
                                                      const std::vector<std::string_view>& known) {
        std::vector<std::string_view> longer;
        for (const std::string_view name : known) {
            if (name.ends_with("_" + word)) longer.push_back(name);
        }
        return longer;
    }

    static std::string variants_with(const ObjectSpec& spec, std::string_view name) {
        std::vector<std::string_view> owners;
        for (const Variant& variant : spec.variants) {
            const auto has_it = [&](const KeySpec& key) { return key.name == name; };
            if (std::ranges::any_of(variant.keys, has_it)) owners.push_back(variant.name);
        }
        return quoted_list(owners);
    }

    void check_alternatives(const JsonNode& node, const Variant& variant, const std::string& path,
                            const std::set<std::string_view>& excused) {
        if (variant.exactly_one_of.empty()) return;
        const auto is_there = [&](std::string_view name) {
            return node.find(name) != nullptr || excused.contains(name);
        };
        const auto there = std::ranges::count_if(variant.exactly_one_of, is_there);
        if (there == 1) return;
        diagnostics_.error(node.location, path,
                           fmt::format("found {} of the keys {}, expected exactly one of them",
                                       there == 0 ? "none" : "more than one", quoted_list(variant.exactly_one_of)));
    }

    // Reports a key without the key that it needs.
    void check_company(const JsonNode& node, const KeySpec& key, const std::string& path,
                       const std::set<std::string_view>& excused) {
        const JsonNode* value = node.find(key.name);
        if (value == nullptr || key.needs.empty()) return;
        if (node.find(key.needs) != nullptr || excused.contains(key.needs)) return;
        diagnostics_.error(value->location, path_of_key(path, key.name),
                           fmt::format("only goes together with the key \"{}\"", key.needs));
    }

    Diagnostics& diagnostics_;
};

}  // namespace

void check_scene(JsonNode& root, Diagnostics& diagnostics) {
    Checker(diagnostics).check_object(root, scene_spec(), "");
}

}  // namespace ricochet::detail
