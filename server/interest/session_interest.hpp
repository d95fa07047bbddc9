// SessionInterest: the chunks one session sees or waits for. Every chunk of its view is in one state:
//   wanted       in the queue, nearest first
//   waiting      not in memory: a load was asked for
//   subscribed   a snapshot was sent; every later commit that touches the chunk goes to the session
//   unavailable  it could not be loaded, and the session was told; loading again would fail again
// One thread.
#pragma once
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"
#include "protocol/codec/messages.hpp"
#include "server/interest/view_cells.hpp"

namespace runstone {

enum class ChunkInterest { wanted, waiting, subscribed, unavailable };

class SessionInterest {
 public:
  explicit SessionInterest(CoordLimit limit) : limit_(limit) {}

  struct Left {  // chunks that left the view
    ChunkKey key;
    ChunkInterest was;
  };
  /// Moves the view: new chunks become wanted, those outside are forgotten and returned.
  /// O(columns + chunks that change + wanted log wanted).
  std::vector<Left> set_view(const View& view);
  const std::optional<View>& view() const { return view_; }

  /// Nearest wanted chunk (ties by key), which stays wanted. Amortised O(log wanted).
  std::optional<ChunkKey> nearest_wanted();

  std::optional<ChunkInterest> state(const ChunkKey& key) const;
  /// Requires a chunk of the view.
  void set_state(const ChunkKey& key, ChunkInterest state);

  std::size_t count(ChunkInterest state) const { return counts_[static_cast<std::size_t>(state)]; }
  /// All chunks of the view, ascending.
  const std::map<ChunkKey, ChunkInterest>& chunks() const { return chunks_; }
  /// Next subscribed chunk after the one returned last time, going round; for audits.
  std::optional<ChunkKey> next_for_audit();

 private:
  std::size_t& counter(ChunkInterest state) { return counts_[static_cast<std::size_t>(state)]; }
  void forget(const ChunkKey& key);

  CoordLimit limit_;
  std::optional<View> view_;
  std::map<ChunkKey, ChunkInterest> chunks_;
  std::array<std::size_t, 4> counts_{};
  // Farthest first, so that the nearest is popped from the back. May hold keys that are not wanted any more:
  // nearest_wanted() drops them when it meets them.
  std::vector<ChunkKey> queue_;
  bool queue_sorted_ = true;
  std::optional<ChunkKey> audited_;
};

}  // namespace runstone
