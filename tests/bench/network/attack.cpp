#include "tests/bench/network/attack.hpp"

#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <string_view>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "protocol/limits.hpp"
#include "tests/bench/network/hostile_fleet.hpp"

namespace runstone::bench {
namespace {

constexpr int kTinyBuffer = 4 * 1024;        // of a socket that is not read
constexpr std::int32_t kFarChunk = 1 << 20;  // from the middle of the world; in it at any edge
constexpr std::uint8_t kSomeRadius = 4;

View view_at(ChunkCoord centre, std::uint8_t radius_h, std::uint8_t radius_v) {
  return {centre, radius_h, radius_v};
}
View large_view() { return view_at({}, kViewRadiusMax, kViewRadiusMax); }

ChunkCoord anywhere(SplitMix64& random, std::int32_t reach) {
  const std::int32_t x = random.between(-reach, reach), y = random.between(-reach, reach);
  return {x, y, random.between(-reach, reach)};
}

void say_nothing(HostileClient& /*client*/) {}

// ---- slow readers

void never_read(HostileFleet& fleet) {
  const auto client = fleet.join(kTinyBuffer);
  if (client == nullptr) return;
  client->queue(large_view());
  while (!fleet.is_over()) {
    client->flush();
    fleet.pause_ms(50);
  }
  client->read();
  fleet.end(*client);
}

void ping_unread(HostileFleet& fleet) {
  fleet.flood([](HostileClient& client) { client.queue(large_view()); },
              [](HostileClient& client) { client.queue(Ping{1}); }, kJustBelowFlooding, false);
}

void read_a_byte_a_second(HostileFleet& fleet) {
  const auto client = fleet.join(kTinyBuffer);
  if (client == nullptr) return;
  client->queue(large_view());
  for (double next = 1; !fleet.is_over(); fleet.pause_ms(10)) {
    client->flush();
    if (fleet.seconds() < next) continue;
    next += 1;
    client->queue(Ping{1});
    client->read(1);
  }
  client->read();
  fleet.end(*client);
}

// ---- floods of one kind of message

double rate_of(const HostileFleet& fleet) {
  return fleet.index() % 2 == 0 ? kJustBelowFlooding : kNoLimit;
}

void flood_views(HostileFleet& fleet) {
  const auto look = [&fleet](HostileClient& client) {
    client.queue(view_at(anywhere(fleet.random(), kFarChunk), kViewRadiusMax, kViewRadiusMax));
  };
  fleet.flood(say_nothing, look, rate_of(fleet));
}

void flood_absurd_views(HostileFleet& fleet) {
  const auto look = [](HostileClient& client) { client.queue(view_at({}, 255, 255)); };
  fleet.flood(say_nothing, look, kNoLimit);
}

/// Of so many chunks of a block around the middle, each said to be held as it was after edit 1.
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
  for (const Message& message : cached_chunks_messages(chunks))
    out.push_back(encode_message(message));
  return out;
}

void claim_falsely(HostileFleet& fleet) {
  // 29,791 chunks fit what a session may claim, and are claimed again and again; 117,649 do not.
  const bool fits = fleet.index() % 2 == 0;
  const std::vector<EncodedMessage> claims = claims_of(fits ? 15 : 24, fleet.random());
  std::size_t next = 0;
  const auto begin = [&](HostileClient& client) {
    next = 0;
    if (fits) client.queue(view_at({0, kFarChunk, 0}, 1, 1));  // none of them is ever answered
  };
  const auto claim = [&](HostileClient& client) {
    client.queue(claims[next]);
    next = (next + 1) % claims.size();
  };
  fleet.flood(begin, claim, rate_of(fleet));
}

void request_chunks(HostileFleet& fleet) {
  const auto begin = [](HostileClient& client) {
    client.queue(view_at({}, kSomeRadius, kSomeRadius));
  };
  const auto request = [&fleet](HostileClient& client) {
    ChunkRequest wish;
    for (std::size_t i = 0; i < kChunkRequestKeysMax; ++i) {
      wish.keys.push_back({0, anywhere(fleet.random(), kSomeRadius)});
    }
    client.queue(wish);
  };
  fleet.flood(begin, request, rate_of(fleet));
}

/// Edits of this shape in a place of the fleet's own, far from everybody.
template <class ShapeAt>
void flood_edits(HostileFleet& fleet, const ShapeAt& shape_at) {
  const VoxelPos home{1 << 20, 0, static_cast<std::int32_t>(fleet.index() + 1) << 12};
  ClientSequence next = 0;
  const auto begin = [&](HostileClient& client) {
    next = 0;
    const std::int32_t edge = client.welcome().chunk_edge;
    client.queue(view_at({home.x / edge, home.y / edge, home.z / edge}, kSomeRadius, kSomeRadius));
  };
  const auto edit = [&](HostileClient& client) {
    const VoxelPos at{home.x + fleet.random().between(-64, 64), fleet.random().between(-64, 64),
                      home.z + fleet.random().between(-64, 64)};
    const auto material = static_cast<Material>(fleet.random().below(2));
    client.queue(EditRequest{++next, 0, {shape_at(at), {}, material}});
  };
  fleet.flood(begin, edit, rate_of(fleet));
}

void edit_too_often(HostileFleet& fleet) {
  flood_edits(fleet, [](const VoxelPos& at) { return EditShape{SetVoxel{at}}; });
}

void edit_too_much(HostileFleet& fleet) {
  constexpr std::uint16_t kRadius =
      60;  // 905,000 voxels, just below what one edit may have by default
  flood_edits(fleet, [](const VoxelPos& at) { return EditShape{FillSphere{at, kRadius}}; });
}

void travel_too_often(HostileFleet& fleet) {
  std::uint32_t request = 0;
  const auto begin = [&](HostileClient& client) {
    request = 0;
    client.queue(view_at({}, kSomeRadius, kSomeRadius));
  };
  const auto travel = [&](HostileClient& client) {
    client.queue(
        HistoryRequest{++request, HistoryTarget::sequence, fleet.random().below(1'000), 0});
  };
  fleet.flood(begin, travel, rate_of(fleet));
}

void command_too_often(HostileFleet& fleet) {
  std::uint32_t id = 0;
  const auto command = [&](HostileClient& client) {
    client.queue(CommandRequest{++id, id % 2 == 0 ? "undo" : std::string(kCommandBytesMax, 'x')});
  };
  fleet.flood(say_nothing, command, rate_of(fleet));
}

// ---- before there is a session

/// As an honest client begins, but for its key.
Bytes framed_hello() {
  Hello hello;
  hello.name = "mallory";
  Bytes out;
  FrameWriter().append(encode_message(hello), out);
  return out;
}

void open_halfway(HostileFleet& fleet) {
  constexpr std::size_t kOpenMax = 500;  // of each thread: far fewer than a process may have open
  constexpr std::uint32_t kAddresses = 250;
  constexpr int kPerStep = 4;
  std::deque<std::unique_ptr<HostileClient>> open;
  const auto look = [&](bool is_last) {
    for (auto it = open.begin(); it != open.end();) {
      (*it)->flush();
      (*it)->read();
      if ((*it)->is_open() && !is_last) {
        ++it;
        continue;
      }
      fleet.end(**it);
      it = open.erase(it);
    }
  };
  for (std::uint32_t turn = 0; !fleet.is_over(); ++turn) {
    for (int i = 0; i < kPerStep && open.size() < kOpenMax; ++i) {
      // Every other thread from as many addresses as it likes, the others from the one that honest clients have, too.
      const std::uint32_t other = fleet.index() % 2 == 0 ? 0 : 1 + fleet.random().below(kAddresses);
      auto client = fleet.connect(HostileFleet::kLoopback + other);
      if (client == nullptr) break;
      const Bytes hello = framed_hello();
      if (turn % 2 == 0) client->queue_bytes(ByteView(hello).first(hello.size() / 2));
      open.push_back(std::move(client));
    }
    look(false);
    fleet.pause_ms(1);
  }
  look(true);
}

/// Bytes that no client sends, of one sort after another.
Bytes garbage(SplitMix64& random, std::uint64_t sort) {
  Bytes out;
  ByteWriter writer(out);
  const Bytes hello = framed_hello();
  switch (sort % 5) {
    case 0:
      for (int i = 0; i < 4096; ++i) writer.u64(random.next());
      break;
    case 1:  // a frame of 4 GiB
      writer.u32(UINT32_MAX);
      writer.u64(0);
      break;
    case 2:  // the end in the middle of a frame
      out.assign(hello.begin(), hello.end() - 1);
      break;
    case 3:  // a message with one bit turned over
      out = hello;
      out[kFrameHeaderBytes +
          random.below(static_cast<std::uint32_t>(out.size() - kFrameHeaderBytes))] ^=
          static_cast<std::uint8_t>(1U << random.below(8));
      break;
    default:  // a fragment after the other of a message that never ends
      for (std::uint32_t counter = 0; counter < 64; ++counter) {
        writer.u32(kFragmentBytesMax);
        writer.u32(1U << 8);
        writer.u32(counter);
        out.resize(out.size() + kFragmentBytesMax);
      }
  }
  return out;
}

void send_garbage(HostileFleet& fleet) {
  constexpr int kWaitMs = 200;
  for (std::uint64_t sort = fleet.index(); !fleet.is_over(); ++sort) {
    const auto client = fleet.connect();
    if (client == nullptr) return;
    client->queue_bytes(garbage(fleet.random(), sort));
    for (int ms = 0; ms < kWaitMs && client->is_open() && !fleet.is_over(); ++ms) {
      client->flush();
      if (client->queued() == 0) client->shutdown_send();
      client->wait(1, true);
      client->read();
    }
    fleet.end(*client);
  }
}

/// No attack at all: bytes between two sockets of its own. What others feel of it is what a busy machine does to them.
void keep_the_machine_busy(HostileFleet& fleet) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
  const Descriptor in(ends[0]), out(ends[1]);
  std::array<std::uint8_t, 16 * 1024> bytes{};
  while (!fleet.is_over()) {
    const ssize_t sent = ::send(in.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent > 0) fleet.outcome.bytes_sent += static_cast<std::uint64_t>(sent);
    while (::recv(out.get(), bytes.data(), bytes.size(), MSG_DONTWAIT) > 0) {
    }
  }
}

constexpr std::array<Attack, 14> kAttacks = {{
    {"elsewhere", "as many threads copy bytes in the kernel: no attack, only a busy machine",
     keep_the_machine_busy},
    {"never-reads", "a view of radius 64, and nothing is ever read", never_read},
    {"unread-pings", "the same, and 9,000 pings a second whose answers are not read", ping_unread},
    {"byte-a-second", "a view of radius 64, one byte read a second", read_a_byte_a_second},
    {"views",
     "views of radius 64 anywhere in the world, 9,000 a second and as many as the socket takes",
     flood_views},
    {"absurd-views", "views of radius 255", flood_absurd_views},
    {"claims", "29,791 chunks said to be held, again and again; and 117,649", claim_falsely},
    {"half-open", "connections that say nothing, or half a hello; from one address and from 250",
     open_halfway},
    {"garbage",
     "random bytes, frames of 4 GiB, frames cut short, bits turned over, messages without end",
     send_garbage},
    {"chunk-requests", "64 chunks of a view a message, again and again", request_chunks},
    {"edits", "single voxels, 9,000 a second and as many as the socket takes", edit_too_often},
    {"large-edits", "the same with spheres of 905,000 voxels", edit_too_much},
    {"travel", "wishes to see the past, likewise", travel_too_often},
    {"commands", "command lines, likewise, half of them 1 KiB of nonsense", command_too_often},
}};

AttackOutcome play(const Attack& attack, std::uint16_t port, unsigned index, double seconds,
                   std::uint64_t seed) {
  constexpr int kLowest = 19;
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kLowest);
  HostileFleet fleet(port, index, seconds, seed);
  attack.play(fleet);
  rusage used{};
  if (::getrusage(RUSAGE_THREAD, &used) == 0) {
    const auto seconds_of = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
    };
    fleet.outcome.core_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  }
  return std::move(fleet.outcome);
}

}  // namespace

