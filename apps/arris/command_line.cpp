#include "arris/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "arris/error.h"
#include "base/nearest_name.h"

namespace arris::program {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Error(Error::Kind::input, "", what);
}

std::string long_name(const OptionRow& row) {
  return row.name.substr(row.name.find(',') + 1);
}

std::vector<std::string> names_of(const OptionRow& row) {
  if (row.name.find(',') == std::string::npos) return {row.name};
  return {row.name.substr(0, row.name.find(',')), long_name(row)};
}

std::vector<const OptionRow*> rows_of(const CommandRow& command) {
  std::vector<const OptionRow*> rows;
  for (const OptionGroup& group : command.groups) {
    for (const OptionRow& row : group.options) rows.push_back(&row);
  }
  return rows;
}

[[noreturn]] void fail_unknown_option(const CommandRow& command, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  std::vector<std::string> known;
  for (const OptionRow* row : rows_of(command)) {
    for (const std::string& each : names_of(*row)) known.push_back(each);
  }
  const std::string hint = did_you_mean(name, known);
  fail(
      fmt::format("arris {} has no option {}{}", command.name, name,
                  hint.empty() ? fmt::format("; arris {} --help lists them", command.name) : hint));
}

// What CLI11 says about an option whose value is missing or that is given twice.
[[noreturn]] void fail_parse(const CommandRow& command, const CLI::ParseError& error) {
  const std::string text = error.what();
  for (const OptionRow* row : rows_of(command)) {
    const std::string name = long_name(*row);
    if (text.starts_with(name + ":")) {
      if (row->value.empty()) fail(fmt::format("{} takes no value", name));
      fail(fmt::format("{} takes one value, once: {} {}", name, name, row->value));
    }
  }
  fail(text);
}

void check_argument_count(const CommandRow& command, const std::vector<std::string>& given) {
  if (given.size() < command.min_arguments) {
    fail(fmt::format("arris {} needs {}; arris {} --help shows examples", command.name,
                     command.arguments, command.name));
  }
  if (given.size() > command.max_arguments) {
    fail(fmt::format("arris {} takes {} only; \"{}\" is too much", command.name, command.arguments,
                     given[command.max_arguments]));
  }
}

// CLI11 would take "--quiet=false" for --quiet.
void check_flags(const CommandRow& command, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word == "--") return;
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) continue;
    for (const OptionRow* row : rows_of(command)) {
      if (row->value.empty() && word.substr(0, equals) == row->name) {
        fail(fmt::format("{} takes no value", row->name));
      }
    }
  }
}

std::string wrap(const std::string& text, std::size_t indent, std::size_t width) {
  std::string out;
  std::size_t column = indent;
  for (std::size_t first = 0; first < text.size();) {
    const std::size_t end = std::min(text.find(' ', first), text.size());
    const std::string word = text.substr(first, end - first);
    if (column > indent && column + 1 + word.size() > width) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
    first = end + 1;
  }
  return out;
}

std::string option_title(const OptionRow& row) {
  const std::vector<std::string> names = names_of(row);
  const std::string title = names.size() == 1 ? names[0] : names[0] + ", " + names[1];
  return row.value.empty() ? title : title + " " + row.value;
}

constexpr std::string_view kExitCodes =
    "Exit codes: 0 done, 1 failed or stopped while working, 2 wrong usage or input.";

}  // namespace

std::optional<std::string> Arguments::find(const std::string& name) const {
  const auto found = options.find(name);
  return found == options.end() ? std::nullopt : std::optional(found->second);
}

const CommandRow& find_command(const std::string& name) {
  std::vector<std::string> known;
  for (const CommandRow& command : commands()) {
    if (command.name == name) return command;
    known.push_back(command.name);
  }
  const std::string hint = did_you_mean(name, known);
  fail(fmt::format("there is no command \"{}\"{}", name,
                   hint.empty() ? "; arris --help lists them" : hint));
}

