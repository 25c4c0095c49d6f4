#include "view/page/page_files.h"

#include <array>
#include <string>

#include "ricochet/core/error.h"

// Symbols defined by the assembler file (src/view/page/CMakeLists.txt).
extern "C" {
#define PAGE_FILE(symbol, name) \
    extern const char symbol[]; \
    extern const char symbol##_end[];
#include RICOCHET_PAGE_FILES
#undef PAGE_FILE
}

namespace ricochet {

std::string_view page_file(std::string_view name) {
    struct File {
        std::string_view name;
        const char* begin;
        const char* end;
    };
    static const std::array files = {
#define PAGE_FILE(symbol, name) File{name, symbol, symbol##_end},
#include RICOCHET_PAGE_FILES
#undef PAGE_FILE
    };
    for (const File& file : files) {
        if (file.name == name) return {file.begin, static_cast<std::size_t>(file.end - file.begin)};
    }
    throw RunError("the program has no page file " + std::string(name));
}

}  // namespace ricochet
