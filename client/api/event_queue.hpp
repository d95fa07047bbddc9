// EventQueue: the events of a WorldClient that were not drained yet. Full: the oldest event of the
// same kind is dropped, except of edits of this client, which the caller bounds, and of removed
// chunks, of which there are no more than were reported. One thread.
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

  void push(WorldEvent event) {
    const std::size_t kind = event.index();
    if (counts_[kind] >= kEventsMax && !is_of_edit(event) &&
        !std::holds_alternative<ChunkRemoved>(event)) {
      const auto oldest =
          std::find_if(events_.begin(), events_.end(),
                       [&](const WorldEvent& other) { return other.index() == kind; });
      events_.erase(oldest);
      --counts_[kind];
    }
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
    edit_events_ = 0;
    return out;
  }

 private:
  static bool is_of_edit(const WorldEvent& event) {
    return std::holds_alternative<EditConfirmed>(event) ||
           std::holds_alternative<EditRejected>(event) ||
           std::holds_alternative<EditDurable>(event) || std::holds_alternative<EditUnseen>(event);
  }

  std::deque<WorldEvent> events_;
  std::array<std::size_t, std::variant_size_v<WorldEvent>> counts_{};
  std::size_t edit_events_ = 0;
};

}  // namespace runstone
