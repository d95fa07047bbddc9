// VersionTracker: what a light bot knows of the world: of each chunk in view the sequence it stands at, and no voxels. It follows
// snapshots and commits by the rules of docs/protocol.md, "Order", and says where a server broke them:
//   - an edit continues its chunk's version, or is in the snapshot already; where neither holds, the server may have marked
//     the chunk stale because this session's queue was full, and sends a snapshot on its own within kResendUsMax;
//   - an audit may not name a newer version than what came, but for as long;
//   - the digest of a snapshot is that of its voxels.
// A chunk that is not resent in time is a violation, and asked for. Pure: times are arguments. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/schedule/histogram.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// How long a chunk that the server dropped edits of may take to be sent again.
inline constexpr TimeUs kResendUsMax = 5'000'000;
inline constexpr std::size_t kWaitingLinksMax =
    1024;  // edits held back per chunk; more: only the newest is remembered

/// What a server did that it must not do: by name, with how often. The first one of each is described.
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

/// Counts since the book was made. An edit counts once per chunk in view.
struct VersionCounts {
  std::uint64_t snapshots = 0;  // verified, digest included
  std::uint64_t stale = 0;      // of them older than what was known: legal, and ignored
  std::uint64_t outside = 0;    // of chunks that are not in view any more
  std::uint64_t followed = 0;   // chunk edits that continued their chunk's version
  std::uint64_t contained = 0;  // that a snapshot had already
  std::uint64_t held_back = 0;  // that came ahead of their snapshot
  std::uint64_t resent = 0;     // snapshots that stood for commits which did not come
  std::uint64_t audited = 0;    // versions of audits compared
  Histogram behind_us;          // of resent chunks: from the first sign that something is missing
  void merge(const VersionCounts& other);
};

class VersionTracker {
 public:
  /// A connection opens: all chunks are expected anew.
  void open(Epoch epoch);
  /// Chunks outside are forgotten.
  void set_view(const View& view);

  void receive(const ChunkSnapshot& snapshot, TimeUs now_us);
  void receive(const UniformChunks& uniform, TimeUs now_us);
  void receive(const ChunkUnavailable& unavailable);
  void receive(const DigestCheck& audit, TimeUs now_us);
  /// One edit of a commit touches this chunk, which stood at `previous` before.
  void follow(ChunkCoord at, Sequence previous, Sequence seq, TimeUs now_us);
  /// Looks for chunks that were not resent in time. O(1) while none is behind.
  void tick(TimeUs now_us);
  /// Chunks to ask the server for.
  std::vector<ChunkKey> take_requests();

  /// Chunks of the view that came, or are said not to be had.
  std::size_t known() const { return held_ + unavailable_; }
  /// Chunks that lack edits.
  std::size_t behind() const { return behind_; }
  /// The version's sequence of a chunk that came.
  std::optional<Sequence> version(ChunkCoord at) const;
  const VersionCounts& counts() const { return counts_; }
  Violations& violations() { return violations_; }
  const Violations& violations() const { return violations_; }

 private:
  struct Link {
    Sequence previous = 0, seq = 0;
  };
  struct Known {
    Sequence at = 0, latest = 0;  // stands at; newest edit heard of
    bool held = false, unavailable = false;
    std::optional<TimeUs> behind_us;  // since when edits are missing
    bool is_asked = false;            // it was too long
    std::vector<Link> waiting;        // ascending
  };
  void take(const ChunkKey& key, Version version, TimeUs now_us);
  void settle(Known& chunk, TimeUs now_us);
  void forget(const Known& chunk);

  Epoch epoch_ = 0;
  std::optional<View> view_;
  std::map<ChunkCoord, Known> chunks_;
  std::size_t held_ = 0, unavailable_ = 0, behind_ = 0;
  std::vector<ChunkKey> requests_;
  VersionCounts counts_;
  Violations violations_;
};

}  // namespace runstone
