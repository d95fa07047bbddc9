#include "client/web/web_session.hpp"

#include <sodium.h>

#include <algorithm>
#include <utility>

#include "client/report/link_counts.hpp"
#include "client/session/cache_exchange.hpp"
#include "common/os/steady_clock.hpp"

namespace runstone {
namespace {

/// The time for which a view waits for the cache. IndexedDB answers between frames, so it needs
/// longer than a disk. A cache without rows of the world answers at once.
constexpr TimeUs kCacheWaitUs = 1'000'000;

SessionConfig config_of(const JoinOptions& options) {
  SessionConfig config;
  config.keys = key_pair_of(options.seed);
  config.name = options.name;
  config.ticket = options.ticket;
  config.pinned = options.pinned;
  config.has_cache = options.has_cache;
  config.cache_wait_us = kCacheWaitUs;
  if (options.is_key_kept) config.features |= kFeatureNames;
  config.instance = 0;
  while (config.instance == 0) randombytes_buf(&config.instance, sizeof config.instance);
  config.view.radius_h = options.view_radius;
  config.view.radius_v = options.view_radius_v;
  config.view.levels = options.far_levels;
  return config;
}

/// Returns the host and port of a URL.
std::string host_of(const std::string& url) {
  const std::size_t scheme = url.find("://");
  const std::size_t begin = scheme == std::string::npos ? 0 : scheme + 3;
  return url.substr(begin, url.find('/', begin) - begin);
}

}  // namespace

WebSession::WebSession(const JoinOptions& options)
    : session_(config_of(options)), link_(options.url, *this) {
  if (options.has_cache) cache_.emplace(options.cached_worlds);
}

void WebSession::step(TimeUs now_us, TimeUs until_us) {
  if (has_left_) return;
  link_.read(until_us);
  if (!is_refused() || connection_ != 0) link_.step(now_us);
}

void WebSession::flush(TimeUs now_us) {
  if (has_left_) return;
  for (const Message& message : session_.take_outgoing())
    link_.send(connection_, encode_message(message));
  if (session_.wants_close() && connection_ != 0) link_.close(connection_);
  if (connection_ != 0) link_.step(now_us);
}

void WebSession::step_cache(std::size_t room_bytes, TimeUs now_us) {
  if (!cache_) return;
  exchange_lookups(session_, *cache_, room_bytes, now_us);
  exchange_textures(session_.textures(), textures_);
}

void WebSession::keep_chunks(TimeUs now_us) {
  if (!cache_ || now_us < keep_us_) return;
  const auto world = session_.cached_world();
  const std::size_t room = std::min(cache_->room(), kKeepChunks);
  if (!world || room == 0) return;
  const std::vector<KeyedChunk> chunks = session_.replica().take_for_cache(room);
  cache_->keep(*world, chunks);
  if (!session_.replica().is_cache_round_over()) return;
  cache_->flush();
  keep_us_ = now_us + kKeepUs;
}

bool WebSession::take_world_opened() { return std::exchange(world_opened_, false); }

void WebSession::leave() {
  if (std::exchange(has_left_, true)) return;
  session_.close(GoodbyeReason::closing, "");
  for (const Message& message : session_.take_outgoing())
    link_.send(connection_, encode_message(message));
  link_.stop();
}

void WebSession::on_connected(ConnectionNumber connection,
                              const std::optional<ChannelBinding>& binding) {
  connection_ = connection;
  Nonce nonce;
  randombytes_buf(nonce.data(), nonce.size());
  session_.connected(nonce, binding, steady_now_us(), link_.attempt().is_listed);
  for (const Message& message : session_.take_outgoing())
    link_.send(connection_, encode_message(message));
}

void WebSession::on_received(LinkReceived received) {
  if (const auto* chunks = std::get_if<Chunks>(&received.message))
    count_snapshots(snapshots_, *chunks, received);
  session_.receive(std::move(received.message),
                   {received.received_us, received.unpacked_us, steady_now_us()});
  if (std::exchange(servers_seen_, session_.servers_number()) != session_.servers_number())
    link_.set_servers(session_.servers());
  if (std::exchange(connects_handled_, session_.connect_count()) != session_.connect_count()) {
    world_opened_ = true;
    last_words_ = {};
  }
}

void WebSession::on_disconnected(ConnectionNumber /*connection*/, std::string why) {
  connection_ = 0;
  session_.disconnected();
  last_words_ = session_.end() ? words_of(*session_.end())
                               : words_of_link(why, host_of(link_.attempt().address));
}

FailureWords WebSession::failure_words() const {
  return is_refused() ? words_of(*session_.end()) : last_words_;
}

void WebSession::add_to(ClientReport& report) const {
  report.snapshots = snapshots_;
  report.net = net_counts(link_.stats());
  if (cache_) report.cache = cache_->counters();
}

}  // namespace runstone
