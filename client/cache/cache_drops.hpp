// CacheDrops: which rows of a world a cache drops when the server of the world describes it in
// another way than before. Pure.
#pragma once
#include "client/replica/cache_lookup.hpp"
#include "client/replica/shared_history.hpp"

namespace runstone {

struct CacheDrops {
  bool all = false;     // the chunks have another size
  bool edited = false;  // rows with edits: the server stands on a restored backup, or lost edits
  bool lost = false;    // rows above the sequence `common` whose epoch is below `epoch`
  bool tiles = false;   // the server makes tiles by other rules
  Sequence common = 0;
  Epoch epoch = 0;

  bool any() const { return all || edited || lost || tiles; }
};

/// Returns what to drop. `before`: the world as it was described last. If `now` has no rules for
/// tiles, those of `before` stay in force.
inline CacheDrops drops_of(const CachedWorld& before, const CachedWorld& now) {
  CacheDrops out;
  const SharedHistory kept(before.mark, now.mark);
  out.all = before.chunk_edge != now.chunk_edge;
  out.edited = !out.all && kept.went_back();
  out.lost = !out.all && !out.edited && before.mark.epoch != now.mark.epoch;
  out.tiles = now.tile_rules != 0 && before.tile_rules != now.tile_rules;
  out.common = kept.common();
  out.epoch = now.mark.epoch;
  return out;
}

}  // namespace runstone
