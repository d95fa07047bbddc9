// SimProcess: a server program of a world that several servers share, in virtual time. It owns the
// world or follows the owner, as server/app/standby.hpp and server/runtime/server_core.hpp do with
// threads and sockets. WorldServer, the reading at a start, and the preparation of a takeover are
// the real ones. A program can be killed, stand still, and be cut off from the database.
#pragma once
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/simulation/server/world/model_store.hpp"

namespace runstone::test {

class SimProcess final : public SimServer {
 public:
  /// Returns the program at an address, or null.
  using FindPeer = std::function<SimProcess*(const std::string& address)>;

  /// `tell` gets a line for each thing that happens to the program.
  SimProcess(VirtualTime& time, SplitMix64& rng, WorldConfig config, ModelDatabase& database,
             const WorldMeta& meta, std::string address, FindPeer find_peer,
             std::function<void(const std::string&)> tell)
      : SimServer(time, rng, std::move(config), nullptr),
        database_(database),
        meta_(meta),
        address_(std::move(address)),
        find_peer_(std::move(find_peer)),
        tell_(std::move(tell)) {}

  /// Starts the program.
  void launch() {
    ask([this] {
      const auto owner = database_.owner();
      if (owner) free_looks_ = 0;
      if (!owner && ++free_looks_ > kFreeLooks) return own();
      if (!owner || database_.epoch() == 0) return launch_again();
      follow();
    });
  }
  /// Ends the program at once. It starts again after a while.
  void kill() {
    tell("ends");
    end();
    time_.after(rng_.between(300'000, 3'000'000), [this, life = life_] {
      if (life == life_) launch();
    });
  }
  /// Stops the program as its operator does. It starts again after a while.
  void stop() {
    if (!running()) return;
    // A program that stands still notices it when it goes on.
    run(life_, [this] {
      if (is_stopping_ || role_ == Role::handing_over) return;
      tell("is stopped");
      is_stopping_ = true;
      if (link_) link_->cut();
      world_->begin_stop(now());
      finish_stop_later();
    });
  }
  /// An owner lets the server with the most players take the world over, and follows it. Returns
  /// false if it cannot.
  bool hand_over() {
    if (role_ != Role::owner || is_stopping_ || is_paused_) return false;
    if (world_->cluster().handover_refusal(std::nullopt)) return false;
    tell("hands the world over");
    world_->cluster().hand_over(std::nullopt, now());
    role_ = Role::handing_over;
    end_handover_later();
    return true;
  }
  /// The program stands still. What comes to it waits.
  void pause() {
    tell("stands still");
    is_paused_ = true;
  }
  void resume() {
    if (is_paused_) tell("goes on");
    is_paused_ = false;
    resumed_us_ = time_.now();
    while (!is_paused_ && !backlog_.empty()) {
      const std::function<void()> event = std::move(backlog_.front());
      backlog_.pop_front();
      event();
    }
  }
  /// The connections with the database have ended. An owner cannot go on.
  void lose_database_connections() {
    if (term_) kill();
  }
  void cut_owner_link() {
    if (link_) link_->cut();
  }

  const std::string& address() const { return address_; }
  bool is_paused() const { return is_paused_; }
  /// Returns true if players can connect.
  bool listens() const { return running() && !is_stopping_; }
  bool is_owner() const { return role_ == Role::owner; }

  bool is_database_cut = false;  // nothing passes between program and database
  LinkFaults peer_faults;        // of its connection with the owner
  static constexpr TimeUs kLeaseUs = 5'000'000;

 private:
  enum class Role { none, following, taking_over, owner, handing_over };
  struct Write {
    std::function<void()> write;  // what the transaction writes
    std::function<void()> done;   // after it
  };

  static constexpr int kFreeLooks = 4;
  static constexpr TimeUs kRunsForUs = 300'000;
  static constexpr TimeUs kOwnerHeardUsMax = 1'500'000, kSuccessorUs = 1'000'000;

  void tell(const std::string& what) const { tell_(address_ + ' ' + what); }

