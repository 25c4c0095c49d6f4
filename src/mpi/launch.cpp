#include "mpi/launch.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace ricochet::mpi {
namespace {

// Environment variables that Open MPI's mpirun, and PMIx and PMI servers (srun and other versions of mpirun) set. PMIx
// has no variable for the number of processes.
constexpr std::array kRanks = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};
constexpr std::array kSizes = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"};

template <std::size_t N>
std::optional<std::size_t> first_number(const std::array<const char*, N>& names) {
    for (const char* const name : names) {
        const char* const value = std::getenv(name);
        if (value == nullptr) continue;
        const std::string_view text(value);
        std::size_t number = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (error == std::errc() && end == text.data() + text.size()) return number;
    }
    return std::nullopt;
}

}  // namespace

bool was_launched() { return first_number(kRanks).has_value(); }
std::size_t launch_rank() { return first_number(kRanks).value_or(0); }
std::size_t launch_size() { return first_number(kSizes).value_or(1); }

}  // namespace ricochet::mpi
