// WebState: what the connections of a gateway share. Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <map>
#include <memory>
#include <string_view>
#include <vector>

#include "common/core/bytes.hpp"
#include "server/web/certificate.hpp"
#include "server/web/client_files.hpp"
#include "server/web/map_gate.hpp"
#include "server/web/origin_check.hpp"
#include "server/web/rare_line.hpp"
#include "server/web/socket_limits.hpp"
#include "server/web/web_config.hpp"
#include "server/web/web_counters.hpp"
#include "server/web/web_world.hpp"

namespace runstone {

class WebConnection;

struct WebState {
  WebState(const WebConfig& config_, ClientFiles client_, OriginCheck origin_,
           Certificate certificate_)
      : config(config_),
        client(std::move(client_)),
        origin(std::move(origin_)),
        certificate(std::move(certificate_)),
        own_origin({}, certificate.is_there()),
        map_share(config_),
        limits(config_.sockets_per_address, config_.connections_per_second) {
    if (config.servers.empty())
      worlds.push_back(std::make_unique<WebWorld>(io, "", config, map_share, counters));
    for (const WebServer& server : config.servers) {
      worlds.push_back(std::make_unique<WebWorld>(io, server.name, config_for(config, server),
                                                  map_share, counters));
    }
  }
  bool has_several_worlds() const { return !config.servers.empty(); }

  const WebConfig config;
  const ClientFiles client;  // may be empty
  const OriginCheck origin;
  // Other threads only post to it. Sockets and timers are used by one thread, so Asio need not lock
  // them.
  boost::asio::io_context io{BOOST_ASIO_CONCURRENCY_HINT_UNSAFE_IO};
  Certificate certificate;
  const OriginCheck own_origin;  // pages of this gateway alone, for the forms of operators
  WebCounters counters;
  /// What addresses may spend on wrong links and cookies: ten at once, then one in ten seconds.
  static constexpr std::uint64_t kOperatorFaultPrice = 10;
  AddressLedger operator_faults{Budget{1, 10 * kOperatorFaultPrice}};
  WaitingRequests operator_requests;
  MapShare map_share;
  std::vector<std::unique_ptr<WebWorld>> worlds;  // one at least, in the order of the configuration
  SocketLimits limits;
  RareLine link_line;  // a connection to a server failed
  Bytes message;       // to a browser, while it is written
  /// All connections, oldest first. A connection removes itself when it is destroyed.
  std::map<std::uint64_t, WebConnection*> connections;
};

/// Where a request leads.
struct WebPlace {
  WebWorld* world = nullptr;  // null: to the pages of a gateway with several servers
  std::string_view target;    // within the folder of the world; it begins with '/'
};
inline WebPlace place_of(const WebState& state, std::string_view target) {
  if (!state.has_several_worlds()) return {state.worlds.front().get(), target};
  if (!target.starts_with(kWorldsPath)) return {nullptr, target};
  const std::string_view inside = target.substr(kWorldsPath.size());
  for (const auto& world : state.worlds) {
    const std::string_view name = world->name;
    if (inside.starts_with(name) && inside.substr(name.size()).starts_with('/'))
      return {world.get(), inside.substr(name.size())};
  }
  return {nullptr, target};
}

}  // namespace runstone
