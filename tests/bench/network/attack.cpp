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
#include "tests/bench/network/hostile_crew.hpp"

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

void never_read(HostileCrew& crew) {
  const auto client = crew.join(kTinyBuffer);
  if (client == nullptr) return;
  client->queue(large_view());
  while (!crew.is_over()) {
    client->flush();
    crew.pause_ms(50);
  }
  client->read();
  crew.end(*client);
}

void ping_unread(HostileCrew& crew) {
  crew.flood([](HostileClient& client) { client.queue(large_view()); },
             [](HostileClient& client) { client.queue(Ping{1}); }, kJustBelowFlooding, false);
}

void read_a_byte_a_second(HostileCrew& crew) {
  const auto client = crew.join(kTinyBuffer);
  if (client == nullptr) return;
  client->queue(large_view());
  for (double next = 1; !crew.is_over(); crew.pause_ms(10)) {
    client->flush();
    if (crew.seconds() < next) continue;
    next += 1;
    client->queue(Ping{1});
    client->read(1);
  }
  client->read();
  crew.end(*client);
}

// ---- floods of one kind of message

double rate_of(const HostileCrew& crew) { return crew.index() % 2 == 0 ? kJustBelowFlooding : kNoLimit; }

void flood_views(HostileCrew& crew) {
  const auto look = [&crew](HostileClient& client) {
    client.queue(view_at(anywhere(crew.random(), kFarChunk), kViewRadiusMax, kViewRadiusMax));
  };
  crew.flood(say_nothing, look, rate_of(crew));
}

void flood_absurd_views(HostileCrew& crew) {
  const auto look = [](HostileClient& client) { client.queue(view_at({}, 255, 255)); };
  crew.flood(say_nothing, look, kNoLimit);
}

