// DueTimes: when the edits of all bots of this process were due, on its one steady clock. A bot that receives an edit of another
// one looks here, so no clock is estimated. Bound: of each client instance the newest kLocalEditsMax edits, as many as may be
// without an answer. One thread.
#pragma once
#include <deque>
#include <optional>
#include <unordered_map>

#include "client/replica/local_edits.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class DueTimes {
 public:
  /// Sequences of an instance ascend.
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
  /// Nothing for an edit that none of the bots here made.
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
  std::unordered_map<ClientInstance, Row> rows_;  // only looked up
};

}  // namespace runstone
