/// \file
/// Commands and options of a program. CLI11, which reads them, is compiled in command_line.cpp alone.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace ricochet::cli {

/// How an option is shown and checked; every function returns *this. A reference into its CommandLine.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    /// Name of the value in the help text, for example FILE.
    Option& type_name(const std::string& name);
    Option& required();
    /// The value that the variable has now stands in the help text.
    Option& show_default();
    /// Each occurrence takes one value, so that an argument can follow it.
    Option& one_value_each();
    /// Makes sense only together with the other option.
    Option& needs(const Option& other);
    /// Whole numbers from low to high are accepted.
    Option& range(int low, int high);

private:
    CLI::Option* option_;
};

/// A program or one of its commands. A reference into its CommandLine; variables must outlive that.
class Command {
public:
    explicit Command(CLI::App* app) : app_(app) {}

    /// An option (`--name`) or an argument (`name`). Value: std::string, std::optional<std::string>,
    /// std::vector<std::string>, std::filesystem::path, double, int, std::uint32_t or std::uint64_t.
    template <typename Value>
    Option add_option(const std::string& name, Value& value, const std::string& help);
    void add_flag(const std::string& name, bool& value, const std::string& help);

    [[nodiscard]] Command add_command(const std::string& name, const std::string& help);
    /// What happens when the command has been read; what it throws comes out of CommandLine::parse().
    void on_call(std::function<void()> action);
    /// Whether the command line names this command.
    [[nodiscard]] bool is_called() const;

private:
    CLI::App* app_;
};

/// --progress and --quiet, as all commands that take long have them.
void add_progress_options(Command command, std::string& progress, bool& quiet);

/// The whole command line: a program that needs a command.
class CommandLine {
public:
    CommandLine(const std::string& help, const std::string& program);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    [[nodiscard]] Command program();
    /// Adds --version, which prints the text.
    void add_version(std::function<std::string()> text);

    /// Names of the commands, in the order in which they were added.
    [[nodiscard]] std::vector<std::string> commands() const;

    /// Ends the program's help with a line; commands that are added before have none.
    void add_footer(const std::string& text);

    /// Reads the words behind the program's name and calls the command that they name. Returns the exit code where help
    /// or version was asked for and printed, else nothing. Throws InputError on wrong arguments, with `hint` in
    /// brackets.
    std::optional<int> parse(std::vector<std::string> words, const std::string& hint);

private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace ricochet::cli
