#include "bench/harness/strand_surroundings.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <variant>

#include "common/core/assert.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/message_table.hpp"

namespace runstone::bench {

bool StrandSurroundings::send(SessionId session, const EncodedMessage& message) {
  if (message.kind == kKindOf<Welcome>) welcomes.insert_or_assign(session, message);
  return true;
}

void StrandSurroundings::close(SessionId /*session*/, GoodbyeReason /*reason*/,
                               const std::string& text) {
  fmt::print(stderr, "closed: {}\n", text);
  RUNSTONE_ASSERT(false);
}

WorldConfig strand_config(std::uint8_t tile_levels) {
  WorldConfig c;
  c.chunk_edge = kStrandEdge;
  c.server_keys = key_pair_of({1});
  c.tile_levels_max = tile_levels;
  c.idle_us_max = 3'600'000'000;
  for (int i = 1; i < 8; ++i) {
    MaterialInfo info;
    info.name = "m" + std::to_string(i);
    RUNSTONE_ASSERT(c.materials.add(info).has_value());
  }
  return c;
}

void fill_constant(std::span<std::uint8_t> out) { std::ranges::fill(out, std::uint8_t{7}); }

void join(WorldServer& server, const StrandSurroundings& surroundings, SessionId session,
          const KeyPair& keys, const std::string& name, std::uint64_t features, const Clocks& now) {
  server.connected(session, now);
  Hello hello;
  hello.key = keys.public_key;
  hello.instance = 1;
  hello.name = name;
  hello.features = features;
  server.received(session, hello, now);
  const EncodedMessage& sent = surroundings.welcomes.at(session);
  const auto welcome = decode_message(Sender::server, sent.kind, *sent.bytes, kStrandEdge);
  RUNSTONE_ASSERT(welcome.has_value());
  const Bytes transcript = client_transcript(hello, std::get<Welcome>(*welcome), std::nullopt);
  server.received(session, ClientAuth{sign(keys, transcript), {}}, now);
}

}  // namespace runstone::bench
