#include "bench/network/view_attacks.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "bench/network/attack_thread.hpp"
#include "common/core/coords.hpp"
#include "protocol/limits.hpp"

namespace runstone::bench {
namespace {

constexpr int kTinyBuffer = 4 * 1024;        // of a socket that is not read
constexpr std::int32_t kFarChunk = 1 << 20;  // from the middle of the world; inside it at any edge
constexpr std::uint8_t kNearRadius = 4;

View view_at(ChunkCoord centre, std::uint8_t radius_h, std::uint8_t radius_v) {
  return {1, centre, radius_h, radius_v};
}
View large_view(ChunkCoord centre) { return view_at(centre, kViewRadiusMax, kViewRadiusMax); }

ChunkCoord anywhere(SplitMix64& random, std::int32_t reach) {
  const std::int32_t x = random.between(-reach, reach), y = random.between(-reach, reach);
  return {x, y, random.between(-reach, reach)};
}

/// Returns a place anywhere at the height of the ground, where chunks differ most.
ChunkCoord on_the_ground(SplitMix64& random) {
  return {random.between(-kFarChunk, kFarChunk), 0, random.between(-kFarChunk, kFarChunk)};
}

/// Returns claims of all chunks of a block around the middle, each claimed in its state after edit
/// 1.
std::vector<EncodedMessage> claims_of(std::int32_t reach, SplitMix64& random) {
  std::vector<CachedChunk> chunks;
  for (std::int32_t x = -reach; x <= reach; ++x) {
    for (std::int32_t y = -reach; y <= reach; ++y) {
      for (std::int32_t z = -reach; z <= reach; ++z) {
        chunks.push_back({{0, {x, y, z}}, {1, 1}, random.next() >> 4});
      }
    }
  }
  std::sort(chunks.begin(), chunks.end(),
            [](const auto& a, const auto& b) { return a.key < b.key; });
  std::vector<EncodedMessage> out;
  for (const auto& message : cached_chunks_messages(chunks)) out.push_back(encode_message(message));
  return out;
}

}  // namespace

void never_read(AttackThread& thread) {
  const auto client = thread.join(kTinyBuffer);
  if (client == nullptr) return;
  client->queue(large_view({}));
  while (!thread.is_over()) {
    client->flush();
    thread.pause_ms(50);
  }
  client->read();
  thread.end(*client);
}

void ping_unread(AttackThread& thread) {
  thread.flood([](AttackClient& client) { client.queue(large_view({})); },
               [](AttackClient& client) { client.queue(Ping{1}); }, kJustBelowFlooding, false);
}

void read_a_byte_a_second(AttackThread& thread) {
  const auto client = thread.join(kTinyBuffer);
  if (client == nullptr) return;
  client->queue(large_view({}));
  for (double next = 1; !thread.is_over(); thread.pause_ms(10)) {
    client->flush();
    if (thread.seconds() < next) continue;
    next += 1;
    client->queue(Ping{1});
    client->read(1);
  }
  client->read();
  thread.end(*client);
}

void flood_views(AttackThread& thread) {
  const auto look = [&thread](AttackClient& client) {
    client.queue(view_at(anywhere(thread.random(), kFarChunk), kViewRadiusMax, kViewRadiusMax));
  };
  thread.flood(say_nothing, look, thread.flood_rate());
}

void flood_absurd_views(AttackThread& thread) {
  const auto look = [](AttackClient& client) { client.queue(view_at({}, 255, 255)); };
  thread.flood(say_nothing, look, kNoLimit);
}

void claim_falsely(AttackThread& thread) {
  // 29,791 chunks are within the limit of a session and are claimed again and again; 117,649 are
  // not.
  const bool fits = thread.index() % 2 == 0;
  const std::vector<EncodedMessage> claims = claims_of(fits ? 15 : 24, thread.random());
  std::size_t next = 0;
  const auto begin = [&](AttackClient& client) {
    next = 0;
    // The server never sends any of these chunks.
    if (fits) client.queue(view_at({0, kFarChunk, 0}, 1, 1));
  };
  const auto claim = [&](AttackClient& client) {
    client.queue(claims[next]);
    next = (next + 1) % claims.size();
  };
  thread.flood(begin, claim, thread.flood_rate());
}

void request_chunks(AttackThread& thread) {
  const auto begin = [](AttackClient& client) {
    client.queue(view_at({}, kNearRadius, kNearRadius));
  };
  const auto request = [&thread](AttackClient& client) {
    std::set<ChunkKey> keys;
    while (keys.size() < kChunkRequestKeysMax) {
      keys.insert({0, anywhere(thread.random(), kNearRadius)});
    }
    client.queue(ChunkRequest{{keys.begin(), keys.end()}});
  };
  thread.flood(begin, request, thread.flood_rate());
}

void travel_too_often(AttackThread& thread) {
  std::uint32_t request = 0;
  const auto begin = [&](AttackClient& client) {
    request = 0;
    client.queue(view_at({}, kNearRadius, kNearRadius));
  };
  const auto travel = [&](AttackClient& client) {
    client.queue(
        HistoryRequest{++request, HistoryTarget::sequence, thread.random().below(1'000), 0});
  };
  thread.flood(begin, travel, thread.flood_rate());
}

void teleport(AttackThread& thread) {
  constexpr double kJumpsPerSecond = 20;  // as often as the server lets a view take effect
  const auto jump = [&thread](AttackClient& client) {
    const ChunkCoord centre = on_the_ground(thread.random());
    const double edge = client.welcome().chunk_edge;
    client.queue(Move{{{centre.x * edge, centre.y * edge, centre.z * edge}, 0, 0}});
    client.queue(large_view(centre));
  };
  thread.flood(say_nothing, jump, kJumpsPerSecond);
}

void spread_views(AttackThread& thread) {
  constexpr double kViewsPerSecond = 0.25;  // a server needs seconds to load so many chunks
  const auto look = [&thread](AttackClient& client) {
    client.queue(large_view(on_the_ground(thread.random())));
  };
  thread.flood(say_nothing, look, kViewsPerSecond);
}

}  // namespace runstone::bench
