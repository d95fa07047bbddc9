#include "client/api/session_threads.hpp"

#include <utility>
#include <variant>
#include <vector>

#include "client/net/key_file.hpp"
#include "client/session/cache_exchange.hpp"
#include "client/session/texture_exchange.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {

SessionThreads::SessionThreads(SessionConfig config, std::unique_ptr<CacheThread> cache,
                               SessionWatcher& watcher)
    : watcher_(watcher),
      cache_(std::move(cache)),
      session_((config.has_cache = cache_ != nullptr, std::move(config))) {}

SessionThreads::~SessionThreads() = default;

void SessionThreads::connect(LinkConfig config, std::function<void()> wake) {
  net_ = std::make_unique<NetClient>(std::move(config), std::move(wake));
}

void SessionThreads::disconnect() {
  net_->stop(0);
  events_.clear();
  connection_ = 0;
  session_.disconnected();
}

void SessionThreads::receive() {
  if (events_.empty()) {
    for (LinkEvent& event : net_->take_events()) events_.push_back(std::move(event));
  }
  for (const TimeUs until_us = steady_now_us() + kReceiveUsMax;
       !events_.empty() && steady_now_us() < until_us;) {
    LinkEvent event = std::move(events_.front());
    events_.pop_front();
    if (const auto* connected = std::get_if<LinkConnected>(&event)) on_connected(*connected);
    if (const auto* gone = std::get_if<LinkDisconnected>(&event)) on_disconnected(*gone);
    if (auto* received = std::get_if<LinkReceived>(&event)) on_received(*received);
  }
}

void SessionThreads::on_connected(const LinkConnected& event) {
  connection_ = event.connection;
  session_.connected(random_nonce(), event.binding, steady_now_us(), event.is_listed);
  flush();
}

void SessionThreads::on_received(LinkReceived& event) {
  if (event.connection != connection_) return;
  watcher_.on_message(event);
  session_.receive(std::move(event.message),
                   {event.received_us, event.unpacked_us, steady_now_us()});
  if (std::exchange(servers_seen_, session_.servers_number()) != session_.servers_number())
    net_->set_servers(session_.servers());
  if (std::exchange(connects_handled_, session_.connect_count()) != session_.connect_count())
    watcher_.on_world_opened();
}

void SessionThreads::on_disconnected(const LinkDisconnected& event) {
  if (event.connection != 0 && event.connection != connection_) return;
  connection_ = 0;
  step_cache(steady_now_us(), 0);
  keep_all_chunks();
  session_.disconnected();
  watcher_.on_connection_lost(event);
}

void SessionThreads::flush() {
  for (const Message& message : session_.take_outgoing())
    net_->send(connection_, encode_message(message));
  if (session_.wants_close() && connection_ != 0) net_->close(connection_);
}

void SessionThreads::step_cache(TimeUs now_us, std::size_t room_bytes) {
  if (!cache_) return;
  exchange_lookups(session_, *cache_, room_bytes, now_us);
  exchange_textures(session_.textures(), *cache_);
  if (now_us - kept_us_ >= kKeepUs) {
    kept_us_ = now_us;
    static_cast<void>(keep_chunks(cache_->room()));
  }
  if (std::string warning = cache_->take_warning(); !warning.empty())
    watcher_.on_cache_warning(std::move(warning));
}

bool SessionThreads::keep_chunks(std::size_t count_max) {
  const auto world = session_.cached_world();
  if (!cache_ || !world) return false;
  std::vector<KeyedChunk> batch = session_.replica().take_for_cache(count_max);
  if (batch.empty()) return false;
  cache_->keep(*world, std::move(batch));
  return true;
}

void SessionThreads::keep_all_chunks() {
  while (keep_chunks(SIZE_MAX)) {
  }
}

void SessionThreads::finish() {
  step_cache(steady_now_us(), 0);
  keep_all_chunks();
  session_.close(GoodbyeReason::closing, "");
  flush();
  if (cache_) cache_->stop();
  net_->stop(kGoodbyeMs);
}

}  // namespace runstone
