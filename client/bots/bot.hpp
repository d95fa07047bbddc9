// Bot: one player of a fleet: a session with its replica, and a behaviour that hands in edits. Open loop: edit i
// is due i / rate seconds after the start, whatever became of the ones before. Pure, as the session: messages
// and times come in as arguments (microseconds of the client's steady clock). One thread.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "client/bots/behaviour.hpp"
#include "client/bots/edit_ledger.hpp"
#include "client/replica/client_session.hpp"
#include "client/schedule/histogram.hpp"

namespace runstone {

struct BotConfig {
  SessionConfig session;  // its view's centre is the bot's business
  BotRole role = BotRole::build;
  std::size_t site = 0, sites = 1;
  std::uint64_t seed = 1;
  double rate = 1;                         // edits a second, > 0
  std::optional<std::uint64_t> edits_max;  // nothing more after so many
};

struct BotCounts {
  std::uint64_t due = 0;        // edits whose time came
  std::uint64_t submitted = 0;  // and that the session took
  std::uint64_t not_ready = 0;  // what they depend on was not loaded
  std::uint64_t refused = 0;    // by the session: it holds too many, or the world ends there
  std::uint64_t confirmed = 0, rejected = 0, durable = 0;
  std::uint64_t others = 0;  // edits of others that touched chunks in view
  Histogram own_us;          // due -> own commit applied
};

class Bot {
 public:
  explicit Bot(BotConfig config);

  ClientSession& session() { return session_; }
  const ClientSession& session() const { return session_; }
  const BotConfig& config() const { return config_; }
  const std::string& name() const { return config_.session.name; }

  /// Everything in view is here.
  bool loaded() const { return session_.loaded(); }
  /// Edits are due from now on, until end().
  void begin(TimeUs now_us) { began_us_ = now_us; }
  void end() { ended_ = true; }
  /// No edit is due any more, and every one handed in was answered and is on disk.
  bool settled() const;
  /// Moves, hands in what is due, and takes the replica's news. Call every few milliseconds and after messages.
  void step(TimeUs now_us);

  const BotCounts& counts() const { return counts_; }
  EditLedger::Standing standing() const { return ledger_.compare(session_.replica()); }

 private:
  bool enter();
  void follow(TimeUs now_us);
  void take_news();

  BotConfig config_;
  ClientSession session_;
  std::unique_ptr<Behaviour> behaviour_;  // once the world is known
  EditLedger ledger_;
  std::optional<TimeUs> began_us_;
  bool ended_ = false;
  struct Open {
    TimeUs due_us = 0;
    EditDescriptor edit;
  };
  std::map<ClientSequence, Open> open_;  // edits without an answer
  BotCounts counts_;
};

}  // namespace runstone
