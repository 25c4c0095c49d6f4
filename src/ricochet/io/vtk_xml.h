/// \file
/// Tags of VTK's XML files, as far as their readers need them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace ricochet::detail {

/// Whose file it is, for messages.
struct VtkSource {
    std::filesystem::path path;
    std::string_view expected;  ///< `expected a .vtp file ...`

    /// Throws InputError: `PATH: WHAT; EXPECTED`.
    [[noreturn]] void refuse(const std::string& what) const;
};

struct XmlTag {
    std::string name;  ///< with a leading slash when it closes
    std::map<std::string, std::string, std::less<>> attributes;
    bool closed = false;    ///< <name/>
    std::string_view text;  ///< between this tag and the next
    std::size_t begin = 0;  ///< where the tag begins in the text, bytes
    std::size_t end = 0;    ///< the byte after it
};

/// Cuts a text into tags. The text must outlive it and its tags.
class XmlTags {
public:
    XmlTags(VtkSource source, std::string_view text) : source_(std::move(source)), text_(text) {}

    /// The next tag; nothing at the end. Comments are left out.
    [[nodiscard]] std::optional<XmlTag> next();

private:
    [[nodiscard]] XmlTag parse(std::string_view inside) const;

    VtkSource source_;
    std::string_view text_;
    std::size_t at_ = 0;
};

/// The attribute of a tag that must have it.
[[nodiscard]] const std::string& attribute_of(const VtkSource& source, const XmlTag& tag, std::string_view name);
/// The same as a whole number >= 0.
[[nodiscard]] std::uint64_t count_of(const VtkSource& source, const XmlTag& tag, std::string_view name);

}  // namespace ricochet::detail
