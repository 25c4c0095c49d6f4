// The command line: `ricochet COMMAND ...`. Every command adds itself to the parser and sets the exit code after it
// ran.
// Exit codes: 0 for success, 1 for a failure while running, 2 for wrong arguments, scenes or meshes, 128 + N after
// signal N. Every error is one line on stderr.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/interrupts.h"
#include "cli/shared_run.h"
#include "cli/terminal.h"
#include "inspect/mesh_topology.h"
#include "mpi/mpi_ranks.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/acceleration/triangle_bvh.h"
#include "ricochet/io/scene.h"
#include "ricochet/io/scene/diagnostics.h"

namespace ricochet {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongInput = 2;

constexpr const char* kOutOfMemory =
    "out of memory: the work needs more than the machine, its control group or ulimit gives; make it smaller";

/// Function that adds one subcommand. The subcommand's callback sets exit_code and throws InputError or RunError.
using AddCommand = void (*)(cli::Command program, int& exit_code);

const std::vector<AddCommand>& commands() {
    static const std::vector<AddCommand> list = {
        add_bench_command,  add_check_command, add_compare_command, add_export_command,
        add_info_command,   add_new_command,   add_render_command,  add_run_command,
        add_schema_command, add_study_command, add_view_command,
    };
    return list;
}

std::string version_text() {
    return fmt::format("ricochet {}\n{}\nTBB {}\nOpenMesh {}", RICOCHET_VERSION, embree_version(), tbb_version(),
                       openmesh_version());
}

int report_error(std::string message, int exit_code) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    const std::string who = cli::speaker().empty() ? "" : cli::speaker() + ": ";
    cli::print(stderr, "ricochet: {}{}\n", who, message);
    return exit_code;
}

constexpr const char* kHelp = "help";

// Throws InputError unless the first word is a command or an option.
void check_command(const cli::CommandLine& line, const std::vector<std::string>& words) {
    const std::string word = words.empty() ? "" : words.front();
    std::vector<std::string> known = line.commands();
    known.emplace_back(kHelp);
    if (word.empty() || word.front() == '-' || std::find(known.begin(), known.end(), word) != known.end()) return;
    const std::vector<std::string_view> names(known.begin(), known.end());
    const std::vector<std::string_view> nearest = detail::nearest_names(word, names);
    const std::string help = nearest.empty() ? "expected " + detail::quoted_list(names) : detail::did_you_mean(nearest);
    throw InputError(fmt::format("unknown command \"{}\"; {}", word, help));
}

// Replaces `help run` by `run --help`, and `help` by `--help`.
std::vector<std::string> without_help_command(std::vector<std::string> words) {
    while (!words.empty() && words.front() == kHelp) {
        words.erase(words.begin());
        words.insert(words.begin() + (words.empty() ? 0 : 1), "--help");
    }
    return words;
}

int parse_and_run(const std::vector<std::string>& arguments) {
    cli::CommandLine line("Exact collisions of particles with triangle meshes", "ricochet");
    line.add_version(version_text);
    int exit_code = kDone;
    for (const AddCommand add : commands()) add(line.program(), exit_code);
    line.add_footer("`ricochet help COMMAND`, or `ricochet COMMAND --help`, lists the options of a command.");
    const std::vector<std::string> words = without_help_command(arguments);
    check_command(line, words);
    try {
        if (const auto printed = line.parse(words, "ricochet --help lists commands and options")) return *printed;
    } catch (...) {
        // Only one of the processes that share a run reports the error.
        if (words.empty() || words.front() != "run") throw;
        if (const auto failed = cli::fail_together(std::current_exception())) return *failed;
        throw;
    }
    return exit_code;
}

int run(int argc, char** argv) {
    try {
        const int exit_code = parse_and_run({argv + std::min(argc, 1), argv + argc});
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw RunError("standard output cannot be written");
        return exit_code;
    } catch (const SceneError& error) {
        for (const std::string& message : error.messages()) report_error(message, kWrongInput);
        return kWrongInput;
    } catch (const InputError& error) {
        return report_error(error.what(), kWrongInput);
    } catch (const std::bad_alloc&) {
        return report_error(kOutOfMemory, kFailed);
    } catch (const std::length_error&) {  // a container throws it if its size would exceed the address space
        return report_error(kOutOfMemory, kFailed);
    } catch (const std::exception& error) {
        return report_error(error.what(), kFailed);
    }
}

std::atomic<bool> memory_has_run_out{false};
const std::terminate_handler terminate_otherwise = std::get_terminate();

[[noreturn]] void remember_and_throw() {
    memory_has_run_out = true;
    throw std::bad_alloc();
}

// Reports running out of memory in one line, and ends the program. Called if an allocation fails in code that cannot
// throw, such as destructors of JSON documents and iterators of folders.
[[noreturn]] void terminate() {
    if (memory_has_run_out) {
        (void)std::fputs("ricochet: ", stderr);
        (void)std::fputs(kOutOfMemory, stderr);
        (void)std::fputs("\n", stderr);
        std::_Exit(kFailed);
    }
    terminate_otherwise();
    std::abort();
}

}  // namespace
}  // namespace ricochet

int main(int argc, char** argv) {
    std::set_new_handler(ricochet::remember_and_throw);
    std::set_terminate(ricochet::terminate);
    ricochet::cli::reserve_standard_streams();
    ricochet::cli::end_at_interrupts();
    const int exit_code = ricochet::run(argc, argv);
    ricochet::mpi::end_process(exit_code);
    return exit_code;
}
