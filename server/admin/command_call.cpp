#include "server/admin/command_call.hpp"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "server/admin/command_table.hpp"
#include "server/admin/folder_import.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/admin/rights_hazard.hpp"
#include "server/admin/rights_reason.hpp"
#include "server/names/name_reference.hpp"

namespace runstone {
namespace {

/// Returns the keys that the state of rights names, some more than once.
std::vector<PublicKey> keys_of(const RightsState& state) {
  std::vector<PublicKey> keys;
  for (const auto& [key, grant] : state.grants()) keys.push_back(key);
  for (const Decided<Restrict>* restriction : state.restrictions()) {
    if (const auto* key = std::get_if<PublicKey>(&restriction->value.subject)) keys.push_back(*key);
  }
  for (const auto& [name, box] : state.boxes()) {
    if (box.value.owner) keys.push_back(*box.value.owner);
    keys.insert(keys.end(), box.value.members.begin(), box.value.members.end());
  }
  return keys;
}

/// Returns what the world strand knows about players. A worker adds what the store has.
KnownPlayers::Sources sources_of(const WorldServer& world, const std::vector<std::string>& words) {
  KnownPlayers::Sources sources;
  for (const OnlinePlayer& player : world.people().online())
    sources.present.push_back({player.author, player.key, player.name});
  sources.visitors = world.order().players().visitors();
  // Only a fingerprint finds a key without a name.
  const bool has_fingerprint = std::any_of(
      words.begin(), words.end(), [](const auto& word) { return !fingerprint_in(word).empty(); });
  if (has_fingerprint) sources.others = keys_of(world.rights().state());
  return sources;
}

Result<CommandCall::FoundPlayers, std::string> look_up_players(
    WorldReader& reader, KnownPlayers::Sources sources, const std::vector<std::string>& words,
    const std::vector<std::string>& patterns) {
  CommandCall::FoundPlayers found;
  auto stored = reader.players();
  auto used = reader.player_names();
  auto claims = reader.name_claims();
  if (!claims) return failure(claims.error().message());
  if (!used) return failure(used.error().message());
  if (!stored) return failure(stored.error().message());
  sources.stored = *std::move(stored);
  sources.used = *std::move(used);
  sources.claims = *std::move(claims);
  found.known = std::make_shared<const KnownPlayers>(sources);
  for (const std::string& word : words) {
    const auto key = found.known->find(word);
    if (!key) return failure("\"" + word + "\": " + key.error());
    found.keys.push_back(*key);
  }
  for (const std::string& pattern : patterns) {
    std::set<AuthorId>& authors = found.matches.emplace_back();
    for (const PublicKey& key : found.known->matching(pattern)) {
      if (const auto author = found.known->author_of(key)) authors.insert(*author);
    }
  }
  return found;
}

}  // namespace

bool has_right(const CommandCaller& caller, const RightsState& state, Right right, TimeUs now_us) {
  if (!caller.scope.has(right)) return false;
  if (!caller.actor.key || caller.actor.is_operator) return true;
  return state.decide(*caller.actor.key, right, now_us).is_allowed;
}

std::optional<std::string> why_not(const CommandCaller& caller, const RightsState& state,
                                   const CommandRule& rule, TimeUs now_us) {
  if (!caller.actor.key) return std::nullopt;
  if (rule.is_local) return "this command is for the console and `runstone-server control`";
  if (rule.any_of == RightSet()) return std::nullopt;
  if (rule.any_of.and_in(caller.scope) == RightSet())
    return "the token in use is for commands that need " + rights_text(caller.scope);
  if (caller.actor.is_operator) return std::nullopt;
  const PublicKey& key = *caller.actor.key;
  std::string names;
  std::optional<std::string> restricted;
  for (std::size_t i = 0; i < kRightCount; ++i) {
    const auto right = static_cast<Right>(i);
    if (!rule.any_of.has(right) || !caller.scope.has(right)) continue;
    const RightsDecision decision = state.decide(key, right, now_us);
    if (decision.is_allowed) return std::nullopt;
    names += (names.empty() ? "" : " or ") + std::string(name_of(right));
    if (const auto kind = restriction_of(decision.reason))
      restricted = "you are " + why_restricted(state, *kind, key, now_us);
  }
  if (restricted) return restricted;
  return "this command needs the right " + names + "; your role is " + state.role_of(key).name;
}

void CommandServices::tick(const Clocks& now) {
  if (folder_import) folder_import->tick(now);
  if (folder_import && folder_import->is_over()) folder_import = nullptr;
  announcements.tick(now.steady_us, now.utc_us, [&](const std::string& text) {
    if (world.cluster().is_following() || world.people().online().empty()) return;
    world.people().chat().say(text, {}, now);
  });
  for (Waiting& each : std::exchange(waiting, {})) {
    const Order& order = world.order();
    if (order.durable() >= each.needed &&
        order.names().durable_change() >= each.needed_name_change) {
      each.begin();
    } else if (each.is_work ? !order.accepts_edits()
                            : order.ownership().is(OwnershipState::log_lost)) {
      each.refuse();
    } else {
      const bool is_late = order.is_disk_full() || now.steady_us >= each.report_us;
      if (is_late && each.report) std::exchange(each.report, {})();
      waiting.push_back(std::move(each));
    }
  }
}

void CommandCall::answer_when_durable(Sequence record, const std::string& text) const {
  answer_when_durable(record, 0, text);
}

void CommandCall::answer_when_names_durable(const std::string& text) const {
  answer_when_durable(0, world().order().names().last_change(), text);
}

void CommandCall::answer_when_durable(Sequence record, std::uint64_t name_change,
                                      const std::string& text) const {
  services.waiting.push_back(
      {record, [call = *this, text] { call.answer(text); },
       [call = *this, text] {
         call.refuse(text +
                     "; in force until the server stops, but NOT on disk: the log cannot be "
                     "written any more");
       },
       [call = *this, text] {
         const Order& order = call.world().order();
         const std::string why =
             order.is_disk_full() ? std::string(": ") + order.disk_reason() : "";
         call.reply(CommandAnswer::unsaved(text + "; in force, not on disk yet" + why));
       },
       now.steady_us + kAnswerUnsavedUs, false, name_change});
}

void CommandCall::find_players(const std::vector<std::string>& words,
                               const std::vector<std::string>& patterns,
                               std::function<void(const FoundPlayers&)> go_on,
                               const std::string& before) const {
  on_worker(
      before,
      [sources = sources_of(world(), words), words, patterns](WorldReader& reader) {
        return look_up_players(reader, sources, words, patterns);
      },
      std::move(go_on));
}

void CommandCall::with_players(const std::vector<std::string>& words,
                               std::function<void(const KnownPlayers&, const Keys&)> go_on,
                               const std::string& before) const {
  find_players(
      words, {},
      [go_on = std::move(go_on)](const FoundPlayers& found) { go_on(*found.known, found.keys); },
      before);
}

bool CommandCall::refuse_unless_confirmed(const std::optional<std::string>& hazard) const {
  if (!hazard || is_confirmed) return false;
  // A line with a password's verifier is not repeated.
  const std::string repeat =
      logged_command(line) == line
          ? "give the command as: " + line + " " + kAnyway
          : std::string("give the command with the word ") + kAnyway + " at its end";
  refuse("nothing has changed: " + *hazard + ". To do it all the same, " + repeat);
  return true;
}

void CommandCall::change_rights(const RightsChange& change, const std::string& text,
                                const std::function<std::string()>& in_force) const {
  if (const auto valid = validate(change); !valid) return refuse(valid.error().what);
  if (auto why = world().rights().change_refusal(change, caller.actor))
    return refuse(*std::move(why));
  if (refuse_unless_confirmed(hazard_of(rights(), change))) return;
  const std::size_t sessions = world().session_count();
  const auto seq = world().changes().change_rights(change, caller.actor, caller.author, now);
  if (!seq) return refuse(seq.error());
  std::string answer_text = text + " (record " + std::to_string(*seq) + ")";
  const std::size_t left = world().session_count();
  if (left < sessions) answer_text += "; sessions ended: " + std::to_string(sessions - left);
  if (in_force) answer_text += in_force();
  answer_when_durable(*seq, answer_text);
}

}  // namespace runstone
