#include "server/world/cluster/server_list.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace runstone {
namespace {

bool have_same_addresses(const std::vector<ServerEntry>& a, const std::vector<ServerEntry>& b) {
  return std::ranges::equal(a, b, [](const ServerEntry& one, const ServerEntry& other) {
    return one.address == other.address && one.page == other.page;
  });
}

}  // namespace

/// Returns the servers that run now, without the numbers of their players.
std::vector<ServerEntry> ServerList::servers_now() const {
  std::map<std::string, std::string> pages;  // by address
  const auto add = [&pages](const std::string& address, const std::string& page) {
    if (!address.empty() && pages.size() < kServersMax) pages.try_emplace(address, page);
  };
  add(config_.player_address, config_.page_address);
  for (const auto& [link, follower] : followers_.all()) {
    if (order_.feed().is_served(link)) add(follower.player_address, follower.page_address);
  }
  std::vector<ServerEntry> servers;
  servers.reserve(pages.size());
  for (const auto& [address, page] : pages) servers.push_back({address, page});
  return servers;
}

void ServerList::count_players(std::vector<ServerEntry>& servers) const {
  for (const Session* session : sessions_.open()) {
    const Follower* there = followers_.of_session(session->id);
    const std::string& address = there == nullptr ? config_.player_address : there->player_address;
    const auto found = std::ranges::find(servers, address, &ServerEntry::address);
    if (found != servers.end()) ++found->players;
  }
}

void ServerList::update(const Clocks& now) {
  if (now.steady_us < held_until_us_) return;
  if (followers_.count() == 0 && number_ == 0) return;
  std::vector<ServerEntry> servers = servers_now();
  const bool is_alone = servers.size() < 2;
  if (is_alone && number_ == 0) return;
  const bool is_same = have_same_addresses(servers, newest_);
  if (is_same && (is_alone || now.steady_us < counts_due_us_)) return;
  counts_due_us_ = now.steady_us + kPlayerCountsUs;
  count_players(servers);
  if (servers == newest_) return;
  newest_ = std::move(servers);
  ++number_;
}

void ServerList::take(const Servers& list) {
  newest_ = list.servers;
  ++number_;
}

void ServerList::send() {
  if (number_ == 0) return;
  std::optional<EncodedMessage> message;
  const auto encoded = [&]() -> const EncodedMessage& {
    if (!message) message = encode_message(seen_from({newest_}, config_.player_address));
    return *message;
  };
  for (auto& [link, follower] : followers_.all()) {
    if (!follower.takes_servers || !order_.feed().is_served(link) ||
        follower.servers_sent == number_)
      continue;
    follower.servers_sent = number_;
    order_.feed().send(link, encoded());
  }
  for (const Session* session : sessions_.open()) {
    if (session->is_relayed || !session->has(kFeatureServerList)) continue;
    std::uint64_t& sent = sent_[session->id];
    if (sent != number_ && environment_.send(session->id, encoded())) sent = number_;
  }
}

}  // namespace runstone
