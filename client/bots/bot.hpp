// Bot: one player of a fleet. It has a behaviour, the times at which it acts, and a session:
// ReplicaBot or HeadlessBot. Open loop: an edit is due at its time, whatever became of the edits
// before. Pure: messages and times are arguments, in microseconds of the process' steady clock. One
// thread.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "client/bots/behaviour.hpp"
#include "client/bots/edit_schedule.hpp"
#include "client/bots/placed_voxels.hpp"
#include "client/schedule/histogram.hpp"
#include "client/session/client_handshake.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct BotConfig {
  SessionConfig session;  // the bot sets the centre of the view
  BotRole role = BotRole::build;
  std::size_t site = 0, sites = 1;
  std::uint64_t seed = 1;
  double rate = 1;   // edits, or joins of a join storm, per second; > 0
  double phase = 0;  // 0 to 1: part of 1 / rate that passes before the first edit
  std::optional<std::uint64_t> edits_max;  // number of edits after which the bot stops
};

struct BotCounts {
  std::uint64_t due = 0;        // edits, or departures of a join storm, that were due
  std::uint64_t submitted = 0;  // edits that the session accepted
  std::uint64_t not_ready = 0;  // the ground that they need was not loaded
  std::uint64_t refused = 0;    // by the session: too many local edits, or outside of the world
  std::uint64_t confirmed = 0, rejected = 0, durable = 0;
  std::uint64_t others = 0;  // edits of other clients that arrived
  /// From the due time until the commit of a local edit was applied, or verified by a bot without a
  /// replica. Infinite without an answer.
  Histogram confirm_us;
  std::uint64_t joins = 0;  // how often a bot loaded all of its view after connecting
  Histogram join_us;        // from the start of the connection attempt until then
  void merge(const BotCounts& other);
};

class Bot {
 public:
  virtual ~Bot() = default;

  const BotConfig& config() const { return config_; }
  const std::string& name() const { return config_.session.name; }

  /// The link starts to connect.
  void start(TimeUs now_us) { joining_us_ = now_us; }
  /// Returns true if everything in view has arrived.
  virtual bool loaded() const = 0;
  /// Makes edits due from now on, until end().
  void begin(TimeUs now_us) { schedule_.begin(now_us); }
  void end() { schedule_.end(); }
  /// Returns true if no edit is due any more, and every submitted edit was answered and is on disk.
  bool is_done() const { return schedule_.is_over() && is_answered(); }
  /// Returns the sequence up to which the server has told the bot that the log is on disk. The bot
  /// has received every edit up to there that touches its view.
  virtual Sequence durable() const = 0;
  /// Moves, offers what is due, and takes what arrived. Call it at due_us() at the latest.
  void step(TimeUs now_us);
  /// Returns when the next step is due.
  TimeUs due_us(TimeUs now_us) const;

  virtual BotCounts counts() const { return counts_; }
  /// Returns how much of what the bot built is intact. Without a replica all counts are 0.
  virtual PlacedVoxels::Standing standing() const { return {}; }

 protected:
  explicit Bot(BotConfig config);

  /// Returns null unless the session is open.
  virtual const Welcome* world() const = 0;
  virtual void set_view(const View& view) = 0;
  virtual void set_pose(const Pose& pose) = 0;
  virtual const GroundHeight& ground() const = 0;
  virtual void tick(TimeUs now_us) = 0;
  virtual TimeUs tick_due_us(TimeUs now_us) const = 0;
  virtual void drain_changes() {}
  /// Returns true if the session accepted the edit.
  virtual bool offer(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) = 0;
  virtual bool is_answered() const = 0;
  /// Sends a goodbye. The link then connects again.
  virtual void depart() = 0;

  BotConfig config_;
  BotCounts counts_;

 private:
  bool enter();
  void follow(TimeUs now_us);
  void act(TimeUs due_us, TimeUs now_us);

  EditSchedule schedule_;
  std::unique_ptr<Behaviour> behaviour_;  // null until the world is known
  std::optional<View> requested_view_;
  std::optional<TimeUs> joining_us_;  // since when it connects, until the view is loaded
};

}  // namespace runstone
