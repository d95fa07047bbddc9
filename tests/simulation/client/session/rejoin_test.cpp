// A client session and a world strand, connected without a network: the cost of a reconnection, and
// how a wrong copy is found and replaced. All messages are encoded, and their bytes are counted as
// frames carry them.
#include <catch2/catch.hpp>

#include <algorithm>
#include <map>

#include "client/session/client_session.hpp"
#include "common/runs/run_builder.hpp"
#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/message_table.hpp"
#include "tests/support/codec/chunks_message.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

/// Returns the bytes on the wire: the message and the headers of its frames.
std::size_t framed(const EncodedMessage& message) {
  const std::size_t size = message.bytes->size();
  return size + (size + kFragmentBytesMax - 1) / kFragmentBytesMax * kFrameHeaderBytes;
}

WorldConfig wide_config() {
  WorldConfig c = config();
  c.view_radius_max = 16;
  c.loads_per_session_max = 4'096;
  c.loads_in_flight_max = 4'096;
  return c;
}

SessionConfig builder(const View& view) {
  SessionConfig c;
  c.keys = key_pair_of(seed_of(1));
  c.instance = 5;
  c.view = view;
  return c;
}

class Joined {
 public:
  explicit Joined(const View& view) : session_(builder(view)) {}

  void connect() {
    ++id_;
    bench.environment.sent.clear();
    bench.environment.snapshots.clear();
    bench.server.connected(id_, bench.now());
    session_.connected({static_cast<std::uint8_t>(id_)}, std::nullopt, bench.time_us);
    exchange();
  }
  void disconnect() {
    session_.disconnected();
    bench.server.disconnected(id_);
  }
  /// Delivers all messages of both sides, and all messages that follow from them.
  void exchange() {
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      for (const Message& message : session_.take_outgoing()) {
        goes_on = true;
        const EncodedMessage encoded = encode_message(message);
        if (is_of_chunks(message)) to_server += framed(encoded);
        auto decoded = decode_message(Sender::client, encoded.kind, *encoded.bytes, kEdge);
        REQUIRE(decoded.has_value());
        bench.server.received(id_, std::move(*decoded), bench.now());
      }
      bench.server.commit(bench.now());
      while (!bench.environment.loads.empty()) {
        goes_on = true;
        const ChunkKey key = bench.environment.loads.front();
        bench.environment.loads.pop_front();
        bench.server.chunk_loaded(key, hills(key.at), bench.now());
      }
      for (const auto& sent : std::exchange(bench.environment.sent, {}))
        goes_on |= deliver(sent.session, sent.message);
      for (const auto& snapshot : std::exchange(bench.environment.snapshots, {})) {
        const ChunkEntry entry =
            encode_snapshot(snapshot.key, *snapshot.chunk, ChunkEncoding::packed);
        goes_on |= deliver(snapshot.session, join_entries(session_.view().number, {&entry, 1}));
      }
    }
  }
  /// Runs the ticks of one second.
  void second() {
    for (int i = 0; i < 20; ++i) {
      bench.tick();
      session_.tick(bench.time_us);
      exchange();
    }
  }

  ClientSession& session() { return session_; }
  Replica& replica() { return session_.replica(); }
  SessionId id() const { return id_; }

  WorldBench bench{wide_config()};
  std::size_t to_server = 0;  // claims
  std::size_t to_client = 0;  // messages about chunks

 private:
  static bool is_of_chunks(const Message& message) {
    return std::holds_alternative<CachedChunks>(message);
  }

  /// Makes ground with a pattern of its own per chunk, so that the sizes of chunks differ.
  static Chunk hills(ChunkCoord at) {
    RunBuilder builder(Extent::cube(kEdge), AxisOrder::yxz);
    for (unsigned column = 0; column < kEdge * kEdge; ++column) {
      const auto height =
          1 + static_cast<unsigned>(
                  (at.x * 7 + at.y * 3 + at.z * 5 + static_cast<int>(column / 3)) & 7);
      builder.append(height, Material{1});
      builder.append(kEdge - height, kEmpty);
    }
    Chunk chunk{builder.finish(), {}, {}};
    chunk.digest = digest_of(chunk.voxels);
    return chunk;
  }

  bool deliver(SessionId session, const EncodedMessage& message) {
    if (session != id_) return false;
    if (class_of(message) == FrameClass::chunks) to_client += framed(message);
    auto decoded = decode_message(Sender::server, message.kind, *message.bytes,
                                  session_.welcome() ? kEdge : std::uint16_t{0});
    REQUIRE(decoded.has_value());
    session_.receive(*std::move(decoded), {bench.time_us, bench.time_us, bench.time_us});
    return true;
  }

  ClientSession session_;
  SessionId id_ = 0;
};

/// Requires that all chunks of the replica equal those of the server.
void require_equal(Joined& joined) {
  REQUIRE(joined.session().loaded());
  for (const ChunkKey& key : joined.replica().confirmed_keys()) {
    const ChunkPtr theirs = joined.bench.server.order().chunks().find(key);
    const ChunkPtr ours = joined.replica().confirmed(key);
    REQUIRE(theirs != nullptr);
    REQUIRE(ours->version == theirs->version);
    REQUIRE(digest_of(ours->voxels) == digest_of(theirs->voxels));
  }
}

}  // namespace

