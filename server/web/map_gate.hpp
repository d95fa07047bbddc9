// MapGate limits the requests of each address for the map, and passes them to the drawing thread.
// Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "common/core/address_block.hpp"
#include "server/limits/address_ledger.hpp"
#include "server/map/map_service.hpp"
#include "server/web/web_config.hpp"
#include "server/web/web_counters.hpp"

namespace runstone {

/// Limits how much each address may request of the maps. All maps of a gateway share them.
struct MapBudgets {
  explicit MapBudgets(const WebConfig& config);
  AddressLedger requests, work_us;
};

class MapGate {
 public:
  /// The requests of one address, and of one range of addresses, that may wait for the drawing thread.
  static constexpr std::size_t kWaitingMax = 16, kWaitingOfRangeMax = 64;

  /// There is no map if the setting `world` is empty. The others must outlive the object.
  MapGate(boost::asio::io_context& io, const WebConfig& config, MapBudgets& budgets,
          WebCounters& counters);

  bool is_on() const { return service_ != nullptr; }
  /// Counts a request on a connection. Returns false if the address may not ask now.
  bool ask(AddressBlock from, TimeUs now_us) {
    const bool may_ask = budgets_.requests.take(from, 1, now_us);
    if (!may_ask) ++counters_.map_refused;
    return may_ask;
  }
  /// Returns the answer to a request for a path below kMapDataPath. The address pays for the time of
  /// the thread that draws.
  boost::asio::awaitable<MapAnswer> answer(AddressBlock from, std::string_view target,
                                           std::string if_none_match);
  std::size_t cache_bytes() const { return service_ == nullptr ? 0 : service_->cache_bytes(); }
  /// Ends the thread that draws. Requests that wait are answered, and later ones are
  /// answered that the gateway stops.
  void stop() {
    is_stopped_ = true;
    service_.reset();
  }

 private:
  struct Waiting;
  boost::asio::awaitable<MapAnswer> wait_for(MapRequest request, std::string if_none_match);

  boost::asio::io_context& io_;
  MapBudgets& budgets_;
  WebCounters& counters_;
  std::map<AddressBlock, std::size_t> waiting_, waiting_of_range_;  // no count is 0
  bool is_stopped_ = false;
  std::unique_ptr<MapService> service_;  // null: no map
};

}  // namespace runstone
