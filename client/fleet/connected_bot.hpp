// ConnectedBot: a bot with its connection to the server. Thread: the one that runs the io_context.
#pragma once
#include <asio/io_context.hpp>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include "client/fleet/linked_session.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// BotType has a session(), a name() and a step(now_us).
template <class BotType>
class ConnectedBot {
 public:
  /// Starts connecting. `io` must outlive the bot.
  template <class... BotArguments>
  ConnectedBot(asio::io_context& io, const LinkConfig& net, BotArguments&&... arguments)
      : bot_(std::forward<BotArguments>(arguments)...),
        link_(io, bot_.session(), bot_.name(), net) {}

  using Session = std::remove_reference_t<decltype(std::declval<BotType&>().session())>;

  BotType& bot() { return bot_; }
  const BotType& bot() const { return bot_; }
  const LinkedSession<Session>& link() const { return link_; }

  void step(TimeUs now_us) {
    bot_.step(now_us);
    link_.flush();
  }
  void leave(std::int64_t milliseconds) { link_.leave(milliseconds); }
  /// Returns a line such as "bot-3 was refused: the server is full".
  std::string failure(const std::string& what) const {
    const std::string& why = link_.last_failure();
    return bot_.name() + " " + what + (why.empty() ? "" : ": " + why);
  }

 private:
  BotType bot_;
  LinkedSession<Session> link_;
};

}  // namespace runstone
