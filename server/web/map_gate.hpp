// MapGate limits the requests of each address for the map of a world, and passes them to the
// threads that draw.
// Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "common/core/address_block.hpp"
#include "server/limits/address_ledger.hpp"
#include "server/map/map_service.hpp"
#include "server/map/map_threads.hpp"
#include "server/web/waiting_requests.hpp"
#include "server/web/web_config.hpp"
#include "server/web/web_counters.hpp"

namespace runstone {

/// All maps of a gateway share these: the limits of each address, and the threads that draw.
struct MapShare {
  explicit MapShare(const WebConfig& config);
  AddressLedger requests, work_us;
  WaitingRequests waiting;
  std::unique_ptr<MapThreads> threads;  // null: there is no map
};

class MapGate {
 public:
  /// There is no map if the setting `world` is empty. The others must outlive the object.
  MapGate(boost::asio::io_context& io, const WebConfig& config, MapShare& share,
          WebCounters& counters);

  bool is_on() const { return service_ != nullptr; }
  /// Counts a request on a connection. Returns false if the address may not ask now.
  bool ask(AddressBlock from, TimeUs now_us) {
    const bool may_ask = share_.requests.take(from, 1, now_us);
    if (!may_ask) ++counters_.map_refused;
    return may_ask;
  }
  /// Returns the answer to a request for a path below kMapDataPath. The address pays for the time
  /// of drawing.
  boost::asio::awaitable<MapAnswer> answer(AddressBlock from, std::string_view target,
                                           std::string if_none_match);
  /// Returns the newest edits, for pages of the gateway. No address pays.
  boost::asio::awaitable<MapAnswer> recent_edits();
  std::size_t cache_bytes() const { return service_ == nullptr ? 0 : service_->cache_bytes(); }
  /// Ends the drawing. Requests that wait are answered, and later ones are
  /// answered that the gateway stops.
  void stop() {
    is_stopped_ = true;
    service_.reset();
  }

 private:
  struct Waiting;
  boost::asio::awaitable<MapAnswer> wait_for(MapRequest request, std::string if_none_match);

  boost::asio::io_context& io_;
  MapShare& share_;
  WebCounters& counters_;
  bool is_stopped_ = false;
  std::unique_ptr<MapService> service_;  // null: no map
};

}  // namespace runstone
