// command_line.h — the program's commands and options, as one table
// What       commands() is the table; parsing, help texts and docs/cli.md all come from it
// Errors     arris::Error, kind input: unknown options and commands with the nearest known name, missing and
//            superfluous values
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace arris::program {

struct OptionRow {
  std::string name;   // "--size", or "-o,--output"
  std::string value;  // "WxH"; empty: a flag
  std::string help;
};

struct OptionGroup {
  std::string title;
  std::vector<OptionRow> options;
};

struct Example {
  std::string line;
  std::string what;
};

// What a command was given; options by their long name.
class Arguments {
 public:
  std::vector<std::string> positionals;
  std::map<std::string, std::string> options;  // flags: "true"

  [[nodiscard]] bool has(const std::string& name) const { return options.contains(name); }
  [[nodiscard]] std::optional<std::string> find(const std::string& name) const;
};

struct CommandRow {
  std::string name;
  std::string arguments;  // "INPUT"
  std::size_t min_arguments = 1, max_arguments = 1;
  std::string summary;
  std::string description;
  std::vector<OptionGroup> groups;
  std::vector<Example> examples;
  int (*run)(const Arguments& arguments) = nullptr;
};

std::span<const CommandRow> commands();

// Throws for unknown names.
const CommandRow& find_command(const std::string& name);

Arguments parse_arguments(const CommandRow& command, const std::vector<std::string>& words);

std::string help_text();
std::string help_text(const CommandRow& command);
std::string help_markdown();

}  // namespace arris::program
