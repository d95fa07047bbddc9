#include "server/admin/rights_command.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "common/core/hex.hpp"
#include "server/admin/address_range_text.hpp"
#include "server/admin/edit_budget_text.hpp"

namespace runstone {
namespace {

using Parsed = Result<RightsCommand, std::string>;

constexpr const char* kPlayerWord = "a name, # and a number, a key or a fingerprint";
constexpr const char* kRestrictionWord = "a player, an address or a range";

/// Returns the command, or the error of the reader.
template <class Command>
Parsed parsed_or_error(const CommandReader& reader, Command command) {
  if (!reader.error().empty()) return failure(reader.error());
  return RightsCommand(std::move(command));
}

/// Takes a name of a role or a box.
std::string take_rights_name(CommandReader& reader, const std::string& word) {
  const std::string rule = "a name of a-z, 0-9, \"_\", \"-\" and \".\", at most " +
                           std::to_string(kRightsNameBytesMax) + " characters";
  std::string name = reader.take(word, rule);
  if (!is_rights_name(name)) reader.wrong(word + " \"" + name + "\": " + rule);
  return name;
}

std::string take_player(CommandReader& reader, const std::string& word) {
  std::string player = reader.take(word, kPlayerWord);
  if (player.empty()) reader.wrong(word + " \"\": " + kPlayerWord);
  if (player.starts_with('#') && !number_of<AuthorId>(std::string_view(player).substr(1)))
    reader.wrong(word + " \"" + player + "\": a number comes after #");
  return player;
}

/// Takes the words `reason TEXT`, if they come next.
void take_reason(CommandReader& reader, std::string& reason) {
  if (!reader.take_word("reason")) return;
  reason = reader.take("reason", "a text, in quotes if it has blanks,");
  if (reason.size() > kReasonBytesMax) {
    reader.wrong("reason: at most " + std::to_string(kReasonBytesMax) + " bytes, not " +
                 std::to_string(reason.size()));
  }
}

/// Returns "see, build, ...".
std::string all_right_names() {
  std::string list;
  for (std::size_t i = 0; i < kRightCount; ++i)
    list += (i == 0 ? "" : ", ") + std::string(name_of(static_cast<Right>(i)));
  return list;
}

RightSet take_rights(CommandReader& reader, const std::string& word) {
  const std::string text =
      reader.take(word, "rights, separated by commas without blanks, or none,");
  RightSet rights;
  if (text == "none") return rights;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string name = text.substr(at, end - at);
    const auto right = right_named(name);
    if (right) rights.add(*right);
    if (!right) reader.wrong(word + " \"" + name + "\": none, or any of " + all_right_names());
    at = end + 1;
  }
  return rights;
}

/// Takes the budget of a role. A role cannot have an unlimited one: 0 stands for that of the settings.
Budget take_edit_budget(CommandReader& reader) {
  const std::string text = reader.take("edits", "a budget");
  const auto budget = parse_edit_budget(text);
  if (budget && budget->is_limited()) return *budget;
  reader.wrong("edits \"" + text + "\": " + edit_budget_rule() + "; not unlimited");
  return {};
}

/// Takes a quota of a role, if one comes next. Returns false if none does.
bool take_quota(CommandReader& reader, Role& role) {
  if (reader.take_word("edits")) {
    role.edit_budget = take_edit_budget(reader);
  } else if (reader.take_word("view")) {
    role.view_radius_max = static_cast<std::uint8_t>(
        reader.number("view", 0, std::numeric_limits<std::uint8_t>::max()));
  } else if (reader.take_word("loads")) {
    role.chunk_loads_per_second =
        static_cast<std::uint32_t>(reader.number("loads", 0, kBudgetPerSecondMax));
  } else {
    return false;
  }
  return true;
}

Parsed set_role(CommandReader reader) {
  constexpr auto kVolumeMax = std::numeric_limits<std::int64_t>::max();
  SetRoleCommand command;
  Role& role = command.role;
  role.name = take_rights_name(reader, "role set");
  role.rights = take_rights(reader, "role set " + role.name);
  while (!reader.at_end()) {
    if (take_quota(reader, role)) continue;
    if (reader.take_word("volume")) {
      role.edit_volume_max = static_cast<std::uint64_t>(reader.number("volume", 0, kVolumeMax));
    } else if (reader.take_word("claims")) {
      role.claims_max = static_cast<std::uint32_t>(
          reader.number("claims", 0, std::numeric_limits<std::uint32_t>::max()));
    } else if (reader.take_word("claim-volume")) {
      role.claim_volume_max =
          static_cast<std::uint64_t>(reader.number("claim-volume", 0, kVolumeMax));
    } else {
      reader.wrong("role set \"" + reader.peek() +
                   "\": volume, claims, claim-volume, edits, view or loads");
    }
  }
  return parsed_or_error(reader, command);
}

Parsed role_command(CommandReader reader) {
  const std::string allowed = "set, remove or default";
  const std::string verb = reader.take("role", allowed);
  if (verb == "set") return set_role(reader);
  if (verb == "remove" || verb == "default") {
    const std::string name = take_rights_name(reader, "role " + verb);
    reader.expect_end("role " + verb + " " + name);
    if (verb == "remove") return parsed_or_error(reader, RemoveRoleCommand{name});
    return parsed_or_error(reader, DefaultRoleCommand{name});
  }
  reader.wrong("role \"" + verb + "\": " + allowed);
  return failure(reader.error());
}

/// Takes the subject of a restriction. Only bans are for addresses.
RestrictionWord take_subject(CommandReader& reader, const std::string& word, RestrictionKind kind) {
  if (reader.at_end()) {
    reader.wrong(word + ": " + (kind == RestrictionKind::ban ? kRestrictionWord : kPlayerWord) +
                 " is missing");
    return {};
  }
  const auto range = parse_address_range(reader.peek());
  if (!range) return {take_player(reader, word), std::nullopt, false};
  const std::string text = reader.take("", "");
  if (kind != RestrictionKind::ban)
    reader.wrong(word + " \"" + text + "\": only bans are for addresses");
  if (!*range) {
    reader.wrong(word + " \"" + text + "\": " + range->error());
    return {};
  }
  return {"", (*range)->range, (*range)->is_widened};
}

Parsed restrict_command(CommandReader reader, const std::string& word, RestrictionKind kind) {
  RestrictCommand command;
  command.kind = kind;
  command.who = take_subject(reader, word, kind);
  while (!reader.at_end()) {
    if (reader.take_word("for")) {
      command.until_us = reader.end_of_duration("for");
    } else if (reader.peek() == "reason") {
      take_reason(reader, command.reason);
    } else {
      return failure(word + " \"" + reader.peek() + "\": for DURATION or reason \"TEXT\"");
    }
  }
  return parsed_or_error(reader, command);
}

Parsed lift_command(CommandReader reader, const std::string& word, RestrictionKind kind) {
  LiftCommand command;
  command.kind = kind;
  command.who = take_subject(reader, word, kind);
  reader.expect_end(word);
  return parsed_or_error(reader, command);
}

Parsed kick_command(CommandReader reader) {
  KickCommand command;
  command.player = take_player(reader, "kick");
  take_reason(reader, command.reason);
  if (!reader.at_end()) reader.wrong("kick \"" + reader.peek() + "\": reason \"TEXT\"");
  return parsed_or_error(reader, command);
}

/// Takes the words after `invite`. Options may have two dashes, as people type them in a shell.
Parsed invite_command(CommandReader reader, TimeUs now_us) {
  constexpr const char* kOptions = "role ROLE, uses N, days N, for DURATION or cancel ID";
  constexpr std::int64_t kDaysMax = 3650;
  constexpr TimeUs kDayUs = TimeUs{24} * 3600 * 1'000'000;
  if (reader.take_word("cancel")) {
    const std::string id = reader.take("invite cancel", "an id (invites lists them)");
    const auto invite = hex_number_of(id);
    if (!invite) reader.wrong("invite cancel \"" + id + "\": an id (invites lists them)");
    reader.expect_end("invite cancel " + id);
    return parsed_or_error(reader, CancelInviteCommand{invite.value_or(0)});
  }
  CreateInviteCommand command;
  command.until_us = now_us + 7 * kDayUs;
  while (!reader.at_end()) {
    std::string option = reader.take("invite", kOptions);
    if (option.starts_with("--")) option.erase(0, 2);
    if (option == "role") {
      command.role = take_rights_name(reader, "invite role");
    } else if (option == "uses") {
      command.uses = static_cast<std::uint32_t>(reader.number("invite uses", 1, kInviteUsesMax));
    } else if (option == "days") {
      command.until_us = now_us + reader.number("invite days", 1, kDaysMax) * kDayUs;
    } else if (option == "for") {
      command.until_us = reader.end_of_duration("invite for");
    } else {
      reader.wrong("invite \"" + option + "\": " + kOptions);
    }
  }
  return parsed_or_error(reader, command);
}

/// Takes what verifier_text() makes.
bool take_verifier(CommandReader& reader, JoinPassword& password) {
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

Parsed password_command(CommandReader reader) {
  if (reader.at_end()) return RightsCommand(ShowPasswordCommand{});
  if (reader.take_word("clear")) {
    reader.expect_end("password clear");
    return parsed_or_error(reader, ClearPasswordCommand{});
  }
  if (!reader.take_word("set")) return failure("password: set or clear comes after it");
  SetPasswordCommand command;
  command.password.role = kBuilderRole;
  while (!reader.at_end()) {
    if (reader.take_word("role")) {
      command.password.role = take_rights_name(reader, "password set role");
    } else if (reader.take_word("verifier")) {
      command.has_verifier = take_verifier(reader, command.password);
    } else {
      // The word may be a password, so it is not repeated.
      reader.wrong("password set: only role ROLE comes after it; control asks for the password");
    }
  }
  return parsed_or_error(reader, command);
}

/// Takes a box: six numbers, or `columns` and four.
VoxelBox take_ground(CommandReader& reader, const std::string& word) {
  if (!reader.take_word("columns")) return reader.box(word);
  constexpr const char* kFour =
      "four numbers: x z of one corner and of the opposite one, both inside";
  std::int32_t c[4] = {};
  for (std::int32_t& value : c) value = reader.coordinate("columns", kFour);
  return columns(std::min(c[0], c[2]), std::min(c[1], c[3]), std::max(c[0], c[2]) + 1,
                 std::max(c[1], c[3]) + 1);
}

bool is_whole_number(const std::string& word) { return number_of<std::int64_t>(word).has_value(); }

Parsed members_command(CommandReader reader, const std::string& name, bool is_removal) {
  constexpr std::string_view kRole = "role:";
  BoxMembersCommand command{name, is_removal, {}, {}};
  const std::string word = "protect " + name + (is_removal ? " remove" : " add");
  if (reader.at_end()) return failure(word + ": a player or role:ROLE is missing");
  while (!reader.at_end()) {
    if (!reader.peek().starts_with(kRole)) {
      command.players.push_back(take_player(reader, word));
      continue;
    }
    const std::string text = reader.take("", "");
    command.roles.push_back(text.substr(kRole.size()));
    if (!is_rights_name(command.roles.back()))
      reader.wrong(word + " \"" + text + "\": the name of a role comes after role:");
  }
  return parsed_or_error(reader, command);
}

Parsed protect_command(CommandReader reader) {
  const std::string allowed = "X Y Z X Y Z, columns X Z X Z, owner, priority, add or remove";
  ProtectCommand command;
  command.name = take_rights_name(reader, "protect");
  const std::string word = "protect " + command.name;
  if (reader.error().empty() && reader.at_end())
    return failure(word + ": " + allowed + " is missing");
  if (reader.take_word("add")) return members_command(reader, command.name, false);
  if (reader.take_word("remove")) return members_command(reader, command.name, true);
  while (!reader.at_end()) {
    if (reader.take_word("owner")) {
      command.owner = take_player(reader, "owner");
    } else if (reader.take_word("priority")) {
      command.priority =
          static_cast<std::int32_t>(reader.number("priority", -kBoxPriorityMax, kBoxPriorityMax));
    } else if (!command.box && (reader.peek() == "columns" || is_whole_number(reader.peek()))) {
      command.box = take_ground(reader, word);
    } else {
      reader.wrong(word + " \"" + reader.peek() +
                   "\": " + (command.box ? "owner or priority" : allowed));
    }
  }
  return parsed_or_error(reader, command);
}

Parsed claim_command(CommandReader reader) {
  ClaimCommand command;
  command.name = take_rights_name(reader, "claim");
  command.box = take_ground(reader, "claim " + command.name);
  reader.expect_end("claim " + command.name);
  return parsed_or_error(reader, command);
}

VoxelPos take_position(CommandReader& reader, const std::string& word) {
  constexpr const char* kThree = "three numbers: x y z of a voxel";
  VoxelPos at;
  at.x = reader.coordinate(word, kThree);
  at.y = reader.coordinate(word, kThree);
  at.z = reader.coordinate(word, kThree);
  return at;
}

Parsed protected_command(CommandReader reader) {
  ListBoxesCommand command;
  if (reader.take_word("at")) {
    command.at = take_position(reader, "at");
    reader.expect_end("protected at X Y Z");
  } else if (!reader.at_end()) {
    reader.wrong("protected \"" + reader.peek() + "\": at X Y Z");
  }
  return parsed_or_error(reader, command);
}

Parsed why_command(CommandReader reader) {
  WhyCommand command;
  command.player = take_player(reader, "why");
  const std::string name = reader.take("why", "one of the rights " + all_right_names());
  const auto right = right_named(name);
  if (!right) reader.wrong("why \"" + name + "\": one of the rights " + all_right_names());
  command.right = right.value_or(Right::see);
  if (!reader.at_end()) {
    if (command.right != Right::build)
      reader.wrong("why \"" + reader.peek() + "\": a place comes after the right build only");
    command.at = take_position(reader, "why");
    reader.expect_end("why PLAYER build X Y Z");
  }
  return parsed_or_error(reader, command);
}

Parsed undo_rights_command(CommandReader reader) {
  if (!reader.take_word("undo")) {
    if (reader.at_end()) return failure("rights: undo SEQ is missing");
    return failure("rights \"" + reader.peek() + "\": undo SEQ");
  }
  UndoRightsCommand command;
  command.seq = static_cast<Sequence>(
      reader.number("rights undo", 1, std::numeric_limits<std::int64_t>::max()));
  reader.expect_end("rights undo SEQ");
  return parsed_or_error(reader, command);
}

Parsed player_and_role(CommandReader reader) {
  GrantCommand command;
  command.player = take_player(reader, "grant");
  command.role = take_rights_name(reader, "grant " + command.player);
  reader.expect_end("grant " + command.player + " " + command.role);
  return parsed_or_error(reader, command);
}

}  // namespace

std::string verifier_text(const JoinPassword& password) {
  return to_hex(password.salt) + to_hex(password.hash);
}

std::optional<Parsed> parse_rights_command(const std::vector<std::string>& words, TimeUs now_us) {
  const std::string& name = words.front();
  CommandReader reader(words, 1, now_us);
  const auto alone = [&](RightsCommand command) -> Parsed {
    if (reader.at_end()) return command;
    return failure(name + " \"" + reader.peek() + "\": nothing comes after " + name);
  };
  if (name == "roles") return alone(ListRolesCommand{});
  if (name == "grants") return alone(ListGrantsCommand{});
  if (name == "bans") return alone(ListRestrictionsCommand{});
  if (name == "role") return role_command(reader);
  if (name == "grant") return player_and_role(reader);
  if (name == "revoke") {
    const std::string player = take_player(reader, name);
    reader.expect_end(name + " " + player);
    return parsed_or_error(reader, RevokeCommand{player});
  }
  if (name == "ban") return restrict_command(reader, name, RestrictionKind::ban);
  if (name == "mute") return restrict_command(reader, name, RestrictionKind::mute);
  if (name == "freeze") return restrict_command(reader, name, RestrictionKind::freeze);
  if (name == "unban") return lift_command(reader, name, RestrictionKind::ban);
  if (name == "unmute") return lift_command(reader, name, RestrictionKind::mute);
  if (name == "unfreeze") return lift_command(reader, name, RestrictionKind::freeze);
  if (name == "kick") return kick_command(reader);
  if (name == "protect") return protect_command(reader);
  if (name == "claim") return claim_command(reader);
  if (name == "unprotect") {
    const std::string box = take_rights_name(reader, name);
    reader.expect_end(name + " " + box);
    return parsed_or_error(reader, UnprotectCommand{box});
  }
  if (name == "protected") return protected_command(reader);
  if (name == "why") return why_command(reader);
  if (name == "rights") return undo_rights_command(reader);
  if (name == "invite") return invite_command(reader, now_us);
  if (name == "invites") return alone(ListInvitesCommand{});
  if (name == "password") return password_command(reader);
  if (name == "refusals") return alone(ListRefusalsCommand{});
  return std::nullopt;
}

}  // namespace runstone
