// SessionInterest: the chunks that one session sees or waits for. Every chunk of its view is in one
// state:
//   wanted           in the queue, in the order of the view (ViewOrder). All chunks begin in this
//                    state, so it has no entry in a table: a client that moves its view often costs
//                    its queue only.
//   waiting          not in memory; its load is requested.
//   subscribed       a snapshot was sent; every later commit that touches the chunk goes to the
//                    session.
//   unavailable      it could not be loaded, and the session got "chunk unavailable". Loading would
//                    fail again.
//   loading_history  the session sees the past, and a worker makes the chunk as it was.
//   history_sent     the session has the chunk as it was. It gets no commits.
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

enum class ChunkInterest {
  wanted,
  waiting,
  subscribed,
  unavailable,
  loading_history,
  history_sent
};

class SessionInterest {
 public:
  explicit SessionInterest(CoordLimit limit) : limit_(limit) {}

  struct Left {
    ChunkKey key;
    ChunkInterest was;
  };
  struct Moved {
    std::vector<Left> left;  // chunks that left the view and were not wanted
    std::size_t steps = 0;   // chunks visited: the cost of the call
  };
  /// Sets the view: new chunks become wanted, chunks outside are removed, and wanted chunks get the
  /// new order. Cost: O((columns + chunks that change + wanted) * log entries); O(wanted) if only
  /// the direction changes.
  Moved set_view(const View& view);
  const std::optional<View>& view() const { return view_; }

  /// Returns the first wanted chunk in the view's order, or nullopt. It stays wanted.
  /// Cost: O(log wanted), amortised.
  std::optional<ChunkKey> nearest_wanted();

  /// Returns nullopt for a chunk outside of the view.
  std::optional<ChunkInterest> state(const ChunkKey& key) const;
  /// Requires a chunk of the view. Cost: O(log view).
  void set_state(const ChunkKey& key, ChunkInterest state);

  /// Returns the number of chunks in a state. Requires a state other than wanted.
  std::size_t count(ChunkInterest state) const { return counts_[static_cast<std::size_t>(state)]; }
  /// Returns all chunks of the view that are not wanted, ascending.
  const std::map<ChunkKey, ChunkInterest>& chunks() const { return chunks_; }
  /// Returns the subscribed chunk after the one returned last, round robin, or nullopt if there is
  /// none.
  std::optional<ChunkKey> next_for_digest_check();

 private:
  std::size_t& counter(ChunkInterest state) { return counts_[static_cast<std::size_t>(state)]; }
  /// Returns the chunks of the queue that are wanted. A chunk that is twice in the queue is there
  /// twice.
  std::vector<ChunkCoord> wanted() const;
  /// Requires a chunk of the view.
  bool is_wanted(ChunkCoord at) const { return !chunks_.contains({0, at}); }
  void pop_nearest();
  /// Makes the queue of these chunks in the order of the view.
  void set_queue(const View& view, const std::vector<ChunkCoord>& chunks);

  CoordLimit limit_;
  std::optional<View> view_;
  std::map<ChunkKey, ChunkInterest> chunks_;  // without the wanted ones
  std::array<std::size_t, 6> counts_{};
  std::optional<ViewOrder> order_;  // of view_
  // A heap of places in order_, the lowest on top. It contains every wanted chunk. Some entries are
  // not wanted any more, or are there twice: nearest_wanted() drops those it meets, set_view() all
  // of them.
  std::vector<ViewOrder::Place> queue_;
  std::optional<ChunkKey> digest_checked_;
};

}  // namespace runstone
