// VersionTracker: what a headless bot knows of the world: the sequence of each chunk in view, and
// no voxels. It follows snapshots and commits by the rules of docs/protocol.md, "Order", and
// reports a server that breaks them:
//   - An edit continues the version of its chunk, or is contained in the snapshot. Otherwise the
//     server may have marked the chunk stale because the queue of this session was full. Then it
//     sends a snapshot within kResendUsMax, without a request.
//   - A digest check may name a version newer than what arrived for kResendUsMax at most.
//   - The digest of a snapshot is that of its voxels.
//   - A tile lies in the view, or in one before it. It has no edits.
//   - Edits in place of a snapshot answer claims only, and this client makes none.
//   - An answer names a view that was sent.
//   - When the view is complete, every chunk of it was answered.
// A chunk that is not sent again in time is a violation, and is requested. Pure: times are
// arguments. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "client/bots/tile_answers.hpp"
#include "client/replica/recent_views.hpp"
#include "client/schedule/histogram.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/codec/view_size.hpp"

namespace runstone {

/// Bound of the time until the server sends a chunk again after it dropped edits of it.
inline constexpr TimeUs kResendUsMax = 5'000'000;
/// Bound of the edits held back per chunk. Beyond it, only the newest sequence is remembered.
inline constexpr std::size_t kWaitingLinksMax = 1024;

/// The rules that a server broke: how often, by name, and a description of the first case of each.
class Violations {
 public:
  void add(const std::string& name, std::string what);
  void merge(const Violations& other);
  struct Entry {
    std::uint64_t count = 0;
    std::string first;
  };
  const std::map<std::string, Entry>& all() const { return all_; }
  std::uint64_t total() const;

 private:
  std::map<std::string, Entry> all_;
};

/// Counts since the tracker was made. An edit counts once per chunk in view.
struct VersionCounts {
  std::uint64_t snapshots = 0;         // verified, digest included
  std::uint64_t tiles = 0;             // of them and of uniform ones: tiles of distant ground
  std::uint64_t stale = 0;             // older than what is known: allowed, and ignored
  std::uint64_t outside = 0;           // answers for chunks that are not in view, or left it since
  std::uint64_t followed = 0;          // chunk edits that continued the version of their chunk
  std::uint64_t contained = 0;         // chunk edits that a snapshot contained
  std::uint64_t held_back = 0;         // chunk edits that arrived before their snapshot
  std::uint64_t resent = 0;            // snapshots in place of commits that did not arrive
  std::uint64_t versions_checked = 0;  // versions compared with digest checks
  Histogram behind_us;  // of chunks sent again: since the first sign of a missing edit
  void merge(const VersionCounts& other);
};

class VersionTracker {
 public:
  /// Opens a connection. All chunks of the view that the world has are expected again.
  void open(Epoch epoch, CoordLimit world);
  /// Another server has taken the world over, and chunks may be of this epoch from now on.
  void raise_epoch(Epoch epoch) { epoch_ = epoch; }
  /// Forgets the chunks outside of the view. The view was sent with its number.
  void set_view(const View& view);

  void receive(const Chunks& chunks, TimeUs now_us);
  void receive(const UniformChunks& uniform, TimeUs now_us);
  void receive(const ChunkUnavailable& unavailable);
  /// Every chunk of the view of this number was answered.
  void complete(std::uint32_t view);
  void receive(const DigestCheck& check, TimeUs now_us);
  /// An edit of a commit touches this chunk, whose sequence was `previous` before it.
  void follow(ChunkCoord at, Sequence previous, Sequence seq, TimeUs now_us);
  /// Finds chunks that were not sent again in time. Cost: O(1) while none is behind.
  void tick(TimeUs now_us);
  /// Returns the chunks to request from the server, ascending.
  std::vector<ChunkKey> take_requests();

  /// Returns the number of chunks of the view that arrived or are unavailable.
  std::size_t known() const { return held_ + unavailable_; }
  /// Returns the number of chunks that lack edits.
  std::size_t behind() const { return behind_; }
  /// Returns true if every tile of the view that has an answer arrived. Requires a view with tiles.
  bool tiles_are_complete() const { return tiles_.are_complete(*views_.current(), world_); }
  /// Returns the sequence of a chunk, or nullopt if it has not arrived.
  std::optional<Sequence> version(ChunkCoord at) const;
  const VersionCounts& counts() const { return counts_; }
  Violations& violations() { return violations_; }
  const Violations& violations() const { return violations_; }

 private:
  struct Link {
    Sequence previous = 0, seq = 0;
  };
  struct Known {
    Sequence at = 0, latest = 0;  // sequence reached; newest one seen
    bool held = false, unavailable = false;
    std::optional<TimeUs> behind_us;  // since when edits are missing
    bool is_asked = false;            // a request was made
    std::vector<Link> waiting;        // ascending
  };
  void take(const ChunkSnapshot& snapshot, std::uint32_t view, TimeUs now_us);
  bool accepts(const ChunkKey& key, std::uint32_t view);
  void take(const ChunkKey& key, std::uint32_t view, Version version, bool is_empty, TimeUs now_us);
  void take_tile(const ChunkKey& key, std::uint32_t view, bool is_empty);
  void advance(Known& chunk, TimeUs now_us);
  void forget(const Known& chunk);

  Epoch epoch_ = 0;
  CoordLimit world_;
  RecentViews views_;
  std::map<ChunkCoord, Known> chunks_;
  std::size_t held_ = 0, unavailable_ = 0, behind_ = 0;
  TileAnswers tiles_;
  std::set<ChunkKey> requests_;
  VersionCounts counts_;
  Violations violations_;
};

}  // namespace runstone
