// Greeting: who a client says it is, and whether it believes the server's answer. Pure: randomness is an argument.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct SessionConfig {
  KeyPair keys;
  std::string name = "builder";
  ClientInstance instance = 1;               // random per process
  std::uint8_t encodings = kEncodingsKnown;  // as in Hello
  std::uint64_t features = kFeaturesKnown;
  View view;                            // wished; the server's limit cuts the radii
  std::map<WorldId, PublicKey> pinned;  // server keys seen before
  bool has_cache = false;               // of a ClientSession: somebody answers take_cache_lookup()
};

/// `nonce` must be fresh and random: it keeps old welcomes from being replayed.
Hello make_hello(const SessionConfig& config, const Nonce& nonce);

/// Why a welcome is not believed; trying again with the same configuration is pointless.
struct WelcomeFault {
  GoodbyeReason reason = GoodbyeReason::not_authenticated;
  std::string text;
};
/// Nothing: the server speaks our protocol and proved its key, which is the one in `pinned` for its world, and is put there if
/// there was none. One signature is verified: some 0.1 ms.
std::optional<WelcomeFault> check_welcome(const Hello& hello, const Welcome& welcome,
                                          std::map<WorldId, PublicKey>& pinned);

}  // namespace runstone
