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
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return {std::nullopt, code == 0 ? 0 : 2};
  }
  return {out, 0};
}

}  // namespace runstone
