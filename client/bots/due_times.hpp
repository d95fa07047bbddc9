// DueTimes: when the edits of all bots of this process were due, on its steady clock. A bot that
// receives an edit of another bot looks the due time up here, so that no clock offset is estimated.
// Bound: the newest kLocalEditsMax edits per client instance, because more cannot wait for an
// answer. One thread.
#pragma once
#include <deque>
#include <optional>
#include <unordered_map>

#include "client/replica/local_edits.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class DueTimes {
 public:
  /// Adds a due time. Requires ascending sequences per instance.
  void add(ClientInstance instance, ClientSequence seq, TimeUs due_us) {
    Row& row = rows_[instance];
    if (row.due_us.empty() || seq != row.first + row.due_us.size()) {
      row.due_us.clear();
      row.first = seq;
    }
    row.due_us.push_back(due_us);
    if (row.due_us.size() > kLocalEditsMax) {
      row.due_us.pop_front();
      ++row.first;
    }
  }
  /// Returns nullopt for an edit that no bot of this process made.
  std::optional<TimeUs> find(ClientInstance instance, ClientSequence seq) const {
    const auto found = rows_.find(instance);
    if (found == rows_.end()) return std::nullopt;
    const Row& row = found->second;
    if (seq < row.first || seq - row.first >= row.due_us.size()) return std::nullopt;
    return row.due_us[seq - row.first];
  }

 private:
  struct Row {
    ClientSequence first = 0;
    std::deque<TimeUs> due_us;
  };
  std::unordered_map<ClientInstance, Row> rows_;  // never iterated
};

}  // namespace runstone
