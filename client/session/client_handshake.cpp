#include "client/session/client_handshake.hpp"

#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {

Hello make_hello(const SessionConfig& config, const Nonce& nonce) {
  Hello hello;
  hello.key = config.keys.public_key;
  hello.instance = config.instance;
  hello.nonce = nonce;
  hello.name = config.name;
  hello.encodings = config.encodings;
  hello.features = config.features;
  return hello;
}

std::optional<WelcomeFault> check_welcome(const Hello& hello, const Welcome& welcome,
                                          const std::optional<ChannelBinding>& binding,
                                          std::map<WorldId, PublicKey>& pinned) {
  if (welcome.protocol != kProtocolVersion) {
    return WelcomeFault{GoodbyeReason::wrong_protocol,
                        "server speaks protocol " + std::to_string(welcome.protocol) + ", client " +
                            std::to_string(kProtocolVersion)};
  }
  if (!verify(welcome.server_key, server_transcript(hello, welcome, binding), welcome.signature)) {
    return WelcomeFault{GoodbyeReason::not_authenticated, "server signature is wrong"};
  }
  if ((welcome.features & ~hello.features) != 0) {
    return WelcomeFault{GoodbyeReason::malformed_message,
                        "welcome has features that hello did not offer"};
  }
  const auto [pin, first_use] = pinned.try_emplace(welcome.world_id, welcome.server_key);
  if (!first_use && pin->second != welcome.server_key) {
    return WelcomeFault{GoodbyeReason::not_authenticated,
                        "this server has the key " + key_fingerprint(welcome.server_key) +
                            ", but the world's key is pinned as " + key_fingerprint(pin->second) +
                            ": it may be an impostor; ask the host which key is right"};
  }
  return std::nullopt;
}

}  // namespace runstone
