#include "client/net/net_client.hpp"

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <mutex>
#include <thread>
#include <utility>

namespace runstone {
namespace {

/// A message without chunks takes at most about so many times its bytes on the wire.
constexpr std::size_t kUnpackFactor = 16;

/// Returns about the memory that a message takes. Chunks of a few bytes can have many runs.
std::size_t memory_of(const LinkReceived& received) {
  const auto* chunks = std::get_if<Chunks>(&received.message);
  if (chunks == nullptr) return sizeof(LinkReceived) + kUnpackFactor * received.bytes;
  std::size_t bytes = sizeof(LinkReceived) + received.bytes;
  for (const ChunkAnswer& answer : chunks->chunks) {
    bytes += sizeof(ChunkAnswer);
    if (const auto* snapshot = std::get_if<ChunkSnapshot>(&answer))
      bytes += snapshot->chunk.voxels.runs.byte_capacity();
  }
  return bytes;
}

}  // namespace

struct NetClient::State final : private LinkCallbacks {
  State(LinkConfig config, std::function<void()> net_wake)
      : events_max(config.events_max),
        event_bytes_max(config.event_bytes_max),
        wake(std::move(net_wake)),
        link(io, std::move(config), *this) {}

  void push(LinkEvent event, std::size_t bytes = 0) {
    {
      const std::lock_guard lock(mutex);
      events.push_back(std::move(event));
      event_bytes += bytes;
    }
    wake();
  }
  void on_connected(ConnectionNumber connection,
                    const std::optional<ChannelBinding>& binding) override {
    push(LinkConnected{connection, binding, link.attempt().is_listed});
  }
  void on_received(LinkReceived received) override {
    const std::size_t bytes = memory_of(received);
    push(std::move(received), bytes);
  }
  void on_disconnected(ConnectionNumber connection, std::string why) override {
    push(LinkDisconnected{connection, std::move(why), link.attempt().address.server});
  }
  bool is_full() override {
    const std::lock_guard lock(mutex);
    return events.size() >= events_max || event_bytes >= event_bytes_max;
  }

  const std::size_t events_max, event_bytes_max;
  const std::function<void()> wake;
  asio::io_context io{1};
  Link link;  // used by the thread only
  std::mutex mutex;
  std::vector<LinkEvent> events;  // guarded by mutex, as is the next one
  std::size_t event_bytes = 0;    // about the memory of the events
  std::thread thread;
};

NetClient::NetClient(LinkConfig config, std::function<void()> wake)
    : state_(std::make_unique<State>(std::move(config), std::move(wake))) {
  state_->link.start();
  state_->thread = std::thread([raw = state_.get()] { raw->io.run(); });
}

NetClient::~NetClient() { stop(0); }

std::vector<LinkEvent> NetClient::take_events() {
  const std::lock_guard lock(state_->mutex);
  state_->event_bytes = 0;
  return std::exchange(state_->events, {});
}

void NetClient::send(ConnectionNumber connection, const EncodedMessage& message) {
  asio::post(state_->io,
             [raw = state_.get(), connection, message] { raw->link.send(connection, message); });
}

void NetClient::close(ConnectionNumber connection) {
  asio::post(state_->io, [raw = state_.get(), connection] { raw->link.close(connection); });
}

void NetClient::set_servers(const Servers& list) {
  asio::post(state_->io, [raw = state_.get(), list] { raw->link.set_servers(list); });
}

void NetClient::stop(std::int64_t wait_ms) {
  if (!state_->thread.joinable()) return;
  asio::post(state_->io, [raw = state_.get(), wait_ms] { raw->link.stop(wait_ms); });
  state_->thread.join();
}

const LinkStats& NetClient::stats() const { return state_->link.stats(); }

}  // namespace runstone
