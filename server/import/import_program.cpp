#include "server/import/import_program.hpp"

#include <sodium.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/build_files/model_reading.hpp"
#include "common/edits/clipboard/orientation.hpp"
#include "common/materials/look_on_shape.hpp"
#include "common/materials/palette.hpp"
#include "common/os/new_folder.hpp"
#include "common/os/progress_line.hpp"
#include "server/import/import_builds.hpp"
#include "server/import/import_luanti.hpp"
#include "server/import/mapped_parts.hpp"
#include "server/import/turned_parts.hpp"
#include "server/mapping/material_map_file.hpp"
#include "server/store/store.hpp"
#include "server/store/world_folder.hpp"
#include "server/textures/stored_textures.hpp"
#include "server/textures/texture_import.hpp"

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

/// Returns the materials of the new world: those of the imported one, with looks that belong to their
/// shapes (look_on_shape()), and the palette.
Result<MaterialTable, std::string> materials_of(const ImportRequest& request,
                                                const MaterialTable& found) {
  MaterialTable materials = with_looks_on_shapes(found);
  if (request.palette && !append_palette(materials, default_material_table())) {
    return failure(request.source + ": its " + std::to_string(found.size()) +
                   " materials leave no room for the builders' palette: add --palette none");
  }
  return materials;
}

/// Gives the materials of the new world the textures of a folder.
Result<void, std::string> give_textures_of(const std::string& place, const MaterialTable& materials,
                                           Store& store, std::ostream& out) {
  const auto found = import_textures(place, materials, {});
  if (!found) return failure(found.error());
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto given = append_textures(
      store, found->textures, std::chrono::duration_cast<std::chrono::microseconds>(now).count());
  if (!given) return failure(given.error().message());
  out << textures_text(*found) << '\n';
  return {};
}

/// Makes the world in `folder`, and has `chunks` write its base.
Result<void, std::string> fill(
    const ImportRequest& request, const MaterialTable& materials, VoxelPos spawn,
    const std::string& folder, std::ostream& out,
    const std::function<Result<void, std::string>(BaseWriter&)>& chunks) {
  WorldMeta meta;
  meta.chunk_edge = request.edge;
  meta.generator.name = "empty";
  meta.materials = materials;
  meta.spawn = {spawn.x + 0.5, static_cast<double>(spawn.y), spawn.z + 0.5};
  draw_identity(meta);
  auto store = create_world(folder, meta);
  if (!store) return failure(store.error().message());
  BaseWriter base(**store);
  const auto done = chunks(base);
  if (!base.error().empty()) return failure(base.error());
  if (!done) return done;
  if (!base.flush()) return failure(base.error());
  if (request.textures.empty()) return {};
  return give_textures_of(request.textures, materials, **store, out);
}

Result<void, std::string> fill_from_luanti(const ImportRequest& request, const MaterialMap* map,
                                           const LuantiImportReport& survey, BaseWriter& base) {
  LuantiImportSink sink;
  sink.materials = [](const MaterialTable&) {};
  sink.chunk = [&](const ChunkKey& key, RunChunk&& voxels) {
    return base.add(key, std::move(voxels));
  };
  const auto report = import_luanti(request.source, {request.edge, request.keep_all, map}, sink);
  if (!report) return failure(report.error().message());
  if (report->materials != survey.materials || report->chunks != survey.chunks) {
    return failure(request.source +
                   ": changed while it was read: stop the Luanti server, or import a copy");
  }
  return {};
}

constexpr const char* kOtherLuanti =
    "blocks of versions 24 to 29 are read (Luanti 0.4.2 and later). To import others, let Luanti "
    "5.5 or later rewrite a copy of the world (luantiserver --world COPY --recompress)";

std::string place_of(const DamagedBlock& block) {
  return "pos " + std::to_string(block.pos) +
         (block.version ? ", version " + std::to_string(*block.version) : std::string());
}

/// Returns true if a block is of a version that is not read, or is damaged and of an older version
/// than Luanti writes today.
bool needs_other_luanti(const std::vector<DamagedBlock>& damaged) {
  return std::any_of(damaged.begin(), damaged.end(), [](const DamagedBlock& block) {
    return block.error.code == ErrorCode::bad_version ||
           (block.version && *block.version >= 24 && *block.version < 29);
  });
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
    out << "damaged block " << block.block.x << "," << block.block.y << "," << block.block.z << " ("
        << place_of(block) << "): " << block.error.what << "\n";
  }
  if (needs_other_luanti(report.damaged)) out << kOtherLuanti << "\n";
  if (!report.repeated.empty()) {
    const ChunkCoord& first = report.repeated.front();
    out << report.repeated.size()
        << " rows have the position of an earlier row, the first at block " << first.x << ","
        << first.y << "," << first.z
        << ": the earlier row was imported. The map has no key, so another program changed it\n";
  }
  if (report.has_seed_map)
    out << "world.mt names a readonly_backend: the blocks of that map were not imported\n";
}

/// Makes the new world, which `chunks` fills.
Result<MaterialTable, std::string> make_world(
    const ImportRequest& request, const MaterialTable& found, VoxelPos spawn, std::ostream& out,
    const std::function<Result<void, std::string>(const MaterialTable&, BaseWriter&)>& chunks) {
  const auto materials = materials_of(request, found);
  if (!materials) return failure(materials.error());
  auto folder = NewFolder::make(request.world, out);
  if (!folder) return failure(folder.error());
  const auto filled = fill(request, *materials, spawn, folder->path(), out,
                           [&](BaseWriter& base) { return chunks(*materials, base); });
  if (!filled) return failure(filled.error());
  if (const auto finished = folder->finish("world.sqlite"); !finished)
    return failure(finished.error());
  return *materials;
}

