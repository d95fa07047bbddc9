#include "client/bots/version_tracker.hpp"

#include <algorithm>
#include <utility>

#include "common/core/key_text.hpp"
#include "protocol/codec/view_tiles.hpp"

namespace runstone {

void Violations::add(const std::string& name, std::string what) {
  Entry& entry = all_[name];
  if (entry.count++ == 0) entry.first = std::move(what);
}

void Violations::merge(const Violations& other) {
  for (const auto& [name, theirs] : other.all_) {
    Entry& ours = all_[name];
    if (ours.count == 0) ours.first = theirs.first;
    ours.count += theirs.count;
  }
}

std::uint64_t Violations::total() const {
  std::uint64_t sum = 0;
  for (const auto& [name, entry] : all_) sum += entry.count;
  return sum;
}

void VersionCounts::merge(const VersionCounts& other) {
  snapshots += other.snapshots;
  tiles += other.tiles;
  stale += other.stale;
  outside += other.outside;
  followed += other.followed;
  contained += other.contained;
  held_back += other.held_back;
  resent += other.resent;
  versions_checked += other.versions_checked;
  behind_us.merge(other.behind_us);
}

void VersionTracker::open(Epoch epoch, CoordLimit world) {
  epoch_ = epoch;
  world_ = world;
  views_.reopen();
  chunks_.clear();
  tiles_.clear();
  requests_.clear();
  held_ = unavailable_ = behind_ = 0;
}

void VersionTracker::set_view(const View& view) {
  views_.set(view);
  tiles_.set_view(view);
  for (auto it = chunks_.begin(); it != chunks_.end();) {
    if (view.contains(it->first)) {
      ++it;
      continue;
    }
    forget(it->second);
    it = chunks_.erase(it);
  }
}

void VersionTracker::forget(const Known& chunk) {
  if (chunk.held) --held_;
  if (chunk.unavailable) --unavailable_;
  if (chunk.behind_us) --behind_;
}

void VersionTracker::receive(const Chunks& chunks, TimeUs now_us) {
  for (const ChunkAnswer& answer : chunks.chunks) {
    if (const auto* snapshot = std::get_if<ChunkSnapshot>(&answer)) {
      take(*snapshot, chunks.view, now_us);
    } else {
      violations_.add("chunk edits", "chunk " + text_of(key_of(answer)));
    }
  }
}

void VersionTracker::take(const ChunkSnapshot& snapshot, std::uint32_t view, TimeUs now_us) {
  if (!digest_matches(snapshot)) {
    violations_.add("snapshot digest", "chunk " + text_of(snapshot.key) + " at seq " +
                                           std::to_string(snapshot.chunk.version.seq));
  }
  take(snapshot.key, view, snapshot.chunk.version, is_empty(snapshot.chunk.voxels), now_us);
}

void VersionTracker::receive(const UniformChunks& uniform, TimeUs now_us) {
  for (const UniformChunk& chunk : uniform.chunks) {
    take(chunk.key, uniform.view, chunk.version, chunk.material == kEmpty, now_us);
  }
}

/// Returns true if an answer to this view counts for the chunk.
bool VersionTracker::accepts(const ChunkKey& key, std::uint32_t view) {
  const std::uint32_t newest = views_.current() ? views_.current()->number : 0;
  if (view > newest) {
    violations_.add("view number", "chunk " + text_of(key) + " answers view " +
                                       std::to_string(view) + ", and the newest one is " +
                                       std::to_string(newest));
  }
  if (views_.accepts(key, view)) return true;
  ++counts_.outside;
  return false;
}

/// Takes a snapshot whose voxels are verified already.
void VersionTracker::take(const ChunkKey& key, std::uint32_t view, Version version, bool is_empty,
                          TimeUs now_us) {
  if (version.epoch > epoch_) {
    violations_.add("epoch",
                    "chunk " + text_of(key) + " is of epoch " + std::to_string(version.epoch));
  }
  ++counts_.snapshots;
  if (key.lod > 0) return take_tile(key, view, is_empty);
  if (!accepts(key, view)) return;
  Known& chunk = chunks_[key.at];
  if (std::exchange(chunk.unavailable, false)) --unavailable_;
  if (chunk.held && version.seq < chunk.at) {
    ++counts_.stale;
    return;
  }
  // Only a snapshot newer than what is held replaces commits.
  if (chunk.held && version.seq > chunk.at) ++counts_.resent;
  if (!std::exchange(chunk.held, true)) ++held_;
  chunk.at = version.seq;
  chunk.latest = std::max(chunk.latest, version.seq);
  chunk.is_asked = false;
  advance(chunk, now_us);
}

void VersionTracker::take_tile(const ChunkKey& key, std::uint32_t view, bool is_empty) {
  ++counts_.tiles;
  const auto& current = views_.current();
  if (current && contains_key(*current, key)) tiles_.add(key, is_empty);
  // A tile of a view before the newest one may be on its way when its place leaves the view.
  if (current && view == current->number && !contains_key(*current, key))
    violations_.add("tile outside",
                    "tile " + text_of(key) + " is not in view " + std::to_string(view));
}

void VersionTracker::receive(const ChunkUnavailable& unavailable) {
  for (const ChunkKey& key : unavailable.keys) {
    if (!accepts(key, unavailable.view)) continue;
    Known& chunk = chunks_[key.at];
    forget(chunk);
    chunk = {};
    chunk.unavailable = true;
    ++unavailable_;
  }
}

void VersionTracker::complete(std::uint32_t view) {
  // The chunks of an older view may have been forgotten.
  if (!views_.current() || views_.current()->number != view) return;
  const std::size_t expected = chunks_in(*views_.current(), world_);
  if (known() == expected) return;
  violations_.add("incomplete view", "view " + std::to_string(view) + " is complete, and " +
                                         std::to_string(known()) + " of its " +
                                         std::to_string(expected) + " chunks were answered");
}

void VersionTracker::receive(const DigestCheck& check, TimeUs now_us) {
  for (const DigestCheckEntry& entry : check.entries) {
    const auto found = chunks_.find(entry.key.at);
    if (entry.key.lod != 0 || found == chunks_.end() || !found->second.held) continue;
    ++counts_.versions_checked;
    // Commits are batched for a while, and a digest check may overtake them.
    found->second.latest = std::max(found->second.latest, entry.version.seq);
    advance(found->second, now_us);
  }
}

void VersionTracker::follow(ChunkCoord at, Sequence previous, Sequence seq, TimeUs now_us) {
  if (!views_.contains({0, at})) return;
  Known& chunk = chunks_[at];
  if (chunk.unavailable) return;
  chunk.latest = std::max(chunk.latest, seq);
  if (chunk.held && seq <= chunk.at) {
    ++counts_.contained;
    return;
  }
  if (chunk.held && chunk.waiting.empty() && chunk.at == previous) {
    chunk.at = seq;
    ++counts_.followed;
    if (chunk.behind_us) advance(chunk, now_us);
    return;
  }
  ++counts_.held_back;
  if (chunk.waiting.size() == kWaitingLinksMax) chunk.waiting.clear();
  chunk.waiting.push_back({previous, seq});
  if (chunk.held) advance(chunk, now_us);
}

/// Follows the edits that continue the version, and notes whether edits are missing. Requires a
/// held chunk.
void VersionTracker::advance(Known& chunk, TimeUs now_us) {
  std::size_t taken = 0;
  for (; taken < chunk.waiting.size(); ++taken) {
    const Link& link = chunk.waiting[taken];
    if (link.seq <= chunk.at) {
      ++counts_.contained;
    } else if (link.previous == chunk.at) {
      chunk.at = link.seq;
      ++counts_.followed;
    } else {
      break;
    }
  }
  chunk.waiting.erase(chunk.waiting.begin(),
                      chunk.waiting.begin() + static_cast<std::ptrdiff_t>(taken));
  const bool is_behind = chunk.at < chunk.latest;
  if (is_behind && !chunk.behind_us) {
    chunk.behind_us = now_us;
    ++behind_;
  } else if (!is_behind && chunk.behind_us) {
    counts_.behind_us.add(now_us - *chunk.behind_us);
    chunk.behind_us.reset();
    chunk.is_asked = false;
    --behind_;
  }
}

void VersionTracker::tick(TimeUs now_us) {
  if (behind_ == 0) return;
  for (auto& [at, chunk] : chunks_) {
    if (!chunk.behind_us || chunk.is_asked || now_us - *chunk.behind_us < kResendUsMax) continue;
    const ChunkKey key{0, at};
    violations_.add("gap", "chunk " + text_of(key) + " stands at seq " + std::to_string(chunk.at) +
                               ", edit " + std::to_string(chunk.latest) +
                               " touched it, and the edits between did not arrive");
    chunk.is_asked = true;
    requests_.insert(key);
  }
}

std::vector<ChunkKey> VersionTracker::take_requests() {
  const auto requests = std::exchange(requests_, {});
  return {requests.begin(), requests.end()};
}

std::optional<Sequence> VersionTracker::version(ChunkCoord at) const {
  const auto found = chunks_.find(at);
  if (found == chunks_.end() || !found->second.held) return std::nullopt;
  return found->second.at;
}

}  // namespace runstone
