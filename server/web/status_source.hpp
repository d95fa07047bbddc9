// StatusSource: asks the server for its status, at most once a second however many pages are
// requested. Requests that come while an answer is under way wait for it.
// Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <string>

#include "common/core/ids.hpp"
#include "server/web/server_status.hpp"

namespace runstone {

class StatusSource {
 public:
  /// `path`: of the server's status socket.
  StatusSource(boost::asio::io_context& io, std::string path);

  /// Returns a status that is at most a second older than the call. A server that gives no answer
  /// is reported as not up, with the reason.
  boost::asio::awaitable<std::shared_ptr<const ServerStatus>> newest(TimeUs called_us);

 private:
  boost::asio::awaitable<ServerStatus> ask();

  boost::asio::io_context& io_;
  const std::string path_;
  std::shared_ptr<const ServerStatus> newest_;  // null before the first answer
  TimeUs asked_us_ = 0;                         // when newest_ was asked for
  bool is_asking_ = false;
  boost::asio::steady_timer answered_;  // never expires; cancelled when an answer has come
};

}  // namespace runstone
