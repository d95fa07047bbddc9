// Names: who may join under which name, and when a name becomes the property of a key.
// Thread: the world strand.
#pragma once
#include <optional>
#include <string>

#include "server/limits/address_ledger.hpp"
#include "server/names/lookalike_names.hpp"
#include "server/world/order/order.hpp"
#include "server/world/rights/rights.hpp"
#include "server/world/sessions/session.hpp"

namespace runstone {

/// A claim of a name costs its address so much, of names_per_address units a second: an hour's
/// worth.
inline constexpr std::uint64_t kClaimPrice = 3'600;

class Names {
 public:
  Names(const WorldConfig& config, WorldEnvironment& environment, Order& order,
        const Rights& rights);

  /// Returns why the session may not have its name, for goodbye name_refused, or nullopt:
  ///   - the name breaks a rule of name_fault(), or is reserved;
  ///   - it belongs to another key, or the key owns names_per_key others already;
  ///   - its key does not own it yet, and commands would read it as a reference to another player,
  ///     a role or an address (name_reference.hpp), or it looks like a reserved name or like the
  ///     name of a role (lookalike_names.hpp). The default role does not count, because everybody
  ///     has it. "builder" itself is free while the role of that name has no rights over others,
  ///     because clients call their player so at first.
  /// Changes nothing. Cost: O(log claims), and that of LookalikeNames::like().
  std::optional<std::string> refusal(const Session& session) const;
  /// Makes the session's key own its name, if the client keeps its key (kFeatureNames) and nobody
  /// owns the name. Nothing is claimed while the log has no room, once the address has claimed
  /// names_per_address in an hour, and beyond kNameClaimsMax: the player then joins as one whose
  /// client does not keep its key, and the next join tries again. Requires !refusal().
  void claim(const Session& session, TimeUs now_us);
  /// Returns true if the session's key owns its name and the claim is not on disk yet. Nobody waits
  /// for a full disk.
  bool is_claim_unwritten(const Session& session) const;
  /// Frees a name. Returns the claim that it had, or the reason why nothing changed.
  Result<NameClaim, std::string> release(const std::string& name);

 private:
  /// Returns the names of all roles but the default role. They are collected again after a change of
  /// rights.
  const LookalikeNames& names_of_roles() const;
  std::optional<std::string> not_for_new_owners(const std::string& name, const std::string& folded,
                                                const PublicKey& key) const;

  const WorldConfig& config_;
  WorldEnvironment& environment_;
  Order& order_;
  const Rights& rights_;
  const LookalikeNames reserved_;
  mutable LookalikeNames roles_;
  mutable std::optional<std::uint64_t> roles_revision_;  // of Rights, when roles_ was made
  AddressLedger ledger_;
};

}  // namespace runstone
