// SimServer: a WorldServer with virtual threads: a log writer and workers that answer after a
// while, sessions on simulated connections, and crashes that lose everything except the disk.
// SimProcess derives from it: a server of a world that several servers share.
#pragma once
#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/runs/run_builder.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/history/find_action.hpp"
#include "server/history/missing_edits.hpp"
#include "server/runtime/recovery.hpp"
#include "server/store/store.hpp"
#include "server/world/world_server.hpp"
#include "tests/simulation/client/session/sim_network.hpp"

namespace runstone::test {

inline constexpr std::uint16_t kSimEdge = 16;

/// A fault that ends the simulation, and the test unless it expects the fault.
struct SimFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns the base of the simulated world: stone below y = 0, sand in a checkered crust at y = 0,
/// air above.
inline Material sim_base_material(VoxelPos at) {
  if (at.y < 0) return 4;
  return at.y == 0 && ((at.x >> 2) + (at.z >> 2)) % 2 == 0 ? Material{2} : kEmpty;
}

inline RunChunk sim_base_chunk(ChunkCoord at) {
  const Extent extent = Extent::cube(kSimEdge);
  RunBuilder builder(extent, AxisOrder::xzy);
  const VoxelPos o = origin_of(at, kSimEdge);
  for (VoxelIndex i = 0; i < extent.volume(); ++i) {
    const LocalPos p = pos_of(i, extent, AxisOrder::xzy);
    builder.append(1, sim_base_material({o.x + p.x, o.y + p.y, o.z + p.z}));
  }
  return builder.finish();
}

class SimServer : public WorldEnvironment {
 public:
  /// `open` opens the store of the world. It is called at each start.
  SimServer(VirtualTime& time, SplitMix64& rng, WorldConfig config,
            std::function<std::unique_ptr<Store>()> open)
      : time_(time), rng_(rng), config_(std::move(config)), open_(std::move(open)) {}

  bool running() const { return world_ != nullptr; }
  WorldServer& world() { return *world_; }
  Store& store() { return *store_; }

  void start() {
    store_ = open_();
    const Epoch epoch = value(store_->raise_epoch());
    WorldStart start = read_start();
    start.log.epoch = epoch;
    make_world(start);
    tick_later();
  }

  /// Loses power: memory, queues and connections are lost. The disk keeps what was synchronised.
  void crash() {
    ++life_;
    turn_waits_ = false;
    world_.reset();
    store_.reset();
    batches_.clear();
    for (auto& [id, session] : sessions_) session.connection->server_died();
    sessions_.clear();
  }

  /// Opens a new session. Returns its connection.
  std::shared_ptr<SimConnection> accept(const LinkFaults& faults, SimEnd client) {
    const SessionId id = next_session_++;
    SimEnd end;
    end.on_message = [this, id, life = life_](MessageKind kind, ByteView bytes) -> Result<void> {
      run(life, [this, id, kind, copy = Bytes(bytes.begin(), bytes.end())] {
        if (!sessions_.contains(id)) return;
        auto message = decode_message(Sender::client, kind, copy, kSimEdge);
        if (!message) throw SimFault(std::string("server cannot decode: ") + message.error().what);
        receive(id, std::move(*message));
        turn_later();
      });
      return {};
    };
    end.on_bad_stream = [](const Error& error) {
      throw SimFault(std::string("server got a bad stream: ") + error.what);
    };
    end.on_closed = [this, id, life = life_] {
      run(life, [this, id] {
        if (sessions_.erase(id) != 0) world_->disconnected(id);
      });
    };
    end.on_drained = [this, id, life = life_] {
      run(life, [this, id] {
        if (sessions_.contains(id)) world_->drained(id, now());
      });
    };
    auto connection = std::make_shared<SimConnection>(time_, rng_, faults, server_queue_bytes,
                                                      std::move(end), std::move(client));
    sessions_[id].connection = connection;
    run(life_, [this, id] { world_->connected(id, now()); });
    return connection;
  }

