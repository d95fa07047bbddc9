// KeyTransferSession: the client's end of a connection that moves a player's key to another device:
// it leaves a sealed key at the server, or fetches one. It performs the handshake up to Welcome and
// sends its request in place of ClientAuth, so the player does not join the world. Pure: randomness
// is an argument. One thread, one connection.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "client/session/client_handshake.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class KeyTransferSession {
 public:
  using Request = std::variant<KeyDeposit, KeyRequest>;
  using Answer = std::variant<KeyDeposited, SealedKey>;

  /// `keys` sign a deposit. A request may use any keys. `pinned` has the server keys seen before.
  KeyTransferSession(const KeyPair& keys, std::map<WorldId, PublicKey> pinned, Request request);

  /// Begins the connection on its byte stream. `nonce` must be fresh and random.
  void connected(const Nonce& nonce, const std::optional<ChannelBinding>& binding);
  void receive(const Message& message);
  /// Call it when the byte stream has ended, or could not be made.
  void disconnected(const std::string& why);
  /// Returns the messages to send, in order.
  std::vector<Message> take_outgoing() { return std::exchange(outgoing_, {}); }

  /// Returns the answer of the server, or the reason why there is none, once it is known. A refused
  /// deposit is a failure.
  const std::optional<Result<Answer, std::string>>& outcome() const { return outcome_; }
  /// Returns the welcome once the server has proved its key.
  const std::optional<Welcome>& welcome() const { return welcome_; }
  /// Returns the server keys seen before, and that of the server's world.
  const std::map<WorldId, PublicKey>& pinned() const { return config_.pinned; }

 private:
  void on_welcome(const Welcome& welcome);
  void fail(std::string why);

  SessionConfig config_;
  Request request_;
  Hello hello_;
  std::optional<ChannelBinding> binding_;
  std::optional<Welcome> welcome_;
  std::vector<Message> outgoing_;
  std::optional<Result<Answer, std::string>> outcome_;
};

}  // namespace runstone
