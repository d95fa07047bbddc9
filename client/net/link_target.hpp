// LinkTarget: where a link connects to. It is a server, or a WebSocket of a gateway.
#pragma once
#include <string>
#include <vector>

#include "common/os/host_port.hpp"
#include "protocol/codec/server_list.hpp"

namespace runstone {

struct LinkTarget {
  HostPort server;
  /// Path of the WebSocket, such as "/play". Empty: `server` takes frames without a WebSocket.
  std::string web_path = {};
  friend bool operator==(const LinkTarget&, const LinkTarget&) = default;
};

/// Returns the servers of a list besides its sender.
std::vector<LinkTarget> other_servers(const Servers& list);
/// Returns the WebSockets of the gateways of these servers. With `is_encrypted` it returns those of
/// https:// pages only, without it those of http:// pages only.
std::vector<LinkTarget> other_gateways(const Servers& list, bool is_encrypted);

}  // namespace runstone
