// How a WebSocket is closed that gets no connection to its server. The words are for the player, so
// they name no path of this machine.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/system/error_code.hpp>

namespace runstone {

struct WebClose {
  boost::beast::websocket::close_code code;
  const char* words;  // at most 123 bytes
};

/// `error`: of the connection to the server's socket, or of the first write to it.
WebClose close_for_link_error(const boost::system::error_code& error);

}  // namespace runstone
