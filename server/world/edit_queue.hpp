// EditQueue: the edits that were accepted and are not ordered yet. Clients take turns with one edit
// each, and a commit holds a bounded amount of work. So an edit waits for the commit under way and
// for at most one costly edit of each other client, however many they have sent. The edits of one
// client keep their order.
// Bound: the caller's (WorldState::environment.log_has_room(), is_memory_full()).
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"

namespace runstone {

struct EditOffer {
  OperationId op;
  Cause cause = Cause::player;
  TimeUs submitted_us = 0;
  EditDescriptor edit;
  Sequence subject = 0;  // the edit that this rollback, undo or redo is about; 0: none
};

class EditQueue {
 public:
  explicit EditQueue(std::int32_t chunk_edge) : chunk_edge_(chunk_edge) {}

  void push(const EditOffer& offer);
  /// Removes and returns the edits of the next commit, in their order. The result is empty only if
  /// no edit waits. Cost: O(edits + clients) * log clients.
  std::vector<EditOffer> take();

  std::size_t size() const { return size_; }
  /// Returns the bytes of memory that the edits take.
  std::size_t bytes() const { return bytes_; }

 private:
  struct Waiting {
    EditOffer offer;
    std::size_t work;
  };
  using Client = std::pair<AuthorId, ClientInstance>;

  std::int32_t chunk_edge_;
  std::map<Client, std::deque<Waiting>> lanes_;  // no lane is empty
  Client turn_{};                                // whose turn begins the next commit
  std::size_t size_ = 0, bytes_ = 0;
};

}  // namespace runstone
