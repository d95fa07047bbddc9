#include "client/app/key_program.hpp"

#include <exception>
#include <istream>
#include <ostream>

#include "client/app/key_transfer.hpp"
#include "client/net/key_file.hpp"
#include "common/core/hex.hpp"
#include "common/os/passphrase.hpp"
#include "common/os/text_file.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

using Done = Result<void, std::string>;

void print(const KeySeed& seed, std::ostream& out) {
  const PublicKey key = key_pair_of(seed).public_key;
  out << "public key  " << to_hex(key) << "\nfingerprint " << key_fingerprint(key) << "\n";
}

Result<std::string, std::string> exported_line(const KeyCommand& command, std::istream& in) {
  if (!command.file.empty()) return read_first_line(command.file);
  std::string line = first_line_of(in);
  if (line.empty()) return failure("standard input: cannot be read, or its first line is empty");
  return line;
}

/// Returns the passphrase of an export. At the terminal it is typed twice.
Result<std::string, std::string> new_passphrase(const KeyCommand& command) {
  const bool is_asked = command.passphrase_file.empty();
  auto passphrase = is_asked ? ask_new_passphrase("passphrase for the exported key: ")
                             : read_first_line(command.passphrase_file);
  if (passphrase && passphrase->size() < kPassphraseBytesMin)
    return failure("the passphrase has fewer than " + std::to_string(kPassphraseBytesMin) +
                   " bytes: take some words");
  return passphrase;
}

Done export_key(const KeyCommand& command, std::ostream& out, SealCost cost) {
  const KeySeed seed = load_key_seed(command.key_file);
  const auto passphrase = new_passphrase(command);
  if (!passphrase) return failure(passphrase.error());
  const auto line = seal_key(seed, *passphrase, cost);
  if (!line) return failure(line.error());
  if (command.file.empty()) {
    out << *line << "\n";
    return {};
  }
  write_new_secret_file(command.file, *line + "\n");
  print(seed, out);
  return {};
}

Done import_key(const KeyCommand& command, std::istream& in, std::ostream& out) {
  const auto line = exported_line(command, in);
  if (!line) return failure(line.error());
  const auto passphrase = command.passphrase_file.empty()
                              ? ask_passphrase("passphrase of the exported key: ")
                              : read_first_line(command.passphrase_file);
  if (!passphrase) return failure(passphrase.error());
  const auto seed = open_sealed_key(*line, *passphrase);
  if (!seed) return failure(seed.error());
  save_new_key(command.key_file, *seed);
  print(*seed, out);
  return {};
}

Done receive(KeyCommand command, std::istream& in, std::ostream& out) {
  if (command.code.empty()) {
    out << "code: " << std::flush;
    command.code = first_line_of(in);
  }
  const auto seed = receive_key(command, out);
  if (!seed) return failure(seed.error());
  print(*seed, out);
  return {};
}

}  // namespace

Done run_key_program(const KeyCommand& command, std::istream& in, std::ostream& out,
                     SealCost cost) {
  try {
    switch (command.verb) {
      case KeyCommand::Verb::show:
        print(load_key_seed(command.key_file), out);
        return {};
      case KeyCommand::Verb::export_key:
        return export_key(command, out, cost);
      case KeyCommand::Verb::import_key:
        return import_key(command, in, out);
      case KeyCommand::Verb::send:
        return send_key(command, out);
      case KeyCommand::Verb::receive:
        return receive(command, in, out);
    }
  } catch (const std::exception& error) {
    return failure(error.what());
  }
  return {};
}

}  // namespace runstone
