// LargeActions: remembers the newest actions of the clients that have the feature large actions: the
// first edit of each that was ordered, which the edits that follow name as their subject. So an undo
// finds all of them in the log. What is forgotten is found in the log again (find_action()), because
// an action is named by the operation of its first edit. Forgotten are
//   - all, when the server ends;
//   - of a client with more than kActionsOfClientMax, the action whose newest edit is oldest;
//   - the actions of the client whose newest edit is oldest, if more than kClientsMax have any.
// One thread.
#pragma once
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <list>
#include <map>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"

namespace runstone {

class LargeActions {
 public:
  static constexpr std::size_t kClientsMax = 4'096;
  static constexpr std::size_t kActionsOfClientMax = 8;

  enum class Standing {
    unknown,  // not remembered: the log may have it
    open,     // it takes edits
    ended,    // the player has undone it: it takes no more edits
  };

  /// `first_op` is the operation of the first edit of an action. Cost: O(log clients).
  Standing find(const OperationId& first_op) const {
    const auto client = clients_.find({first_op.author, first_op.instance});
    if (client == clients_.end()) return Standing::unknown;
    const auto action = find_in(client->second.actions, first_op.seq);
    if (action == client->second.actions.end()) return Standing::unknown;
    return action->is_ended ? Standing::ended : Standing::open;
  }
  /// Returns the sequence of the first edit of an action, or 0 if it is not ordered or not remembered.
  Sequence first_of(const OperationId& first_op) const {
    const auto client = clients_.find({first_op.author, first_op.instance});
    if (client == clients_.end()) return 0;
    const auto action = find_in(client->second.actions, first_op.seq);
    return action == client->second.actions.end() ? 0 : action->first;
  }
  /// Notes that the first edit of an action was accepted. It is ordered later.
  void begin(const OperationId& first_op) { add(first_op, {first_op.seq, 0, 0, false}); }
  /// Notes what the log has of an action: the sequence of its first edit.
  void remember(const OperationId& first_op, Sequence first, bool is_ended) {
    add(first_op, {first_op.seq, first, first, is_ended});
  }
  /// Takes an edit of an action that gets the sequence `seq`, in log order. Returns the first edit of
  /// the action, or 0 if it is the first one. An action that was forgotten since its edit was accepted
  /// begins anew. Cost: O(log clients).
  Sequence order(const OperationId& op, ClientSequence action, Sequence seq) {
    const auto client = clients_.find({op.author, op.instance});
    if (client != clients_.end()) {
      std::vector<Open>& actions = client->second.actions;
      const auto found = actions.begin() + (find_in(actions, action) - actions.cbegin());
      if (found != actions.end()) {
        std::rotate(found, std::next(found), actions.end());
        by_use_.splice(by_use_.end(), by_use_, client->second.place);
        Open& open = actions.back();
        open.last = seq;
        if (open.first != 0) return open.first;
        open.first = seq;
        return 0;
      }
    }
    add({op.author, op.instance, action}, {action, seq, seq, false});
    return 0;
  }
  /// Ends the action of the author whose first edit is `first`: it takes no more edits. Returns the
  /// newest edit of the action that was ordered, or 0 if the action is not remembered. Cost: O(clients
  /// of the author).
  Sequence end(AuthorId author, Sequence first) {
    Sequence last = 0;
    for (auto client = clients_.lower_bound({author, 0});
         client != clients_.end() && client->first.first == author; ++client) {
      for (Open& open : client->second.actions) {
        if (open.first != first) continue;
        open.is_ended = true;
        last = std::max(last, open.last);
      }
    }
    return last;
  }
  /// Returns the number of clients.
  std::size_t size() const { return clients_.size(); }

 private:
  using Client = std::pair<AuthorId, ClientInstance>;
  struct Open {
    ClientSequence action = 0;
    Sequence first = 0;  // 0: accepted, and not ordered yet
    Sequence last = 0;
    bool is_ended = false;
  };
  struct ClientActions {
    std::vector<Open> actions;          // that of the newest edit is last
    std::list<Client>::iterator place;  // in by_use_
  };
  static std::vector<Open>::const_iterator find_in(const std::vector<Open>& actions,
                                                   ClientSequence action) {
    return std::find_if(actions.begin(), actions.end(),
                        [action](const Open& open) { return open.action == action; });
  }
  void add(const OperationId& first_op, const Open& open) {
    const Client client{first_op.author, first_op.instance};
    const auto [entry, is_new] = clients_.try_emplace(client);
    if (is_new) entry->second.place = by_use_.insert(by_use_.end(), client);
    by_use_.splice(by_use_.end(), by_use_, entry->second.place);
    std::vector<Open>& actions = entry->second.actions;
    const auto known = find_in(actions, open.action);
    if (known != actions.end()) actions.erase(known);
    if (actions.size() == kActionsOfClientMax) actions.erase(actions.begin());
    actions.push_back(open);
    if (clients_.size() <= kClientsMax) return;
    clients_.erase(by_use_.front());
    by_use_.pop_front();
  }

  std::map<Client, ClientActions> clients_;
  std::list<Client> by_use_;  // the clients; that of the newest edit is at the end
};

}  // namespace runstone
