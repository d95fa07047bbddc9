#include "server/web/map_gate.hpp"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <optional>

#include "common/os/steady_clock.hpp"
#include "server/web/http_answer.hpp"
#include "server/web/web_log.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kUsPerMs = 1'000;
// An address may use the budgets of so many seconds at once. A first look at a world needs many tiles
// that nobody drew yet.
constexpr std::uint64_t kRequestsAtOnce = 10, kWorkAtOnce = 40;
// While one map reads much of the disk in one turn, others are drawn.
constexpr std::size_t kMapThreadsMax = 2;

std::unique_ptr<MapThreads> make_threads(const WebConfig& config) {
  std::size_t maps = config.servers.empty() && !config.world.empty() ? 1 : 0;
  for (const WebServer& server : config.servers) maps += server.world.empty() ? 0 : 1;
  if (maps == 0) return nullptr;
  return std::make_unique<MapThreads>(std::min(maps, kMapThreadsMax));
}

std::unique_ptr<MapService> make_service(const WebConfig& config, const MapShare& share) {
  if (config.world.empty()) return nullptr;
  constexpr std::size_t kMib = std::size_t{1} << 20;
  return std::make_unique<MapService>(
      *share.threads, config.world, static_cast<std::size_t>(config.map_memory_mib) * kMib,
      // For the host alone: the pages do not name paths and errors of this machine.
      [](const std::string& fault) { log_web_line("map: " + fault); });
}

Budget budget_of(std::uint64_t per_second, std::uint64_t times_at_once) {
  return {per_second, per_second * times_at_once};
}

}  // namespace

/// A request for which a coroutine waits. The timer never expires; it is cancelled by the answer.
struct MapGate::Waiting {
  explicit Waiting(boost::asio::io_context& io) : answered(io) {
    answered.expires_at(boost::asio::steady_timer::time_point::max());
  }
  boost::asio::steady_timer answered;
  std::optional<MapAnswer> answer;
};

MapShare::MapShare(const WebConfig& config)
    : requests(budget_of(config.map_requests_per_second, kRequestsAtOnce)),
      work_us(budget_of(config.map_ms_per_second * kUsPerMs, kWorkAtOnce)),
      threads(make_threads(config)) {}

MapGate::MapGate(boost::asio::io_context& io, const WebConfig& config, MapShare& share,
                 WebCounters& counters)
    : io_(io), share_(share), counters_(counters), service_(make_service(config, share)) {}

boost::asio::awaitable<MapAnswer> MapGate::answer(AddressBlock from, std::string_view target,
                                                  std::string if_none_match) {
  const std::size_t question = target.find('?');
  const auto query =
      question == std::string_view::npos ? std::string_view() : target.substr(question + 1);
  auto request = parse_map_request(target.substr(0, question), query);
  if (!request) {
    const unsigned status = request.error().is_unknown_path ? 404 : 400;
    co_return map_words(status, request.error().what);
  }
  if (is_stopped_) co_return map_words(503, "the gateway stops");
  if (service_ == nullptr)
    co_return map_words(404, "this gateway shows no map: its host has not turned it on");
  const auto refuse = [&](const char* words) {
    ++counters_.map_refused;
    return map_words(429, words);
  };
  if (!share_.work_us.has(from, 1, steady_now_us()))
    co_return refuse("the map has drawn much for this address: ask again in a moment");
  if (!share_.waiting.add(from))
    co_return refuse("many requests of this address wait for the map: ask again in a moment");
  ++counters_.map_requests;
  MapAnswer out = co_await wait_for(*std::move(request), std::move(if_none_match));
  share_.waiting.remove(from);
  share_.work_us.charge_range(from, out.work_us, steady_now_us());
  counters_.map_work_us += out.work_us;
  counters_.map_not_modified += out.status == 304 ? 1 : 0;
  co_return out;
}

boost::asio::awaitable<MapAnswer> MapGate::recent_edits() {
  if (is_stopped_ || service_ == nullptr) co_return map_words(503, "the gateway stops");
  MapAnswer out = co_await wait_for(RecentEditsRequest(), std::string());
  counters_.map_work_us += out.work_us;
  co_return out;
}

boost::asio::awaitable<MapAnswer> MapGate::wait_for(MapRequest request, std::string if_none_match) {
  const auto waiting = std::make_shared<Waiting>(io_);
  // The last reference to the timer must end on this thread, so the reply gives its own away.
  auto reply = [&io = io_, waiting = waiting](MapAnswer answer) mutable {
    boost::asio::post(io, [waiting = std::move(waiting), answer = std::move(answer)]() mutable {
      waiting->answer = std::move(answer);
      waiting->answered.cancel();
    });
  };
  service_->ask(request, std::move(if_none_match), std::move(reply));
  while (!waiting->answer) {
    boost::system::error_code woken;
    co_await waiting->answered.async_wait(
        boost::asio::redirect_error(boost::asio::use_awaitable, woken));
  }
  co_return *std::move(waiting->answer);
}

}  // namespace runstone
