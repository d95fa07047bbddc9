#include "server/map/recent_changes.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace runstone {

void RecentChanges::begin(Sequence seq) {
  known_after_ = seq;
  columns_.clear();
}

void RecentChanges::add(Sequence seq, std::span<const ChunkCoord> chunks) {
  std::set<std::pair<std::int32_t, std::int32_t>> columns;
  for (const ChunkCoord& chunk : chunks) columns.emplace(chunk.x, chunk.z);
  if (columns.size() > kKeptMax) return begin(seq);
  for (const auto& [x, z] : columns) columns_.push_back({x, z, seq});
  // An edit is dropped as a whole, because after() answers for whole edits.
  while (columns_.size() > kKeptMax) {
    known_after_ = columns_.front().seq;
    while (!columns_.empty() && columns_.front().seq == known_after_) columns_.pop_front();
  }
}

RecentChanges::Answer RecentChanges::after(Sequence since) const {
  Answer out;
  if (since < known_after_) return out;
  std::map<std::pair<std::int32_t, std::int32_t>, ChangedColumn> newest;
  for (auto at = columns_.rbegin(); at != columns_.rend() && at->seq > since; ++at) {
    newest.try_emplace({at->x, at->z}, *at);
    if (newest.size() > kAnswerMax) return out;
  }
  out.is_complete = true;
  for (const auto& [place, column] : newest) out.columns.push_back(column);
  return out;
}

}  // namespace runstone
