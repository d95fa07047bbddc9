#include "bench/map/map_worlds.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/runs/reorder.hpp"
#include "server/history/keyframe_maker.hpp"
#include "server/import/import_luanti.hpp"
#include "server/store/sqlite_backend.hpp"
#include "tests/support/edits/builder_session.hpp"

namespace runstone::bench {
namespace {

constexpr std::uint16_t kEdge = 32;

/// Writes base chunks some hundred at a time.
class BaseWriter {
 public:
  explicit BaseWriter(Store& store) : store_(store) {}
  Result<void, std::string> add(const ChunkKey& key, RunChunk voxels) {
    Chunk chunk;
    chunk.digest = digest_of(voxels);
    chunk.voxels = std::move(voxels);
    chunks_.emplace_back(key, std::make_shared<const Chunk>(std::move(chunk)));
    ++count_;
    return chunks_.size() < 256 ? Result<void, std::string>() : flush();
  }
  Result<void, std::string> flush() {
    const auto saved = store_.save_base(chunks_);
    chunks_.clear();
    if (!saved) return failure(saved.error().message());
    return {};
  }
  std::uint64_t count() const { return count_; }

 private:
  Store& store_;
  std::vector<std::pair<ChunkKey, ChunkPtr>> chunks_;
  std::uint64_t count_ = 0;
};

Result<std::uint64_t, std::string> store_terrain(Store& store, const Generator& generator) {
  BaseWriter base(store);
  constexpr std::int32_t kReach = kStoredSide / 2 / kEdge;
  for (std::int32_t x = -kReach; x < kReach; ++x) {
    for (std::int32_t y = floor_div(generator.y_min(), kEdge); y * kEdge < generator.y_max(); ++y) {
      for (std::int32_t z = -kReach; z < kReach; ++z) {
        const ChunkKey key{0, {x, y, z}};
        auto voxels =
            in_cheapest_order(generator.generate(origin_of(key.at, kEdge), Extent::cube(kEdge)));
        if (auto added = base.add(key, std::move(voxels)); !added) return failure(added.error());
      }
    }
  }
  if (auto flushed = base.flush(); !flushed) return failure(flushed.error());
  return base.count();
}

Result<void, std::string> log_a_year(Store& store, std::uint64_t edits) {
  constexpr TimeUs kYear = TimeUs{365} * 24 * 3600 * 1'000'000;
  constexpr TimeUs kBegin = 1'700'000'000'000'000;
  if (auto raised = store.raise_epoch(); !raised) return failure(raised.error().message());
  test::BuilderSession session(7);
  std::vector<EditRecord> batch;
  for (std::uint64_t i = 0; i < edits; ++i) {
    batch.push_back(session.next());
    batch.back().time_us = kBegin + kYear / static_cast<TimeUs>(edits) * static_cast<TimeUs>(i);
    if (batch.size() < 64 && i + 1 < edits) continue;
    if (auto appended = store.append({}, batch); !appended)
      return failure(appended.error().message());
    batch.clear();
  }
  return {};
}

}  // namespace

Result<std::uint64_t, std::string> make_stored_world(const std::string& folder,
                                                     std::uint64_t edits) {
  WorldMeta meta;
  meta.chunk_edge = kEdge;
  meta.generator.name = "terrain";
  meta.materials = default_material_table();
  const auto generator = make_generator(meta.generator, meta.materials);
  if (!generator) return failure(generator.error().what);
  auto created = create_sqlite_world(folder, meta, {"", false});
  if (!created) return failure(created.error().message());
  Store& store = **created;
  const auto chunks = store_terrain(store, **generator);
  if (!chunks) return chunks;
  if (auto logged = log_a_year(store, edits); !logged) return failure(logged.error());
  const auto made =
      KeyframeMaker(store, **generator, {})
          .make_due([&](const KeyframeMaker::Chunks& all, const std::optional<Keyframe>& keyframe) {
            return store.save_keyframe(all, keyframe);
          });
  if (!made) return failure(made.error().message());
  return chunks;
}

Result<VoxelBox, std::string> make_luanti_world(const std::string& folder,
                                                const std::string& luanti) {
  std::unique_ptr<Store> store;
  std::optional<BaseWriter> base;
  std::string why;
  LuantiImportSink sink;
  sink.materials = [&](const MaterialTable& materials) {
    WorldMeta meta;
    meta.chunk_edge = kEdge;
    meta.generator.name = "empty";
    meta.materials = materials;
    auto created = create_sqlite_world(folder, meta, {"", false});
    if (!created) {
      why = created.error().message();
      return;
    }
    store = *std::move(created);
    base.emplace(*store);
  };
  sink.chunk = [&](const ChunkKey& key, RunChunk&& voxels) {
    if (!base) return false;
    const auto added = base->add(key, std::move(voxels));
    if (!added) why = added.error();
    return added.has_value();
  };
  const auto report = import_luanti(luanti, {.edge = kEdge, .only_cubes = true}, sink);
  if (!report) return failure(why.empty() ? report.error().message() : why);
  if (auto flushed = base->flush(); !flushed) return failure(flushed.error());
  return report->bounds;
}

}  // namespace runstone::bench
