#include "bench/network/strangers.hpp"

#include <sys/epoll.h>

#include <array>
#include <cstddef>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "bench/network/attack_thread.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/limits.hpp"

namespace runstone::bench {
namespace {

constexpr double kAgainSeconds = 1;  // the pause of a stranger whose connection was ended
constexpr double kByteSeconds = 1;   // between two bytes of a slow stranger
constexpr int kWaitMs = 5;           // for events, at most
constexpr int kUnreadBuffer = 4 * 1024;

struct Stranger {
  StrangerStage stage = StrangerStage::socket;
  std::unique_ptr<AttackClient> client;
  bool is_there = false;   // it has come as far as its stage
  bool has_begun = false;  // it has queued its message or view
};

/// Returns the frames of a message of the largest size.
Bytes largest_message() {
  Bytes out;
  FrameWriter().append({kKindOf<EditRequest>, std::make_shared<const Bytes>(kClientEditBytesMax)},
                       out);
  return out;
}

class Strangers {
 public:
  Strangers(AttackThread& thread, std::span<const StrangerStage> stages, unsigned count)
      : thread_(thread), epoll_(::epoll_create1(EPOLL_CLOEXEC)), strangers_(count) {
    for (std::size_t i = 0; i < count; ++i) {
      strangers_[i].stage = stages[i % stages.size()];
      absent_.push_back({0, i});
    }
  }

  void run() {
    std::array<epoll_event, 256> events{};
    while (!thread_.is_over()) {
      connect_due();
      send_slow_bytes();
      const int count =
          ::epoll_wait(epoll_.get(), events.data(), static_cast<int>(events.size()), kWaitMs);
      for (int i = 0; i < count; ++i) {
        const epoll_event& event = events[static_cast<std::size_t>(i)];
        handle(event.data.u64, (event.events & (EPOLLRDHUP | EPOLLHUP | EPOLLERR)) != 0);
      }
    }
    for (Stranger& stranger : strangers_) {
      if (stranger.client != nullptr) thread_.end(*stranger.client);
    }
  }

 private:
  struct Absent {
    double due = 0;  // when it connects
    std::size_t who = 0;
  };

  void connect_due() {
    const double now = thread_.seconds();
    for (; !absent_.empty() && absent_.front().due <= now; ++connected_) {
      if (static_cast<double>(connected_) >= now * kStrangersPerSecond) return;
      connect(absent_.front().who);
      absent_.pop_front();
    }
  }

  void connect(std::size_t who) {
    Stranger& stranger = strangers_[who];
    const auto from = AttackThread::address(static_cast<unsigned>(who) % thread_.addresses());
    stranger.client =
        thread_.connect(from, stranger.stage == StrangerStage::unread ? kUnreadBuffer : 0);
    stranger.is_there = stranger.has_begun = false;
    if (stranger.client == nullptr) return;  // the attack is over
    if (stranger.stage == StrangerStage::hello || stranger.stage == StrangerStage::unread)
      stranger.client->queue_hello(thread_.random().next(), 1);
    watch(who, EPOLL_CTL_ADD);
    advance(who);
  }

  void watch(std::size_t who, int operation) {
    const Stranger& stranger = strangers_[who];
    epoll_event wanted{};
    wanted.data.u64 = who;
    wanted.events = EPOLLRDHUP;
    if (!stranger.is_there) wanted.events |= EPOLLIN | EPOLLOUT | EPOLLET;
    // A socket that is closed leaves the epoll by itself.
    (void)::epoll_ctl(epoll_.get(), operation, stranger.client->socket(), &wanted);
  }

  void handle(std::size_t who, bool is_ended) {
    Stranger& stranger = strangers_[who];
    if (stranger.client == nullptr) return;
    if (!is_ended && !stranger.is_there) advance(who);
    if (!is_ended && stranger.client->is_open()) return;
    stranger.client->read();  // the goodbye, if there is one
    thread_.end(*stranger.client);
    stranger.client.reset();
    absent_.push_back({thread_.seconds() + kAgainSeconds, who});
  }

  /// Does what is possible now on the way to the stranger's stage.
  void advance(std::size_t who) {
    Stranger& stranger = strangers_[who];
    AttackClient& client = *stranger.client;
    switch (stranger.stage) {
      case StrangerStage::socket:
      case StrangerStage::slow_tls:
        stranger.is_there = true;
        break;
      case StrangerStage::half_tls:
        client.flush();
        stranger.is_there = client.bytes_sent() > 0 && client.queued() == 0;
        break;
      case StrangerStage::tls:
        client.flush();
        client.read();
        client.flush();
        stranger.is_there = client.is_encrypted() && client.queued() == 0;
        break;
      case StrangerStage::message:
        if (!stranger.has_begun) {
          client.flush();
          client.read();
          client.flush();
          if (!client.is_encrypted() || client.queued() > 0) break;
          client.queue_bytes(largest_message());
          client.flush(0);
          stranger.has_begun = true;
        }
        client.flush(client.queued() - 1);
        stranger.is_there = client.queued() == 1;
        break;
      case StrangerStage::hello:
        client.flush();
        client.continue_handshake(false);
        client.flush();
        stranger.is_there = client.is_welcome();
        break;
      case StrangerStage::unread:
        client.flush();
        client.continue_handshake(true);
        if (client.has_session() && !std::exchange(stranger.has_begun, true))
          client.queue(View{1, {}, kViewRadiusMax, kViewRadiusMax});
        client.flush();
        stranger.is_there = stranger.has_begun && client.queued() == 0;
        break;
    }
    if (stranger.is_there) watch(who, EPOLL_CTL_MOD);
  }

  void send_slow_bytes() {
    if (thread_.seconds() < next_byte_) return;
    next_byte_ = thread_.seconds() + kByteSeconds;
    for (std::size_t who = 0; who < strangers_.size(); ++who) {
      const Stranger& stranger = strangers_[who];
      if (stranger.stage != StrangerStage::slow_tls || stranger.client == nullptr) continue;
      stranger.client->flush(1);
      handle(who, false);
    }
  }

  AttackThread& thread_;
  const Descriptor epoll_;
  std::vector<Stranger> strangers_;
  std::deque<Absent> absent_;  // in the order of their times
  std::uint64_t connected_ = 0;
  double next_byte_ = 0;
};

}  // namespace

std::span<const StrangerSort> stranger_sorts() {
  using enum StrangerStage;
  static const std::array<StrangerSort, 8> sorts = {{
      {"silent-sockets", "connections that send nothing", {socket}},
      {"half-handshakes", "the first message of the TLS handshake, then nothing", {half_tls}},
      {"slow-handshakes", "a byte a second of that message", {slow_tls}},
      {"silent-tls", "the whole TLS handshake, then nothing", {tls}},
      {"half-messages",
       "the TLS handshake and all but the last byte of the largest message",
       {message}},
      {"silent-hellos", "hello, and no answer to welcome", {hello}},
      {"unread-views", "players with a view of radius 64 who read nothing", {unread}},
      {"all-strangers",
       "all of these in turn",
       {socket, half_tls, slow_tls, tls, message, hello, unread}},
  }};
  return sorts;
}

void hold_strangers(AttackThread& thread, std::span<const StrangerStage> stages, unsigned count) {
  Strangers(thread, stages, count).run();
}

}  // namespace runstone::bench
