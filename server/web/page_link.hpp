// PageLink: asks the server for the operators' page, over a Unix socket (PageDesk of the server
// answers). Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <string>

#include "server/web/page_reply.hpp"

namespace runstone {

/// The time after which a command that goes on is shown as far as it is answered.
inline constexpr std::uint64_t kPageAnswerSeconds = 30;

/// Sends one line, and returns the answer of the server.
boost::asio::awaitable<PageReply> ask_page(boost::asio::io_context& io, std::string path,
                                           std::string line);

}  // namespace runstone
