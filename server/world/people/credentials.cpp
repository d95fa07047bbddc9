#include "server/world/people/credentials.hpp"

#include <utility>

#include "protocol/codec/invite_token.hpp"
#include "protocol/codec/password_key.hpp"

namespace runstone {

/// Makes the change that gives the player of the session a role. Returns why it was refused, as a
/// sentence, or nullopt.
std::optional<std::string> Credentials::take_role(const Session& session,
                                                  const RightsChange& change, const Clocks& now) {
  const AuthorId author = order_.players().enter(session.key, session.name);
  const auto accepted = changes_.change_rights(change, rights_.actor_of(session.key), author, now);
  if (accepted) return std::nullopt;
  order_.author_left(author);
  return accepted.error();
}

std::optional<std::string> Credentials::accept_invite(const Session& session,
                                                      const std::string& ticket,
                                                      const Clocks& now) {
  const auto invite = invite_of(ticket, config_.world_id, config_.server_keys.public_key);
  if (!invite) return "the invite is not one of this world";
  return take_role(session, AcceptInvite{*invite, session.key}, now);
}

std::optional<std::string> Credentials::accept_password(const Session& session,
                                                        const PasswordKey& key, const Clocks& now) {
  const std::optional<JoinPassword>& password = rights_.state().password().value;
  if (!password) return "the world has no password";
  if (!session.binding) return "a password needs an encrypted connection";
  if (!guesses_.has(session.address, kGuessPrice, now.steady_us)) return kTooManyGuesses;
  if (is_key_of(*password, key)) {
    // Each new player is a record that stays, and the number of grants has a bound.
    if (!joins_.take(session.address, 1, now.steady_us))
      return "too many players joined with the password from your network: wait a minute";
    return take_role(session, AcceptPassword{session.key}, now);
  }
  guesses_.take(session.address, kGuessPrice, now.steady_us);
  return "the password is wrong";
}

std::optional<std::string> Credentials::accept(const Session& session,
                                               const JoinCredentials& brought, const Clocks& now) {
  if (rights_.state().grants().contains(session.key)) return std::nullopt;
  std::optional<std::string> no_invite;
  if (!brought.ticket.empty()) no_invite = accept_invite(session, brought.ticket, now);
  const bool is_decided = !brought.ticket.empty() && !no_invite;
  if (is_decided || !brought.password_key) return no_invite;
  const auto no_password = accept_password(session, *brought.password_key, now);
  if (!no_password || !no_invite) return no_password;
  if (no_invite->ends_with('.')) no_invite->pop_back();
  return *no_invite + "; " + *no_password;
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

std::optional<std::string> Credentials::leave_key(const Session& session, const KeyDeposit& deposit,
                                                  const Clocks& now) {
  const auto why =
      deposits_.take(session.address, kGuessPrice, now.steady_us)
          ? keys_.put(session.key, session.address, deposit, now.steady_us)
          : std::optional<std::string>("too many keys were left from your network: wait a minute");
  if (why) rights_.note_refusal(session.key, "key for another device: " + *why, now.utc_us);
  return why;
}

}  // namespace runstone
