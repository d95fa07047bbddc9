// LogFeed: the log as it is appended: to the log writer, and to the servers that follow this one.
// It keeps the parts that may not be durable, for servers that begin to follow. Bounds: a server
// whose send queue is full gets nothing more (is_full()). It connects again, and reads what it has
// missed from the database.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <map>
#include <vector>

#include "server/world/environment/player_rows.hpp"
#include "server/world/environment/world_environment.hpp"
#include "server/world/order/authority.hpp"
#include "server/world/order/unwritten_log.hpp"

namespace runstone {

class LogFeed {
 public:
  /// `may_be_followed`: the world is where other servers reach it.
  LogFeed(WorldEnvironment& environment, bool may_be_followed)
      : environment_(environment), may_be_followed_(may_be_followed) {}

  // Appending. Each call queues its rows for the log writer and sends them to the servers that
  // follow.
  void append(std::vector<PlayerRow> players, OrderedBatch& batch);
  /// Rows of players without records.
  void append_players(Epoch epoch, std::vector<PlayerRow> players);
  void append_names(Epoch epoch, std::vector<NameChange> changes);
  /// Reports that every record up to `seq` is on disk.
  void durable(Sequence seq) { unwritten_.durable(seq); }

  // The connections with the servers that follow.
  void add(SessionId link) { receivers_[link] = {}; }
  void remove(SessionId link) { receivers_.erase(link); }
  /// From now on the server gets every record.
  void begin(SessionId link) { receivers_.at(link).gets_records = true; }
  /// No server gets records any more.
  void pause_all();
  bool gets_records(SessionId link) const { return receivers_.at(link).gets_records; }
  /// Returns true if the server gets every record.
  bool is_served(SessionId link) const;
  /// Returns true if the server's queue was full. It has missed a message, and must be closed.
  bool is_full(SessionId link) const { return receivers_.at(link).is_full; }
  bool has_served() const;
  /// Sends a message. Returns false if the queue is or was full.
  bool send(SessionId link, const EncodedMessage& message);
  /// Sends a message to the servers that get every record; `to_all`: also to those that get none.
  void send_to_served(const EncodedMessage& message, bool to_all = false);

  /// Returns true if unwritten() has all parts that may not be durable.
  bool keeps_unwritten() const { return may_be_followed_; }
  const UnwrittenLog& unwritten() const { return unwritten_; }
  void clear_unwritten() { unwritten_.clear(); }

 private:
  struct Receiver {
    bool gets_records = false;
    bool is_full = false;
  };
  /// Returns true if a server may follow this one, now or later.
  bool may_be_followed() const { return may_be_followed_ || has_served(); }
  void pass_on(LogPart part);
  void pass_on_batch(const std::vector<PlayerRow>& players, const OrderedBatch& batch);

  WorldEnvironment& environment_;
  bool may_be_followed_;
  UnwrittenLog unwritten_;
  std::map<SessionId, Receiver> receivers_;
};

}  // namespace runstone
