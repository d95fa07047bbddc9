// ClusterBench: servers of one world in one thread. Server 0 owns the world at first, the others
// follow it. Messages between them are encoded and decoded, as between programs. The bench is their
// database: it keeps what the owner's log writes, up to the sequence that the test allows. Its
// players answer a Resume as clients do.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/world/cluster/following.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {

/// A voxel in the view kSmall, for x from 0 to 15.
inline SetVoxel block(std::int32_t x) { return {{x, 1, 1}}; }

/// What is on disk.
struct WorldDatabase {
  Epoch epoch = 1;
  std::vector<EditRecord> records;
  std::map<AuthorId, PlayerRow> players;
  std::map<std::string, NameClaim> names;  // by folded form
  AuthorId author_max = 0;                 // of players whose rows are lost
  Sequence checkpoint = 0;

  Sequence last() const { return records.empty() ? 0 : records.back().version.seq; }
  ReadLog read(Sequence first, std::size_t records_max) const {
    ReadLog found;
    for (const auto& [author, row] : players) found.players.push_back(row);
    for (const auto& [folded, claim] : names) found.names.push_back(claim);
    for (const EditRecord& record : records) {
      if (record.version.seq >= first && found.records.size() < records_max)
        found.records.push_back(record);
    }
    found.last = last();
    return found;
  }
  void change_name(const NameChange& change) {
    names.erase(change.claim.folded);
    if (!change.is_release) names[change.claim.folded] = change.claim;
  }
  /// Returns the state of a server that starts now, without the epoch.
  WorldStart start() const {
    WorldStart start;
    std::map<std::pair<AuthorId, ClientInstance>, ClientSequence> resolved;
    for (const EditRecord& record : records) {
      const OperationId& op = record.op;
      start.log.last = record.version.seq;
      start.log.last_epoch = record.version.epoch;
      start.log.last_time_us = record.time_us;
      ClientSequence& mark = resolved[{op.author, op.instance}];
      mark = std::max(mark, op.seq);
      if (const RightsChange* change = rights_change_of(record.edit))
        start.rights.push_back({*change, {record.version.seq, op.author, record.time_us}});
      if (const WorldTime* time = world_time_of(record.edit))
        start.saved.clock = SavedClock{record.version.seq, *time};
    }
    for (const auto& [client, seq] : resolved)
      start.resolved.push_back({client.first, client.second, seq, 0});
    for (const auto& [author, row] : players) start.players.push_back(row);
    for (const auto& [folded, claim] : names) start.name_claims.push_back(claim);
    start.author_max = std::max(author_max, players.empty() ? 0 : players.rbegin()->first);
    return start;
  }
};

struct ClusterBench {
  struct Server {
    std::unique_ptr<WorldBench> bench;
    // Its log, as far as it is written.
    std::size_t records_written = 0, players_written = 0, names_written = 0;
    // Its connection with the owner, if it follows.
    std::optional<std::size_t> owner;
    SessionId link = 0;               // its session there
    std::size_t passed_on = 0;        // of everything that the owner has sent
    bool holds_from_owner = false;    // messages of the owner are delayed
    bool holds_to_owner = false;      // messages to the owner are delayed
    bool holds_when_live = false;     // the same, as soon as it is live
    bool holds_reads = false;         // the database does not answer
    std::vector<LogPart> parts;       // that arrived
    std::vector<Message> from_owner;  // all that arrived
  };

  /// Makes an owner and connects followers with it. `sends_unwritten`: servers send what is not
  /// durable to those that come, as all programs but old ones do.
  explicit ClusterBench(std::size_t followers = 1, WorldConfig c = config(),
                        bool sends_unwritten = true)
      : config_(std::move(c)) {
    config_.may_be_followed = sends_unwritten;
    servers.emplace_back().bench = std::make_unique<WorldBench>(config_of(0));
    for (std::size_t i = 0; i < followers; ++i) connect(add_follower());
    pump();
  }

