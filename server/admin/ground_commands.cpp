#include "server/admin/ground_commands.hpp"

#include <algorithm>
#include <array>

#include "server/admin/command_call.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/names/name_reference.hpp"

namespace runstone {
namespace {

constexpr const char* kProtectWords =
    "X Y Z X Y Z, columns X Z X Z, owner, priority, add or remove";

std::string no_box(const std::string& name) {
  return "there is no protected box \"" + name + "\" (protected lists them)";
}

Result<ClaimCommand, std::string> parse_claim(WordReader& reader) {
  ClaimCommand command;
  command.name = reader.rights_name("claim");
  command.box = reader.ground("claim " + command.name);
  reader.expect_end("claim " + command.name);
  return reader.result(command);
}

void claim(const CommandCall& call, const ClaimCommand& command) {
  const auto& owner = call.caller.actor.key;
  if (!owner) {
    return call.refuse("claims are for players: protect " + command.name +
                       " ... owner PLAYER protects ground for one");
  }
  const Decided<ProtectedBox>* old = call.rights().find_box(command.name);
  if (old != nullptr && old->value.owner != owner) {
    return call.refuse("there is a protected box \"" + command.name +
                       "\" of somebody else: choose another name");
  }
  ProtectedBox box = old == nullptr ? ProtectedBox{} : old->value;
  box.name = command.name;
  box.box = command.box;
  box.owner = owner;
  call.change_rights(Protect{box}, command.name + " protects " + ground_text(box.box) + " for you");
}

bool is_whole_number(const std::string& word) { return number_of<std::int64_t>(word).has_value(); }

Result<ProtectCommand, std::string> parse_protect(WordReader& reader) {
  ProtectCommand command;
  command.name = reader.rights_name("protect");
  const std::string word = "protect " + command.name;
  if (reader.at_end()) reader.wrong(word + ": " + kProtectWords + " is missing");
  while (!reader.at_end()) {
    if (reader.take_word("owner")) {
      command.owner = reader.player("owner");
    } else if (reader.take_word("priority")) {
      command.priority =
          static_cast<std::int32_t>(reader.number("priority", -kBoxPriorityMax, kBoxPriorityMax));
    } else if (!command.box && (reader.peek() == "columns" || is_whole_number(reader.peek()))) {
      command.box = reader.ground(word);
    } else {
      reader.wrong(word + " \"" + reader.peek() +
                   "\": " + (command.box ? "owner or priority" : kProtectWords));
    }
  }
  return reader.result(command);
}

void protect(const CommandCall& call, const ProtectCommand& command) {
  std::vector<std::string> words;
  if (command.owner) words.push_back(*command.owner);
  call.with_players(
      words, [call, command](const KnownPlayers& players, const CommandCall::Keys& keys) {
        const Decided<ProtectedBox>* old = call.rights().find_box(command.name);
        if (old == nullptr && !command.box) return call.refuse(no_box(command.name));
        ProtectedBox box = old == nullptr ? ProtectedBox{} : old->value;
        box.name = command.name;
        if (command.box) box.box = *command.box;
        if (command.owner) box.owner = keys[0];
        if (command.priority) box.priority = *command.priority;
        const std::string owner = box.owner ? players.text_of(*box.owner) : "nobody";
        call.change_rights(Protect{box}, command.name + " protects " + ground_text(box.box) +
                                             ", priority " + std::to_string(box.priority) +
                                             ", owner " + owner);
      });
}

Result<BoxMembersCommand, std::string> parse_members(WordReader& reader) {
  BoxMembersCommand command;
  command.name = reader.rights_name("protect");
  command.is_removal = !reader.take_word("add") && reader.take_word("remove");
  const std::string word = "protect " + command.name + (command.is_removal ? " remove" : " add");
  if (reader.at_end()) reader.wrong(word + ": a player or role:ROLE is missing");
  while (!reader.at_end()) {
    if (!reader.peek().starts_with(kRolePrefix)) {
      command.players.push_back(reader.player(word));
      continue;
    }
    const std::string text = reader.take("", "");
    command.roles.push_back(text.substr(kRolePrefix.size()));
    if (!is_rights_name(command.roles.back()))
      reader.wrong(word + " \"" + text + "\": the name of a role comes after role:");
  }
  return reader.result(command);
}

/// Adds or removes one entry of an ascending list. Returns false if that changes nothing.
template <class T>
bool change_entry(std::vector<T>& list, const T& entry, bool is_removal) {
  const auto at = std::lower_bound(list.begin(), list.end(), entry);
  const bool is_in = at != list.end() && *at == entry;
  if (is_in != is_removal) return false;
  if (is_removal) {
    list.erase(at);
  } else {
    list.insert(at, entry);
  }
  return true;
}

void change_members(const CommandCall& call, const BoxMembersCommand& command) {
  call.with_players(command.players, [call, command](const KnownPlayers& players,
                                                     const CommandCall::Keys& keys) {
    const Decided<ProtectedBox>* old = call.rights().find_box(command.name);
    if (old == nullptr) return call.refuse(no_box(command.name));
    ProtectedBox box = old->value;
    const std::string unchanged = command.is_removal ? " is no member of " : " is a member of ";
    std::string changed;
    for (const PublicKey& key : keys) {
      const std::string who = players.text_of(key);
      if (!change_entry(box.members, key, command.is_removal))
        return call.refuse(who + unchanged + command.name);
      changed += (changed.empty() ? "" : ", ") + who;
    }
    for (const std::string& role : command.roles) {
      if (!change_entry(box.roles, role, command.is_removal))
        return call.refuse("the role " + role + unchanged + command.name);
      changed += (changed.empty() ? "" : ", ") + ("the role " + role);
      // An owner from before may have a name that reads as a role (name_reference.hpp).
      const std::string word = std::string(kRolePrefix) + role;
      const std::string called = players.list_of_named(word);
      if (!called.empty()) changed += " [\"" + word + "\" is also the name of " + called + "]";
    }
    call.change_rights(
        Protect{box},
        command.name + (command.is_removal ? " does not admit any more: " : " admits: ") + changed);
  });
}

Result<std::string, std::string> parse_unprotect(WordReader& reader) {
  const std::string box = reader.rights_name("unprotect");
  reader.expect_end("unprotect " + box);
  return reader.result(box);
}

void unprotect(const CommandCall& call, const std::string& name) {
  if (call.rights().find_box(name) == nullptr) return call.refuse(no_box(name));
  call.change_rights(Unprotect{name}, name + " protects nothing any more");
}

constexpr CommandRule kGround = needs(Right::claim, Right::protect);

constexpr std::array<CommandRow, 5> kGroundRows = {{
    {.words = "claim",
     .rule = kGround,
     .help = "claim NAME BOX            protect ground of your own",
     .functions = parsed_by<parse_claim, claim>(),
     .may_be_confirmed = true},
    {.words = "protect",
     .rule = kGround,
     .help = "protect NAME [BOX] [owner PLAYER] [priority N]\n"
             "                          protect ground, or change the box of this name",
     .functions = parsed_by<parse_protect, protect>(),
     .may_be_confirmed = true},
    {"protect NAME add", kGround,
     "protect NAME add|remove PLAYER|role:ROLE\n"
     "                          say who else may change the ground of a box",
     parsed_by<parse_members, change_members>()},
    {"protect NAME remove", kGround, "", parsed_by<parse_members, change_members>()},
    {"unprotect", kGround, "unprotect NAME            remove a box; the ground stays as it is",
     parsed_by<parse_unprotect, unprotect>()},
}};

}  // namespace

std::span<const CommandRow> ground_commands() { return kGroundRows; }

}  // namespace runstone
