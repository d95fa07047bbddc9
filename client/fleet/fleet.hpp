// Fleet: bots, each with its link, on one thread. What they do and when it is done is their owner's business.
#pragma once
#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "client/fleet/session_link.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// A bot has a session(), a name() and a step(now_us).
template <class BotType>
class FleetMember {
 public:
  template <class... BotArguments>
  FleetMember(asio::io_context& io, const NetConfig& net, BotArguments&&... arguments)
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
  /// "bot-3 was sent away: the server is full"
  std::string failure(const std::string& what) const {
    const std::string& why = link_.last_failure();
    return bot_.name() + " " + what + (why.empty() ? "" : ": " + why);
  }

 private:
  BotType bot_;
  LinkedSession<Session> link_;
};

template <class BotType>
struct Fleet {
  using Member = FleetMember<BotType>;

  /// Also starts connecting.
  template <class... BotArguments>
  void add(const NetConfig& net, BotArguments&&... arguments) {
    members.push_back(std::make_unique<Member>(io, net, std::forward<BotArguments>(arguments)...));
  }
  /// Runs the links for as long as bots may go without a step.
  void run_links() { io.run_for(std::chrono::milliseconds(5)); }
  /// Blocks for two seconds at most.
  void leave() {
    constexpr std::int64_t kGoodbyeMs = 1'000;
    for (const auto& member : members) member->leave(kGoodbyeMs);
    io.run_for(std::chrono::milliseconds(2 * kGoodbyeMs));
  }

  asio::io_context io{1};
  std::vector<std::unique_ptr<Member>> members;
};

}  // namespace runstone