std::string alike(const std::string& reason) {
  constexpr std::string_view kSpeaks = "client speaks protocol ";
  std::string out = reason.substr(0, reason.find(" (at byte"));
  const std::size_t at = out.find(kSpeaks);
  if (at != std::string::npos) {
    const std::size_t number = at + kSpeaks.size();
    out.replace(number, out.find(',', number) - number, "N");
  }
  return out;
}

std::span<const Attack> all_attacks() { return kAttacks; }

void AttackOutcome::merge(const AttackOutcome& other) {
  for (const auto& [ending, count] : other.endings) endings[ending] += count;
  connections += other.connections;
  bytes_sent += other.bytes_sent;
  bytes_received += other.bytes_received;
  core_seconds += other.core_seconds;
}

RunningAttack::RunningAttack(const Attack& attack, std::uint16_t port, unsigned clients,
                             double seconds, std::uint64_t seed)
    : outcomes_(clients) {
  for (unsigned i = 0; i < clients; ++i) {
    threads_.emplace_back([=, this] { outcomes_[i] = play(attack, port, i, seconds, seed); });
  }
}

RunningAttack::~RunningAttack() {
  for (std::thread& thread : threads_) thread.join();
}

AttackOutcome RunningAttack::finish() {
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
  AttackOutcome sum;
  for (const AttackOutcome& outcome : outcomes_) sum.merge(outcome);
  return sum;
}

}  // namespace runstone::bench
