// WebOptions: the command line of runstone-web as a value.
#pragma once
#include <map>
#include <optional>
#include <string>

namespace runstone {

struct WebOptions {
  std::map<std::string, std::string> settings;  // text by field of WebConfig
  std::string config_file, port_file;           // empty: none
  bool print_config = false;
};

/// The options, or the exit code of a program that has nothing more to do: 0 after help or version,
/// 2 after an error. The help text or the error was printed.
struct ParsedWebOptions {
  std::optional<WebOptions> options;
  int exit_code = 0;
};
ParsedWebOptions parse_web_options(int argc, const char* const* argv);

}  // namespace runstone
