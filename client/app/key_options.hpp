// KeyCommand: the command line of `runstone-client key` as a value.
#pragma once
#include <optional>
#include <string>

#include "common/command_line/command_help.hpp"
#include "common/os/host_port.hpp"
#include "common/tls/tls_context.hpp"
#include "protocol/default_port.hpp"

namespace runstone {

struct KeyCommand {
  enum class Verb { show, export_key, import_key, send, receive } verb{};
  std::string key_file;
  std::string file;             // exported to, or imported from; empty: the terminal
  std::string passphrase_file;  // empty: the passphrase is asked for
  // The fields below are used by the verbs send and receive.
  HostPort server{"127.0.0.1", kDefaultPort};
  std::optional<TlsContext> tls = TlsContext::client();  // nullopt: no encryption
  std::string code = {};                                 // to receive; empty: it is asked for
};

/// The command, or the exit code of a program that has nothing more to do: 0 after help, 2 after an
/// error. The help text or the error was printed.
struct ParsedKeyCommand {
  std::optional<KeyCommand> command;
  int exit_code = 0;
};
/// Parses the words from "key" on.
ParsedKeyCommand parse_key_command(int argc, const char* const* argv);
/// Returns the subcommand `key` as the help of the program has it.
CommandHelp key_command_help();

}  // namespace runstone
