// Credentials: what a player brings to get a role or a key: an invite, the world's password, the
// code of a key that was left for another device. Guesses are charged to the player's address.
// Thread: the world strand.
#pragma once
#include <optional>
#include <string>

#include "server/limits/address_ledger.hpp"
#include "server/world/commit/changes.hpp"
#include "server/world/people/key_deposits.hpp"

namespace runstone {

/// A wrong password or device code costs its address so much of kGuessBudget, and so does a key
/// that is left for another device: ten at once, then one a minute. People mistype less often, and
/// whoever guesses gets nowhere. A setting would only serve to weaken it.
inline constexpr std::uint64_t kGuessPrice = 60;
inline constexpr Budget kGuessBudget{1, 10 * kGuessPrice};
/// A player who joins with the password for the first time costs the address one of these: a school
/// class at once, then one a second. Otherwise new keys of one address could use up all grants.
inline constexpr Budget kJoinBudget{1, 60};
inline constexpr const char* kTooManyGuesses =
    "too many wrong passwords or codes came from your network: wait a minute";

/// The proofs that a player may bring to join.
struct JoinCredentials {
  std::string ticket;  // of an invite, or empty
  std::optional<PasswordKey> password_key;
};

class Credentials {
 public:
  Credentials(const WorldConfig& config, Order& order, Rights& rights, Changes& changes)
      : config_(config), order_(order), rights_(rights), changes_(changes) {}

  /// Gives an authenticated player without a granted role the role of an invite or, if there is
  /// none, of the password. Fails if nothing was granted: why, as a sentence. The session may be
  /// closed on return, if the role may not see the world.
  Result<void, std::string> accept(const Session& session, const JoinCredentials& brought,
                                   const Clocks& now);
  /// Removes the sealed key of a slot and returns it, or returns why the session ends: there is
  /// none, which counts as a guess, or the address has guessed too often.
  Result<Bytes, Refusal> take_key(const Session& session, const KeySlot& slot, const Clocks& now);
  /// Keeps a sealed key of the player. Fails if it cannot be kept: why, as a sentence.
  Result<void, std::string> leave_key(const Session& session, const KeyDeposit& deposit,
                                      const Clocks& now);

 private:
  Result<void, std::string> accept_invite(const Session& session, const std::string& ticket,
                                          const Clocks& now);
  Result<void, std::string> accept_password(const Session& session, const PasswordKey& key,
                                            const Clocks& now);
  Result<void, std::string> take_role(const Session& session, const RightsChange& change,
                                      const Clocks& now);

  const WorldConfig& config_;
  Order& order_;
  Rights& rights_;
  Changes& changes_;
  AddressLedger guesses_{kGuessBudget}, deposits_{kGuessBudget}, joins_{kJoinBudget};
  KeyDeposits keys_;
};

}  // namespace runstone
