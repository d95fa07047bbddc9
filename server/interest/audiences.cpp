#include "server/interest/audiences.hpp"

#include <algorithm>
#include <iterator>
#include <map>

namespace runstone {
namespace {

/// The edits of a commit that have the same receivers.
struct EditGroup {
  const std::vector<SessionId>* receivers;
  std::vector<std::uint32_t> edits;
};

std::vector<EditGroup> group_edits(const std::vector<std::vector<SessionId>>& receivers) {
  const auto less = [](const auto* a, const auto* b) { return *a < *b; };
  std::map<const std::vector<SessionId>*, std::size_t, decltype(less)> known(less);
  std::vector<EditGroup> groups;
  std::size_t last = 0;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    if (receivers[i].empty()) continue;
    // Edits in one place follow each other, and comparing with the last list is cheap.
    if (groups.empty() || *groups[last].receivers != receivers[i]) {
      const auto [at, is_new] = known.try_emplace(&receivers[i], groups.size());
      if (is_new) groups.push_back({&receivers[i], {}});
      last = at->second;
    }
    groups[last].edits.push_back(static_cast<std::uint32_t>(i));
  }
  return groups;
}

std::vector<SessionId> all_receivers(const std::vector<EditGroup>& groups) {
  std::vector<SessionId> all, merged;
  for (const EditGroup& group : groups) {
    merged.clear();
    std::ranges::set_union(all, *group.receivers, std::back_inserter(merged));
    all.swap(merged);
  }
  return all;
}

}  // namespace

std::vector<Audience> audiences_of(const std::vector<std::vector<SessionId>>& receivers) {
  const std::vector<EditGroup> groups = group_edits(receivers);
  if (groups.empty()) return {};
  if (groups.size() == 1) return {{*groups[0].receivers, groups[0].edits}};

  // For each session, one bit for each group of edits that it gets.
  const std::vector<SessionId> sessions = all_receivers(groups);
  using Bits = std::vector<std::uint64_t>;
  std::vector<Bits> gets(sessions.size(), Bits((groups.size() + 63) / 64));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::size_t at = 0;
    for (const SessionId session : *groups[g].receivers) {
      while (sessions[at] != session) ++at;
      gets[at][g / 64] |= 1ULL << (g % 64);
    }
  }
  std::vector<Audience> audiences;
  std::map<Bits, std::size_t> known;
  for (std::size_t at = 0; at < sessions.size(); ++at) {
    const auto [found, is_new] = known.try_emplace(gets[at], audiences.size());
    if (is_new) {
      Audience& fresh = audiences.emplace_back();
      for (std::size_t g = 0; g < groups.size(); ++g) {
        if ((gets[at][g / 64] >> (g % 64) & 1U) == 0) continue;
        fresh.edits.insert(fresh.edits.end(), groups[g].edits.begin(), groups[g].edits.end());
      }
      std::ranges::sort(fresh.edits);
    }
    audiences[found->second].sessions.push_back(sessions[at]);
  }
  return audiences;
}

}  // namespace runstone
