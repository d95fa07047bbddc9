// EditQueue: the edits that were accepted and are not ordered yet. Clients take turns with one edit
// each, and a commit holds a bounded amount of work. So an edit waits for the commit under way and
// for at most one costly edit of each other client, however many they have sent. The edits of one
// client keep their order. A large edit of a player also waits until LargeEditPace has room, and
// those of its client wait behind it.
// Bounds: the caller's (Order::log_has_room(), Order::is_memory_full()), and for large
// edits has_room_for().
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"

namespace runstone {

struct EditOffer {
  OperationId op;
  Cause cause = Cause::player;
  TimeUs submitted_us = 0;
  EditDescriptor edit;
  Sequence subject = 0;  // the edit that this rollback, undo or redo is about; 0: none
  /// For an edit of a player: the client sequence of the first edit of its action; 0: none.
  ClientSequence action = 0;
  TimeUs arrived_us = 0;  // an edit of a player: when it was accepted, by the server's steady clock
  bool is_of_large_action = false;  // `action` is remembered by LargeActions
};

/// Returns the work of an edit: an upper bound of its bytes in a commit message, in which its
/// chunks weigh more because each of them is swept. Materials, shapes and textures are in no such
/// message, and have so little work that kCommitEditsMax of them are one commit. Cost: O(1);
/// stroke: O(points).
std::size_t edit_work(const EditDescriptor& edit, std::int32_t chunk_edge);
/// Returns true if an edit with this work waits for room: a large edit of a player.
constexpr bool waits_for_room(std::size_t work, Cause cause) {
  constexpr std::size_t kSmallWork = 4 * 1024;
  return work > kSmallWork && cause == Cause::player;
}
/// Room for all large edits that wait.
inline constexpr std::uint64_t kAllLargeEdits = std::numeric_limits<std::uint64_t>::max();

class EditQueue {
 public:
  /// The work of large edits that may wait; the last one may exceed it.
  static constexpr std::size_t kWaitingWorkMax = 16 * 1024 * 1024;
  /// The work of large edits that may wait if no edit of the author waits. It is higher, so that
  /// many waiting edits of others keep nobody out.
  static constexpr std::size_t kFirstWaitingWorkMax = 4 * kWaitingWorkMax;

  explicit EditQueue(std::int32_t chunk_edge) : chunk_edge_(chunk_edge) {}

  /// Returns false for a large edit of this player if the large edits that wait have too much work
  /// together. Such an edit is refused: nobody knows when it would be ordered, and a stop orders
  /// all that wait. Cost: that of edit_work(), O(log clients).
  bool has_room_for(const EditDescriptor& edit, AuthorId author) const;
  void push(const EditOffer& offer);
  /// Removes and returns the edits of the next commit, in their order. `large_room` is the work of
  /// large edits of players that it may have; the last one may exceed it, and at 0 there is none.
  /// The result is empty only if has_ready(large_room > 0) is false. Cost: O(edits + clients) * log
  /// clients.
  std::vector<EditOffer> take(std::uint64_t large_room = kAllLargeEdits);
  /// Returns true if the next take() returns edits.
  bool has_ready(bool has_large_room) const {
    return has_large_room ? size_ > 0 : lanes_.size() > large_fronts_;
  }

  /// Returns true if the operation waits. Requires that the operations of a client were pushed in
  /// ascending order. Cost: O(log edits).
  bool has(const OperationId& op) const;
  /// Returns the newest waiting edit of each client of the author. Cost: O(log clients).
  std::vector<OperationId> newest_of(AuthorId author) const;
  /// Returns true if an edit of the author waits. Cost: O(log clients).
  bool has_of(AuthorId author) const;
  std::size_t size() const { return size_; }
  /// Returns the bytes of memory that the edits take.
  std::size_t bytes() const { return bytes_; }

 private:
  struct Waiting {
    EditOffer offer;
    std::size_t work;
    bool is_large() const { return waits_for_room(work, offer.cause); }
  };
  /// Edits of the server that have a client's author and instance are in a lane of their own.
  using Client = std::tuple<AuthorId, ClientInstance, bool>;
  using Lanes = std::map<Client, std::deque<Waiting>>;

  /// Removes the lane's first edit, and the lane if it was the last. Returns the next lane.
  Lanes::iterator pop(Lanes::iterator lane);

  std::int32_t chunk_edge_;
  Lanes lanes_;                   // no lane is empty
  std::size_t large_fronts_ = 0;  // lanes whose first edit waits for room
  std::size_t large_work_ = 0;    // of all edits that wait for room
  Client turn_{};                 // whose turn begins the next commit
  std::size_t size_ = 0, bytes_ = 0;
};

}  // namespace runstone
