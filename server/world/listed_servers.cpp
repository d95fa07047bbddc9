#include "server/world/listed_servers.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "server/world/followers.hpp"
#include "server/world/world_state.hpp"

namespace runstone {
namespace {

/// Returns the servers that run now, without the numbers of their players.
std::vector<ServerEntry> servers_now(const WorldState& world) {
  std::map<std::string, std::string> pages;  // by address
  const auto add = [&pages](const std::string& address, const std::string& page) {
    if (!address.empty() && pages.size() < kServersMax) pages.try_emplace(address, page);
  };
  add(world.config.player_address, world.config.page_address);
  for (const auto& [link, follower] : world.followers) {
    if (is_served(follower)) add(follower.player_address, follower.page_address);
  }
  std::vector<ServerEntry> servers;
  servers.reserve(pages.size());
  for (const auto& [address, page] : pages) servers.push_back({address, page});
  return servers;
}

void count_players(const WorldState& world, std::vector<ServerEntry>& servers) {
  for (const auto& [id, session] : world.sessions) {
    if (session.state != SessionStage::open) continue;
    const RelayedSession* relayed = world.output.relayed(id);
    const std::string& address = relayed == nullptr
                                     ? world.config.player_address
                                     : world.followers.at(relayed->link).player_address;
    const auto found = std::ranges::find(servers, address, &ServerEntry::address);
    if (found != servers.end()) ++found->players;
  }
}

bool have_same_addresses(const std::vector<ServerEntry>& a, const std::vector<ServerEntry>& b) {
  return std::ranges::equal(a, b, [](const ServerEntry& one, const ServerEntry& other) {
    return one.address == other.address && one.page == other.page;
  });
}

}  // namespace

void update_listed_servers(WorldState& world, const Clocks& now) {
  ListedServers& listed = world.listed;
  if (now.steady_us < listed.held_until_us) return;
  if (world.followers.empty() && listed.number == 0) return;
  std::vector<ServerEntry> servers = servers_now(world);
  const bool is_alone = servers.size() < 2;
  if (is_alone && listed.number == 0) return;
  const bool is_same = have_same_addresses(servers, listed.newest);
  if (is_same && (is_alone || now.steady_us < listed.counts_due_us)) return;
  listed.counts_due_us = now.steady_us + kPlayerCountsUs;
  count_players(world, servers);
  if (servers == listed.newest) return;
  listed.newest = std::move(servers);
  ++listed.number;
}

void take_listed_servers(WorldState& world, const Servers& list) {
  world.listed.newest = list.servers;
  ++world.listed.number;
}

void hold_listed_servers(WorldState& world, const Clocks& now) {
  world.listed.held_until_us = now.steady_us + kServersGatherUs;
}

void send_listed_servers(WorldState& world) {
  const ListedServers& listed = world.listed;
  if (listed.number == 0) return;
  std::optional<EncodedMessage> message;
  const auto send = [&](SessionId to) {
    if (!message) message = encode_message(seen_from({listed.newest}, world.config.player_address));
    return world.environment.send(to, *message);
  };
  for (auto& [link, follower] : world.followers) {
    if (!follower.takes_servers || !is_served(follower) || follower.servers_sent == listed.number)
      continue;
    follower.servers_sent = listed.number;
    follower.is_full = !send(link);
  }
  for (auto& [id, session] : world.sessions) {
    if (session.state != SessionStage::open || session.is_relayed ||
        (session.features & kFeatureServerList) == 0 || session.servers_sent == listed.number)
      continue;
    if (send(id)) session.servers_sent = listed.number;
  }
}

}  // namespace runstone
