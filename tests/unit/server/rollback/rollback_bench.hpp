// RollbackBench: the world strand of a world on disk, with a rollback service. The test decides
// when the log is written, when a worker runs and when a tick comes.
#pragma once
#include <catch2/catch.hpp>
#include <deque>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/rollback/rollback_service.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/store/sample_world.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {

inline constexpr SessionId kGriefer = 1, kBuilder = 2;

class RollbackBench : public RollbackService::Workers {
 public:
  explicit RollbackBench(WorldConfig c = config(), const WorldStart& start = {})
      : bench(std::move(c), start),
        service(bench.server, *this, [this](std::span<std::uint8_t> out) {
          for (auto& byte : out) byte = static_cast<std::uint8_t>(++random_);
        }) {
    WorldMeta meta = sample_meta();
    REQUIRE(meta.chunk_edge == kEdge);
    REQUIRE(create_world(folder.path(), meta).has_value());
    store = *open_world(folder.path(), StoreAccess::read_write);
    REQUIRE(store->raise_epoch().has_value());
    GeneratorPin pin;
    pin.name = "empty";
    generator = *make_generator(pin, meta.materials);
    bench.has_empty_base = true;  // the generator makes empty chunks
  }

  void run(Work work, std::function<void(std::string)> then) override {
    works.emplace_back(std::move(work), std::move(then));
  }
  /// Does one piece of work. Returns false if there is none.
  bool work() {
    if (works.empty()) return false;
    auto [job, then] = std::move(works.front());
    works.pop_front();
    job(*store, *generator);
    then("");
    return true;
  }

  /// Writes the ordered edits to disk.
  void write_log() {
    bench.server.commit(bench.now());
    auto& records = bench.environment.records;
    if (written < records.size()) {
      const std::span<const EditRecord> fresh(records.data() + written, records.size() - written);
      const auto done = store->append(std::exchange(bench.environment.players, {}), fresh);
      INFO((done ? "" : done.error().message()));
      REQUIRE(done.has_value());
      written = bench.environment.log_written = records.size();
      bench.server.durable(records.back().version.seq, bench.now());
    }
  }
  void tick() {
    bench.tick();
    service.tick(bench.now());
  }
  /// Works and ticks until nothing is under way.
  void run_all() {
    for (int i = 0; i < 2000; ++i) {
      write_log();
      tick();
      while (work()) service.tick(bench.now());
      if (works.empty() && service.running() == 0 && written == bench.environment.records.size() &&
          i > 2)
        return;
    }
    FAIL("the service does not come to rest");
  }

  CommandReply reply() {
    return [this](const CommandAnswer& answer) { answers.push_back(answer); };
  }
  /// Returns the last answer to the command. Requires that there is one.
  CommandAnswer answer() {
    REQUIRE_FALSE(answers.empty());
    REQUIRE(answers.back().is_done);
    return answers.back();
  }

  /// Opens a session that sees the first chunks.
  AuthorId join(SessionId session) {
    const AuthorId author = bench.join(session, static_cast<std::uint8_t>(session)).author;
    bench.view(session, View{1, {0, 0, 0}, 4, 1});
    return author;
  }
  void edit(SessionId session, const EditShape& shape, Material material) {
    bench.edit(session, ++client_seq[session], shape, material);
    bench.server.commit(bench.now());
    bench.answer_loads();
  }
  /// Edits as one action.
  void edit_as_one(SessionId session, const std::vector<EditDescriptor>& edits) {
    const ClientSequence action = client_seq[session] + 1;
    for (const EditDescriptor& edit : edits) {
      EditRequest request{++client_seq[session], 0, edit};
      request.action = action;
      bench.server.received(session, request, bench.now());
      bench.server.commit(bench.now());
      bench.answer_loads();
    }
  }
  void fill(SessionId session, VoxelBox box, Material material) {
    edit(session, FillBox{box}, material);
  }
  void set(SessionId session, VoxelPos at, Material material) {
    edit(session, SetVoxel{at}, material);
  }
  Material at(VoxelPos p) {
    const ChunkPtr chunk = bench.server.order().chunks().find({0, chunk_of(p, kEdge)});
    REQUIRE(chunk != nullptr);
    return material_at(chunk->voxels, local_of(p, kEdge));
  }
  /// Returns the digest of each edited chunk in memory.
  std::vector<std::pair<ChunkKey, Digest>> digests() {
    std::vector<std::pair<ChunkKey, Digest>> out;
    for (const auto& [key, chunk] : bench.server.order().chunks().edited()) {
      if (chunk->digest != Digest{}) out.emplace_back(key, chunk->digest);
    }
    return out;
  }

  TempFolder folder;
  std::unique_ptr<Store> store;
  std::unique_ptr<Generator> generator;
  WorldBench bench;
  std::deque<std::pair<Work, std::function<void(std::string)>>> works;
  std::vector<CommandAnswer> answers;
  std::map<SessionId, ClientSequence> client_seq;
  std::size_t written = 0;

 private:
  std::uint64_t random_ = 0;

 public:
  RollbackService service;
};

}  // namespace runstone::test