  void run_now(std::function<void()> event) override {
    if (is_paused_)
      backlog_.push_back(std::move(event));
    else
      event();
  }
  void end() {
    if (link_) link_->cut();
    link_.reset();
    ++link_number_;
    crash();
    backlog_.clear();
    writes_.clear();
    relayed_.clear();
    is_paused_ = is_stopping_ = is_disk_full_ = false;
    term_.reset();
    valid_until_us_ = 0;
    role_ = Role::none;
    free_looks_ = 0;
    ownerless_us_.reset();
    not_before_us_ = 0;
  }
  void finish_stop_later(int polls = 1'000) {
    later(5'000, 15'000, [this, polls] {
      if (!world_->order().is_flushed() && polls > 0) return finish_stop_later(polls - 1);
      if (term_ && !is_database_cut) database_.release(*term_);
      kill();
    });
  }

  // The database.
  /// Runs an event that needs an answer of the database.
  void ask(std::function<void()> event) {
    later(200, 3'000, [this, event = std::move(event)] { ask_now(event); });
  }
  void ask_now(const std::function<void()>& event) {
    if (!is_database_cut) return event();
    later(100'000, 100'000, [this, event] { ask_now(event); });
  }
  void begin_lease(LeaseTerm term, TimeUs asked_us) {
    term_ = term;
    valid_until_us_ = asked_us + kLeaseUs * 9 / 10;
    renew_later(term, kLeaseUs / 3);
  }
  void renew_later(LeaseTerm term, TimeUs pause_us) {
    const auto pause = static_cast<std::int32_t>(pause_us);
    later(pause, pause, [this, term] {
      if (term_ != term) return;  // it was given up
      if (is_database_cut) return renew_later(term, kLeaseUs / 20);
      // The database gets the request, and sends its answer, whether this program stands still or
      // not.
      time_.after(rng_.between(100, 3'000), [this, term, life = life_, asked_us = time_.now()] {
        if (life != life_ || term_ != term) return;
        const bool is_renewed = database_.renew(term, kLeaseUs);
        later(100, 3'000, [this, term, asked_us, is_renewed] {
          if (term_ != term) return;
          if (!is_renewed) return kill();
          valid_until_us_ = asked_us + kLeaseUs * 9 / 10;
          renew_later(term, kLeaseUs / 3);
        });
      });
    });
  }
  bool may_order() const {
    return !database_.is_there(Protection::owner_clock) || time_.now() < valid_until_us_;
  }