void print_unused_rows(const ImportRequest& request, const MaterialMap* map,
                       const AppliedRows& applied, std::ostream& out) {
  if (map == nullptr) return;
  const std::string notice = unused_rows_notice(request.map, *map, applied);
  if (!notice.empty()) out << notice << '\n';
}

Result<void, std::string> import_luanti_world(const ImportRequest& request, const MaterialMap* map,
                                              std::ostream& out) {
  LuantiImportSink survey_sink;
  survey_sink.materials = [](const MaterialTable&) {};
  survey_sink.chunk = [](const ChunkKey&, RunChunk&&) { return true; };
  const auto survey =
      import_luanti(request.source, {request.edge, request.keep_all, map}, survey_sink);
  if (!survey) return failure(survey.error().message());
  if (survey->blocks == 0 && !survey->damaged.empty()) {
    const DamagedBlock& first = survey->damaged.front();
    return failure(request.source + ": each of its " + std::to_string(survey->damaged.size()) +
                   " blocks is damaged, the first at " + place_of(first) + ": " + first.error.what +
                   (needs_other_luanti(survey->damaged) ? std::string("; ") + kOtherLuanti : ""));
  }
  if (survey->chunks == 0) {
    return failure(request.source + ": nothing but air is in its " +
                   std::to_string(survey->blocks) + " blocks" +
                   (request.keep_all ? "" : ". Plants are imported with --keep-all"));
  }
  const auto materials = make_world(request, survey->materials, survey->spawn, out,
                                    [&](const MaterialTable&, BaseWriter& base) {
                                      return fill_from_luanti(request, map, *survey, base);
                                    });
  if (!materials) return failure(materials.error());
  print(*survey, request, *materials, out);
  print_unused_rows(request, map, survey->applied, out);
  return {};
}

void print(const BuildsReport& report, const ImportRequest& request, const BuildsSurvey& survey,
           std::size_t materials, std::ostream& out) {
  const VoxelBox& box = survey.bounds;
  out << request.world << ": " << report.voxels << " voxels in a box of " << box.max.x - box.min.x
      << " x " << box.max.y - box.min.y << " x " << box.max.z - box.min.z << " became "
      << report.chunks << " chunks of edge " << request.edge << " with " << report.runs
      << " runs and " << survey.materials.size()
      << " materials, to which the builders' palette adds " << materials - survey.materials.size()
      << '\n';
  for (std::size_t i = 0; i < report.faults.size() && i < kDamagedListed; ++i)
    out << "left out: " << report.faults[i] << '\n';
  if (report.faults.size() > kDamagedListed)
    out << "left out: " << report.faults.size() - kDamagedListed << " more\n";
}

Result<void, std::string> import_parts(const ImportRequest& request, ImportParts& parts,
                                       std::ostream& out) {
  ProgressLine line("parts read", request.progress);
  const ImportProgress progress = [&](std::uint64_t done, std::uint64_t total) {
    line.show(done, total);
  };
  const auto survey = survey_builds(parts, progress);
  if (!survey) return failure(request.source + ": " + survey.error());
  BuildsReport report;
  const auto materials =
      make_world(request, survey->materials, survey->spawn, out,
                 [&](const MaterialTable& table, BaseWriter& base) -> Result<void, std::string> {
                   auto done = import_builds(
                       parts, table, request.edge,
                       [&](const ChunkKey& key, RunChunk&& voxels) {
                         return base.add(key, std::move(voxels));
                       },
                       progress);
                   if (!done) return failure(request.source + ": " + done.error());
                   report = *std::move(done);
                   return {};
                 });
  if (!materials) return failure(materials.error());
  print(report, request, *survey, materials->size(), out);
  for (const std::string& notice : parts.notices()) out << notice << '\n';
  return {};
}

}  // namespace

Result<void, std::string> import_world(const ImportRequest& request, std::ostream& out) {
  if (sodium_init() < 0) return failure("libsodium cannot start");
  if (request.edge != 16 && request.edge != 32 && request.edge != 64 && request.edge != 128) {
    return failure("--edge " + std::to_string(request.edge) +
                   ": chunks have an edge of 16, 32, 64 or 128");
  }
  if (!request.colours.empty() && request.kind != ImportKind::file)
    return failure("--colours: only import file takes it, for a height map");
  if (const auto free = NewFolder::check(request.world); !free) return failure(free.error());
  std::optional<MaterialMap> map;
  if (!request.map.empty()) {
    auto read = read_material_map(request.map);
    if (!read) return failure(read.error());
    map = *std::move(read);
  }
  const MaterialMap* const chosen = map ? &*map : nullptr;
  if (request.kind == ImportKind::luanti) return import_luanti_world(request, chosen, out);
  auto parts = request.kind == ImportKind::file
                   ? open_file_parts(request.source, request.at, request.keep_all, request.colours,
                                     request.model)
                   : open_minecraft_parts(request.source, request.keep_all);
  if (!parts) return failure(parts.error());
  std::unique_ptr<ImportParts> all = *std::move(parts);
  const MappedParts* mapped = nullptr;
  if (chosen != nullptr) {
    auto made = std::make_unique<MappedParts>(std::move(all), *chosen);
    mapped = made.get();
    all = std::move(made);
  }
  // A map has the names of the file, so the build is turned after the map was applied. A model was
  // turned when it was read.
  const int quarters = request.model.quarters;
  if (request.kind == ImportKind::file && quarters != 0 && !is_model_file(request.source)) {
    all = std::make_unique<TurnedParts>(std::move(all), Orientation{}.rotated_about_y(quarters));
  }
  const auto done = import_parts(request, *all, out);
  if (done && mapped != nullptr) print_unused_rows(request, chosen, mapped->applied(), out);
  return done;
}

}  // namespace runstone
