#include <pthread.h>

#include <array>
#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/thread_pool.hpp>
#include <asio/use_future.hpp>
#include <atomic>
#include <chrono>
#include <ctime>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "bench/servers/fan_out_senders.hpp"
#include "bench/servers/receivers.hpp"
#include "common/tls/tls_context.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/net/listener.hpp"

namespace runstone::bench {
namespace {

constexpr std::array<std::uint8_t, 32> kSessionSeed{2};

/// Collects the sessions whose connections are ready.
class ReadySessions final : public NetEvents {
 public:
  void on_refused(SessionId /*session*/) override { ++refused; }
  void on_connected(SessionId session, const std::optional<ChannelBinding>& /*binding*/) override {
    const std::lock_guard lock(mutex_);
    ready_.push_back(session);
  }
  void on_message(SessionId /*session*/, Message&& /*message*/, std::size_t /*bytes*/) override {}
  void on_drained(SessionId /*session*/) override {}
  void on_disconnected(SessionId /*session*/) override {}

  std::vector<SessionId> ready() const {
    const std::lock_guard lock(mutex_);
    return ready_;
  }
  std::atomic<std::size_t> refused{0};

 private:
  mutable std::mutex mutex_;
  std::vector<SessionId> ready_;
};

NetLimits limits_for(std::size_t receivers) {
  NetLimits limits;
  limits.connections_max = limits.handshakes_per_address = receivers + 1;
  return limits;
}

/// The connections of a server without a world. All of them use one thread, whose time is measured.
class SessionSender final : public FanOutSender {
 public:
  explicit SessionSender(const FanOutSize& size)
      : decoders_(1),
        listener_(std::make_shared<Listener>(
            io_, decoders_.get_executor(), limits_for(size.receivers), std::uint16_t{32}, events_)),
        work_(io_.get_executor()) {
    if (size.is_encrypted) listener_->set_tls(TlsContext::self_signed_server(kSessionSeed));
  }
  ~SessionSender() override {
    receivers_.reset();
    listener_->stop();
    listener_->close_all(GoodbyeReason::closing, "the end");
    work_.reset();
    if (thread_.joinable()) thread_.join();
    decoders_.join();
  }
  SessionSender(const SessionSender&) = delete;
  SessionSender& operator=(const SessionSender&) = delete;

  Result<void, std::string> connect(const FanOutSize& size) {
    if (const auto bound = listener_->listen("127.0.0.1:0"); !bound) return bound;
    listener_->start();
    thread_ = std::thread([this] { io_.run(); });
    receivers_ = std::make_unique<Receivers>(listener_->port(), size.receivers, size.is_encrypted);
    if (const auto connected = receivers_->wait(); !connected) return connected;
    while (events_.ready().size() < size.receivers) {
      if (events_.refused > 0) return failure("a connection was refused");
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    for (const SessionId id : events_.ready()) sessions_.push_back(listener_->find(id));
    return {};
  }

  std::int64_t send_to_all(std::size_t body_bytes) override {
    const EncodedMessage commit{kKindOf<Commit>, std::make_shared<const Bytes>(body_bytes, 1)};
    const std::uint64_t sent = listener_->counters().commit_sends;
    const std::int64_t began_ns = io_thread_ns();
    asio::post(io_, [this, commit] {
      SendRound round = listener_->begin_round(commit);
      for (const auto& session : sessions_) session->send(commit, round);
    });
    while (listener_->counters().commit_sends < sent + sessions_.size()) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    // The thread may still run the task that sent the last commit. It runs tasks one after another.
    asio::post(io_, asio::use_future).get();
    return io_thread_ns() - began_ns;
  }

 private:
  /// Returns the processor time of the connections' thread.
  std::int64_t io_thread_ns() {
    clockid_t clock{};
    ::pthread_getcpuclockid(thread_.native_handle(), &clock);
    timespec at{};
    ::clock_gettime(clock, &at);
    return std::int64_t{at.tv_sec} * 1'000'000'000 + at.tv_nsec;
  }

  asio::io_context io_;
  asio::thread_pool decoders_;
  ReadySessions events_;
  std::shared_ptr<Listener> listener_;
  asio::executor_work_guard<asio::io_context::executor_type> work_;
  std::thread thread_;
  std::vector<std::shared_ptr<NetSession>> sessions_;
  std::unique_ptr<Receivers> receivers_;
};

}  // namespace

Result<std::unique_ptr<FanOutSender>, std::string> make_session_sender(const FanOutSize& size) {
  auto sender = std::make_unique<SessionSender>(size);
  if (const auto connected = sender->connect(size); !connected) return failure(connected.error());
  return std::unique_ptr<FanOutSender>(std::move(sender));
}

}  // namespace runstone::bench