Arguments parse_arguments(const CommandRow& command, const std::vector<std::string>& words) {
  check_flags(command, words);
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  Arguments arguments;
  app.add_option("arguments", arguments.positionals)->expected(0, -1);
  std::map<std::string, std::string> values;
  std::map<std::string, CLI::Option*> given;
  for (const OptionRow* row : rows_of(command)) {
    const std::string name = long_name(*row);
    given[name] =
        row->value.empty() ? app.add_flag(row->name) : app.add_option(row->name, values[name]);
  }
  try {
    app.parse(
        std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes them from the end
  } catch (const CLI::ParseError& error) {
    fail_parse(command, error);
  }
  bool options_end = false;  // at "--"
  for (const std::string& word : app.remaining()) {
    if (!options_end && word == "--") {
      options_end = true;
      continue;
    }
    if (!options_end && word.size() > 1 && word[0] == '-') fail_unknown_option(command, word);
    arguments.positionals.push_back(word);
  }
  for (const auto& [name, option] : given) {
    if (option->count() == 0) continue;
    arguments.options[name] = values.contains(name) ? values[name] : "true";
  }
  if (arguments.has("--quiet") && arguments.has("--verbose")) {
    fail("--quiet and --verbose contradict each other; use one of them");
  }
  // Both only print.
  const bool needs_input = !arguments.has("--help") && arguments.find("--material") != "list";
  if (needs_input) check_argument_count(command, arguments.positionals);
  return arguments;
}

std::string help_text() {
  std::string text =
      "arris renders models with rounded edges.\n\nUsage: arris COMMAND ...\n\nCommands:\n";
  for (const CommandRow& command : commands()) {
    text += fmt::format("  {:<10}{}\n", command.name, command.summary);
  }
  text +=
      "\narris COMMAND --help shows the options of a command, with examples.\n"
      "arris --version prints the version.\n";
  return text + fmt::format("{}\n", kExitCodes);
}

std::string help_text(const CommandRow& command) {
  constexpr std::size_t kColumn = 34, kWidth = 100;
  std::string text = fmt::format("arris {}: {}\n\nUsage: arris {} {} [options]\n\n{}\n",
                                 command.name, command.summary, command.name, command.arguments,
                                 wrap(command.description, 0, kWidth));
  for (const OptionGroup& group : command.groups) {
    text += fmt::format("\n{}:\n", group.title);
    for (const OptionRow& row : group.options) {
      std::string title = "  " + option_title(row);
      title.resize(std::max(title.size() + 2, kColumn), ' ');
      if (title.size() > kColumn) title += "\n" + std::string(kColumn, ' ');
      text += title + wrap(row.help, kColumn, kWidth) + "\n";
    }
  }
  text += "\nExamples:\n";
  for (const Example& example : command.examples) {
    text += fmt::format("  {}\n      {}\n", example.line, example.what);
  }
  return text + fmt::format("\n{}\n", kExitCodes);
}

std::string help_markdown() {
  std::string text =
      "# The arris program\n\n"
      "Made from the program's own table of options by `arris --help-markdown`.\n\n"
      "Results go to stdout, everything else to stderr. Output files appear whole or not at all.\n";
  text += fmt::format("{}\n", kExitCodes);
  for (const CommandRow& command : commands()) {
    text += fmt::format("\n## arris {}\n\n`arris {} {} [options]`: {}.\n\n{}\n", command.name,
                        command.name, command.arguments, command.summary, command.description);
    for (const OptionGroup& group : command.groups) {
      text += fmt::format("\n### {}\n\n", group.title);
      for (const OptionRow& row : group.options) {
        text += fmt::format("- `{}`: {}\n", option_title(row), row.help);
      }
    }
    text += "\n### Examples\n\n";
    for (const Example& example : command.examples) {
      text += fmt::format("- `{}`: {}\n", example.line, example.what);
    }
  }
  return text;
}

}  // namespace arris::program
