#include "cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/io/scene/diagnostics.h"

namespace ricochet::cli {

Option& Option::type_name(const std::string& name) {
    option_->type_name(name);
    return *this;
}

Option& Option::required() {
    option_->required();
    return *this;
}

Option& Option::show_default() {
    option_->capture_default_str();
    return *this;
}

Option& Option::one_value_each() {
    option_->allow_extra_args(false);
    return *this;
}

Option& Option::needs(const Option& other) {
    option_->needs(other.option_);
    return *this;
}

Option& Option::range(int low, int high) {
    option_->check(CLI::Range(low, high));
    return *this;
}

template <typename Value>
Option Command::add_option(const std::string& name, Value& value, const std::string& help) {
    return Option(app_->add_option(name, value, help));
}

template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option Command::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<int>&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);
template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, std::uint32_t&, const std::string&);
template Option Command::add_option(const std::string&, std::uint64_t&, const std::string&);

void Command::add_flag(const std::string& name, bool& value, const std::string& help) {
    app_->add_flag(name, value, help);
}

Command Command::add_command(const std::string& name, const std::string& help) {
    return Command(app_->add_subcommand(name, help));
}

void Command::on_call(std::function<void()> action) { app_->callback(std::move(action)); }

bool Command::is_called() const { return app_->parsed(); }

namespace {

/// Returns the options that the user may have meant by a word. Their names are spelt similarly to the word. For a word
/// of one letter, they are the names that start with this letter.
std::vector<std::string_view> meant_options(std::string_view word, const std::vector<std::string_view>& known) {
    std::string_view name = word.substr(0, word.find('='));
    name.remove_prefix(std::min(name.find_first_not_of('-'), name.size()));
    if (name.size() != 1) return detail::nearest_names(name, known);
    std::vector<std::string_view> meant;
    std::copy_if(known.begin(), known.end(), std::back_inserter(meant),
                 [&](std::string_view option) { return option.starts_with(fmt::format("--{}", name)); });
    return meant;
}

/// Returns a message about the first word that looks like an option but is unknown, or nothing.
std::optional<std::string> unknown_option(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    for (const std::string& word : command.remaining()) {
        if (word.size() < 2 || word.front() != '-' || word == "--") continue;
        const std::string help = detail::did_you_mean(meant_options(word, {names.begin(), names.end()}));
        return fmt::format("The following argument was not expected: {}{}", word, help.empty() ? "" : "; " + help);
    }
    return std::nullopt;
}

/// Returns the message of unknown_option() for the called command or for the program, or nothing.
std::optional<std::string> unknown_option_of_any(const CLI::App& program) {
    for (const CLI::App* command : program.get_subcommands()) {
        if (auto message = unknown_option(*command)) return message;
    }
    return unknown_option(program);
}

}  // namespace

CommandLine::CommandLine(const std::string& help, const std::string& program)
    : app_(std::make_unique<CLI::App>(help, program)) {
    app_->require_subcommand(1);
}

CommandLine::~CommandLine() = default;

Command CommandLine::program() { return Command(app_.get()); }

void CommandLine::add_version(std::function<std::string()> text) {
    app_->set_version_flag("--version", std::move(text), "Print the versions of ricochet and its libraries");
}

std::vector<std::string> CommandLine::commands() const {
    std::vector<std::string> names;
    for (const CLI::App* command : app_->get_subcommands([](const CLI::App*) { return true; })) {
        names.push_back(command->get_name());
    }
    return names;
}

void CommandLine::add_footer(const std::string& text) { app_->footer(text); }

std::optional<int> CommandLine::parse(std::vector<std::string> words, const std::string& hint) {
    std::reverse(words.begin(), words.end());  // CLI11 expects the words in reverse order
    try {
        app_->parse(words);
    } catch (const CLI::Success& help_or_version) {
        return app_->exit(help_or_version);
    } catch (const CLI::ParseError& error) {
        // If a required option is misspelt, CLI11 only reports that it is missing. The message about the misspelt word
        // names the cause.
        throw InputError(fmt::format("{} ({})", unknown_option_of_any(*app_).value_or(error.what()), hint));
    }
    return std::nullopt;
}

void add_progress_options(Command command, std::string& progress, bool& quiet) {
    command
        .add_option("--progress", progress,
                    "Show progress: auto on a terminal, always in a pipe too (a line every 10 s), never")
        .type_name("auto|always|never")
        .show_default();
    command.add_flag("--quiet", quiet, "No report, and no progress unless --progress always");
}

}  // namespace ricochet::cli
