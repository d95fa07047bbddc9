// EventQueue: the events of a WorldClient that were not drained yet. If the queue is full, the
// oldest event of the same kind is dropped. Two kinds are never dropped: events of edits of this
// client, whose number the caller bounds, and events of removed chunks, of which there are at most
// as many as reported chunks. All chunks that edits of others name share one bound, because one
// edit of a server may name all chunks of the view. Thread: one.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <iterator>
#include <utility>
#include <variant>
#include <vector>

#include "client/api/world_event.hpp"

namespace runstone {

class EventQueue {
 public:
  static constexpr std::size_t kEventsMax = 4'096;  // of a kind
  /// The greatest number of chunks that all events of edits of others name, 12 MiB. The newest
  /// event is kept even if it names more.
  static constexpr std::size_t kNamedChunksMax = std::size_t{1} << 20;

  void push(WorldEvent event) {
    const std::size_t kind = event.index();
    if (counts_[kind] >= kEventsMax && !is_of_edit(event) &&
        !std::holds_alternative<ChunkRemoved>(event))
      drop_oldest(kind);
    named_chunks_ += named_by(event);
    while (named_by(event) != 0 && named_chunks_ > kNamedChunksMax && counts_[kind] != 0)
      drop_oldest(kind);
    if (is_of_edit(event)) ++edit_events_;
    ++counts_[kind];
    events_.push_back(std::move(event));
  }
  /// Returns the number of events of edits of this client.
  std::size_t edit_events() const { return edit_events_; }
  std::vector<WorldEvent> drain() {
    std::vector<WorldEvent> out(std::make_move_iterator(events_.begin()),
                                std::make_move_iterator(events_.end()));
    events_.clear();
    counts_ = {};
    edit_events_ = named_chunks_ = 0;
    return out;
  }

 private:
  /// Drops the oldest event of a kind. Requires that there is one.
  void drop_oldest(std::size_t kind) {
    const auto oldest = std::find_if(events_.begin(), events_.end(), [&](const WorldEvent& event) {
      return event.index() == kind;
    });
    named_chunks_ -= named_by(*oldest);
    events_.erase(oldest);
    --counts_[kind];
  }
  static std::size_t named_by(const WorldEvent& event) {
    const auto* const edit = std::get_if<OthersEdit>(&event);
    return edit == nullptr ? 0 : edit->chunks.size();
  }
  static bool is_of_edit(const WorldEvent& event) {
    return std::holds_alternative<EditConfirmed>(event) ||
           std::holds_alternative<EditRejected>(event) ||
           std::holds_alternative<EditDurable>(event) || std::holds_alternative<EditUnseen>(event);
  }

  std::deque<WorldEvent> events_;
  std::array<std::size_t, std::variant_size_v<WorldEvent>> counts_{};
  std::size_t edit_events_ = 0;
  std::size_t named_chunks_ = 0;  // by events of edits of others
};

}  // namespace runstone
