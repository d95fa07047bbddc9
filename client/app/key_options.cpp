#include "client/app/key_options.hpp"

#include <CLI/CLI.hpp>

namespace runstone {

ParsedKeyCommand parse_key_command(int argc, const char* const* argv) {
  KeyCommand out;
  CLI::App app{"Shows a player's key, and moves it to another computer.", "runstone-client key"};
  app.require_subcommand(1);
  const auto add = [&](const char* name, KeyCommand::Verb verb, const char* help) {
    CLI::App* command = app.add_subcommand(name, help);
    command->add_option("--key", out.key_file, "file of the key")->required();
    command->callback([&out, verb] { out.verb = verb; });
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
  std::string address;
  bool insecure = false;
  CLI::App* send = add("send", KeyCommand::Verb::send,
                       "leave the key at a server for another device, and print a one-time code");
  CLI::App* receive = add("receive", KeyCommand::Verb::receive,
                          "make the key file by a one-time code; an existing file stays");
  for (CLI::App* command : {send, receive}) {
    command->add_option("--connect", address, "the server: HOST or HOST:PORT")->required();
    command->add_flag("--insecure", insecure,
                      "do not encrypt the connection; for servers that run with --insecure");
  }
  receive->add_option("CODE", out.code, "the code of `key send`; default: ask for it");
  try {
    app.parse(argc, argv);
    if (send->parsed() || receive->parsed()) {
      auto server = parse_host_port(address, kDefaultPort);
      if (!server) throw CLI::ValidationError("--connect", server.error());
      out.server = *std::move(server);
      if (insecure) out.tls.reset();
    }
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return {std::nullopt, code == 0 ? 0 : 2};
  }
  return {out, 0};
}

}  // namespace runstone
