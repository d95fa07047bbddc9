#include "server/limits/recent_refusals.hpp"

#include <algorithm>
#include <tuple>

namespace runstone {
namespace {

bool was_before(const auto& a, const auto& b) { return a.second.last_us < b.second.last_us; }

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
                                 [](const auto& a, const auto& b) { return was_before(a, b); }));
  } else if (rows_.size() >= kRefusalRowsMax) {
    rows_.erase(std::min_element(rows_.begin(), rows_.end(),
                                 [](const auto& a, const auto& b) { return was_before(a, b); }));
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
