// SessionInterest: the chunks one session sees or waits for. Every chunk of its view is in one state:
//   wanted       in the queue, in the order of the view (ViewOrder); the state of all chunks nothing was done for yet, so it
//                costs no entry: a peer that looks elsewhere again and again pays for its queue, not for a table
//   waiting      not in memory: a load was asked for
//   subscribed   a snapshot was sent; every later commit that touches the chunk goes to the session
//   unavailable  it could not be loaded, and the session was told; loading again would fail again
//   recalling    the session looks at the past, and the chunk as it was then is being made
//   recalled     the session has it as it was; commits do not concern it
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
#include "server/interest/view_order.hpp"

namespace runstone {

enum class ChunkInterest { wanted, waiting, subscribed, unavailable, loading_history, recalled };

class SessionInterest {
 public:
  explicit SessionInterest(CoordLimit limit) : limit_(limit) {}

  struct Left {
    ChunkKey key;
    ChunkInterest was;
  };
  struct Moved {
    std::size_t entered = 0;  // chunks that came into the view
    std::vector<Left> left;   // those that left it and were not wanted
    std::size_t steps = 0;    // chunks looked at: what it cost
  };
  /// Moves the view: new chunks become wanted, those outside are forgotten, and what is wanted is put in the new
  /// order. O(columns + chunks that change + wanted), times log of the entries; O(wanted) if it only turns.
  Moved set_view(const View& view);
  const std::optional<View>& view() const { return view_; }

  /// The wanted chunk that comes first in the view's order, which stays wanted. Amortised O(log wanted).
  std::optional<ChunkKey> nearest_wanted();

  /// Nothing for a chunk outside of the view.
  std::optional<ChunkInterest> state(const ChunkKey& key) const;
  /// Requires a chunk of the view. O(log view).
  void set_state(const ChunkKey& key, ChunkInterest state);

  /// Chunks in a state other than wanted.
  std::size_t count(ChunkInterest state) const { return counts_[static_cast<std::size_t>(state)]; }
  /// All chunks of the view that are not wanted, ascending.
  const std::map<ChunkKey, ChunkInterest>& chunks() const { return chunks_; }
  /// Next subscribed chunk after the one returned last time, going round; for audits.
  std::optional<ChunkKey> next_for_audit();

 private:
  std::size_t& counter(ChunkInterest state) { return counts_[static_cast<std::size_t>(state)]; }
  bool is_wanted(const ChunkKey& key) const {
    return !chunks_.contains(key);
  }  // of a key in the queue
  void pop_nearest();
  void set_order(const View& view);

  CoordLimit limit_;
  std::optional<View> view_;
  std::map<ChunkKey, ChunkInterest> chunks_;  // but the wanted ones
  std::array<std::size_t, 6> counts_{};
  std::optional<ViewOrder> order_;  // of view_
  // A heap with the first one on top, of chunks of the view only. Holds every wanted chunk, and some that are
  // not wanted any more or twice in it: nearest_wanted() drops those it meets, set_view() all of them.
  std::vector<ChunkKey> queue_;
  std::optional<ChunkKey> audited_;
};

}  // namespace runstone
