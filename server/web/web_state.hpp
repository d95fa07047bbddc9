// WebState: what the connections of a gateway share. Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ssl/context.hpp>
#include <cstdint>
#include <map>
#include <optional>

#include "server/web/client_files.hpp"
#include "server/web/map_gate.hpp"
#include "server/web/origin_check.hpp"
#include "server/web/socket_limits.hpp"
#include "server/web/status_source.hpp"
#include "server/web/web_config.hpp"
#include "server/web/web_counters.hpp"

namespace runstone {

class WebConnection;

struct WebState {
  WebState(const WebConfig& config_, ClientFiles client_, OriginCheck origin_,
           std::optional<boost::asio::ssl::context> tls_)
      : config(config_),
        client(std::move(client_)),
        origin(std::move(origin_)),
        tls(std::move(tls_)),
        status(io, config_.gateway_socket + ".status"),
        map(io, config_, counters),
        limits(config_.sockets_per_address, config_.connections_per_second) {}

  const WebConfig config;
  const ClientFiles client;  // may be empty
  const OriginCheck origin;
  boost::asio::io_context io{1};
  std::optional<boost::asio::ssl::context> tls;
  WebCounters counters;
  StatusSource status;
  MapGate map;
  SocketLimits limits;
  /// All connections, oldest first. A connection removes itself when it is destroyed.
  std::map<std::uint64_t, WebConnection*> connections;
};

}  // namespace runstone
