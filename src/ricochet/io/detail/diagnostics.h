/// \file
/// What is wrong with a scene, collected so that one run shows all of it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ricochet/io/detail/json_node.h"

namespace ricochet::detail {

/// Where in the document a value is, as text: "colliders[1].file". Keys that are not plain words are quoted.
[[nodiscard]] std::string path_of_key(const std::string& parent, std::string_view key);
[[nodiscard]] std::string path_of_item(const std::string& parent, std::size_t index);

/// Errors and warnings with their places.
class Diagnostics {
public:
    /// file: the scene file's name as the user wrote it. overrides: the `--set` arguments.
    Diagnostics(std::string file, std::vector<std::string> overrides);

    /// path: empty where no single value is meant.
    void error(const Place& place, const std::string& path, std::string_view what);
    void warning(const Place& place, const std::string& path, std::string_view what);

    [[nodiscard]] bool failed() const { return !errors_.empty(); }
    /// One line each, in the order of their places.
    [[nodiscard]] std::vector<std::string> errors() const { return lines(errors_); }
    [[nodiscard]] std::vector<std::string> warnings() const { return lines(warnings_); }
    [[nodiscard]] const std::vector<std::string>& overrides() const { return overrides_; }

private:
    struct Entry {
        Place place;
        std::string line;
    };
    [[nodiscard]] Entry entry(const Place& place, const std::string& path, std::string_view what) const;
    [[nodiscard]] static std::vector<std::string> lines(std::vector<Entry> entries);

    std::string file_;
    std::vector<std::string> overrides_;
    std::vector<Entry> errors_;
    std::vector<Entry> warnings_;
};

}  // namespace ricochet::detail
