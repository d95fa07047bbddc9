#include "server/import/import_program.hpp"

#include <sodium.h>

#include <memory>
#include <utility>
#include <vector>

#include "common/materials/palette.hpp"
#include "common/os/new_folder.hpp"
#include "server/import/import_luanti.hpp"
#include "server/store/store.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

constexpr std::size_t kChunksPerTransaction = 512;
constexpr std::size_t kDamagedListed = 10;

/// Collects chunks and writes them to the base, many in one transaction.
class BaseWriter {
 public:
  explicit BaseWriter(ImportSink& world) : world_(world) {}
  bool add(const ChunkKey& key, RunChunk&& voxels) {
    auto chunk = std::make_shared<Chunk>();
    chunk->digest = digest_of(voxels);
    chunk->voxels = std::move(voxels);
    pending_.emplace_back(key, std::move(chunk));
    return pending_.size() < kChunksPerTransaction || flush();
  }
  bool flush() {
    const auto saved = world_.save_base(pending_);
    if (!saved) error_ = saved.error().message();
    pending_.clear();
    return saved.has_value();
  }
  const std::string& error() const { return error_; }

 private:
  ImportSink& world_;
  std::vector<std::pair<ChunkKey, ChunkPtr>> pending_;
  std::string error_;
};

/// Returns the materials of the new world: those of the imported one, and the palette.
Result<MaterialTable, std::string> materials_of(const ImportRequest& request,
                                                const LuantiImportReport& survey) {
  MaterialTable materials = survey.materials;
  if (request.palette && !append_palette(materials, default_material_table())) {
    return failure(request.luanti + ": its " + std::to_string(survey.materials.size()) +
                   " materials leave no room for the builders' palette: add --palette none");
  }
  return materials;
}

Result<void, std::string> fill(const ImportRequest& request, const LuantiImportReport& survey,
                               const MaterialTable& materials, const std::string& folder) {
  WorldMeta meta;
  meta.chunk_edge = request.edge;
  meta.generator.name = "empty";
  meta.materials = materials;
  meta.spawn = {survey.spawn.x + 0.5, static_cast<double>(survey.spawn.y), survey.spawn.z + 0.5};
  draw_identity(meta);
  auto store = create_world(folder, meta);
  if (!store) return failure(store.error().message());
  BaseWriter base(**store);
  LuantiImportSink sink;
  sink.materials = [](const MaterialTable&) {};
  sink.chunk = [&](const ChunkKey& key, RunChunk&& voxels) {
    return base.add(key, std::move(voxels));
  };
  const auto report = import_luanti(request.luanti, {request.edge, request.keep_all}, sink);
  if (!base.error().empty()) return failure(base.error());
  if (!report) return failure(report.error().message());
  if (!base.flush()) return failure(base.error());
  if (report->materials != survey.materials || report->chunks != survey.chunks) {
    return failure(request.luanti + ": changed while it was read");
  }
  return {};
}

void print(const LuantiImportReport& report, const ImportRequest& request,
           const MaterialTable& materials, std::ostream& out) {
  out << request.world << ": " << report.blocks << " blocks became " << report.chunks
      << " chunks of edge " << request.edge << " with " << report.runs << " runs and "
      << report.materials.size() << " materials, to which the builders' palette adds "
      << materials.size() - report.materials.size() << ", " << report.damaged.size()
      << " damaged blocks left empty\n";
  for (std::size_t i = 0; i < report.damaged.size() && i < kDamagedListed; ++i) {
    const DamagedBlock& block = report.damaged[i];
    out << "damaged block " << block.block.x << "," << block.block.y << "," << block.block.z
        << " (pos " << block.pos << "): " << block.error.what << "\n";
  }
}

}  // namespace

Result<void, std::string> import_world(const ImportRequest& request, std::ostream& out) {
  if (sodium_init() < 0) return failure("libsodium cannot start");
  if (request.edge != 16 && request.edge != 32 && request.edge != 64 && request.edge != 128) {
    return failure("--edge " + std::to_string(request.edge) +
                   ": chunks have an edge of 16, 32, 64 or 128");
  }
  if (const auto free = NewFolder::check(request.world); !free) return failure(free.error());
  LuantiImportSink survey_sink;
  survey_sink.materials = [](const MaterialTable&) {};
  survey_sink.chunk = [](const ChunkKey&, RunChunk&&) { return true; };
  const auto survey = import_luanti(request.luanti, {request.edge, request.keep_all}, survey_sink);
  if (!survey) return failure(survey.error().message());
  if (survey->blocks == 0 && !survey->damaged.empty()) {
    const DamagedBlock& first = survey->damaged.front();
    return failure(request.luanti + ": each of its " + std::to_string(survey->damaged.size()) +
                   " blocks is damaged, the first at pos " + std::to_string(first.pos) + ": " +
                   first.error.what);
  }

  const auto materials = materials_of(request, *survey);
  if (!materials) return failure(materials.error());
  auto folder = NewFolder::make(request.world, out);
  if (!folder) return failure(folder.error());
  if (const auto filled = fill(request, *survey, *materials, folder->path()); !filled)
    return failure(filled.error());
  if (const auto finished = folder->finish("world.sqlite"); !finished)
    return failure(finished.error());
  print(*survey, request, *materials, out);
  return {};
}

}  // namespace runstone
