#include "server/admin/password_commands.hpp"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <variant>

#include "common/core/hex.hpp"
#include "protocol/codec/password_key.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/rights_lists.hpp"

namespace runstone {
namespace {

/// Takes what verifier_text() makes.
bool take_verifier(WordReader& reader, JoinPassword& password) {
  constexpr std::size_t kSaltDigits = 2 * kPasswordSaltBytes;
  const std::string rule =
      std::to_string(kSaltDigits + 2 * kPasswordHashBytes) + " hexadecimal digits";
  const std::string text = reader.take("password set verifier", rule);
  const std::size_t salt_ends = std::min(kSaltDigits, text.size());
  if (read_hex(text.substr(0, salt_ends), password.salt) &&
      read_hex(text.substr(salt_ends), password.hash))
    return true;
  reader.wrong("password set verifier: " + rule);
  return false;
}

Result<SetPasswordCommand, std::string> parse_set_password(WordReader& reader) {
  SetPasswordCommand command;
  command.password.role = kBuilderRole;
  while (!reader.at_end()) {
    if (reader.take_word("role")) {
      command.password.role = reader.rights_name("password set role");
    } else if (reader.take_word("verifier")) {
      command.has_verifier = take_verifier(reader, command.password);
    } else {
      // The word may be a password, so it is not repeated.
      reader.wrong("password set: only role ROLE comes after it; control asks for the password");
    }
  }
  return reader.result(command);
}

/// Adds what the world keeps of the password that is read now. So the password itself leaves the
/// control program in no form.
Result<std::string, std::string> with_verifier(const std::string& line, const std::any& meaning,
                                               const ReadPassword& read_password) {
  const auto& command = *std::any_cast<SetPasswordCommand>(&meaning);
  if (command.has_verifier) return line;
  const auto text = read_password();
  if (!text) return failure(text.error());
  PasswordSalt salt{};
  randombytes_buf(salt.data(), salt.size());
  const auto password = join_password(*text, salt, command.password.role);
  if (!password) return failure("password set: " + password.error());
  const std::string verifier = " verifier " + verifier_text(*password);
  const std::string anyway = std::string(" ") + kAnyway;
  if (!line.ends_with(anyway)) return line + verifier;
  return line.substr(0, line.size() - anyway.size()) + verifier + anyway;
}

void set_password(const CommandCall& call, const SetPasswordCommand& command) {
  if (!command.has_verifier) {
    return call.refuse(
        "the password is typed where nobody sees it: runstone-server control --world "
        "FOLDER password set");
  }
  std::string text = "players without a granted role join with the password and get the role " +
                     command.password.role;
  const Decided<Role>* usual = call.rights().find_role(call.rights().default_role().value);
  if (usual != nullptr && usual->value.rights.has(Right::see))
    text += "; others still join as " + usual->value.name + " (role default nobody keeps them out)";
  call.change_rights(SetPassword{command.password}, text);
}

Result<std::monostate, std::string> parse_clear_password(WordReader& reader) {
  reader.expect_end("password clear");
  return reader.result(std::monostate());
}

void clear_password(const CommandCall& call, std::monostate) {
  call.change_rights(SetPassword{std::nullopt},
                     "the world has no password; players who joined with it keep their role");
}

Result<std::monostate, std::string> parse_password(WordReader& reader) {
  if (!reader.at_end()) reader.wrong("password: set or clear comes after it");
  return reader.result(std::monostate());
}

void show_password(const CommandCall& call, std::monostate) {
  call.with_players({}, [call](const KnownPlayers& players, const CommandCall::Keys&) {
    call.answer(password_line(call.rights(), players));
  });
}

constexpr std::array<CommandRow, 3> kPasswordRows = {{
    {.words = "password set",
     .rule = kLocal,
     .help = "password set [role ROLE]  give the world a password, which control asks for",
     .functions = parsed_by<parse_set_password, set_password>(),
     .may_be_confirmed = true,
     .is_secret = true,
     .complete = with_verifier},
    {"password clear", needs(Right::administer),
     "password clear            take the world's password away",
     parsed_by<parse_clear_password, clear_password>()},
    {"password", needs(Right::administer),
     "password                  whether the world has a password",
     parsed_by<parse_password, show_password>()},
}};

}  // namespace

std::span<const CommandRow> password_commands() { return kPasswordRows; }

std::string verifier_text(const JoinPassword& password) {
  return to_hex(password.salt) + to_hex(password.hash);
}

}  // namespace runstone
