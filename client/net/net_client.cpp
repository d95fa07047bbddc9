#include "client/net/net_client.hpp"

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <mutex>
#include <thread>
#include <utility>

namespace runstone {

struct NetClient::State final : private LinkCallbacks {
  State(LinkConfig config, std::function<void()> net_wake)
      : events_max(config.events_max),
        wake(std::move(net_wake)),
        link(io, std::move(config), *this) {}

  void push(LinkEvent event) {
    {
      const std::lock_guard lock(mutex);
      events.push_back(std::move(event));
    }
    wake();
  }
  void on_connected(ConnectionNumber connection) override { push(LinkConnected{connection}); }
  void on_received(LinkReceived received) override { push(std::move(received)); }
  void on_disconnected(ConnectionNumber connection, std::string why) override {
    push(LinkDisconnected{connection, std::move(why)});
  }
  bool is_full() override {
    const std::lock_guard lock(mutex);
    return events.size() >= events_max;
  }

  const std::size_t events_max;
  const std::function<void()> wake;
  asio::io_context io{1};
  Link link;  // used by the thread only
  std::mutex mutex;
  std::vector<LinkEvent> events;  // guarded by mutex
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
  return std::exchange(state_->events, {});
}

void NetClient::send(ConnectionNumber connection, const EncodedMessage& message) {
  asio::post(state_->io,
             [raw = state_.get(), connection, message] { raw->link.send(connection, message); });
}

void NetClient::close(ConnectionNumber connection) {
  asio::post(state_->io, [raw = state_.get(), connection] { raw->link.close(connection); });
}

void NetClient::stop(std::int64_t wait_ms) {
  if (!state_->thread.joinable()) return;
  asio::post(state_->io, [raw = state_.get(), wait_ms] { raw->link.stop(wait_ms); });
  state_->thread.join();
}

const LinkStats& NetClient::stats() const { return state_->link.stats(); }

}  // namespace runstone
