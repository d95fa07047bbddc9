#include "bench/network/session_attacks.hpp"

#include <sys/socket.h>

#include <array>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "bench/network/attack_thread.hpp"
#include "common/core/bytes.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/limits.hpp"

namespace runstone::bench {
namespace {

/// Returns the frame with which an honest client begins, except for its key.
Bytes framed_hello() {
  Hello hello;
  hello.name = "mallory";
  Bytes out;
  FrameWriter().append(encode_message(hello), out);
  return out;
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
    case 1:  // a frame of 64 KiB
      writer.u32(UINT32_MAX);
      writer.u32(0);
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
    default: {  // one fragment after another of a message that never ends
      FrameWriter frames;
      for (int i = 0; i < 64; ++i) {
        const FrameHeader header = frames.next(kKindOf<EditRequest>, kFragmentBytesMax, true);
        out.insert(out.end(), header.begin(), header.end());
        out.resize(out.size() + kFragmentBytesMax);
      }
    }
  }
  return out;
}

}  // namespace

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

void take_seats_of_range(AttackThread& thread) {
  constexpr std::size_t kSeatsMax = 100;
  constexpr int kWaitMs = 1'000, kPauseMs = 20;
  constexpr double kPingSeconds = 2, kAgainSeconds = 0.25;
  const std::uint32_t from = AttackThread::address_of_range(thread.index());
  std::vector<std::unique_ptr<AttackClient>> seats;
  double next_ping = kPingSeconds, next_join = 0;
  for (; !thread.is_over(); thread.pause_ms(kPauseMs)) {
    if (seats.size() < kSeatsMax && thread.seconds() >= next_join) {
      auto client = thread.connect(from);
      if (client != nullptr && client->open_session(thread.random().next(), 1, kWaitMs)) {
        seats.push_back(std::move(client));
      } else if (client != nullptr) {
        thread.end(*client);
        next_join = thread.seconds() + kAgainSeconds;
      }
    }
    const bool pings = thread.seconds() >= next_ping;
    if (pings) next_ping += kPingSeconds;
    for (const auto& seat : seats) {
      if (pings) seat->queue(Ping{1});
      seat->flush();
      seat->read();
    }
    std::erase_if(seats, [&](const auto& seat) {
      if (!seat->is_open()) thread.end(*seat);
      return !seat->is_open();
    });
  }
  for (const auto& seat : seats) thread.end(*seat);
}

void command_too_often(AttackThread& thread) {
  std::uint32_t id = 0;
  const auto command = [&](AttackClient& client) {
    client.queue(CommandRequest{++id, id % 2 == 0 ? "undo" : std::string(kCommandBytesMax, 'x')});
  };
  thread.flood(say_nothing, command, thread.flood_rate());
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

void shake_hands(AttackThread& thread) {
  constexpr int kWaitMs = 200;
  while (!thread.is_over()) {
    const auto client = thread.connect();
    if (client == nullptr) return;
    for (int ms = 0; ms < kWaitMs && client->is_open() && !thread.is_over(); ++ms) {
      client->flush();
      if (client->bytes_received() > 0) break;
      client->wait(1, true);
      client->read();
    }
    thread.end(*client);
  }
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

void stay_away(AttackThread& thread) {
  constexpr int kPauseMs = 20;
  while (!thread.is_over()) thread.pause_ms(kPauseMs);
}

}  // namespace runstone::bench