/// Of so many chunks of a block around the middle, each said to be held as it was after edit 1.
std::vector<EncodedMessage> claims_of(std::int32_t reach, SplitMix64& random) {
  std::vector<HeldChunk> chunks;
  for (std::int32_t x = -reach; x <= reach; ++x) {
    for (std::int32_t y = -reach; y <= reach; ++y) {
      for (std::int32_t z = -reach; z <= reach; ++z) {
        chunks.push_back({{0, {x, y, z}}, {1, 1}, random.next() >> 4});
      }
    }
  }
  std::sort(chunks.begin(), chunks.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  std::vector<EncodedMessage> out;
  for (const Message& message : held_messages(chunks)) out.push_back(encode_message(message));
  return out;
}

void claim_falsely(HostileCrew& crew) {
  // 29,791 chunks fit what a session may claim, and are claimed again and again; 117,649 do not.
  const bool fits = crew.index() % 2 == 0;
  const std::vector<EncodedMessage> claims = claims_of(fits ? 15 : 24, crew.random());
  std::size_t next = 0;
  const auto begin = [&](HostileClient& client) {
    next = 0;
    if (fits) client.queue(view_at({0, kFarChunk, 0}, 1, 1));  // none of them is ever answered
  };
  const auto claim = [&](HostileClient& client) {
    client.queue(claims[next]);
    next = (next + 1) % claims.size();
  };
  crew.flood(begin, claim, rate_of(crew));
}

void request_chunks(HostileCrew& crew) {
  const auto begin = [](HostileClient& client) { client.queue(view_at({}, kSomeRadius, kSomeRadius)); };
  const auto request = [&crew](HostileClient& client) {
    ChunkRequest wish;
    for (std::size_t i = 0; i < kChunkRequestKeysMax; ++i) {
      wish.keys.push_back({0, anywhere(crew.random(), kSomeRadius)});
    }
    client.queue(wish);
  };
  crew.flood(begin, request, rate_of(crew));
}

/// Edits of this shape in a place of the crew's own, far from everybody.
template <class ShapeAt>
void flood_edits(HostileCrew& crew, const ShapeAt& shape_at) {
  const VoxelPos home{1 << 20, 0, static_cast<std::int32_t>(crew.index() + 1) << 12};
  ClientSequence next = 0;
  const auto begin = [&](HostileClient& client) {
    next = 0;
    const std::int32_t edge = client.welcome().chunk_edge;
    client.queue(view_at({home.x / edge, home.y / edge, home.z / edge}, kSomeRadius, kSomeRadius));
  };
  const auto edit = [&](HostileClient& client) {
    const VoxelPos at{home.x + crew.random().between(-64, 64), crew.random().between(-64, 64),
                      home.z + crew.random().between(-64, 64)};
    const auto material = static_cast<Material>(crew.random().below(2));
    client.queue(EditRequest{++next, 0, {shape_at(at), {}, material}});
  };
  crew.flood(begin, edit, rate_of(crew));
}

void edit_too_often(HostileCrew& crew) {
  flood_edits(crew, [](const VoxelPos& at) { return EditShape{SetVoxel{at}}; });
}

void edit_too_much(HostileCrew& crew) {
  constexpr std::uint16_t kRadius = 60;  // 905,000 voxels, just below what one edit may have by default
  flood_edits(crew, [](const VoxelPos& at) { return EditShape{FillSphere{at, kRadius}}; });
}

void travel_too_often(HostileCrew& crew) {
  std::uint32_t request = 0;
  const auto begin = [&](HostileClient& client) {
    request = 0;
    client.queue(view_at({}, kSomeRadius, kSomeRadius));
  };
  const auto travel = [&](HostileClient& client) {
    client.queue(Travel{++request, TravelTo::sequence, crew.random().below(1'000), 0});
  };
  crew.flood(begin, travel, rate_of(crew));
}

void command_too_often(HostileCrew& crew) {
  std::uint32_t id = 0;
  const auto command = [&](HostileClient& client) {
    client.queue(CommandRequest{++id, id % 2 == 0 ? "undo" : std::string(kCommandBytesMax, 'x')});
  };
  crew.flood(say_nothing, command, rate_of(crew));
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

void open_halfway(HostileCrew& crew) {
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
      crew.end(**it);
      it = open.erase(it);
    }
  };
  for (std::uint32_t turn = 0; !crew.is_over(); ++turn) {
    for (int i = 0; i < kPerStep && open.size() < kOpenMax; ++i) {
      // Every other thread from as many addresses as it likes, the others from the one that honest clients have, too.
      const std::uint32_t other = crew.index() % 2 == 0 ? 0 : 1 + crew.random().below(kAddresses);
      auto client = crew.connect(HostileCrew::kLoopback + other);
      if (client == nullptr) break;
      const Bytes hello = framed_hello();
      if (turn % 2 == 0) client->queue_bytes(ByteView(hello).first(hello.size() / 2));
      open.push_back(std::move(client));
    }
    look(false);
    crew.pause_ms(1);
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
      out[kFrameHeaderBytes + random.below(static_cast<std::uint32_t>(out.size() - kFrameHeaderBytes))] ^=
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

void send_garbage(HostileCrew& crew) {
  constexpr int kWaitMs = 200;
  for (std::uint64_t sort = crew.index(); !crew.is_over(); ++sort) {
    const auto client = crew.connect();
    if (client == nullptr) return;
    client->queue_bytes(garbage(crew.random(), sort));
    for (int ms = 0; ms < kWaitMs && client->is_open() && !crew.is_over(); ++ms) {
      client->flush();
      if (client->queued() == 0) client->shutdown_send();
      client->wait(1, true);
      client->read();
    }
    crew.end(*client);
  }
}

/// No attack at all: bytes between two sockets of its own. What others feel of it is what a busy machine does to them.
void keep_the_machine_busy(HostileCrew& crew) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
  const Descriptor in(ends[0]), out(ends[1]);
  std::array<std::uint8_t, 16 * 1024> bytes{};
  while (!crew.is_over()) {
    const ssize_t sent = ::send(in.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent > 0) crew.outcome.bytes_sent += static_cast<std::uint64_t>(sent);
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
    {"views", "views of radius 64 anywhere in the world, 9,000 a second and as many as the socket takes",
     flood_views},
    {"absurd-views", "views of radius 255", flood_absurd_views},
    {"claims", "29,791 chunks said to be held, again and again; and 117,649", claim_falsely},
    {"half-open", "connections that say nothing, or half a hello; from one address and from 250",
     open_halfway},
    {"garbage", "random bytes, frames of 4 GiB, frames cut short, bits turned over, messages without end",
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
  HostileCrew crew(port, index, seconds, seed);
  attack.play(crew);
  rusage used{};
  if (::getrusage(RUSAGE_THREAD, &used) == 0) {
    const auto seconds_of = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
    };
    crew.outcome.core_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  }
  return std::move(crew.outcome);
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

RunningAttack::RunningAttack(const Attack& attack, std::uint16_t port, unsigned clients, double seconds,
                             std::uint64_t seed)
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
