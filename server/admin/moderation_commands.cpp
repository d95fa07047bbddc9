#include "server/admin/moderation_commands.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <variant>

#include "common/core/utc_text.hpp"
#include "common/names/folded_name.hpp"
#include "common/rights/restriction_text.hpp"
#include "server/admin/address_range_text.hpp"
#include "server/admin/amount_text.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/joined_replies.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/admin/rights_hazard.hpp"
#include "server/admin/rights_lists.hpp"
#include "server/admin/world_lists.hpp"
#include "server/world/environment/world_border.hpp"

namespace runstone {
namespace {

constexpr const char* kAddressWord = "address";
constexpr const char* kWidened = " [a single IPv6 address means its /64]";

/// Returns a line with what to do about damaged rows, or an empty text if none is known.
std::string damage_text(const OperatorActions& actions) {
  const std::uint64_t faults = actions.row_faults ? actions.row_faults() : 0;
  if (faults == 0) return "";
  return "\nDAMAGE: " + std::to_string(faults) +
         " rows or parts of the world are damaged: the log of the server names them. Stop the server "
         "and run `runstone-server repair --world W --to NEW`, with --from and the folder of a backup "
         "if there is one";
}

/// Returns a line about the backups that the server makes by itself, or an empty text.
std::string backups_text(const OperatorActions& actions) {
  return actions.backup_state ? "\n" + backup_state_text(actions.backup_state()) : "";
}

/// Returns the lines of a retention that waits or fails, or an empty text.
std::string retention_text(const OperatorActions& actions) {
  if (!actions.retention_state) return "";
  const RetentionState state = actions.retention_state();
  std::string text;
  if (!state.doubt.empty()) text += "\nRETENTION WAITS: " + state.doubt;
  if (!state.failure.empty()) text += "\nRETENTION FAILS: " + state.failure;
  return text;
}

/// Returns a line with the border of the world, or an empty text if it has none.
std::string border_line(const WorldServer& world) {
  return world.border() ? "\nborder: " + border_text(*world.border()) : "";
}

/// Returns a line with why edits are refused, or an empty text if they are taken.
std::string read_only_text(const Order& order) {
  const std::string why = read_only_reason(order);
  return why.empty() ? "" : "\nREAD-ONLY: edits are refused: " + why;
}

void show_status(const CommandCall& call) {
  const WorldServer& world = call.world();
  const auto& ask_health = call.services.actions.health;
  const ServerHealth health = ask_health ? ask_health() : ServerHealth{};
  const WorldCounters& c = world.counters();
  const WorldMemory memory = world.order().memory();
  call.answer(
      version_line(health) + "\nsessions " + std::to_string(world.session_count()) + ", edits " +
      std::to_string(world.order().head()) + " (on disk " +
      std::to_string(world.order().durable()) + "), since the start " +
      std::to_string(c.edits_ordered) + " ordered and " + std::to_string(c.edits_rejected) +
      " rejected\nchunks in memory " + std::to_string(world.order().chunks().resident_count()) +
      " (" + byte_count_text(memory.voxels) + "), waiting edits " +
      byte_count_text(memory.stacked + memory.queued) + ", damaged chunks " +
      std::to_string(c.chunks_failed) + ", rollbacks and undos under way " +
      std::to_string(call.services.rollback.running()) + "\n" + disk_line(health) +
      border_line(world) + read_only_text(world.order()) + damage_text(call.services.actions) +
      backups_text(call.services.actions) + retention_text(call.services.actions));
}

void show_status_of_follower(const FollowerCall& call) {
  call.reply(CommandAnswer::last(call.status));
}

Result<std::monostate, std::string> parse_names(WordReader& reader) {
  if (!reader.at_end()) reader.wrong("names \"" + reader.peek() + "\": release NAME");
  return reader.result(std::monostate());
}

void list_names(const CommandCall& call, std::monostate) {
  std::vector<OwnedName> owned;
  for (const NameClaim& claim : call.world().order().names().all())
    owned.push_back({claim.name, claim.key, call.world().order().players().author_of(claim.key)});
  call.answer(name_list(owned));
}

/// Returns true if the next word is another subject, and not an option.
bool has_more_subjects(const WordReader& reader) {
  if (reader.at_end()) return false;
  const std::string& word = reader.peek();
  // `ban ana 2d` leaves out "for". A player of such a name is named first, or by number.
  return word != "for" && word != "reason" && !parse_duration(word);
}

Result<KickCommand, std::string> parse_kick(WordReader& reader) {
  KickCommand command;
  do {
    command.players.push_back(reader.player("kick"));
  } while (has_more_subjects(reader));
  command.reason = reader.reason();
  if (!reader.at_end()) reader.wrong("kick \"" + reader.peek() + "\": reason \"TEXT\"");
  return reader.result(command);
}

void kick_player(const CommandCall& call, const PublicKey& key, const std::string& who,
                 const std::string& reason) {
  // A player may kick whom the player may mute: those who have fewer rights.
  const Restrict mute{RestrictionKind::mute, key, 0, ""};
  if (auto why = call.world().rights().change_refusal(mute, call.caller.actor))
    return call.refuse(*std::move(why));
  const std::size_t ended = call.world().people().kick(key, reason);
  if (ended == 0) return call.refuse(who + " is not here");
  call.answer(who + " was kicked; sessions ended: " + std::to_string(ended));
}

/// Returns what the answer to an unknown name begins with. Names are looked up before anything is
/// done.
const char* before_unknown(std::size_t names) { return names > 1 ? "nothing has changed: " : ""; }

void kick(const CommandCall& call, const KickCommand& command) {
  call.with_players(
      command.players,
      [call, reason = command.reason](const KnownPlayers& players, const CommandCall::Keys& keys) {
        CommandCall::Keys once;
        for (const PublicKey& key : keys) {
          if (std::ranges::find(once, key) == once.end()) once.push_back(key);
        }
        const auto replies = joined_replies(call.reply, once.size());
        for (std::size_t i = 0; i < once.size(); ++i) {
          CommandCall part = call;
          part.reply = replies[i];
          kick_player(part, once[i], players.text_of(once[i]), reason);
        }
      },
      before_unknown(command.players.size()));
}

/// Takes the subject of a restriction. Only bans are for addresses.
RestrictionWord take_subject(WordReader& reader, RestrictionKind kind) {
  const std::string& word = reader.command();
  const bool is_ban = kind == RestrictionKind::ban;
  if (reader.at_end()) {
    reader.wrong(word + ": " + (is_ban ? "a player, an address or a range" : kPlayerWord) +
                 " is missing");
    return {};
  }
  const bool is_address = reader.peek() == kAddressWord && reader.has_second() &&
                          parse_address_range(reader.peek_second());
  if (is_address) reader.take("", "");
  const auto range = parse_address_range(reader.peek());
  if (!range) return {reader.player(word), std::nullopt, false};
  const std::string text = reader.take("", "");
  if (!is_ban) reader.wrong(word + " \"" + text + "\": only bans are for addresses");
  if (!*range) {
    reader.wrong(word + " \"" + text + "\": " + range->error());
    return {};
  }
  return {"", (*range)->range, (*range)->is_widened, text, is_address};
}

std::vector<RestrictionWord> take_subjects(WordReader& reader, RestrictionKind kind) {
  std::vector<RestrictionWord> subjects;
  do {
    subjects.push_back(take_subject(reader, kind));
  } while (has_more_subjects(reader));
  return subjects;
}

template <RestrictionKind kind>
Result<RestrictCommand, std::string> parse_restrict(WordReader& reader) {
  RestrictCommand command;
  command.kind = kind;
  command.who = take_subjects(reader, kind);
  while (!reader.at_end()) {
    if (reader.take_word("for")) {
      command.until_us = reader.end_of_duration("for");
    } else if (reader.peek() == "reason") {
      command.reason = reader.reason();
    } else {
      reader.wrong(reader.command() + " \"" + reader.peek() +
                   "\": for DURATION or reason \"TEXT\"");
    }
  }
  return reader.result(command);
}

/// Returns why a word does not mean an address alone: it is the name of a player, too. Otherwise
/// returns nullopt. New players get no such names, so owners and players who are here are all.
std::optional<std::string> doubt_of_address(const CommandCall& call, const RestrictionWord& word) {
  if (word.is_address) return std::nullopt;
  KnownPlayers::Sources sources;
  const std::string folded = folded_name(word.address);
  std::vector<PublicKey> named;
  for (const OnlinePlayer& player : call.world().people().online()) {
    if (folded_name(player.name) != folded) continue;
    sources.present.push_back({player.author, player.key, player.name});
    named.push_back(player.key);
  }
  if (const NameClaim* claim = call.world().order().names().find(folded)) {
    if (const auto author = call.world().order().players().author_of(claim->key))
      sources.present.push_back({*author, claim->key, claim->name});
    sources.claims.push_back(*claim);
    named.push_back(claim->key);
  }
  if (named.empty()) return std::nullopt;
  const KnownPlayers players(sources);
  return "\"" + word.address + "\" is an address and the name of " + players.text_of(named[0]) +
         ": say " + kAddressWord + " " + word.address + ", or " + players.word_for(named[0]) +
         " for the player";
}

/// A subject of a restriction, as it was found.
struct FoundSubject {
  RestrictionSubject subject;
  std::string who;  // its text
  RestrictionWord word;
};
using FoundSubjects = std::vector<FoundSubject>;

/// Calls `go_on` with the subjects of a restriction, each once. Refuses the command if one of them is
/// not known or in doubt.
void with_subjects(const CommandCall& call, const std::vector<RestrictionWord>& words,
                   const std::function<void(const FoundSubjects&)>& go_on) {
  const std::string before = before_unknown(words.size());
  std::vector<std::string> names;
  for (const RestrictionWord& word : words) {
    if (!word.range) names.push_back(word.player);
    if (!word.range) continue;
    if (auto doubt = doubt_of_address(call, word)) return call.refuse(before + *doubt);
  }
  const auto found = [words, go_on](const KnownPlayers& players, const CommandCall::Keys& keys) {
    FoundSubjects subjects;
    auto key = keys.begin();
    for (const RestrictionWord& word : words) {
      FoundSubject each;
      each.word = word;
      if (word.range) {
        each.subject = *word.range;
        each.who = "everybody from " + subject_text(*word.range);
      } else {
        each.subject = *key;
        each.who = players.text_of(*key++);
      }
      const bool is_new = std::ranges::none_of(
          subjects, [&](const FoundSubject& other) { return other.subject == each.subject; });
      if (is_new) subjects.push_back(std::move(each));
    }
    go_on(subjects);
  };
  if (names.empty()) return found({}, {});
  call.with_players(names, found, before);
}

/// Returns what a ban of addresses cannot do in a world whose default role administers.
std::string exempt_by_default(const RightsState& rights) {
  const std::string& name = rights.default_role().value;
  const Decided<Role>* role = rights.find_role(name);
  if (role == nullptr || !role->value.rights.has(Right::administer)) return "";
  return "; players without a granted role still join, because the default role " + name +
         " administers (role default visitor changes it)";
}

/// Returns the player of a restriction. For a restriction of addresses, returns the connected
/// players to whom it applies.
std::vector<PublicKey> present_players(const CommandCall& call, const RestrictionSubject& subject) {
  if (const auto* key = std::get_if<PublicKey>(&subject)) return {*key};
  std::vector<PublicKey> keys;
  for (const OnlinePlayer& player : call.world().people().online()) {
    const bool is_meant = std::get<AddressRange>(subject).contains(player.from);
    if (is_meant && std::ranges::find(keys, player.key) == keys.end()) keys.push_back(player.key);
  }
  return keys;
}

/// Withdraws the newest lines of the chat of those players who are not connected any more. Returns
/// the sentence for the answer, or an empty text if no line was withdrawn.
std::string withdraw_lines_of_gone(const CommandCall& call, const std::vector<PublicKey>& players) {
  People& people = call.world().people();
  const std::vector<OnlinePlayer> online = people.online();
  std::size_t lines = 0;
  for (const PublicKey& key : players) {
    if (std::ranges::find(online, key, &OnlinePlayer::key) == online.end())
      lines += people.chat().withdraw(key);
  }
  return lines == 0 ? "" : "; lines of the chat withdrawn: " + std::to_string(lines);
}

void restrict_subjects(const CommandCall& call, const RestrictCommand& command) {
  with_subjects(call, command.who, [call, command](const FoundSubjects& subjects) {
    const auto change_of = [&](const FoundSubject& each) {
      return Restrict{command.kind, each.subject, command.until_us, command.reason};
    };
    // A warning about one of several comes before all changes.
    for (const FoundSubject& each : subjects) {
      if (subjects.size() > 1 &&
          call.refuse_unless_confirmed(hazard_of(call.rights(), change_of(each))))
        return;
    }
    const auto replies = joined_replies(call.reply, subjects.size());
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      const auto& [subject, who, word] = subjects[i];
      const Restrict change = change_of(subjects[i]);
      std::string text = restriction_text(who + (word.range ? ", except administrators," : "") +
                                              " is " + restricted_text(command.kind),
                                          change);
      if (word.is_widened) text += kWidened;
      if (word.range) text += exempt_by_default(call.rights());
      CommandCall part = call;
      part.reply = replies[i];
      if (command.kind != RestrictionKind::ban) {
        part.change_rights(change, text);
        continue;
      }
      const std::vector<PublicKey> players = present_players(call, subject);
      part.change_rights(change, text, [&] { return withdraw_lines_of_gone(call, players); });
    }
  });
}

template <RestrictionKind kind>
Result<LiftCommand, std::string> parse_lift(WordReader& reader) {
  const LiftCommand command{kind, take_subjects(reader, kind)};
  reader.expect_end(reader.command());
  return reader.result(command);
}

void lift_one(const CommandCall& call, RestrictionKind lifted, const FoundSubject& each) {
  const auto& [subject, who, word] = each;
  const TimeUs now_us = call.rights_time();
  const std::string kind = restricted_text(lifted);
  const Decided<Restrict>* found = call.rights().find_restriction(lifted, subject);
  if (found == nullptr || (found->value.until_us != 0 && found->value.until_us <= now_us)) {
    std::string text = who + " is not " + kind;
    const auto* range = std::get_if<AddressRange>(&subject);
    const auto* wider =
        range == nullptr ? nullptr : call.rights().address_ban(range->first, now_us);
    if (wider != nullptr) text += ", but " + subject_text(wider->value.subject) + " is";
    return call.refuse(text + " (bans lists all)");
  }
  call.change_rights(Lift{lifted, subject},
                     who + " is no longer " + kind + (word.is_widened ? kWidened : ""));
}

void lift_restrictions(const CommandCall& call, const LiftCommand& command) {
  with_subjects(call, command.who, [call, kind = command.kind](const FoundSubjects& subjects) {
    const auto replies = joined_replies(call.reply, subjects.size());
    for (std::size_t i = 0; i < subjects.size(); ++i) {
      CommandCall part = call;
      part.reply = replies[i];
      lift_one(part, kind, subjects[i]);
    }
  });
}

void list_restrictions(const CommandCall& call) {
  call.with_players({}, [call](const KnownPlayers& players, const CommandCall::Keys&) {
    call.answer(restriction_list(call.rights(), call.rights_time(), players));
  });
}

void list_refusals(const CommandCall& call) {
  call.with_players({}, [call](const KnownPlayers& players, const CommandCall::Keys&) {
    call.answer(refusal_list(call.world().rights().refusals(), players));
  });
}

Result<ChatQuery, std::string> parse_chat_log(WordReader& reader) {
  if (!reader.take_word("log"))
    return failure("chat: log comes after it, and then by, since or limit; or withdraw PLAYER");
  ChatQuery query;
  while (!reader.at_end()) {
    const std::string word = reader.take("", "");
    if (word == "by") {
      query.by = reader.take(word, "a name, a fingerprint, a key or server");
    } else if (word == "since") {
      query.since_us = reader.moment(word);
    } else if (word == "limit") {
      query.limit = static_cast<std::uint64_t>(
          reader.number(word, 1, static_cast<std::int64_t>(kChatLinesListedMax)));
    } else {
      return failure("chat log \"" + word + "\": by, since or limit");
    }
  }
  return reader.result(query, "chat log ");
}

void list_chat_log(const CommandCall& call, const ChatQuery& query) {
  const auto& list = call.services.actions.list_chat;
  if (!list) return call.refuse("chat log: this server keeps no log of the chat (chat_days = 0)");
  list(query, call.reply);
}

Result<WithdrawCommand, std::string> parse_withdraw(WordReader& reader) {
  WithdrawCommand command;
  do {
    command.players.push_back(reader.player(reader.command()));
  } while (!reader.at_end());
  return reader.result(command);
}

void withdraw_one(const CommandCall& call, const PublicKey& key, const std::string& who) {
  // A player may withdraw the lines of the players whom the player may mute.
  const Restrict mute{RestrictionKind::mute, key, 0, ""};
  const bool is_self = call.caller.actor.key == key;
  if (auto why = call.world().rights().change_refusal(mute, call.caller.actor); why && !is_self)
    return call.refuse(*std::move(why));
  const std::size_t lines = call.world().people().chat().withdraw(key);
  if (lines == 0) return call.refuse(who + " has no line among the newest ones of the chat");
  call.answer(who + ": lines of the chat withdrawn: " + std::to_string(lines));
}

void withdraw_lines(const CommandCall& call, const WithdrawCommand& command) {
  call.with_players(
      command.players,
      [call](const KnownPlayers& players, const CommandCall::Keys& keys) {
        const auto replies = joined_replies(call.reply, keys.size());
        for (std::size_t i = 0; i < keys.size(); ++i) {
          CommandCall part = call;
          part.reply = replies[i];
          withdraw_one(part, keys[i], players.text_of(keys[i]));
        }
      },
      before_unknown(command.players.size()));
}

constexpr CommandRule kModerators = needs(Right::moderate);

constexpr std::array<CommandRow, 13> kModerationRows = {{
    {.words = "status",
     .rule = kModerators,
     .help = "status                    what the server does",
     .functions = alone<show_status>(),
     .run_at_follower = show_status_of_follower},
    {"names", kModerators, "names                     which key owns which name",
     parsed_by<parse_names, list_names>()},
    {"kick", kModerators,
     "kick PLAYER ... [reason TEXT]\n"
     "                          end the sessions of players, who may come back",
     parsed_by<parse_kick, kick>()},
    {.words = "ban",
     .rule = kModerators,
     .help = "ban PLAYER|ADDRESS|RANGE ... [for DURATION] [reason TEXT]\n"
             "                          let nobody join with these keys, or from there; "
             "administrators\n"
             "                          still join from there",
     .functions = parsed_by<parse_restrict<RestrictionKind::ban>, restrict_subjects>(),
     .may_be_confirmed = true},
    {"mute", kModerators, "mute PLAYER ...           let players not write to others",
     parsed_by<parse_restrict<RestrictionKind::mute>, restrict_subjects>()},
    {"freeze", kModerators, "freeze PLAYER ...         let players not edit",
     parsed_by<parse_restrict<RestrictionKind::freeze>, restrict_subjects>()},
    {"unban", kModerators, "unban, unmute, unfreeze   end bans, mutes or freezes",
     parsed_by<parse_lift<RestrictionKind::ban>, lift_restrictions>()},
    {"unmute", kModerators, "", parsed_by<parse_lift<RestrictionKind::mute>, lift_restrictions>()},
    {"unfreeze", kModerators, "",
     parsed_by<parse_lift<RestrictionKind::freeze>, lift_restrictions>()},
    {"bans", kModerators, "bans                      the bans, mutes and freezes in force",
     alone<list_restrictions>()},
    {"refusals", kModerators, "refusals                  what players were refused lately",
     alone<list_refusals>()},
    {"chat", kModerators,
     "chat log [by PLAYER] [since MOMENT] [limit N]\n"
     "                          the newest lines of the chat, the last one at the bottom",
     parsed_by<parse_chat_log, list_chat_log>()},
    {"chat withdraw", kModerators,
     "chat withdraw PLAYER ...  hide the newest lines of players from everybody; a ban does it, too",
     parsed_by<parse_withdraw, withdraw_lines>()},
}};

}  // namespace

std::span<const CommandRow> moderation_commands() { return kModerationRows; }

}  // namespace runstone
