// The events of a NetClient, one after another.
#pragma once
#include <catch2/catch.hpp>
#include <chrono>
#include <utility>
#include <vector>

#include "client/net/net_client.hpp"
#include "client/net/wake_up.hpp"

namespace runstone::test {

/// Returns the next event. `events` has those that were taken before. Fails the test if none comes
/// within twenty seconds.
inline LinkEvent next_event(NetClient& client, WakeUp& wake, std::vector<LinkEvent>& events) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (events.empty()) {
    REQUIRE(std::chrono::steady_clock::now() < until);
    for (LinkEvent& event : client.take_events()) events.push_back(std::move(event));
    if (events.empty()) wake.wait(std::chrono::milliseconds(50));
  }
  LinkEvent event = std::move(events.front());
  events.erase(events.begin());
  return event;
}

}  // namespace runstone::test
