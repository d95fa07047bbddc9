#include "server/interest/tile_interest.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/chunk_distance.hpp"

namespace runstone {
namespace {

bool has_same_tiles(const View& a, const View& b, std::uint8_t level) {
  return level <= tile_levels(a) && level <= tile_levels(b) && a.radius_h == b.radius_h &&
         tile_at(a.centre, level) == tile_at(b.centre, level);
}

bool is_requested_or_sent(TileStatus status) {
  return status == TileStatus::waiting || client_has(status);
}

}  // namespace

TileInterest::Place TileInterest::place_of(const ChunkKey& key) const {
  return {-int{key.lod}, distance_squared(key.at, tile_at(view_->centre, key.lod)), key};
}

TileStatus TileInterest::status(const ChunkKey& key) const {
  return view_ && has_key(*view_, limit_, key) ? tiles_.at(key) : TileStatus::unknown;
}

std::size_t TileInterest::known_below(unsigned level) const {
  return std::accumulate(known_.begin(), known_.begin() + level, std::size_t{0});
}

std::vector<ChunkKey> TileInterest::roots() const {
  std::vector<ChunkKey> out;
  if (view_ && tile_levels(*view_) != 0) {
    for_each_tile(*view_, limit_, tile_levels(*view_),
                  [&out](const ChunkKey& key) { out.push_back(key); });
  }
  return out;
}

std::vector<ChunkKey> TileInterest::known() const {
  std::vector<ChunkKey> out;
  if (!view_) return out;
  out.reserve(known_count());
  for (std::uint8_t level = 1; level <= tile_levels(*view_); ++level) {
    for_each_tile(*view_, limit_, level, [&](const ChunkKey& key) {
      if (tiles_.at(key) != TileStatus::unknown) out.push_back(key);
    });
  }
  return out;
}

bool TileInterest::is_due(const ChunkKey& key) const {
  if (key.lod == tile_levels(*view_)) return true;
  const TileStatus parent = status(tile_parent(key));
  return parent == TileStatus::sent || parent == TileStatus::behind;
}

void TileInterest::set(const ChunkKey& key, TileStatus now) {
  const TileStatus was = status(key);
  if (was == now) return;
  if (was == TileStatus::wanted) queue_.erase(place_of(key));
  if (was == TileStatus::waiting) --waiting_;
  if (now == TileStatus::wanted) queue_.insert(place_of(key));
  if (now == TileStatus::waiting) ++waiting_;
  if (was == TileStatus::behind) behind_.erase(key);
  if (now == TileStatus::behind) behind_.insert(key);
  if (was == TileStatus::unknown) ++known_[key.lod];
  if (now == TileStatus::unknown) --known_[key.lod];
  tiles_.set(key, now);
}

void TileInterest::drop(const ChunkKey& key, std::vector<ChunkKey>& left) {
  if (is_requested_or_sent(status(key))) left.push_back(key);
  set(key, TileStatus::unknown);
}

void TileInterest::drop_below(const ChunkKey& key, std::vector<ChunkKey>& left) {
  if (key.lod <= 1 || known_below(key.lod) == 0) return;
  for (unsigned i = 0; i < kTileChildren; ++i) {
    const ChunkKey child = tile_child(key, i);
    // The view has the parents of all its tiles, so nothing below a child outside of it is known. Tiles
    // below an unknown child may be known: the view had fewer levels when they were sent.
    if (!has_key(*view_, limit_, child)) continue;
    drop_below(child, left);
    drop(child, left);
  }
}

std::size_t TileInterest::want_level(std::uint8_t level, const std::optional<View>& before) {
  std::size_t steps = 0;
  for_each_tile(*view_, limit_, level, [&](const ChunkKey& key) {
    ++steps;
    if (before && has_key(*before, limit_, key)) return;
    if (status(key) == TileStatus::unknown && is_due(key)) set(key, TileStatus::wanted);
  });
  return steps;
}

TileInterest::Moved TileInterest::set_view(const View& view, std::span<const View> skipped) {
  Moved moved;
  const std::optional<View> before = view_;
  const std::uint8_t levels = tile_levels(view);
  const std::uint8_t levels_before = before ? tile_levels(*before) : std::uint8_t{0};
  const auto leaves = [&](const ChunkKey& key) {
    return !has_key(view, limit_, key) ||
           std::any_of(skipped.begin(), skipped.end(),
                       [&](const View& other) { return !has_key(other, limit_, key); });
  };
  std::vector<ChunkKey> leaving;
  if (skipped.empty()) {
    for (std::uint8_t level = 1; level <= levels_before; ++level) {
      if (has_same_tiles(*before, view, level)) continue;
      for_each_tile(*before, limit_, level, [&](const ChunkKey& key) {
        ++moved.steps;
        if (tiles_.at(key) != TileStatus::unknown && leaves(key)) leaving.push_back(key);
      });
    }
  } else {
    leaving = known();
    moved.steps += leaving.size();
    std::erase_if(leaving, [&](const ChunkKey& key) { return !leaves(key); });
  }
  for (const ChunkKey& key : leaving) drop(key, moved.left);
  if (!before || before->radius_h != view.radius_h) {
    const std::vector<ChunkKey> kept = known();
    std::vector<TileStatus> statuses;
    statuses.reserve(kept.size());
    for (const ChunkKey& key : kept) statuses.push_back(tiles_.at(key));
    moved.steps += kept.size();
    tiles_.reset(view.radius_h);
    for (std::size_t i = 0; i < kept.size(); ++i) tiles_.set(kept[i], statuses[i]);
  }
  // The places in the queue depend on the centre.
  const std::set<Place> queue = std::exchange(queue_, {});
  moved.steps += queue.size();
  view_ = view;
  for (const Place& place : queue) queue_.insert(place_of(std::get<ChunkKey>(place)));
  const std::vector<ChunkKey> behind(behind_.begin(), behind_.end());
  moved.steps += behind.size();
  for (const ChunkKey& key : behind) {
    if (!is_hidden(key)) set(key, TileStatus::wanted);
  }
  // Parents come first, because a tile is due only if its parent is sent.
  for (std::uint8_t level = levels; level >= 1; --level) {
    const bool is_root = level == levels && levels != levels_before;
    if (skipped.empty() && before && !is_root) {
      if (!has_same_tiles(*before, view, level)) moved.steps += want_level(level, before);
    } else {
      moved.steps += want_level(level, std::nullopt);
    }
  }
  return moved;
}

void TileInterest::set_waiting(const ChunkKey& key) {
  RUNSTONE_ASSERT(status(key) == TileStatus::wanted);
  set(key, TileStatus::waiting);
}

void TileInterest::want_again(const ChunkKey& key) {
  RUNSTONE_ASSERT(is_requested_or_sent(status(key)));
  set(key, TileStatus::wanted);
}

void TileInterest::set_behind(const ChunkKey& key) {
  RUNSTONE_ASSERT(status(key) == TileStatus::sent && is_hidden(key));
  set(key, TileStatus::behind);
}

bool TileInterest::is_hidden(const ChunkKey& key) const {
  RUNSTONE_ASSERT(key.lod >= 1 && key.lod <= kTileLevelMax);
  const std::int32_t margin = view_->radius_h < kHiddenMarginRadius ? 0 : kHiddenMargin;
  const std::int64_t radius_h = view_->radius_h - margin;
  const std::int32_t radius_v = (key.lod == 1 ? view_->radius_v : kTileRadiusV) - margin;
  const ChunkCoord centre = tile_at(view_->centre, static_cast<std::uint8_t>(key.lod - 1));
  for (unsigned i = 0; i < kTileChildren; ++i) {
    const ChunkKey child_key = tile_child(key, i);
    const ChunkCoord child = child_key.at;
    const std::int64_t dx = std::int64_t{child.x} - centre.x, dz = std::int64_t{child.z} - centre.z;
    if (dx * dx + dz * dz > radius_h * radius_h || std::abs(child.y - centre.y) > radius_v)
      return false;
    if (child_key.lod > 0 && has_place(limit_, child_key) && !client_has(status(child_key)))
      return false;
  }
  return true;
}

std::vector<ChunkKey> TileInterest::set_sent(const ChunkKey& key, bool is_empty) {
  RUNSTONE_ASSERT(is_requested_or_sent(status(key)));
  std::vector<ChunkKey> left;
  set(key, is_empty ? TileStatus::sent_empty : TileStatus::sent);
  if (is_empty) {
    drop_below(key, left);
  } else if (key.lod > 1) {
    for (unsigned i = 0; i < kTileChildren; ++i) {
      const ChunkKey child = tile_child(key, i);
      if (has_key(*view_, limit_, child) && status(child) == TileStatus::unknown)
        set(child, TileStatus::wanted);
    }
  }
  return left;
}

std::vector<ChunkKey> TileInterest::clear() {
  std::vector<ChunkKey> left = known();
  std::erase_if(left,
                [this](const ChunkKey& key) { return !is_requested_or_sent(tiles_.at(key)); });
  tiles_.reset(0);
  queue_.clear();
  behind_.clear();
  waiting_ = 0;
  known_ = {};
  view_.reset();
  return left;
}

}  // namespace runstone
