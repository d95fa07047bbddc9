// CommandHelp: the options and subcommands of a program, as `--help` shows them. Man pages and shell
// completion are written from it.
#pragma once
#include <string>
#include <vector>

namespace runstone {

struct OptionHelp {
  std::vector<std::string> names;    // with their dashes; of a positional argument its name alone
  std::string value;                 // what stands behind the name, such as TEXT; empty: a flag
  std::vector<std::string> choices;  // the only values, if they are listed
  std::string help;
  std::string group;  // heading; "Options" and "Positionals" are those of CLI11
  bool is_positional = false, is_required = false;
  bool is_value_optional = false;  // a flag that may have a value
};

struct CommandHelp {
  std::string name;  // "runstone-server", or "import" of a subcommand
  std::string description;
  std::string footer;
  std::vector<OptionHelp> options;  // in the order of `--help`; none that is hidden
  std::vector<CommandHelp> subcommands;
};

}  // namespace runstone