  /// The log writer of the owner notices a full disk when it writes.
  void report_space() {
    if (std::exchange(is_disk_full_, database_.is_disk_full) != is_disk_full_)
      world_->set_disk_is_full(is_disk_full_, now());
  }
  /// Writes in a transaction of its own, behind those before.
  void transact(std::function<void()> write, std::function<void()> done) {
    writes_.push_back({std::move(write), std::move(done)});
    if (writes_.size() == 1) write_next();
  }
  void write_next() {
    ask([this] {
      report_space();
      if (is_disk_full_) return later(1'000'000, 1'000'000, [this] { write_next(); });
      later(100, 10'000, [this, transaction = database_.begin()] { confirm(transaction); });
    });
  }
  void confirm(ModelDatabase::Transaction transaction) {
    ask_now([this, transaction] {
      if (!database_.confirm(transaction, *term_, kLeaseUs)) return kill();
      later(100, 10'000, [this, transaction] { commit(transaction); });
    });
  }
  void commit(ModelDatabase::Transaction transaction) {
    ask_now([this, transaction] {
      // From here on the commit happens, whatever happens to the program.
      auto outcome = std::make_shared<std::optional<bool>>();
      time_.after(rng_.between(50, 1'000),
                  [this, transaction, outcome, write = writes_.front().write] {
                    *outcome = database_.commit(transaction);
                    if (**outcome) write();
                  });
      later(1'100, 4'000, [this, outcome] { ask_now([this, outcome] { written(**outcome); }); });
    });
  }
  void written(bool is_committed) {
    if (!is_committed) return kill();
    const Write front = std::move(writes_.front());
    writes_.pop_front();
    if (!writes_.empty()) write_next();
    front.done();
  }

  // Roles.
  void launch_again() {
    later(250'000, 250'000, [this] { launch(); });
  }
  /// Takes the lease, because nobody has it as far as this program knows. `taken` continues.
  void take_lease(const std::function<void()>& taken, const std::function<void()>& not_taken) {
    // The program connects first. Another one may be faster.
    later(1'000, 80'000, [this, taken, not_taken] {
      ask([this, asked_us = time_.now(), taken, not_taken] {
        const auto term = database_.take(kLeaseUs);
        if (!term) return not_taken();
        begin_lease(*term, asked_us);
        ask(taken);
      });
    });
  }
  void own() {
    take_lease(
        [this] {
          ModelStore writer(database_, meta_, term_);
          const auto epoch = writer.raise_epoch();
          if (!epoch) return kill();
          begin_world(*epoch);
          role_ = Role::owner;
          tell("owns the world, epoch " + std::to_string(*epoch));
          if (!database_.publish(*term_, address_)) kill();
        },
        [this] { launch_again(); });
  }
  void follow() {
    begin_world(std::nullopt);
    tell("follows");
    role_ = Role::following;
    watch_later();
    read_checkpoint_later();
  }
  void begin_world(std::optional<Epoch> epoch) {
    store_ = std::make_unique<ModelStore>(database_, meta_);
    WorldStart start = read_start();
    start.log.epoch = epoch ? *epoch : std::max(database_.epoch(), start.log.last_epoch);
    make_world(start);
    if (!epoch) world_->cluster().follow();
    tick_later();
  }
  void watch_later() {
    later(10'000, 250'000, [this] { watch(); });
  }
  void watch() {
    if (role_ != Role::following || is_stopping_) return;
    if (world_->cluster().has_forked()) return kill();
    if (is_database_cut) return watch_later();
    const auto owner = database_.owner();
    if (!owner) return leaves_lease() ? watch_later() : take_over();
    ownerless_us_.reset();
    not_before_us_ = 0;
    if (!owner->address.empty()) connect_to(owner->address);
    watch_later();
  }
  /// As TakeoverWatch::leaves_lease().
  bool leaves_lease() {
    if (!ownerless_us_) ownerless_us_ = time_.now();
    const auto heard_us = world_->cluster().owner_heard_us();
    const bool hears_owner = heard_us && now().steady_us - *heard_us < kOwnerHeardUsMax;
    return time_.now() < not_before_us_ ||
           (hears_owner && time_.now() - *ownerless_us_ < kSuccessorUs);
  }
  /// Writes the log, gives the lease up, and follows.
  void end_handover_later() {
    later(500, 5'000, [this] {
      if (is_disk_full_) return kill();  // the log cannot be written, and the followers have it
      if (!writes_.empty()) return end_handover_later();
      ask([this] {
        database_.release(*term_);
        term_.reset();
        valid_until_us_ = 0;
        world_->cluster().handover_written(now());
        role_ = Role::following;
        not_before_us_ = time_.now() + kSuccessorUs;
        tell("follows");
        watch_later();
        read_checkpoint_later();
      });
    });
  }
  void take_over() {
    take_lease(
        [this] {
          role_ = Role::taking_over;
          if (link_) link_->cut();
          write_rest(world_->cluster().stop_following(), world_->order().last_record());
        },
        [this] { watch_later(); });
  }
  /// Writes what the owner before may not have written, and takes the world over.
  void write_rest(const std::vector<LogPart>& parts, Version last) {
    ask([this, parts, last] {
      ModelStore writer(database_, meta_, term_);
      auto start = prepare_takeover(writer, parts, last);
      if (!start) return kill();
      start->read = as_followed(std::move(start->read));
      ask([this, start = *start] {
        // The others may connect before this server owns the world.
        if (!database_.publish(*term_, address_)) return kill();
        later(100, 20'000, [this, start] {
          role_ = Role::owner;
          tell("takes the world over, epoch " + std::to_string(start.epoch));
          if (!world_->cluster().take_over(start, now())) kill();
        });
      });
    });
  }
  void read_checkpoint_later() {
    later(1'000'000, 1'000'000, [this] {
      if (role_ != Role::following) return;
      if (!is_database_cut) world_->cluster().checkpoint_moved(database_.checkpoint());
      read_checkpoint_later();
    });
  }

  // The connection with the owner.
  void connect_to(const std::string& owner) {
    if (link_ && link_address_ != owner) return link_->cut();
    if (link_) return;
    SimProcess* peer = find_peer_(owner);
    if (peer == nullptr || peer == this || !peer->listens()) return;
    tell("connects to " + owner);
    link_address_ = owner;
    const std::uint64_t number = ++link_number_;
    SimEnd end;
    end.on_message = [this, number, life = life_](MessageKind kind,
                                                  ByteView bytes) -> Result<void> {
      run(life, [this, number, kind, copy = Bytes(bytes.begin(), bytes.end())] {
        if (number != link_number_) return;
        auto message = decode_message(Sender::server, kind, copy, kSimEdge);
        if (!message)
          throw SimFault(std::string("follower cannot decode: ") + message.error().what);
        world_->cluster().owner_received(*std::move(message), now());
      });
      return {};
    };
    end.on_bad_stream = [](const Error& error) {
      throw SimFault(std::string("follower got a bad stream: ") + error.what);
    };
    end.on_closed = [this, number, life = life_] {
      run(life, [this, number] {
        if (number != link_number_) return;
        ++link_number_;
        link_.reset();
        if (role_ == Role::following) world_->cluster().owner_disconnected();
      });
    };
    end.on_drained = [] {};
    link_ = peer->accept(peer_faults, std::move(end));
    world_->cluster().owner_connected(std::nullopt, now());
  }

  /// Keeps what note_rejection() needs. Without `resumed`, send() has already answered a Resume.
  void receive(SessionId id, Message&& message) override {
    if (const auto* open = std::get_if<RelayOpen>(&message))
      relayed_[{id, open->session}] = open->key;
    if (!database_.is_there(Protection::resumed) && std::holds_alternative<Resumed>(message))
      return;
    SimServer::receive(id, std::move(message));
  }
  /// Tells the final check of a rejection: its client may never get it.
  void note_rejection(SessionId id, const EncodedMessage& message) {
    if (message.kind != kKindOf<Reject> && message.kind != kKindOf<Relay>) return;
    const auto decoded = decode_message(Sender::server, message.kind, *message.bytes, kSimEdge);
    if (const auto* reject = std::get_if<Reject>(&*decoded)) {
      for (const auto& player : world_->people().online()) {
        if (player.session == id) note_rejection(player.author, *reject);
      }
      return;
    }
    const Relay& relay = std::get<Relay>(*decoded);
    if (relay.message.kind != kKindOf<Reject>) return;
    const auto inner =
        decode_message(Sender::server, relay.message.kind, *relay.message.bytes, kSimEdge);
    if (const auto author =
            world_->order().players().author_of(relayed_.at({id, relay.sessions.front()})))
      note_rejection(*author, std::get<Reject>(*inner));
  }
  void note_rejection(AuthorId author, const Reject& reject) {
    if (reject.reason != RejectReason::already_resolved)
      database_.rejected(author, reject.client_seq);
  }
  /// Without the comparison of epochs, what is read from the log looks like the log of this server.
  ReadLog as_followed(ReadLog read) const {
    if (database_.is_there(Protection::head_epoch)) return read;
    for (EditRecord& record : read.records) {
      if (record.version.seq == world_->order().head())
        record.version = world_->order().last_record();
    }
    return read;
  }

  // WorldEnvironment.
  bool owns_world() const override { return may_order(); }
  bool send(SessionId id, const EncodedMessage& message) override {
    note_rejection(id, message);
    // The server takes the edits that come before the client's answer.
    if (message.kind == kKindOf<Resume> && !database_.is_there(Protection::resumed)) {
      later(0, 0, [this, id] {
        if (sessions_.contains(id)) world_->received(id, Resumed{}, now());
      });
    }
    return SimServer::send(id, message);
  }
  bool log_has_room(std::size_t /*records*/) const override {
    return may_order() && !is_disk_full_;
  }
  void log_append(std::vector<PlayerRow> players, std::vector<EditRecord> records) override {
    if (role_ == Role::handing_over || role_ == Role::following)
      throw SimFault("a server that does not own the world orders edits");
    // A program that goes on after it stood still first orders the edits that it had accepted.
    // Later it may order an edit only while it has the lease.
    const bool ran_on = time_.now() - resumed_us_ > kRunsForUs;
    if (!records.empty() && ran_on && !database_.holds(*term_))
      throw SimFault("a server orders edits when its lease may have run out");
    database_.ordered(records);
    const Sequence last = records.empty() ? 0 : records.back().version.seq;
    const auto tell = [this, last] {
      if (last != 0) world_->durable(last, now());
    };
    if (!database_.is_there(Protection::durable_last)) later(10, 100, tell);
    transact([this, term = *term_, players = std::move(players),
              records = std::move(records)] { database_.append(term, players, records); },
             tell);
  }
  void log_names(std::vector<NameChange> changes) override {
    const std::size_t count = changes.size();
    transact([this, term = *term_,
              changes = std::move(changes)] { database_.change_names(term, changes); },
             [this, count] { world_->names_durable(count, now()); });
  }
  void save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> chunks,
                      Sequence checkpoint) override {
    transact([this, term = *term_, chunks = std::move(chunks),
              checkpoint] { database_.save_snapshots(term, chunks, checkpoint); },
             [this] { world_->snapshots_saved(now()); });
  }
  void load_chunk(const ChunkKey& key) override {
    later(100, 50'000, [this, key] { ask_now([this, key] { load_now(key); }); });
  }
  bool send_to_owner(const EncodedMessage& message) override {
    return link_ && link_->send_from_client(message);
  }
  void leave_owner(const std::string& why) override {
    tell("leaves the owner: " + why);
    if (link_) link_->cut();
  }
  void read_missed_log(Sequence first) override {
    ask([this, first] {
      if (role_ != Role::following) return;
      auto read = runstone::read_missed_log(*store_, first, 1 + rng_.below(60));
      if (read) read = as_followed(*std::move(read));
      world_->cluster().missed_log_read(read, now());
    });
  }
  void find_action(const OperationId& first_op) override {
    ask([this, first_op] {
      const auto found = runstone::find_action(*store_, first_op);
      world_->people().edits().action_found(first_op, found ? std::optional(*found) : std::nullopt,
                                            now());
    });
  }
  void report(OperatorLogLevel level, const std::string& line) override {
    tell(line);
    if (level == OperatorLogLevel::error) throw SimFault(address_ + " logs an error: " + line);
  }

  ModelDatabase& database_;
  const WorldMeta& meta_;
  const std::string address_;
  const FindPeer find_peer_;
  const std::function<void(const std::string&)> tell_;
  Role role_ = Role::none;
  int free_looks_ = 0;  // for so often, nobody owned the world when this program started
  bool is_stopping_ = false;
  bool is_paused_ = false;
  TimeUs resumed_us_ = 0;
  std::deque<std::function<void()>> backlog_;  // events that wait while the program stands still
  std::optional<LeaseTerm> term_;
  std::optional<TimeUs> ownerless_us_;  // since when nobody owns the world
  TimeUs not_before_us_ = 0;            // it takes no lease before
  TimeUs valid_until_us_ = 0;
  bool is_disk_full_ = false;            // as the world knows
  std::deque<Write> writes_;             // the first one is under way
  std::shared_ptr<SimConnection> link_;  // with the owner; null: there is none
  std::string link_address_;
  std::uint64_t link_number_ = 0;
  // The players at servers that follow, by the connection and the session there.
  std::map<std::pair<SessionId, SessionId>, PublicKey> relayed_;
};

}  // namespace runstone::test
