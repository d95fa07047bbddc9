// Client handshake: the hello that a client sends, and the check of the server's welcome. Pure:
// randomness is an argument.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "client/session/password_keys.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct SessionConfig {
  KeyPair keys;
  std::string name = "builder";
  ClientInstance instance = 1;               // random per process
  std::uint8_t encodings = kEncodingsKnown;  // as in Hello
  /// kFeatureNames is added if the key is kept for later runs. Keys are moved by
  /// KeyTransferSession.
  std::uint64_t features = kFeaturesKnown & ~kFeatureNames & ~kFeatureKeyTransfer;
  View view;                               // requested; the server's limit cuts the radii
  std::map<WorldId, PublicKey> pinned;     // server keys seen before
  std::string ticket;                      // an invite token, sent with the signature; empty: none
  std::shared_ptr<PasswordKeys> password;  // sent to worlds that have one; null: none
  bool has_cache = false;                  // a ClientSession looks chunks up in a cache
  TimeUs cache_wait_us = 250'000;          // the time for which a view waits for the cache
};

/// Returns the hello. `nonce` must be fresh and random, so that old welcomes cannot be replayed.
Hello make_hello(const SessionConfig& config, const Nonce& nonce);

/// Why a welcome is rejected. Trying again with the same configuration is pointless.
struct WelcomeFault {
  GoodbyeReason reason = GoodbyeReason::not_authenticated;
  std::string text;
};
/// Returns nullopt if the server has this protocol version, has proved its key on the connection of
/// this binding, and the key is the pinned one of its world. Adds the key to `pinned` if the world
/// has none. Otherwise returns the reason for the rejection. Cost: one signature check, about 0.1
/// ms.
std::optional<WelcomeFault> check_welcome(const Hello& hello, const Welcome& welcome,
                                          const std::optional<ChannelBinding>& binding,
                                          std::map<WorldId, PublicKey>& pinned);

}  // namespace runstone
