/// \file
/// Parser for the tags of VTK's XML files. It supports only the features that the readers need.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace ricochet::detail {

/// File that is being read, for error messages.
struct VtkSource {
    std::filesystem::path path;
    std::string_view expected;  ///< end of messages, for example `expected a .vtp file ...`

    /// Throws InputError with the message `PATH: WHAT; EXPECTED`.
    [[noreturn]] void refuse(const std::string& what) const;
};

struct XmlTag {
    std::string name;  ///< name of the tag, with a leading slash if it is a closing tag
    std::map<std::string, std::string, std::less<>> attributes;
    bool closed = false;    ///< true for <name/>
    std::string_view text;  ///< text between this tag and the next
    std::size_t begin = 0;  ///< position of the tag in the text, in bytes
    std::size_t end = 0;    ///< position of the byte after the tag
};

/// Splits a text into tags. The text must outlive the object and its tags.
class XmlTags {
public:
    XmlTags(VtkSource source, std::string_view text) : source_(std::move(source)), text_(text) {}

    /// Returns the next tag, or nothing at the end. Comments are skipped.
    [[nodiscard]] std::optional<XmlTag> next();

private:
    [[nodiscard]] XmlTag parse(std::string_view inside) const;

    VtkSource source_;
    std::string_view text_;
    std::size_t at_ = 0;
};

/// Returns the value of an attribute. Throws InputError if the tag does not have the attribute.
[[nodiscard]] const std::string& attribute_of(const VtkSource& source, const XmlTag& tag, std::string_view name);
/// Returns an attribute as a whole number >= 0. Throws InputError if the tag does not have such an attribute.
[[nodiscard]] std::uint64_t count_of(const VtkSource& source, const XmlTag& tag, std::string_view name);

}  // namespace ricochet::detail
