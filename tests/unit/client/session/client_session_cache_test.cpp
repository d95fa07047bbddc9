// What a session holds from before: claims, caches and missing edits.
#include "tests/unit/client/session/session_bench.hpp"

using namespace runstone;
using namespace runstone::test::session_bench;

namespace {

/// All chunks of the fixture's view.
std::vector<ChunkKey> view_keys(const ClientSession& session) {
  std::vector<ChunkKey> keys;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (session.view().contains({x, y, z})) keys.push_back({0, {x, y, z}});
      }
    }
  }
  return keys;
}

}  // namespace

TEST_CASE_METHOD(
    SessionBench,
    "chunks held over a reconnection are claimed before the view, and loaded if not modified",
    "[session]") {
  static_cast<void>(open());
  for (const ChunkKey& key : view_keys(session)) receive(chunks_of(server.world.snapshot(key.at)));
  REQUIRE(session.loaded());
  session.disconnected();
  auto out = open();
  REQUIRE(out.size() >= 2);
  REQUIRE(std::holds_alternative<CachedChunks>(out[0]));
  CHECK(std::holds_alternative<View>(out[1]));
  const auto& held = std::get<CachedChunks>(out[0]).chunks;
  REQUIRE(held.size() == 15);
  CHECK(held[0].digest == claim_digest(server.world.chunk(held[0].key.at).digest));
  CHECK_FALSE(session.loaded());
  ChunksNotModified same;
  for (const CachedChunk& chunk : held) same.chunks.push_back({chunk.key, chunk.version.seq});
  receive(same);
  CHECK(session.loaded());
  // Nothing is claimed twice.
  session.set_view({1, {0, 0, 0}, 2, 1});
  auto more = sent();
  CHECK(take<CachedChunks>(more).empty());
}

TEST_CASE_METHOD(SessionBench, "chunks that a restarted server may have lost are not claimed",
                 "[session]") {
  static_cast<void>(open());
  for (const ChunkKey& key : view_keys(session)) receive(chunks_of(server.world.snapshot(key.at)));
  receive(server.world.commit({9, 1, 1}, set({1, 1, 1}, 2)));  // never durable
  session.disconnected();
  server.world.restart({});
  auto out = open();
  const auto held = take<CachedChunks>(out);
  REQUIRE(held.size() == 1);
  CHECK(held[0].chunks.size() == 14);
}

TEST_CASE_METHOD(SessionBench, "the view waits for the cache, but not for long", "[session]") {
  SessionConfig caching = config();
  caching.has_cache = true;
  session = ClientSession(caching);
  auto out = open();
  CHECK(take<View>(out).empty());
  auto lookup = session.take_cache_lookup();
  REQUIRE(lookup.has_value());
  CHECK(lookup->keys == view_keys(session));
  CHECK(lookup->world.id == server.world_id);
  CHECK_FALSE(session.take_cache_lookup().has_value());
  const ChunkKey key{0, {0, -1, 0}};
  SECTION("its answer is shown and claimed, and the view follows") {
    session.receive_cache_result({{key, std::make_shared<const Chunk>(server.world.chunk(key.at))}},
                                 now);
    CHECK(session.replica().shown(key) != nullptr);
    out = sent();
    REQUIRE(take<CachedChunks>(out).size() == 1);
    CHECK(take<CachedChunks>(out)[0].chunks.size() == 1);
    CHECK(take<View>(out).size() == 1);
    // The cache has it already: only other chunks are handed over.
    for (const ChunkKey& other : view_keys(session))
      receive(chunks_of(server.world.snapshot(other.at)));
    CHECK(session.replica().take_for_cache(100).size() == 14);
    CHECK(session.replica().take_for_cache(100).empty());
    receive(server.world.commit({9, 1, 1}, set({1, -2, 1}, 2)));
    const auto unkept = session.replica().take_for_cache(100);
    REQUIRE(unkept.size() == 1);
    CHECK(unkept[0].first == key);
    // A chunk that leaves the view is handed over.
    receive(server.world.commit({9, 1, 2}, set({1, -2, 1}, 3)));
    session.set_view({1, {50, 0, 0}, 0, 0});
    const auto left = session.replica().take_for_cache(100);
    REQUIRE(left.size() == 1);
    CHECK(left[0].second->version.seq == 2);
  }
  SECTION(
      "without an answer the view goes out after a while, and a late answer counts all the same") {
    now += SessionConfig().cache_wait_us;
    receive(Pong{0, 0});
    session.tick(now);
    out = sent();
    CHECK(take<View>(out).size() == 1);
    session.receive_cache_result({{key, std::make_shared<const Chunk>(server.world.chunk(key.at))}},
                                 now);
    out = sent();
    CHECK(take<CachedChunks>(out).size() == 1);
  }
  SECTION("an answer to an earlier connection is not taken for one of this") {
    session.disconnected();
    server.world_id = {9};
    out = open();
    REQUIRE(session.take_cache_lookup().has_value());
    session.receive_cache_result({{key, std::make_shared<const Chunk>(server.world.chunk(key.at))}},
                                 now);
    CHECK(session.replica().shown(key) == nullptr);
    out = sent();
    CHECK(take<View>(out).empty());
    session.receive_cache_result({}, now);
    out = sent();
    CHECK(take<View>(out).size() == 1);
  }
}

