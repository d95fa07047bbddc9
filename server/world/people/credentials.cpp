#include "server/world/people/credentials.hpp"

#include <utility>

#include "protocol/codec/invite_token.hpp"
#include "protocol/codec/password_key.hpp"

namespace runstone {

/// Makes the change that gives the player of the session a role. Fails if it was
/// refused: why, as a sentence.
Result<void, std::string> Credentials::take_role(const Session& session, const RightsChange& change,
                                                 const Clocks& now) {
  const AuthorId author = order_.players().enter(session.key, session.name);
  const auto accepted = changes_.change_rights(change, rights_.actor_of(session.key), author, now);
  if (accepted) return {};
  order_.author_left(author);
  return failure(accepted.error());
}

Result<void, std::string> Credentials::accept_invite(const Session& session,
                                                     const std::string& ticket, const Clocks& now) {
  const auto invite = invite_of(ticket, config_.world_id, config_.server_keys.public_key);
  if (!invite) return failure("the invite is not one of this world");
  return take_role(session, AcceptInvite{*invite, session.key}, now);
}

Result<void, std::string> Credentials::accept_password(const Session& session,
                                                       const PasswordKey& key, const Clocks& now) {
  const std::optional<JoinPassword>& password = rights_.state().password().value;
  if (!password) return failure("the world has no password");
  if (!session.binding) return failure("a password needs an encrypted connection");
  if (!guesses_.has(session.address, kGuessPrice, now.steady_us)) return failure(kTooManyGuesses);
  if (is_key_of(*password, key)) {
    // Each new player is a record that stays, and the number of grants has a bound.
    if (!joins_.take(session.address, 1, now.steady_us))
      return failure("too many players joined with the password from your network: wait a minute");
    return take_role(session, AcceptPassword{session.key}, now);
  }
  guesses_.take(session.address, kGuessPrice, now.steady_us);
  return failure("the password is wrong");
}

Result<void, std::string> Credentials::accept(const Session& session,
                                              const JoinCredentials& brought, const Clocks& now) {
  if (rights_.state().grants().contains(session.key)) return {};
  Result<void, std::string> by_invite;
  if (!brought.ticket.empty()) by_invite = accept_invite(session, brought.ticket, now);
  const bool is_decided = !brought.ticket.empty() && by_invite;
  if (is_decided || !brought.password_key) return by_invite;
  auto by_password = accept_password(session, *brought.password_key, now);
  if (by_password || by_invite) return by_password;
  std::string why = by_invite.error();
  if (why.ends_with('.')) why.pop_back();
  return failure(why + "; " + by_password.error());
}

Result<Bytes, Refusal> Credentials::take_key(const Session& session, const KeySlot& slot,
                                             const Clocks& now) {
  if (!guesses_.has(session.address, kGuessPrice, now.steady_us))
    return failure(Refusal{GoodbyeReason::flooding, kTooManyGuesses});
  auto sealed = keys_.take(slot, now.steady_us);
  if (sealed) return *std::move(sealed);
  guesses_.take(session.address, kGuessPrice, now.steady_us);
  return failure(Refusal{GoodbyeReason::not_admitted,
                         "no key is here for this code: it was mistyped, used before, or too old"});
}

Result<void, std::string> Credentials::leave_key(const Session& session, const KeyDeposit& deposit,
                                                 const Clocks& now) {
  Result<void, std::string> kept =
      failure("too many keys were left from your network: wait a minute");
  if (deposits_.take(session.address, kGuessPrice, now.steady_us))
    kept = keys_.put(session.key, session.address, deposit, now.steady_us);
  if (!kept)
    rights_.note_refusal(session.key, "key for another device: " + kept.error(), now.utc_us);
  return kept;
}

}  // namespace runstone