  WorldBench& at(std::size_t server) { return *servers.at(server).bench; }
  WorldServer& world(std::size_t server) { return at(server).server; }
  FakeEnvironment& environment(std::size_t server) { return at(server).environment; }
  Clocks now() const { return {time_us, time_us + 1'000'000'000}; }
  /// Returns the times of a server, whose wall clock may be wrong.
  Clocks now_at(std::size_t server) { return {time_us, now().utc_us + at(server).wall_error_us}; }

  /// Starts a server from the database. It is not connected yet.
  std::size_t add_follower() {
    WorldStart start = database.start();
    start.log.epoch = database.epoch;
    const auto random = static_cast<std::uint8_t>(9 + servers.size());
    const WorldConfig c = config_of(servers.size());
    servers.emplace_back().bench = std::make_unique<WorldBench>(c, start, random);
    WorldBench& fresh = *servers.back().bench;
    fresh.time_us = time_us;
    for (const EditRecord& record : database.records) fresh.server.replay_onto_stack(record);
    fresh.server.cluster().follow();
    return servers.size() - 1;
  }
  void connect(std::size_t follower) {
    Server& mine = servers.at(follower);
    REQUIRE_FALSE(mine.owner);
    mine.owner = owner;
    mine.link = next_link_++;
    mine.passed_on = environment(owner).sent.size();
    left_seen_[follower] = environment(follower).owners_left.size();
    world(owner).connected(mine.link, now());
    world(follower).cluster().owner_connected(std::nullopt, now());
  }
  /// Ends the connection. What is under way in either direction is lost.
  void cut(std::size_t follower) {
    Server& mine = servers.at(follower);
    if (!mine.owner) return;
    const std::size_t old = *std::exchange(mine.owner, std::nullopt);
    environment(follower).to_owner.clear();
    if (!gone.contains(old)) world(old).disconnected(mine.link);
    world(follower).cluster().owner_disconnected();
  }
  /// The owner vanishes without a word, and its sessions with it.
  void lose_owner() {
    gone.insert(owner);
    for (std::size_t i = 0; i < servers.size(); ++i) cut(i);
  }

  /// Passes messages on until none is under way, except those that are held.
  void pump() {
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      for (std::size_t i = 0; i < servers.size(); ++i) {
        goes_on = pass_from_owner(i) || goes_on;
        goes_on = pass_to_owner(i) || goes_on;
        goes_on = answer_reads(i) || goes_on;
        goes_on = answer_resumes(i) || goes_on;
      }
    }
  }
  /// Passes messages on, orders the edits, and writes the log.
  void run() {
    pump();
    if (!gone.contains(owner)) world(owner).commit(now_at(owner));
    pump();
    write();
    pump();
  }
  /// Does run(), then lets time pass.
  void tick(TimeUs later_us = 50'000) {
    run();
    time_us += later_us;
    for (std::size_t i = 0; i < servers.size(); ++i) {
      if (gone.contains(i)) continue;
      at(i).time_us = time_us;
      at(i).tick(0);
    }
    run();
  }

  /// Writes the owner's log, records up to durable_max. A row of a player is written with its
  /// records.
  void write() {
    if (gone.contains(owner)) return;
    Server& mine = servers[owner];
    FakeEnvironment& from = mine.bench->environment;
    const auto& records = from.records;
    std::size_t& written = mine.records_written;
    while (written < records.size() && records[written].version.seq <= durable_max)
      database.records.push_back(records[written++]);
    if (written == records.size()) {
      for (; mine.players_written < from.players.size(); ++mine.players_written) {
        const PlayerRow& row = from.players[mine.players_written];
        database.players[row.author] = row;
      }
      const std::size_t before = std::exchange(mine.names_written, from.names.size());
      for (std::size_t i = before; i < from.names.size(); ++i) database.change_name(from.names[i]);
      if (before < from.names.size()) world(owner).names_durable(from.names.size() - before, now());
    }
    world(owner).durable(database.last(), now());
  }

  /// Makes a follower the owner, as server/runtime/recovery.cpp does.
  bool take_over(std::size_t follower) {
    cut(follower);
    const std::vector<LogPart> parts = world(follower).cluster().stop_following();
    const Sequence end = database.last();
    for (const LogPart& part : parts) {
      for (const LogName& name : part.names)
        database.change_name({{name.folded, name.name, name.key}, name.is_release});
      for (const LogPlayer& row : part.players)
        database.players[row.author] = {row.author, row.key, row.name};
      for (const LogPartRecord& mine : part.records) {
        if (mine.record.version.seq > end) database.records.push_back(mine.record);
      }
    }
    Takeover start;
    start.epoch = ++database.epoch;
    start.read = database.read(std::max<Sequence>(1, world(follower).order().last_record().seq),
                               std::numeric_limits<std::size_t>::max());
    start.author_max = database.start().author_max;
    start.checkpoint = database.checkpoint;
    owner = follower;
    return world(follower).cluster().take_over(start, now_at(follower));
  }

  // Players.
  /// Does the handshake up to client auth, and what follows of it.
  void knock(std::size_t server, SessionId session, std::uint8_t who, const Hello& hello,
             const std::string& ticket = "", const std::optional<PasswordKey>& password = {},
             const std::optional<ChannelBinding>& binding = std::nullopt) {
    world(server).connected(session, now(), {}, binding);
    world(server).received(session, hello, now());
    const auto welcome = environment(server).messages<Welcome>(session, 0);
    if (welcome.empty()) return;
    ClientAuth auth = at(server).client_auth(who, hello, welcome[0], binding);
    auth.ticket = ticket;
    auth.password_key = password;
    world(server).received(session, auth, now());
    run();
  }
  Hello hello(std::uint8_t who, std::uint64_t features = kFeaturesKnown & ~kFeatureNames,
              ClientInstance instance = 1) {
    Hello h = at(0).hello(who, instance);
    h.features = features;
    return h;
  }
  SessionAccepted join(std::size_t server, SessionId session, std::uint8_t who) {
    return join(server, session, who, hello(who));
  }
  SessionAccepted join(std::size_t server, SessionId session, std::uint8_t who,
                       const Hello& hello) {
    knock(server, session, who, hello);
    const auto accepted = sent<SessionAccepted>(server, session);
    REQUIRE(accepted.size() == 1);
    return accepted[0];
  }
  /// Sends an edit. It goes no further than the server.
  void edit(std::size_t server, SessionId session, ClientSequence seq, const EditShape& shape) {
    const EditRequest request{seq, 0, {shape, {}, 1}};
    players_[{server, session}].edits[seq] = request;
    receive(server, session, request);
  }
  /// Returns the edits of a session that have no answer.
  std::vector<EditRequest> unanswered(std::size_t server, SessionId session) {
    std::set<ClientSequence> answered;
    for (const Reject& reject : sent<Reject>(server, session)) answered.insert(reject.client_seq);
    for (const OnlinePlayer& player : world(server).people().online()) {
      if (player.session != session) continue;
      for (const OrderedEdit& ordered : edits(server, session)) {
        if (ordered.op.author == player.author) answered.insert(ordered.op.seq);
      }
    }
    std::vector<EditRequest> left;
    for (const auto& [seq, request] : players_[{server, session}].edits) {
      if (!answered.contains(seq)) left.push_back(request);
    }
    return left;
  }
  void receive(std::size_t server, SessionId session, Message message) {
    world(server).received(session, std::move(message), now());
  }
  template <class Kind>
  std::vector<Kind> sent(std::size_t server, SessionId session) {
    return environment(server).messages<Kind>(session, kEdge);
  }
  /// Returns the edits of the commits of a session, in the order in which it got them.
  std::vector<OrderedEdit> edits(std::size_t server, SessionId session) {
    std::vector<OrderedEdit> all;
    for (Commit& commit : sent<Commit>(server, session))
      std::ranges::move(commit.edits, std::back_inserter(all));
    return all;
  }
  std::vector<Sequence> sequences(std::size_t server, SessionId session) {
    std::vector<Sequence> all;
    for (const OrderedEdit& edit : edits(server, session)) all.push_back(edit.seq);
    return all;
  }
  /// Returns how the session was closed, or nullopt if it was not.
  std::optional<FakeEnvironment::Closed> end_of(std::size_t server, SessionId session) {
    for (const auto& closed : environment(server).closed) {
      if (closed.session == session) return closed;
    }
    return std::nullopt;
  }
  bool is_open(std::size_t server, SessionId session) {
    return std::ranges::any_of(world(server).people().online(),
                               [&](const auto& player) { return player.session == session; });
  }
  /// Compares all chunks that either server has edited and in memory. Both must have them.
  void check_same_chunks(std::size_t one, std::size_t other) {
    const auto mine = world(one).order().chunks().edited(),
               theirs = world(other).order().chunks().edited();
    REQUIRE(mine.size() == theirs.size());
    for (std::size_t i = 0; i < mine.size(); ++i) {
      CHECK(mine[i].first == theirs[i].first);
      CHECK(mine[i].second->version == theirs[i].second->version);
      CHECK(mine[i].second->digest == theirs[i].second->digest);
      CHECK(world(one).order().chunks().version(mine[i].first) == mine[i].second->version);
    }
  }

  std::vector<Server> servers;
  std::size_t owner = 0;
  std::set<std::size_t> gone;  // servers that run no more
  WorldDatabase database;
  Sequence durable_max = std::numeric_limits<Sequence>::max();  // later records are not written
  std::size_t read_records_max = 8'192;                         // of one answer of the database
  TimeUs time_us = 1'000'000;
  bool answers_resumes = true;  // the players do

 private:
  /// A player_address of the configuration is the beginning of those of the servers.
  WorldConfig config_of(std::size_t server) const {
    WorldConfig c = config_;
    if (c.player_address.empty()) return c;
    c.player_address += std::to_string(server) + ":4747";
    c.page_address = "https://page" + std::to_string(server);
    return c;
  }
  struct Player {
    std::map<ClientSequence, EditRequest> edits;  // that it has sent
    std::size_t resumes_answered = 0;
  };
  bool pass_from_owner(std::size_t follower) {
    bool has_passed = false;
    while (servers[follower].owner && !servers[follower].holds_from_owner) {
      Server& mine = servers[follower];
      FakeEnvironment& from = environment(*mine.owner);
      if (mine.passed_on == from.sent.size()) {
        const bool is_closed = std::ranges::any_of(
            from.closed, [&](const auto& closed) { return closed.session == mine.link; });
        if (is_closed) cut(follower);
        return has_passed || is_closed;
      }
      const FakeEnvironment::Sent next = from.sent[mine.passed_on++];
      if (next.session != mine.link) continue;
      auto message = decode_message(Sender::server, next.message.kind, *next.message.bytes, kEdge);
      REQUIRE(message.has_value());
      mine.from_owner.push_back(*message);
      if (const auto* part = std::get_if<LogPart>(&*message)) mine.parts.push_back(*part);
      world(follower).cluster().owner_received(*std::move(message), now());
      cut_if_left(follower);
      has_passed = true;
    }
    return has_passed;
  }
  bool pass_to_owner(std::size_t follower) {
    bool has_passed = false;
    cut_if_left(follower);
    if (!servers[follower].owner) REQUIRE(environment(follower).to_owner.empty());
    const auto holds = [&](const Server& mine) {
      return mine.holds_to_owner || (mine.holds_when_live && world(follower).cluster().is_live());
    };
    while (servers[follower].owner && !holds(servers[follower]) &&
           !environment(follower).to_owner.empty()) {
      const EncodedMessage next = std::move(environment(follower).to_owner.front());
      environment(follower).to_owner.pop_front();
      auto message = decode_message(Sender::client, next.kind, *next.bytes, kEdge);
      REQUIRE(message.has_value());
      world(*servers[follower].owner).received(servers[follower].link, *std::move(message), now());
      has_passed = true;
    }
    return has_passed;
  }
  bool answer_resumes(std::size_t server) {
    bool has_answered = false;
    for (const OnlinePlayer& player : world(server).people().online()) {
      const SessionId session = player.session;
      std::size_t& answered = players_[{server, session}].resumes_answered;
      const std::size_t count = sent<Resume>(server, session).size();
      if (count == answered || !answers_resumes || gone.contains(server)) continue;
      has_answered = true;
      for (; answered < count; ++answered) receive(server, session, Resumed{});
      for (const EditRequest& request : unanswered(server, session))
        receive(server, session, request);
    }
    return has_answered;
  }
  bool answer_reads(std::size_t follower) {
    auto& reads = environment(follower).missed_log_reads;
    if (reads.empty() || servers[follower].holds_reads) return false;
    const Sequence first = reads.front();
    reads.pop_front();
    world(follower).cluster().missed_log_read(database.read(first, read_records_max), now());
    cut_if_left(follower);
    return true;
  }
  /// Ends the connection if the follower has left the owner.
  void cut_if_left(std::size_t follower) {
    std::size_t& seen = left_seen_[follower];
    const std::size_t left = environment(follower).owners_left.size();
    if (std::exchange(seen, left) != left) cut(follower);
  }

  WorldConfig config_;
  std::map<std::pair<std::size_t, SessionId>, Player> players_;  // by server and session
  SessionId next_link_ = 1'000;
  std::map<std::size_t, std::size_t> left_seen_;
};

}  // namespace runstone::test
