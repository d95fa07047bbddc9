#include "server/admin/role_commands.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <variant>
#include <vector>

#include "common/core/utc_text.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/edit_budget_text.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/admin/rights_hazard.hpp"
#include "server/admin/rights_lists.hpp"

namespace runstone {
namespace {

Result<GrantCommand, std::string> parse_grant(WordReader& reader) {
  GrantCommand command;
  command.player = reader.player("grant");
  command.role = reader.rights_name("grant " + command.player);
  const std::string before = "grant " + command.player + " " + command.role;
  if (reader.take_word("for")) command.until_us = reader.end_of_duration(before + " for");
  reader.expect_end(before);
  return reader.result(command);
}

/// Returns " until 2026-11-30T20:00:00Z", or an empty text without an end.
std::string until_text(TimeUs until_us) {
  return until_us == 0 ? "" : " until " + utc_text(until_us);
}

void grant_role(const CommandCall& call, const GrantCommand& command) {
  if (command.until_us != 0) {
    if (auto why = call.world().cluster().timed_grant_refusal())
      return call.refuse("grant: " + *why);
  }
  call.with_players({command.player},
                    [call, command](const KnownPlayers& players, const CommandCall::Keys& keys) {
                      call.change_rights(GrantRole{keys[0], command.role, command.until_us},
                                         players.text_of(keys[0]) + " has the role " +
                                             command.role + until_text(command.until_us));
                    });
}

Result<std::string, std::string> parse_revoke(WordReader& reader) {
  const std::string player = reader.player("revoke");
  reader.expect_end("revoke " + player);
  return reader.result(player);
}

void revoke_role(const CommandCall& call, const std::string& player) {
  call.with_players({player}, [call](const KnownPlayers& players, const CommandCall::Keys& keys) {
    const std::string who = players.text_of(keys[0]);
    const bool has_grant = call.rights().grants().contains(keys[0]) ||
                           call.rights().timed_grant(keys[0], call.rights_time()) != nullptr;
    if (!has_grant) return call.refuse(who + " has no granted role (grants lists them)");
    call.change_rights(GrantRole{keys[0], ""},
                       who + " has the default role " + call.rights().default_role().value);
  });
}

void list_grants(const CommandCall& call) {
  call.with_players({}, [call](const KnownPlayers& players, const CommandCall::Keys&) {
    call.answer(grant_list(call.rights(), call.rights_time(), players));
  });
}

/// Parses the words after `invite`. Options may have two dashes, as people type them in a shell.
Result<CreateInviteCommand, std::string> parse_invite(WordReader& reader) {
  constexpr const char* kOptions = "role ROLE, uses N, days N, for DURATION or cancel ID";
  constexpr std::int64_t kDaysMax = 3650;
  constexpr TimeUs kOneDayUs = TimeUs{24} * 3600 * 1'000'000;
  CreateInviteCommand command;
  command.until_us = reader.now_us() + 7 * kOneDayUs;
  while (!reader.at_end()) {
    std::string option = reader.take("invite", kOptions);
    if (option.starts_with("--")) option.erase(0, 2);
    if (option == "role") {
      command.role = reader.rights_name("invite role");
    } else if (option == "uses") {
      command.uses = static_cast<std::uint32_t>(reader.number("invite uses", 1, kInviteUsesMax));
    } else if (option == "days") {
      command.until_us = reader.now_us() + reader.number("invite days", 1, kDaysMax) * kOneDayUs;
    } else if (option == "for") {
      command.until_us = reader.end_of_duration("invite for");
    } else {
      reader.wrong("invite \"" + option + "\": " + kOptions);
    }
  }
  return reader.result(command);
}

void create_invite(const CommandCall& call, const CreateInviteCommand& command) {
  const Invite invite{call.world().people().new_invite_id(), command.role, command.uses,
                      command.until_us};
  call.change_rights(CreateInvite{invite},
                     call.world().people().invite_link(invite.id) + "\ninvite " +
                         invite_text(invite) +
                         ". Whoever has the link can use it: pass it on in private");
}

Result<InviteId, std::string> parse_invite_id(WordReader& reader) {
  const std::string id = reader.take("invite cancel", "an id (invites lists them)");
  const auto invite = hex_number_of(id);
  if (!invite) reader.wrong("invite cancel \"" + id + "\": an id (invites lists them)");
  reader.expect_end("invite cancel " + id);
  return reader.result(InviteId{invite.value_or(0)});
}

void cancel_invite(const CommandCall& call, const InviteId& invite) {
  call.change_rights(CancelInvite{invite},
                     "invite " + invite_id_text(invite) +
                         " is cancelled; players who accepted it keep their role");
}

void list_invites(const CommandCall& call) {
  call.with_players({}, [call](const KnownPlayers& players, const CommandCall::Keys&) {
    call.answer(invite_list(call.rights(), call.rights_time(), players));
  });
}

/// Takes the budget of a role. A role cannot have an unlimited one: 0 stands for that of the
/// settings.
Budget take_edit_budget(WordReader& reader) {
  const std::string text = reader.take("edits", "a budget");
  const auto budget = parse_edit_budget(text);
  if (budget && budget->is_limited()) return *budget;
  reader.wrong("edits \"" + text + "\": " + edit_budget_rule() + "; not unlimited");
  return {};
}

/// Takes a limit of a role. Returns false if the next word names none.
bool take_limit(WordReader& reader, Role& role) {
  constexpr auto kVolumeMax = std::numeric_limits<std::int64_t>::max();
  if (reader.take_word("volume")) {
    role.edit_volume_max = static_cast<std::uint64_t>(reader.number("volume", 0, kVolumeMax));
  } else if (reader.take_word("claims")) {
    role.claims_max = static_cast<std::uint32_t>(
        reader.number("claims", 0, std::numeric_limits<std::uint32_t>::max()));
  } else if (reader.take_word("claim-volume")) {
    role.claim_volume_max =
        static_cast<std::uint64_t>(reader.number("claim-volume", 0, kVolumeMax));
  } else if (reader.take_word("edits")) {
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

Result<Role, std::string> parse_role(WordReader& reader) {
  Role role;
  role.name = reader.rights_name("role set");
  role.rights = take_rights(reader, "role set " + role.name);
  while (!reader.at_end()) {
    if (take_limit(reader, role)) continue;
    reader.wrong("role set \"" + reader.peek() +
                 "\": volume, claims, claim-volume, edits, view or loads");
  }
  return reader.result(role);
}

void set_role(const CommandCall& call, const Role& role) {
  const bool is_allowed =
      !call.world().rights().change_refusal(DefineRole{role}, call.caller.actor);
  if (is_allowed && call.refuse_unless_confirmed(hazard_of_lost_rights(call.rights(), role)))
    return;
  call.change_rights(DefineRole{role}, "role " + role.name + " is " + role_text(role));
}

Result<std::string, std::string> parse_role_name(WordReader& reader) {
  const std::string name = reader.rights_name(reader.command());
  reader.expect_end(reader.command() + " " + name);
  return reader.result(name);
}

void remove_role(const CommandCall& call, const std::string& name) {
  const auto built_in = built_in_roles();
  const bool is_built_in = std::any_of(built_in.begin(), built_in.end(),
                                       [&](const Role& role) { return role.name == name; });
  call.change_rights(RemoveRole{name},
                     "role " + name + (is_built_in ? " is as it was built in" : " is removed"));
}

void set_default_role(const CommandCall& call, const std::string& name) {
  call.change_rights(SetDefaultRole{name}, "players without a grant have the role " + name);
}

/// Parses `undo` and the sequence of a record that changed rights.
Result<Sequence, std::string> parse_undo_rights(WordReader& reader) {
  if (!reader.take_word("undo")) {
    if (reader.at_end()) return failure("rights: undo SEQ is missing");
    return failure("rights \"" + reader.peek() + "\": undo SEQ");
  }
  const auto seq = static_cast<Sequence>(
      reader.number("rights undo", 1, std::numeric_limits<std::int64_t>::max()));
  reader.expect_end("rights undo SEQ");
  return reader.result(seq);
}

/// Returns all changes of rights that are on disk, ascending. They include those that a compaction
/// moved out of the log. Blocks on the disk.
StoreResult<std::vector<RightsRecord>> read_rights_records(LogReader& reader) {
  std::vector<RightsRecord> records;
  const auto read = reader.read_rights([&](const EditRecord& record) {
    if (const RightsChange* change = rights_change_of(record.edit))
      records.push_back({*change, {record.version.seq, record.op.author, record.time_us}});
    return true;
  });
  if (!read) return failure(read.error());
  return records;
}

/// Takes a record back, whose successors `records` has too.
void undo_record(const CommandCall& call, Sequence seq, const std::vector<RightsRecord>& records) {
  const auto found = std::find_if(records.begin(), records.end(), [&](const RightsRecord& record) {
    return record.origin.seq == seq;
  });
  const std::string number = std::to_string(seq);
  if (found == records.end()) {
    return call.refuse("record " + number +
                       " changes no rights (log cause rights lists those that do)");
  }
  if (std::holds_alternative<CorrectTime>(found->change)) {
    return call.refuse("record " + number + " (" + rights_change_text(found->change) +
                       ") cannot be taken back; if the clock is wrong, set it right and give the "
                       "command clock correct again");
  }
  const auto inverse = inverse_of(records, seq);
  if (!inverse) {
    return call.refuse("record " + number + " (" + rights_change_text(found->change) +
                       ") decides nothing any more: a later one has replaced it");
  }
  call.change_rights(*inverse, "record " + number + " (" + rights_change_text(found->change) +
                                   ") is taken back: " + rights_change_text(*inverse));
}

void undo_rights(const CommandCall& call, const Sequence& seq) {
  // The inverse depends on the records after this one, so all of them must be on disk.
  const Sequence newest = call.world().rights().newest();
  if (call.world().order().durable() < newest) {
    call.services.waiting.push_back(
        {newest, [call, seq] { undo_rights(call, seq); },
         [call] { call.refuse("rights undo: the log cannot be written any more"); }});
    return;
  }
  call.on_worker("rights undo: ", read_rights_records,
                 [call, seq, newest](const std::vector<RightsRecord>& records) {
                   if (newest != call.world().rights().newest()) return undo_rights(call, seq);
                   undo_record(call, seq, records);
                 });
}

constexpr CommandRule kGranters = needs(Right::grant);
constexpr CommandRule kRoleAdministrators = needs(Right::administer);

constexpr std::array<CommandRow, 10> kRoleRows = {{
    {"grant", kGranters,
     "grant PLAYER ROLE [for DURATION]\n"
     "                          give a player a role, which ends by itself with for",
     parsed_by<parse_grant, grant_role>()},
    {"revoke", kGranters, "revoke PLAYER             give a player the default role again",
     parsed_by<parse_revoke, revoke_role>()},
    {"grants", kGranters, "grants                    who has which role", alone<list_grants>()},
    {.words = "invite",
     .rule = kGranters,
     .help = "invite [role ROLE] [uses N] [days N]\n"
             "                          make a link with which players join and get a role",
     .functions = parsed_by<parse_invite, create_invite>(),
     .may_be_confirmed = true},
    {"invite cancel", kGranters, "invite cancel ID          end an invite",
     parsed_by<parse_invite_id, cancel_invite>()},
    {"invites", kGranters, "invites                   the invites in force", alone<list_invites>()},
    {.words = "role set",
     .rule = kRoleAdministrators,
     .help = "role set NAME RIGHT,RIGHT,... [volume N] [claims N] [claim-volume N]\n"
             "         [edits BUDGET] [view N] [loads N]\n"
             "                          define a role; volume: voxels of one edit; edits: as "
             "builder_budget;\n"
             "                          view: chunks; loads: chunks a second",
     .functions = parsed_by<parse_role, set_role>(),
     .may_be_confirmed = true},
    {.words = "role remove",
     .rule = kRoleAdministrators,
     .help = "role remove NAME          remove a role, or what was changed of a built-in one",
     .functions = parsed_by<parse_role_name, remove_role>(),
     .may_be_confirmed = true},
    {.words = "role default",
     .rule = kRoleAdministrators,
     .help = "role default NAME         the role of players without a grant",
     .functions = parsed_by<parse_role_name, set_default_role>(),
     .may_be_confirmed = true},
    {.words = "rights",
     .rule = kRoleAdministrators,
     .help = "rights undo SEQ           take back a record that changed rights (log cause rights)",
     .functions = parsed_by<parse_undo_rights, undo_rights>(),
     .may_be_confirmed = true},
}};

}  // namespace

RightSet take_rights(WordReader& reader, const std::string& word) {
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

std::span<const CommandRow> role_commands() { return kRoleRows; }

}  // namespace runstone
