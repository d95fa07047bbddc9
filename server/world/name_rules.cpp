#include "server/world/name_rules.hpp"

#include <algorithm>
#include <vector>

#include "common/names/folded_name.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/world/followers.hpp"

namespace runstone {

std::optional<std::string> name_refusal(const WorldState& world, const WorldSession& mine) {
  const std::string named = "the name \"" + mine.name + "\"";
  if (const auto fault = name_fault(mine.name)) return named + " is refused: " + *fault;
  const std::string folded = folded_name(mine.name);
  if (world.config.reserved_names.contains(folded))
    return named + " is reserved: choose another name";
  const NameClaim* const claim = world.names.find(folded);
  if (claim != nullptr && claim->key == mine.key) return std::nullopt;
  if (claim != nullptr) {
    return named + " belongs to the player with the key " + key_fingerprint(claim->key) +
           ": choose another name, or ask the server's host to release it";
  }
  if ((mine.features & kFeatureNames) == 0) return std::nullopt;
  const std::vector<std::string> owned = world.names.names_of(mine.key);
  if (owned.size() < world.config.names_per_key) return std::nullopt;
  std::string list;
  for (const std::string& name : owned) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  return "your key owns " + std::to_string(owned.size()) + " names and no more are allowed: " +
         "choose one of them, or ask the server's host to release one: " + list;
}

void claim_name(WorldState& world, SessionId session, TimeUs now_us) {
  const WorldSession& mine = *world.find(session);
  if ((mine.features & kFeatureNames) == 0) return;
  std::string folded = folded_name(mine.name);
  if (world.names.find(folded) != nullptr) return;
  const auto report = [&](const std::string& what) {
    world.environment.report(OperatorLogLevel::info, "session=" + std::to_string(session) +
                                                         " name=\"" + mine.name + "\" " + what);
  };
  if (!world.environment.log_has_room(world.authority.queue().size() + 1))
    return report("not claimed: the log has no room");
  if (world.names.size() >= kNameClaimsMax)
    return report("not claimed: this world has " + std::to_string(kNameClaimsMax) +
                  " names (names release NAME)");
  if (!world.claim_ledger.take(mine.address, kClaimPrice, now_us))
    return report("not claimed: too many names of its address in an hour (names_per_address)");
  append_names(world, {world.names.claim({std::move(folded), mine.name, mine.key})});
  report("claimed by key=" + key_fingerprint(mine.key));
}

bool waits_for_claim(const WorldState& world, const WorldSession& mine) {
  if (world.disk_is_full) return false;
  const std::string folded = folded_name(mine.name);
  const NameClaim* const claim = world.names.find(folded);
  return claim != nullptr && claim->key == mine.key && !world.names.is_durable(folded);
}

Result<NameClaim, std::string> release_name(WorldState& world, const std::string& name) {
  const std::string folded = folded_name(name);
  if (world.names.find(folded) == nullptr)
    return Unexpected<std::string>{"nobody owns \"" + name + "\" (names lists who owns what)"};
  if (!world.environment.log_has_room(world.authority.queue().size() + 1))
    return Unexpected<std::string>{"the log has no room; try again later"};
  NameChange change = *world.names.release(folded);
  append_names(world, {change});
  return std::move(change.claim);
}

}  // namespace runstone
