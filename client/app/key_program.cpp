#include "client/app/key_program.hpp"

#include <exception>
#include <fstream>
#include <istream>
#include <ostream>

#include "client/net/key_file.hpp"
#include "common/core/hex.hpp"
#include "common/os/passphrase.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

using Done = Result<void, std::string>;

Unexpected<std::string> key_failure(std::string why) { return {std::move(why)}; }

void print(const KeySeed& seed, std::ostream& out) {
  const PublicKey key = key_pair_of(seed).public_key;
  out << "public key  " << to_hex(key) << "\nfingerprint " << key_fingerprint(key) << "\n";
}

/// Returns the first line, at most kLineBytesMax bytes of it, or an empty text.
std::string first_line(std::istream& in) {
  constexpr std::size_t kLineBytesMax = 1024;  // an exported key has about 150
  std::string line;
  for (char c = 0; line.size() < kLineBytesMax && in.get(c) && c != '\n';) line += c;
  return line;
}

/// Returns the passphrase of an export. At the terminal it is typed twice.
Result<std::string, std::string> new_passphrase(const KeyCommand& request) {
  const bool is_asked = request.passphrase_file.empty();
  auto first = is_asked ? ask_passphrase("passphrase for the exported key: ")
                        : read_passphrase(request.passphrase_file);
  if (!first) return first;
  if (first->size() < kPassphraseBytesMin)
    return key_failure("the passphrase has fewer than " + std::to_string(kPassphraseBytesMin) +
                       " bytes: take some words");
  if (!is_asked) return first;
  const auto second = ask_passphrase("again: ");
  if (!second) return second;
  if (*first != *second) return key_failure("the two passphrases differ");
  return first;
}

Done export_key(const KeyCommand& request, std::ostream& out, SealCost cost) {
  const KeySeed seed = load_key_seed(request.key_file);
  const auto passphrase = new_passphrase(request);
  if (!passphrase) return key_failure(passphrase.error());
  const auto line = seal_key(seed, *passphrase, cost);
  if (!line) return key_failure(line.error());
  if (request.file.empty()) {
    out << *line << "\n";
    return {};
  }
  write_new_secret_file(request.file, *line + "\n");
  print(seed, out);
  return {};
}

Done import_key(const KeyCommand& request, std::istream& in, std::ostream& out) {
  std::ifstream file;
  if (!request.file.empty()) file.open(request.file);
  const std::string line = first_line(request.file.empty() ? in : file);
  if (line.empty())
    return key_failure((request.file.empty() ? "standard input" : request.file) +
                       ": cannot be read, or its first line is empty");
  const auto passphrase = request.passphrase_file.empty()
                              ? ask_passphrase("passphrase of the exported key: ")
                              : read_passphrase(request.passphrase_file);
  if (!passphrase) return key_failure(passphrase.error());
  const auto seed = open_sealed_key(line, *passphrase);
  if (!seed) return key_failure(seed.error());
  save_new_key(request.key_file, *seed);
  print(*seed, out);
  return {};
}

}  // namespace

Done run_key_program(const KeyCommand& request, std::istream& in, std::ostream& out,
                     SealCost cost) {
  try {
    switch (request.verb) {
      case KeyCommand::Verb::show:
        print(load_key_seed(request.key_file), out);
        return {};
      case KeyCommand::Verb::export_key:
        return export_key(request, out, cost);
      case KeyCommand::Verb::import_key:
        return import_key(request, in, out);
    }
  } catch (const std::exception& error) {
    return key_failure(error.what());
  }
  return {};
}

}  // namespace runstone
