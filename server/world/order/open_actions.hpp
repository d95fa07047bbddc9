// OpenActions: remembers, for each client whose newest edit belongs to an action of several edits,
// the first edit of this action that was ordered. The edits that follow name it as their subject,
// so that an undo finds all of them in the log. An action is forgotten
//   - when the server ends;
//   - when more than kClientsMax clients have one: the action that began first is forgotten.
// The rest of a forgotten action is an action by itself. One thread.
#pragma once
#include <cstddef>
#include <iterator>
#include <list>
#include <map>
#include <utility>

#include "common/core/ids.hpp"
#include "protocol/limits.hpp"

namespace runstone {

class OpenActions {
 public:
  static constexpr std::size_t kClientsMax = 4'096;

  /// Takes an edit of a player that gets the sequence `seq`, in log order. Returns the first edit
  /// of its action, or 0 if the edit is the first one or an action by itself. An action has at most
  /// kActionEditsMax edits; the next edit begins another one. Cost: O(log clients).
  Sequence order(const OperationId& op, ClientSequence action, Sequence seq) {
    const Client client{op.author, op.instance};
    const auto found = open_.find(client);
    if (action == 0) {
      if (found != open_.end()) forget(found);
      return 0;
    }
    if (found != open_.end() && found->second.action == action &&
        found->second.edits < kActionEditsMax) {
      ++found->second.edits;
      return found->second.first;
    }
    if (found != open_.end()) forget(found);
    by_age_.push_back(client);
    open_.emplace(client, Open{action, seq, 1, std::prev(by_age_.end())});
    if (open_.size() > kClientsMax) forget(open_.find(by_age_.front()));
    return 0;
  }
  std::size_t size() const { return open_.size(); }

 private:
  using Client = std::pair<AuthorId, ClientInstance>;
  struct Open {
    ClientSequence action = 0;
    Sequence first = 0;
    std::size_t edits = 0;
    std::list<Client>::iterator age;
  };
  void forget(std::map<Client, Open>::iterator at) {
    by_age_.erase(at->second.age);
    open_.erase(at);
  }

  std::map<Client, Open> open_;
  std::list<Client> by_age_;  // the clients of open_; the one whose action began first is in front
};

}  // namespace runstone
