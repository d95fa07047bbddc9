// Bot: one player of a crowd: a behaviour, the times at which it acts, and a session of one kind or the other (ReplicaBot,
// HeadlessBot). Open loop: an edit is due at its time, whatever became of the ones before. Pure, as the sessions: messages and times come
// in as arguments (microseconds of the process' steady clock). One thread.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "client/bots/behaviour.hpp"
#include "client/bots/edit_ledger.hpp"
#include "client/bots/edit_schedule.hpp"
#include "client/replica/client_handshake.hpp"
#include "client/schedule/histogram.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

struct BotConfig {
  SessionConfig session;  // its view's centre is the bot's business
  BotRole role = BotRole::build;
  std::size_t site = 0, sites = 1;
  std::uint64_t seed = 1;
  double rate = 1;   // edits, or joins of a join storm, a second, > 0
  double phase = 0;  // 0 .. 1: how much of 1 / rate passes before the first one
  std::optional<std::uint64_t> edits_max;  // nothing more after so many
};

struct BotCounts {
  std::uint64_t due = 0;        // edits, or departures of a join storm, whose time came
  std::uint64_t submitted = 0;  // edits that the session took
  std::uint64_t not_ready = 0;  // what they depend on was not loaded
  std::uint64_t refused = 0;    // by the session: it holds too many, or the world ends there
  std::uint64_t confirmed = 0, rejected = 0, durable = 0;
  std::uint64_t others = 0;  // edits of others that came
  Histogram
      confirm_us;  // due -> own commit applied, or verified by a bot without a replica; infinite: no answer
  std::uint64_t joins = 0;  // times that a bot came to see all of its view after connecting anew
  Histogram join_us;        // from connecting until then
  void merge(const BotCounts& other);
};

class Bot {
 public:
  virtual ~Bot() = default;

  const BotConfig& config() const { return config_; }
  const std::string& name() const { return config_.session.name; }

  /// The link begins to connect.
  void start(TimeUs now_us) { joining_us_ = now_us; }
  /// Everything in view is here.
  virtual bool loaded() const = 0;
  /// Edits are due from now on, until end().
  void begin(TimeUs now_us) { schedule_.begin(now_us); }
  void end() { schedule_.end(); }
  /// No edit is due any more, and every one handed in was answered and is on disk.
  bool settled() const { return schedule_.is_over() && is_answered(); }
  /// Moves, hands in what is due, and takes what came. Call at due_us() at the latest.
  void step(TimeUs now_us);
  /// When the next step is due.
  TimeUs due_us(TimeUs now_us) const;

  virtual BotCounts counts() const { return counts_; }
  /// Of what it built; a bot without a replica does not know.
  virtual EditLedger::Standing standing() const { return {}; }

 protected:
  explicit Bot(BotConfig config);

  /// Null unless the session is open.
  virtual const Welcome* world() const = 0;
  virtual void set_view(const View& view) = 0;
  virtual void set_pose(const Pose& pose) = 0;
  virtual const Ground& ground() const = 0;
  virtual void tick(TimeUs now_us) = 0;
  virtual TimeUs tick_due_us(TimeUs now_us) const = 0;
  virtual void drain_changes() {}
  /// Whether the session took it.
  virtual bool submit(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) = 0;
  virtual bool is_answered() const = 0;
  /// Says goodbye; the link then connects anew.
  virtual void depart() = 0;

  BotConfig config_;
  BotCounts counts_;

 private:
  bool enter();
  void follow(TimeUs now_us);
  void act(TimeUs due_us, TimeUs now_us);

  EditSchedule schedule_;
  std::unique_ptr<Behaviour> behaviour_;  // once the world is known
  std::optional<View> wished_;
  std::optional<TimeUs> joining_us_;  // connecting since then, and not all of the view is here
};

}  // namespace runstone