TEST_CASE_METHOD(SessionBench,
                 "a view that waits for the cache is sent before the view moves again",
                 "[session]") {
  SessionConfig caching = config();
  caching.has_cache = true;
  session = ClientSession(caching);
  static_cast<void>(open());
  session.set_view({1, {5, 0, 0}, 1, 1});
  CHECK(sent().empty());  // the server knows of no view yet
  REQUIRE(session.take_cache_lookup().has_value());
  session.receive_cache_result({}, now);
  auto out = sent();
  CHECK(take<View>(out) == std::vector{View{1, {5, 0, 0}, 1, 1}});
  const ChunkKey key{0, {5, 0, 0}};
  receive(chunks_of(server.world.snapshot(key.at), 1));
  REQUIRE(session.replica().confirmed(key) != nullptr);

  session.set_view({1, {9, 0, 0}, 1, 1});  // the replica forgets the chunk
  CHECK(sent().empty());
  session.set_view({1, {5, 0, 0}, 1, 1});
  out = sent();
  CHECK(take<View>(out) == std::vector{View{2, {9, 0, 0}, 1, 1}});
  now += SessionConfig().cache_wait_us;
  session.tick(now);
  out = sent();
  CHECK(take<View>(out) == std::vector{View{3, {5, 0, 0}, 1, 1}});
}

TEST_CASE_METHOD(SessionBench, "missing edits complete a cached chunk from any sequence",
                 "[session]") {
  static_cast<void>(open());
  const ChunkKey key{0, {0, 0, 0}};
  receive(chunks_of(server.world.snapshot(key.at)));
  session.disconnected();
  ChunkEdits update{key, 0, {}, {}, {}};
  std::vector<Commit> commits;
  for (Sequence seq = 1; seq <= 3; ++seq) {
    const auto edit = set({static_cast<int>(seq), 1, 1}, static_cast<Material>(seq));
    commits.push_back(server.world.commit({9, 1, seq}, edit));
    update.edits.push_back({seq, edit});
  }
  update.to = server.world.chunk(key.at).version;
  update.digest = server.world.chunk(key.at).digest;
  static_cast<void>(open());
  const auto is_newest = [&] {
    const ChunkPtr held = session.replica().confirmed(key);
    return held->version == update.to && digest_of(held->voxels) == update.digest;
  };
  SECTION("from the version claimed") {
    receive(chunks_of(update));
    CHECK(is_newest());
    CHECK(session.replica().counters().updates_taken == 1);
  }
  SECTION("a commit that overtook them has led part of the way") {
    receive(commits[0]);
    receive(chunks_of(update));
    CHECK(is_newest());
  }
  SECTION("commits that follow came before them") {
    const Commit next = server.world.commit({9, 1, 4}, set({9, 9, 9}, 4));
    receive(next);
    receive(chunks_of(update));
    CHECK(session.replica().confirmed(key)->version.seq == 4);
    CHECK(session.replica().confirmed(key)->digest == server.world.chunk(key.at).digest);
  }
  SECTION(
      "edits that start elsewhere, or end in another digest, are not taken: the chunk is asked "
      "for") {
    const bool starts_elsewhere = GENERATE(true, false);
    if (starts_elsewhere) {
      update.from = 1;
      update.edits.erase(update.edits.begin());
    } else {
      update.digest.lane[0] ^= 1;
    }
    receive(chunks_of(update));
    CHECK(session.replica().confirmed(key)->version.seq == 0);
    session.tick(now);
    auto out = sent();
    CHECK(take<ChunkRequest>(out).size() == 1);
    receive(chunks_of(server.world.snapshot(key.at)));
    CHECK(session.replica().confirmed(key)->version == server.world.chunk(key.at).version);
  }
  SECTION("the same, of a newer version than is held, is not believed") {
    receive(ChunksNotModified{1, {{key, 2}}});
    session.tick(now);
    auto out = sent();
    CHECK(take<ChunkRequest>(out).size() == 1);
  }
}
