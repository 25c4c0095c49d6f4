/// \file
/// Commands and options of a program. Only command_line.cpp includes CLI11, which parses them.
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

/// An option, with functions that set its display in the help text and its checks. Each of these functions returns
/// *this. The object is a reference into its CommandLine.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}

    /// Sets the name of the value in the help text, for example FILE.
    Option& type_name(const std::string& name);
    Option& required();
    /// Shows the current value of the variable in the help text.
    Option& show_default();
    /// Makes each occurrence take one value, so that an argument can follow it.
    Option& one_value_each();
    /// Makes the option valid only together with the other option.
    Option& needs(const Option& other);
    /// Accepts only integers from low to high.
    Option& range(int low, int high);

private:
    CLI::Option* option_;
};

/// A program or one of its commands. The object is a reference into its CommandLine. Variables must outlive the
/// CommandLine.
class Command {
public:
    explicit Command(CLI::App* app) : app_(app) {}

    /// Adds an option (`--name`) or an argument (`name`). Value: std::string, std::optional<std::string>,
    /// std::vector<std::string>, std::filesystem::path, double, int, std::uint32_t or std::uint64_t.
    template <typename Value>
    Option add_option(const std::string& name, Value& value, const std::string& help);
    void add_flag(const std::string& name, bool& value, const std::string& help);

    [[nodiscard]] Command add_command(const std::string& name, const std::string& help);
    /// Sets the action that runs after the command has been parsed. CommandLine::parse() propagates its exceptions.
    void on_call(std::function<void()> action);
    /// Returns true if the command line names this command.
    [[nodiscard]] bool is_called() const;

private:
    CLI::App* app_;
};

/// Adds --progress and --quiet, which all long-running commands have.
void add_progress_options(Command command, std::string& progress, bool& quiet);

/// The command line of a program that requires a command.
class CommandLine {
public:
    CommandLine(const std::string& help, const std::string& program);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    [[nodiscard]] Command program();
    /// Adds --version, which prints the text.
    void add_version(std::function<std::string()> text);

    /// Returns the names of the commands in the order of their addition.
    [[nodiscard]] std::vector<std::string> commands() const;

    /// Adds a last line to the program's help. Commands added before this call do not get the line in their help.
    void add_footer(const std::string& text);

    /// Parses the words after the program's name and runs the named command. Returns the exit code if help or version
    /// was printed, otherwise nothing. Throws InputError on wrong arguments, with `hint` in parentheses.
    std::optional<int> parse(std::vector<std::string> words, const std::string& hint);

private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace ricochet::cli
