// WebWorld: a server behind the gateway with what its pages need. Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/io_context.hpp>
#include <string>
#include <string_view>

#include "server/web/map_gate.hpp"
#include "server/web/recent_edits.hpp"
#include "server/web/status_source.hpp"
#include "server/web/web_config.hpp"
#include "server/web/web_counters.hpp"

namespace runstone {

/// The folder of the worlds of several servers among the paths of the gateway. The pages of a world
/// are the same as those of a gateway with one server, in a folder of this one.
inline constexpr std::string_view kWorldsPath = "/world/";

struct WebWorld {
  WebWorld(boost::asio::io_context& io, std::string name_, const WebConfig& config_,
           MapShare& map_share, WebCounters& counters)
      : name(std::move(name_)),
        config(config_),
        status(io, config_.gateway_socket + ".status"),
        map(io, config_, map_share, counters),
        recent_edits(io, map) {}

  const std::string name;  // empty: the gateway has one server
  const WebConfig config;  // of the gateway, with the values of this server
  StatusSource status;
  MapGate map;
  RecentEdits recent_edits;
};

}  // namespace runstone
