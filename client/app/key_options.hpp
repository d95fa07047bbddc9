// KeyCommand: the command line of `runstone-client key` as a value.
#pragma once
#include <optional>
#include <string>

namespace runstone {

struct KeyCommand {
  enum class Verb { show, export_key, import_key } verb{};
  std::string key_file;
  std::string file;             // exported to, or imported from; empty: the terminal
  std::string passphrase_file;  // empty: the passphrase is asked for
};

/// The request, or the exit code of a program that has nothing more to do: 0 after help, 2 after an
/// error. The help text or the error was printed.
struct ParsedKeyCommand {
  std::optional<KeyCommand> request;
  int exit_code = 0;
};
/// Parses the words from "key" on.
ParsedKeyCommand parse_key_command(int argc, const char* const* argv);

}  // namespace runstone
