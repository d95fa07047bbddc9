#include "server/limits/recent_refusals.hpp"

#include <algorithm>
#include <tuple>

namespace runstone {
namespace {

/// Returns true if row `a` is given up before row `b`: refused joins go first, because everybody
/// can make as many keys as they like and be refused with each.
bool goes_before(const auto& a, const auto& b) {
  const auto order = [](const RefusalRow& row) {
    return std::pair(!row.what.starts_with(kRefusedJoin), row.last_us);
  };
  return order(a.second) < order(b.second);
}

}  // namespace

void RecentRefusals::add(const PublicKey& key, const std::string& what, TimeUs now_us) {
  const Place place{key, what};
  const auto found = rows_.find(place);
  if (found != rows_.end()) {
    ++found->second.count;
    found->second.last_us = now_us;
    return;
  }
  const auto first = rows_.lower_bound({key, ""});
  const auto last =
      std::find_if(first, rows_.end(), [&](const auto& r) { return r.first.first != key; });
  if (static_cast<std::size_t>(std::distance(first, last)) >= kRefusalRowsOfKeyMax) {
    rows_.erase(std::min_element(first, last,
                                 [](const auto& a, const auto& b) { return goes_before(a, b); }));
  } else if (rows_.size() >= kRefusalRowsMax) {
    rows_.erase(std::min_element(rows_.begin(), rows_.end(),
                                 [](const auto& a, const auto& b) { return goes_before(a, b); }));
  }
  rows_.emplace(place, RefusalRow{key, what, 1, now_us, now_us});
}

std::vector<RefusalRow> RecentRefusals::rows() const {
  std::vector<RefusalRow> out;
  out.reserve(rows_.size());
  for (const auto& [place, row] : rows_) out.push_back(row);
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return std::tie(a.last_us, a.key, a.what) < std::tie(b.last_us, b.key, b.what);
  });
  return out;
}

}  // namespace runstone