TEST_CASE(
    "a reconnection with an unchanged view costs at most 32 bytes a chunk in both directions "
    "together",
    "[simulation]") {
  Joined joined({1, {0, 0, 0}, 9, 2});
  joined.connect();
  REQUIRE(joined.session().view_chunks() == 1265);
  require_equal(joined);
  // Half of the chunks have been edited, at high sequences.
  joined.bench.server.connected(900, joined.bench.now());
  ClientSequence seq = 0;
  for (const ChunkKey& key : joined.replica().confirmed_keys()) {
    if (++seq % 2 == 0) continue;
    const VoxelPos o = origin_of(key.at, kEdge);
    REQUIRE(
        joined.session().offer({SetVoxel{{o.x + 3, o.y + 14, o.z + 5}}, {}, 2}, 0, 0).has_value());
  }
  joined.second();
  joined.second();
  require_equal(joined);
  const std::size_t first_time = joined.to_client;
  const std::uint64_t snapshots = joined.bench.server.counters().snapshots_sent;

  joined.disconnect();
  joined.to_server = joined.to_client = 0;
  joined.connect();
  joined.second();
  require_equal(joined);
  CHECK(joined.bench.server.counters().snapshots_sent == snapshots);
  CHECK(joined.bench.server.counters().not_modified_sent == 1265);
  const double per_chunk = static_cast<double>(joined.to_server + joined.to_client) / 1265;
  CHECK(per_chunk <= 32);
  WARN("a chunk: " << static_cast<double>(joined.to_server) / 1265 << " bytes claimed, "
                   << static_cast<double>(joined.to_client) / 1265 << " answered; first time "
                   << static_cast<double>(first_time) / 1265);
}

TEST_CASE("a wrong run in a replica is found by the digest check and repaired", "[simulation]") {
  Joined joined({1, {0, 0, 0}, 1, 1});
  joined.connect();
  require_equal(joined);
  const ChunkKey key{0, {0, 0, 1}};
  // One run of the confirmed chunk gets another material. Its digest does not follow, as with
  // faulty memory.
  Chunk bad = *joined.replica().confirmed(key);
  fill(bad.voxels, 0, 1, Material{3});
  REQUIRE(digest_of(bad.voxels) != bad.digest);
  bad.digest.lane[1] ^= 1;
  const std::uint64_t before = joined.replica().counters().repaired;
  joined.session().receive(chunks_of(ChunkSnapshot{key, bad}), {0, 0, 0});
  REQUIRE(*joined.replica().confirmed(key) == bad);
  const std::uint64_t requested = joined.bench.server.counters().chunks_requested;
  for (int i = 0; i < 5; ++i) joined.second();
  CHECK(joined.replica().counters().drifted == 1);
  CHECK(joined.replica().counters().repaired == before + 2);  // the injected one, and the repair
  CHECK(joined.bench.server.counters().chunks_requested == requested + 1);
  require_equal(joined);
}

TEST_CASE("a copy that went wrong while disconnected is refuted by its claim", "[simulation]") {
  Joined joined({1, {0, 0, 0}, 1, 1});
  joined.connect();
  const ChunkKey key{0, {0, 0, 1}};
  Chunk bad = *joined.replica().confirmed(key);
  fill(bad.voxels, 0, 1, Material{3});
  bad.digest.lane[1] ^= 1;
  joined.session().receive(chunks_of(ChunkSnapshot{key, bad}), {0, 0, 0});
  joined.disconnect();
  joined.connect();
  CHECK(joined.bench.server.counters().claims_drifted == 1);
  CHECK(joined.replica().counters().claims_refuted == 1);
  CHECK(joined.replica().counters().drifted == 0);
  require_equal(joined);
}

TEST_CASE("more claims than a session may have end only that session", "[simulation]") {
  WorldBench bench(wide_config());
  bench.join(1, 1);
  bench.join(2, 2);
  bench.view(2, kSmall);
  std::int32_t next = -30'000;
  for (int message = 0; message <= static_cast<int>(kClaimsPerSessionMax / 64); ++message) {
    CachedChunks held;
    for (int i = 0; i < 64; ++i) held.chunks.push_back({{0, {next++, 0, 0}}, {}, 1});
    bench.server.received(1, held, bench.now());
  }
  REQUIRE(bench.environment.closed.size() == 1);
  CHECK(bench.environment.closed[0].session == 1);
  CHECK(bench.environment.closed[0].reason == GoodbyeReason::flooding);
  CHECK(bench.environment.closed[0].text == "claims to hold more than 32768 chunks");
  bench.edit(2, 1, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.commits(2).size() == 1);
  // Claims of chunks out of view are forgotten with the next view, so they do not accumulate.
  bench.join(3, 3);
  for (int round = 0; round < 20; ++round) {
    for (int message = 0; message < 100; ++message) {
      CachedChunks held;
      for (int i = 0; i < 64; ++i) held.chunks.push_back({{0, {next++ % 30'000, 1, 0}}, {}, 1});
      std::sort(held.chunks.begin(), held.chunks.end(),
                [](const auto& a, const auto& b) { return a.key < b.key; });
      bench.server.received(3, held, bench.now());
    }
    bench.view(3, {static_cast<std::uint32_t>(round + 1), {round, 0, 0}, 1, 0});
    bench.tick();
  }
  CHECK(bench.environment.closed.size() == 1);
}

}  // namespace runstone::test
