#include "server/web/link_error.hpp"

#include <cerrno>

namespace runstone {

WebClose close_for_link_error(const boost::system::error_code& error) {
  using Code = boost::beast::websocket::close_code;
  switch (error.value()) {
    case ENOENT:
    case ECONNREFUSED:
      return {Code::try_again_later,
              "the server of this world is not running, or it is restarting: try again soon"};
    case EPIPE:
    case ECONNRESET:
      return {Code::try_again_later, "the server has not taken the connection: try again soon"};
    // Linux reports a full queue of connections as EAGAIN, of which Asio makes ENOBUFS.
    case EAGAIN:
    case ENOBUFS:
      return {Code::try_again_later, "many players join this world now: try again soon"};
    case EMFILE:
    case ENFILE:
    case ENOMEM:
      return {Code::try_again_later,
              "the gateway has no room for one more connection: try again soon"};
    default:
      return {Code::internal_error,
              "the gateway cannot connect to the server of this world: tell its host"};
  }
}

}  // namespace runstone
