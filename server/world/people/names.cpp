#include "server/world/people/names.hpp"

#include <utility>
#include <vector>

#include "common/names/folded_name.hpp"
#include "protocol/codec/key_fingerprint.hpp"
#include "server/names/name_reference.hpp"

namespace runstone {
namespace {

void add_to(LookalikeNames& names, const std::string& name) {
  names.add(name, is_compared_whole(name) ? LookalikeNames::Compare::whole
                                          : LookalikeNames::Compare::words);
}

LookalikeNames lookalikes_of(const std::set<std::string>& reserved) {
  LookalikeNames names;
  for (const std::string& name : reserved) add_to(names, name);
  return names;
}

/// Returns true for the name that clients give their player until the player chooses another one,
/// while the role of that name has no rights over others. This name does not suggest that its player
/// has the role, and a client that is started for the first time must be able to join.
bool is_first_name(const std::string& folded, const RightsState& rights) {
  if (folded != kBuilderRole) return false;
  const Decided<Role>* role = rights.find_role(folded);
  return role == nullptr || role->value.rights.and_in(kRightsOverOthers) == RightSet();
}

}  // namespace

Names::Names(const WorldConfig& config, WorldEnvironment& environment, Order& order,
             const Rights& rights)
    : config_(config),
      environment_(environment),
      order_(order),
      rights_(rights),
      reserved_(lookalikes_of(config.reserved_names)),
      ledger_({config.names_per_address, config.names_per_address * kClaimPrice}) {}

const LookalikeNames& Names::names_of_roles() const {
  if (roles_revision_ == rights_.revision()) return roles_;
  roles_ = LookalikeNames();
  // Everybody has the default role, so nobody seems to have more by its name.
  const std::string& of_everybody = rights_.state().default_role().value;
  for (const auto& [name, role] : rights_.state().roles()) {
    if (name != of_everybody) add_to(roles_, name);
  }
  roles_revision_ = rights_.revision();
  return roles_;
}

/// Returns why the player may not newly have the name, as the end of a sentence, or nullopt.
std::optional<std::string> Names::not_for_new_owners(const std::string& name,
                                                     const std::string& folded,
                                                     const PublicKey& key) const {
  // A fingerprint as the name of its own player means one player only.
  const bool is_own = fingerprint_in(folded) == key_fingerprint(key);
  const auto reference = read_as_reference(folded);
  if (reference && !is_own) return "is refused: commands read it as " + *reference;
  if (const auto like = reserved_.like(name))
    return "looks like \"" + *like + "\", which is reserved";
  const auto like =
      is_first_name(folded, rights_.state()) ? std::nullopt : names_of_roles().like(name);
  if (like) return "looks like \"" + *like + "\", a role of this world";
  return std::nullopt;
}

std::optional<std::string> Names::refusal(const Session& session) const {
  const std::string named = "the name \"" + session.name + "\"";
  if (const auto fault = name_fault(session.name)) return named + " is refused: " + *fault;
  const std::string folded = folded_name(session.name);
  if (config_.reserved_names.contains(folded)) return named + " is reserved: choose another name";
  const NameClaim* const claim = order_.names().find(folded);
  if (claim != nullptr && claim->key == session.key) return std::nullopt;
  if (claim != nullptr) {
    return named + " belongs to the player with the key " + key_fingerprint(claim->key) +
           ": choose another name, or ask the server's host to release it";
  }
  if (const auto why = not_for_new_owners(session.name, folded, session.key))
    return named + " " + *why + ": choose another name";
  if (!session.has(kFeatureNames)) return std::nullopt;
  const std::vector<std::string> owned = order_.names().names_of(session.key);
  if (owned.size() < config_.names_per_key) return std::nullopt;
  std::string list;
  for (const std::string& name : owned) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  return "your key owns " + std::to_string(owned.size()) + " names and no more are allowed: " +
         "choose one of them, or ask the server's host to release one: " + list;
}

void Names::claim(const Session& session, TimeUs now_us) {
  if (!session.has(kFeatureNames)) return;
  std::string folded = folded_name(session.name);
  NameClaims& names = order_.names();
  if (names.find(folded) != nullptr) return;
  const auto report = [&](const std::string& what) {
    environment_.report(OperatorLogLevel::info, "session=" + std::to_string(session.id) +
                                                    " name=\"" + session.name + "\" " + what);
  };
  if (!order_.log_has_room()) return report("not claimed: the log has no room");
  if (names.size() >= kNameClaimsMax)
    return report("not claimed: this world has " + std::to_string(kNameClaimsMax) +
                  " names (names release NAME)");
  if (!ledger_.take(session.address, kClaimPrice, now_us))
    return report("not claimed: too many names of its address in an hour (names_per_address)");
  order_.append_names({names.claim({std::move(folded), session.name, session.key})});
  report("claimed by key=" + key_fingerprint(session.key));
}

bool Names::is_claim_unwritten(const Session& session) const {
  if (order_.is_disk_full()) return false;
  const std::string folded = folded_name(session.name);
  const NameClaim* const claim = order_.names().find(folded);
  return claim != nullptr && claim->key == session.key && !order_.names().is_durable(folded);
}

Result<NameClaim, std::string> Names::release(const std::string& name) {
  const std::string folded = folded_name(name);
  if (order_.names().find(folded) == nullptr)
    return failure("nobody owns \"" + name + "\" (names lists who owns what)");
  if (!order_.log_has_room()) return failure("the log has no room; try again later");
  NameChange change = *order_.names().release(folded);
  order_.append_names({change});
  return std::move(change.claim);
}

}  // namespace runstone
