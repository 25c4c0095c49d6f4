/// \file
/// What numbers were measured with: machine, compiler, libraries.
#pragma once

#include <string>
#include <string_view>

#include "bench/records.h"

namespace ricochet::bench {

struct Environment {
    std::string machine;  ///< machine_slug()
    std::string cpu;      ///< as the processor calls itself
    int hardware_threads = 0;
    std::string compiler;     ///< with its version
    std::string build_type;   ///< CMake's
    std::string build_flags;  ///< the compiler's, without those for warnings
    std::string ray_library;
    std::string thread_library;
    std::string date;  ///< UTC, as in 2024-05-31T18:00:00Z
    std::string ricochet;
};

/// A name for machines of the same kind, fit for a folder: the processor's model in small letters, digits and hyphens,
/// and its threads, as in "xeon-platinum-8488c-2t". What every model of a maker says is left out.
[[nodiscard]] std::string machine_slug(std::string_view cpu, int hardware_threads);

/// Here and now. version: of ricochet.
[[nodiscard]] Environment this_environment(std::string_view version);

/// Its fields, to be appended to those of a row.
[[nodiscard]] Record record_of(const Environment& environment);

}  // namespace ricochet::bench