  Clocks now() const { return {time_.now(), 1'700'000'000'000'000 + time_.now() + utc_offset_us}; }

  // Faults, in occurrences per 1000.
  std::uint32_t drop_commits = 0;  // send() returns true and loses the commit
  std::size_t server_queue_bytes = 200'000;
  bool log_full = false;
  std::uint64_t dropped = 0;
  std::uint64_t updates = 0;  // sent as edits
  TimeUs utc_offset_us = 0;   // of this machine's clock

 protected:
  struct Session {
    std::shared_ptr<SimConnection> connection;
    SessionEncodings encodings;
    std::size_t encoding_now = 0;  // snapshots on a worker
  };

  template <class T>
  static T value(StoreResult<T> result) {
    if (!result) throw SimFault(result.error().message());
    return *std::move(result);
  }

  static void done(const StoreResult<void>& result) {
    if (!result) throw SimFault(result.error().message());
  }

  /// Reads what the store remembers. The epoch is not set.
  WorldStart read_start() {
    auto start = read_world_start(*store_);
    if (!start) throw SimFault(start.error());
    return *std::move(start);
  }
  void make_world(const WorldStart& start) {
    world_ =
        std::make_unique<WorldServer>(config_, start, *this, [this](std::span<std::uint8_t> out) {
          for (auto& b : out) b = static_cast<std::uint8_t>(rng_.next());
        });
    if (const auto replayed = replay_log(*store_, start, *world_); !replayed)
      throw SimFault(replayed.error());
  }

  /// Handles a message of a client.
  virtual void receive(SessionId id, Message&& message) {
    world_->received(id, std::move(message), now());
  }
  /// Runs an event of the start number `life`, unless the server has crashed since.
  void run(std::uint64_t life, std::function<void()> event) {
    if (life == life_) run_now(std::move(event));
  }
  /// Runs an event of this start. A program that stands still does so later.
  virtual void run_now(std::function<void()> event) { event(); }
  /// Runs `event` after a while, unless the server has crashed by then.
  void later(std::int32_t min_us, std::int32_t max_us, std::function<void()> event) {
    time_.after(rng_.between(min_us, max_us),
                [this, life = life_, event = std::move(event)] { run(life, event); });
  }
  void tick_later() {
    later(40'000, 60'000, [this] {
      world_->tick(now());
      while (world_->ground().has_deliveries()) world_->ground().deliver_next(now());
      tick_later();
    });
  }
  void turn_later() {
    if (std::exchange(turn_waits_, true)) return;
    later(10, 2000, [this] {
      turn_waits_ = false;
      world_->commit(now());
    });
  }

  // WorldEnvironment.
  bool send(SessionId id, const EncodedMessage& message) override {
    const auto it = sessions_.find(id);
    if (it == sessions_.end()) return false;
    if (message.kind == kKindOf<Commit> && rng_.below(1000) < drop_commits) {
      ++dropped;
      return true;
    }
    return it->second.connection->send_from_server(message);
  }
  void set_encodings(SessionId id, SessionEncodings encodings) override {
    if (const auto it = sessions_.find(id); it != sessions_.end()) it->second.encodings = encodings;
  }
  bool send_snapshot(SessionId id, std::uint32_t view, const ChunkKey& key,
                     const ChunkPtr& chunk) override {
    return encode_later(id, view, key, chunk, false);
  }
  bool send_changed_tile(SessionId id, std::uint32_t view, const ChunkKey& key,
                         const ChunkPtr& tile) override {
    return encode_later(id, view, key, tile, true);
  }
  bool encode_later(SessionId id, std::uint32_t view, const ChunkKey& key, const ChunkPtr& chunk,
                    bool is_changed_tile) {
    const auto it = sessions_.find(id);
    if (it == sessions_.end() || it->second.encoding_now >= 16) return false;
    ++it->second.encoding_now;
    later(100, 30'000, [this, id, view, key, chunk, is_changed_tile] {  // the worker
      const auto session = sessions_.find(id);
      if (session == sessions_.end()) return;
      --session->second.encoding_now;
      const SessionEncodings agreed = session->second.encodings;
      const ChunkEncoding encoding = is_changed_tile ? agreed.chunks : agreed.of(key);
      send_encoded(id, view, encode_snapshot(key, *chunk, encoding));
    });
    return true;
  }
  bool send_update(SessionId id, std::uint32_t view, const ChunkKey& key, const ChunkPtr& chunk,
                   Version held) override {
    const auto it = sessions_.find(id);
    if (it == sessions_.end() || it->second.encoding_now >= 16) return false;
    ++it->second.encoding_now;
    later(100, 30'000, [this, id, view, key, chunk, held] {  // the worker
      const auto session = sessions_.find(id);
      if (session == sessions_.end()) return;
      --session->second.encoding_now;
      const ChunkEncoding encoding = session->second.encodings.of(key);
      const auto edits = value(
          missing_edits(*store_, key, *chunk, held, chunk_bytes_about(chunk->voxels, encoding)));
      updates += edits ? 1 : 0;
      send_encoded(id, view,
                   edits ? encode_chunk_edits(*edits) : encode_snapshot(key, *chunk, encoding));
    });
    return true;
  }
  void send_encoded(SessionId id, std::uint32_t view, const ChunkEntry& chunk) {
    const auto session = sessions_.find(id);
    if (session == sessions_.end() || !session->second.connection->open()) return;
    if (session->second.connection->send_from_server(join_entries(view, {&chunk, 1}))) {
      world_->drained(id, now());
    } else {  // send() must queue it: try again when there is room
      later(1000, 5000, [this, id, view, chunk] { send_encoded(id, view, chunk); });
    }
  }
  void close(SessionId id, GoodbyeReason reason, const std::string& text) override {
    const auto it = sessions_.find(id);
    if (it == sessions_.end()) return;
    it->second.connection->send_from_server(encode_message(Goodbye{reason, text}));
    later(100'000, 200'000, [this, id] {
      if (const auto session = sessions_.find(id); session != sessions_.end())
        session->second.connection->cut();
    });
  }
  bool log_has_room(std::size_t) const override { return !log_full; }
  std::size_t log_queued_bytes() const override { return 0; }
  void log_append(std::vector<PlayerRow> players, std::vector<EditRecord> records) override {
    batches_.emplace_back(std::move(players), std::move(records));
    if (batches_.size() == 1) write_later();
  }
  void write_later() {
    later(500, 20'000, [this] {
      auto& [players, records] = batches_.front();
      done(store_->append(players, records));
      const Sequence last = records.empty() ? 0 : records.back().version.seq;
      batches_.erase(batches_.begin());
      if (last != 0) world_->durable(last, now());
      if (!batches_.empty()) write_later();
    });
  }
  void log_names(std::vector<NameChange> changes) override {
    later(500, 20'000, [this, changes = std::move(changes)] {
      done(store_->change_names(changes));
      world_->names_durable(changes.size(), now());
    });
  }
  bool save_state(SavedState /*state*/) override { return true; }
  void load_chunk(const ChunkKey& key) override {
    later(100, 50'000, [this, key] { load_now(key); });
  }
  void load_now(const ChunkKey& key) {
    auto snapshot = value(store_->load_snapshot(key));
    if (snapshot) return world_->chunk_loaded(key, std::move(*snapshot), now());
    Chunk chunk{sim_base_chunk(key.at), {}, {}};
    chunk.digest = digest_of(chunk.voxels);
    world_->chunk_loaded(key, std::move(chunk), now());
  }
  void save_snapshots(std::vector<std::pair<ChunkKey, ChunkPtr>> chunks,
                      Sequence checkpoint) override {
    later(500, 30'000, [this, saved = std::move(chunks), checkpoint] {
      done(store_->save_snapshots(saved, checkpoint));
      world_->snapshots_saved(now());
    });
  }
  void find_action(const OperationId& first_op) override {
    later(100, 20'000, [this, first_op] {
      const auto found = runstone::find_action(*store_, first_op);
      world_->people().edits().action_found(first_op, found ? std::optional(*found) : std::nullopt,
                                            now());
    });
  }
  void report(OperatorLogLevel level, const std::string& line) override {
    if (level == OperatorLogLevel::error) throw SimFault("server logs an error: " + line);
  }

  VirtualTime& time_;
  SplitMix64& rng_;
  WorldConfig config_;
  std::function<std::unique_ptr<Store>()> open_;
  std::unique_ptr<Store> store_;
  std::unique_ptr<WorldServer> world_;
  std::uint64_t life_ = 0;  // number of this start; events of earlier ones do nothing
  SessionId next_session_ = 1;
  std::map<SessionId, Session> sessions_;
  std::vector<std::pair<std::vector<PlayerRow>, std::vector<EditRecord>>> batches_;
  bool turn_waits_ = false;
};

}  // namespace runstone::test
