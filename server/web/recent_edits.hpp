// RecentEdits: the newest edits of a world, for the page with the server's state. They are asked of
// the map at most once a second however many pages are requested, no address pays for them, and a
// page waits for them a moment only: a map that is busy or broken does not delay it.
// Thread: the gateway's.
#pragma once
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <set>
#include <string>

#include "common/core/ids.hpp"
#include "server/web/map_gate.hpp"

namespace runstone {

class RecentEdits {
 public:
  /// Both must outlive the object.
  RecentEdits(boost::asio::io_context& io, MapGate& map) : io_(io), map_(map) {}

  /// Returns the newest edits as JSON: those of the last second, or, if they do not come within a
  /// quarter of a second, the last ones known. Returns null if none are known, or if strangers may
  /// not see them.
  boost::asio::awaitable<std::shared_ptr<const std::string>> newest();

 private:
  boost::asio::awaitable<void> ask();

  boost::asio::io_context& io_;
  MapGate& map_;
  std::shared_ptr<const std::string> newest_;  // null: none are known
  TimeUs asked_us_ = 0;                        // when newest_ was asked for; 0: never
  bool is_asking_ = false;
  std::set<boost::asio::steady_timer*> waiting_;  // cancelled by an answer
};

}  // namespace runstone
