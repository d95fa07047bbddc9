#include "client/app/key_options.hpp"

#include <CLI/CLI.hpp>

#include "common/command_line/help_options.hpp"

namespace runstone {
namespace {

/// The parser of `runstone-client key`, and what it parses into. It stays where it is, because the
/// parser refers to the values.
struct KeyParser {
  KeyCommand out;
  std::string address;
  bool insecure = false;
  CLI::App app{"Shows a player's key, and moves it to another computer.", "runstone-client key"};
  CLI::App *send = nullptr, *receive = nullptr;

  KeyParser();
  KeyParser(const KeyParser&) = delete;
  KeyParser& operator=(const KeyParser&) = delete;
};

KeyParser::KeyParser() {
  app.require_subcommand(1);
  const auto add = [&](const char* name, KeyCommand::Verb verb, const char* help) {
    CLI::App* command = app.add_subcommand(name, help);
    command->add_option("--key", out.key_file, "file of the key")->required();
    command->callback([this, verb] { out.verb = verb; });
    return command;
  };
  add("show", KeyCommand::Verb::show, "print the public key and its fingerprint");
  CLI::App* exported = add("export", KeyCommand::Verb::export_key,
                           "print the key as a line of text that a passphrase protects");
  exported->add_option("--out", out.file, "write the line to this new file instead");
  CLI::App* imported = add("import", KeyCommand::Verb::import_key,
                           "make the key file from an exported line; an existing file stays");
  imported->add_option("--in", out.file, "read the line from this file; default: standard input");
  for (CLI::App* command : {exported, imported}) {
    command->add_option("--passphrase-file", out.passphrase_file,
                        "take the first line of this file as the passphrase; default: ask for it");
  }
  send = add("send", KeyCommand::Verb::send,
             "leave the key at a server for another device, and print a one-time code");
  receive = add("receive", KeyCommand::Verb::receive,
                "make the key file by a one-time code; an existing file stays");
  for (CLI::App* command : {send, receive}) {
    command->add_option("--connect", address, "the server: HOST or HOST:PORT")->required();
    command->add_flag("--insecure", insecure,
                      "do not encrypt the connection; for servers that run with --insecure");
  }
  receive->add_option("CODE", out.code, "the code of `key send`; default: ask for it");
}

}  // namespace

ParsedKeyCommand parse_key_command(int argc, const char* const* argv) {
  KeyParser parser;
  try {
    parser.app.parse(argc, argv);
    if (parser.send->parsed() || parser.receive->parsed()) {
      auto server = parse_host_port(parser.address, kDefaultPort);
      if (!server) throw CLI::ValidationError("--connect", server.error());
      parser.out.server = *std::move(server);
      if (parser.insecure) parser.out.tls.reset();
    }
  } catch (const CLI::ParseError& e) {
    const int code = parser.app.exit(e);
    return {std::nullopt, code == 0 ? 0 : 2};
  }
  return {parser.out, 0};
}

CommandHelp key_command_help() { return command_help(KeyParser().app, "key"); }

}  // namespace runstone
