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
#include "tests/bench/network/attack_thread.hpp"

namespace runstone::bench {
namespace {

constexpr int kTinyBuffer = 4 * 1024;        // of a socket that is not read
constexpr std::int32_t kFarChunk = 1 << 20;  // from the middle of the world; inside it at any edge
constexpr std::uint8_t kSomeRadius = 4;

View view_at(ChunkCoord centre, std::uint8_t radius_h, std::uint8_t radius_v) {
  return {1, centre, radius_h, radius_v};
}
View large_view() { return view_at({}, kViewRadiusMax, kViewRadiusMax); }

ChunkCoord anywhere(SplitMix64& random, std::int32_t reach) {
  const std::int32_t x = random.between(-reach, reach), y = random.between(-reach, reach);
  return {x, y, random.between(-reach, reach)};
}

void say_nothing(AttackClient& /*client*/) {}

// Slow readers.

void never_read(AttackThread& thread) {
  const auto client = thread.join(kTinyBuffer);
  if (client == nullptr) return;
  client->queue(large_view());
  while (!thread.is_over()) {
    client->flush();
    thread.pause_ms(50);
  }
  client->read();
  thread.end(*client);
}

void ping_unread(AttackThread& thread) {
  thread.flood([](AttackClient& client) { client.queue(large_view()); },
               [](AttackClient& client) { client.queue(Ping{1}); }, kJustBelowFlooding, false);
}

void read_a_byte_a_second(AttackThread& thread) {
  const auto client = thread.join(kTinyBuffer);
  if (client == nullptr) return;
  client->queue(large_view());
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

// Floods of one kind of message.

double rate_of(const AttackThread& thread) {
  return thread.index() % 2 == 0 ? kJustBelowFlooding : kNoLimit;
}

void flood_views(AttackThread& thread) {
  const auto look = [&thread](AttackClient& client) {
    client.queue(view_at(anywhere(thread.random(), kFarChunk), kViewRadiusMax, kViewRadiusMax));
  };
  thread.flood(say_nothing, look, rate_of(thread));
}

void flood_absurd_views(AttackThread& thread) {
  const auto look = [](AttackClient& client) { client.queue(view_at({}, 255, 255)); };
  thread.flood(say_nothing, look, kNoLimit);
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
  for (const Message& message : cached_chunks_messages(chunks))
    out.push_back(encode_message(message));
  return out;
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
  thread.flood(begin, claim, rate_of(thread));
}

void request_chunks(AttackThread& thread) {
  const auto begin = [](AttackClient& client) {
    client.queue(view_at({}, kSomeRadius, kSomeRadius));
  };
  const auto request = [&thread](AttackClient& client) {
    ChunkRequest message;
    for (std::size_t i = 0; i < kChunkRequestKeysMax; ++i) {
      message.keys.push_back({0, anywhere(thread.random(), kSomeRadius)});
    }
    client.queue(message);
  };
  thread.flood(begin, request, rate_of(thread));
}

/// Floods edits at a place of the thread's own, far from everybody. `edit_at` returns the edit at a
/// voxel near that place.
template <class EditAt>
void flood_edits(AttackThread& thread, const EditAt& edit_at) {
  const VoxelPos home{1 << 20, 0, static_cast<std::int32_t>(thread.index() + 1) << 12};
  ClientSequence next = 0;
  const auto begin = [&](AttackClient& client) {
    next = 0;
    const std::int32_t edge = client.welcome().chunk_edge;
    client.queue(view_at({home.x / edge, home.y / edge, home.z / edge}, kSomeRadius, kSomeRadius));
  };
  const auto edit = [&](AttackClient& client) {
    const VoxelPos at{home.x + thread.random().between(-64, 64), thread.random().between(-64, 64),
                      home.z + thread.random().between(-64, 64)};
    client.queue(EditRequest{++next, 0, edit_at(at)});
  };
  thread.flood(begin, edit, rate_of(thread));
}

void edit_too_often(AttackThread& thread) {
  flood_edits(thread, [&thread](const VoxelPos& at) {
    return EditDescriptor{SetVoxel{at}, {}, static_cast<Material>(thread.random().below(2))};
  });
}

void edit_too_much(AttackThread& thread) {
  // 905,000 voxels, just below what one edit may have by default.
  constexpr std::uint16_t kRadius = 60;
  flood_edits(thread, [&thread](const VoxelPos& at) {
    const auto material = static_cast<Material>(thread.random().below(2));
    return EditDescriptor{FillSphere{at, kRadius}, {}, material};
  });
}

void paste_much(AttackThread& thread) {
  // 47,000 runs, a byte each: about the longest clipboard that an edit may have.
  constexpr std::uint32_t kRuns = 47'000;
  const Extent extent{128, 125, 3};
  RunChunk cells{extent, AxisOrder::xyz, RunList(extent.volume())};
  for (std::uint32_t end = 1; end <= kRuns; ++end) {
    cells.runs.push_back(
        {end == kRuns ? extent.volume() : end, static_cast<Material>(1 + end % 2)});
  }
  const auto clipboard = Clipboard::of({1, 2}, cells);
  if (!clipboard) return;
  flood_edits(thread, [&clipboard](const VoxelPos& at) {
    return EditDescriptor{Paste{at, *clipboard, {}}, {}, kEmpty};
  });
}

void edit_widely(AttackThread& thread) {
  // 922,624 voxels in one layer, each time in other chunks.
  constexpr std::int32_t kWidth = 1'024, kDepth = 901, kPlaces = 1'000;
  flood_edits(thread, [&thread](const VoxelPos& at) {
    VoxelBox box{at, at};
    box.min.x += kWidth * thread.random().between(-kPlaces, kPlaces);
    box.max = {box.min.x + kWidth, box.min.y + 1, box.min.z + kDepth};
    return EditDescriptor{FillBox{box}, {}, 1};
  });
}

void take_seats(AttackThread& thread) {
  constexpr std::size_t kSeatsMax = 300;
  constexpr int kWaitMs = 1'000, kPauseMs = 20;
  std::vector<std::unique_ptr<AttackClient>> seats;
  for (ClientInstance instance = 1; !thread.is_over(); ++instance) {
    if (seats.size() < kSeatsMax) {
      auto client = thread.connect();
      if (client != nullptr && client->open_session(thread.index(), instance, kWaitMs)) {
        seats.push_back(std::move(client));
      } else if (client != nullptr) {
        thread.end(*client);
      }
    }
    for (const auto& seat : seats) seat->read();
    thread.pause_ms(kPauseMs);
  }
  for (const auto& seat : seats) thread.end(*seat);
}

void travel_too_often(AttackThread& thread) {
  std::uint32_t request = 0;
  const auto begin = [&](AttackClient& client) {
    request = 0;
    client.queue(view_at({}, kSomeRadius, kSomeRadius));
  };
  const auto travel = [&](AttackClient& client) {
    client.queue(
        HistoryRequest{++request, HistoryTarget::sequence, thread.random().below(1'000), 0});
  };
  thread.flood(begin, travel, rate_of(thread));
}

void command_too_often(AttackThread& thread) {
  std::uint32_t id = 0;
  const auto command = [&](AttackClient& client) {
    client.queue(CommandRequest{++id, id % 2 == 0 ? "undo" : std::string(kCommandBytesMax, 'x')});
  };
  thread.flood(say_nothing, command, rate_of(thread));
}

// Attacks before a session is open.

/// Returns the frame with which an honest client begins, except for its key.
Bytes framed_hello() {
  Hello hello;
  hello.name = "mallory";
  Bytes out;
  FrameWriter().append(encode_message(hello), out);
  return out;
}

void open_halfway(AttackThread& thread) {
  // The number of connections of each thread, far fewer than the limit of a process.
  constexpr std::size_t kOpenMax = 500;
  constexpr std::uint32_t kAddresses = 250;
  constexpr int kPerStep = 4;
  std::deque<std::unique_ptr<AttackClient>> open;
  const auto look = [&](bool is_last) {
    for (auto it = open.begin(); it != open.end();) {
      (*it)->flush();
      (*it)->read();
      if ((*it)->is_open() && !is_last) {
        ++it;
        continue;
      }
      thread.end(**it);
      it = open.erase(it);
    }
  };
  for (std::uint32_t turn = 0; !thread.is_over(); ++turn) {
    for (int i = 0; i < kPerStep && open.size() < kOpenMax; ++i) {
      // Every second thread uses many addresses. The others use the address of the honest clients.
      const std::uint32_t other =
          thread.index() % 2 == 0 ? 0 : 1 + thread.random().below(kAddresses);
      auto client = thread.connect(AttackThread::kLoopback + other);
      if (client == nullptr) break;
      const Bytes hello = framed_hello();
      if (turn % 2 == 0) client->queue_bytes(ByteView(hello).first(hello.size() / 2));
      open.push_back(std::move(client));
    }
    look(false);
    thread.pause_ms(1);
  }
  look(true);
}

/// Returns bytes that no client sends, of each sort in turn.
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
    case 3:  // a message with one inverted bit
      out = hello;
      out[kFrameHeaderBytes +
          random.below(static_cast<std::uint32_t>(out.size() - kFrameHeaderBytes))] ^=
          static_cast<std::uint8_t>(1U << random.below(8));
      break;
    default:  // one fragment after another of a message that never ends
      for (std::uint32_t counter = 0; counter < 64; ++counter) {
        writer.u32(kFragmentBytesMax);
        writer.u32(1U << 8);
        writer.u32(counter);
        out.resize(out.size() + kFragmentBytesMax);
      }
  }
  return out;
}

void send_garbage(AttackThread& thread) {
  constexpr int kWaitMs = 200;
  for (std::uint64_t sort = thread.index(); !thread.is_over(); ++sort) {
    const auto client = thread.connect();
    if (client == nullptr) return;
    client->queue_bytes(garbage(thread.random(), sort));
    for (int ms = 0; ms < kWaitMs && client->is_open() && !thread.is_over(); ++ms) {
      client->flush();
      if (client->queued() == 0) client->shutdown_send();
      client->wait(1, true);
      client->read();
    }
    thread.end(*client);
  }
}

/// This is no attack: it copies bytes between two sockets of its own. It shows how the load of the
/// machine affects the bots.
void keep_the_machine_busy(AttackThread& thread) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return;
  const Descriptor in(ends[0]), out(ends[1]);
  std::array<std::uint8_t, 16 * 1024> bytes{};
  while (!thread.is_over()) {
    const ssize_t sent = ::send(in.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent > 0) thread.outcome.bytes_sent += static_cast<std::uint64_t>(sent);
    while (::recv(out.get(), bytes.data(), bytes.size(), MSG_DONTWAIT) > 0) {
    }
  }
}

constexpr std::array<Attack, 17> kAttacks = {{
    {"elsewhere", "as many threads copy bytes in the kernel: no attack, only a busy machine",
     keep_the_machine_busy},
    {"never-reads", "a view of radius 64, without ever reading", never_read},
    {"unread-pings", "the same, and 9,000 pings a second whose answers are not read", ping_unread},
    {"byte-a-second", "a view of radius 64, one byte read a second", read_a_byte_a_second},
    {"views",
     "views of radius 64 anywhere in the world, 9,000 a second and as many as the socket takes",
     flood_views},
    {"absurd-views", "views of radius 255", flood_absurd_views},
    {"claims", "claims of 29,791 chunks, again and again, and of 117,649", claim_falsely},
    {"half-open", "connections that send nothing or half a hello, from one address and from 250",
     open_halfway},
    {"garbage",
     "random bytes, frames of 4 GiB, frames cut short, inverted bits, messages without end",
     send_garbage},
    {"chunk-requests", "64 chunks of a view a message, again and again", request_chunks},
    {"edits", "single voxels, 9,000 a second and as many as the socket takes", edit_too_often},
    {"large-edits", "the same with spheres of 905,000 voxels", edit_too_much},
    {"pastes", "the same with clipboards of 47 KB", paste_much},
    {"wide-edits", "the same with layers of 1,024 x 901 voxels, each in other chunks", edit_widely},
    {"seats", "as many sessions of one key as the server gives, which say nothing", take_seats},
    {"travel", "requests of the past, likewise", travel_too_often},
    {"commands", "command lines, likewise, half of them 1 KiB of nonsense", command_too_often},
}};

AttackOutcome play(const Attack& attack, std::uint16_t port, unsigned index, double seconds,
                   std::uint64_t seed) {
  constexpr int kLowest = 19;
  (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kLowest);
  AttackThread thread(port, index, seconds, seed);
  attack.play(thread);
  rusage used{};
  if (::getrusage(RUSAGE_THREAD, &used) == 0) {
    const auto seconds_of = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
    };
    thread.outcome.core_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
  }
  return std::move(thread.outcome);
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
