#include "server/import/import_luanti.hpp"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "common/core/assert.hpp"
#include "common/formats/block_assembler.hpp"
#include "common/formats/block_materials.hpp"
#include "common/formats/format.hpp"
#include "common/formats/luanti_block.hpp"
#include "common/runs/reorder.hpp"
#include "server/import/luanti_folder.hpp"
#include "server/import/luanti_map.hpp"

namespace runstone {
namespace {

constexpr std::uint64_t kProgressEvery = 64;  // blocks

class Importer {
 public:
  Importer(std::string file, LuantiMap& map, const Format& format,
           const LuantiImportOptions& options, const LuantiImportSink& sink)
      : file_(std::move(file)),
        map_(map),
        format_(format),
        options_(options),
        sink_(sink),
        block_materials_(format, options.keep_all, options.map) {}

  Result<LuantiImportReport, ImportError> run() {
    if (const auto scanned = scan(); !scanned) return error(scanned.error());
    auto table = block_materials_.make_table();
    if (!table) return error(table.error().what);
    std::sort(positions_.begin(), positions_.end());  // a damaged map may have another order
    report_.materials = *std::move(table);
    report_.applied = block_materials_.applied();
    sink_.materials(report_.materials);
    report_.voxels.assign(report_.materials.size(), 0);
    report_.spawn = {(report_.bounds.min.x + report_.bounds.max.x) / 2, report_.bounds.max.y,
                     (report_.bounds.min.z + report_.bounds.max.z) / 2};
    for (const ChunkCoord at : chunk_coords()) {
      if (!make_chunk(at)) return error("the import was stopped");
    }
    advance(0);
    return std::move(report_);
  }

 private:
  static std::optional<std::uint8_t> version_of(ByteView data) {
    if (data.empty()) return std::nullopt;
    return data[0];
  }

  Unexpected<ImportError> error(std::string what) const {
    return {ImportError{file_, std::move(what)}};
  }

  /// The first pass: finds the sound blocks, the names that they use, and their bounds.
  Result<void, std::string> scan() {
    std::optional<std::int64_t> last;  // the position of the row before
    return map_.each_row([&](const LuantiRow& row) {
      const bool is_repeated = row.is_placed && last == row.pos;
      if (row.is_placed) last = row.pos;
      if (is_repeated) {
        report_.repeated.push_back(row.block);
        advance(1);
        return;
      }
      const auto read = row.is_placed
                            ? format_.read(row.data,
                                           [&](ForeignPiece&& piece) {
                                             block_materials_.note(piece);
                                             return Result<void>();
                                           })
                            : fail(ErrorCode::bad_value, "luanti block: not a block position");
      advance(1);
      if (!read) {
        report_.damaged.push_back({row.pos, row.block, version_of(row.data), read.error()});
        return;
      }
      const VoxelBox box = box_of(row.block, kLuantiBlockEdge);
      if (positions_.empty()) report_.bounds = box;
      VoxelBox& all = report_.bounds;
      all.min = {std::min(all.min.x, box.min.x), std::min(all.min.y, box.min.y),
                 std::min(all.min.z, box.min.z)};
      all.max = {std::max(all.max.x, box.max.x), std::max(all.max.y, box.max.y),
                 std::max(all.max.z, box.max.z)};
      positions_.push_back(row.pos);
      ++report_.blocks;
    });
  }

  std::vector<ChunkCoord> chunk_coords() const {
    const auto key = [](const ChunkCoord& c) { return std::tuple(c.z, c.y, c.x); };
    std::vector<ChunkCoord> out;
    out.reserve(positions_.size());
    for (const std::int64_t pos : positions_) {
      out.push_back(chunk_of(origin_of(luanti_block_coord(pos), kLuantiBlockEdge), options_.edge));
    }
    // This is the order of the map's key, so that neighbouring rows are read together.
    std::sort(out.begin(), out.end(),
              [&](const auto& a, const auto& b) { return key(a) < key(b); });
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  /// Returns a sound block with the materials of the new world, or nullopt if there is none. It
  /// reads only positions that the first pass found, in the same read transaction. A row that is
  /// missing or does not decode now means a failing disk.
  std::optional<RunChunk> read_block(ChunkCoord at) {
    const std::int64_t pos = luanti_block_pos(at);
    if (!std::binary_search(positions_.begin(), positions_.end(), pos)) return std::nullopt;
    advance(1);
    const auto data = map_.find(at);
    std::optional<RunChunk> voxels;
    const auto read = data ? format_.read(*data,
                                          [&](ForeignPiece&& piece) {
                                            voxels = block_materials_.resolve(piece);
                                            return Result<void>();
                                          })
                           : fail(ErrorCode::io_failed, "luanti block: could not be read again");
    if (!read) {
      report_.damaged.push_back({pos, at, data ? version_of(*data) : std::nullopt, read.error()});
      --report_.blocks;
    }
    return voxels;
  }

  bool make_chunk(ChunkCoord at) {
    const auto side = static_cast<std::size_t>(options_.edge / kLuantiBlockEdge);
    std::vector<RunChunk> blocks;
    blocks.reserve(side * side * side);  // assemble_chunk() keeps pointers into it
    RunChunk chunk = assemble_chunk(options_.edge, at, [&](ChunkCoord block) -> const RunChunk* {
      auto voxels = read_block(block);
      if (!voxels) return nullptr;
      blocks.push_back(std::move(*voxels));
      return &blocks.back();
    });
    if (chunk.is_uniform() && chunk.runs.material(0) == kEmpty) return true;
    chunk = in_cheapest_order(std::move(chunk));
    RUNSTONE_ASSERT(validate(chunk).has_value());
    count(at, chunk);
    return sink_.chunk({0, at}, std::move(chunk));
  }

  void count(ChunkCoord at, const RunChunk& chunk) {
    ++report_.chunks;
    report_.runs += chunk.runs.size();
    for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
      report_.voxels[chunk.runs.material(i)] += chunk.runs.end(i) - chunk.runs.begin(i);
    }
    // The spawn is above the highest voxel of the middle column. A chunk above another one comes
    // later and replaces its value.
    const VoxelBox box = box_of(at, options_.edge);
    const std::int32_t x = report_.spawn.x, z = report_.spawn.z;
    if (!box.contains({x, box.min.y, z})) return;
    for (std::int32_t y = box.max.y - 1; y >= box.min.y; --y) {
      if (material_at(chunk, local_of({x, y, z}, options_.edge)) == kEmpty) continue;
      report_.spawn.y = y + 1;
      return;
    }
  }

  void advance(std::uint64_t blocks) {
    done_ += blocks;
    if (sink_.progress && (blocks == 0 || done_ % kProgressEvery == 0)) {
      // Both passes read each sound block once. Only the first one reads the other rows.
      sink_.progress(done_,
                     2 * map_.row_count() - report_.damaged.size() - report_.repeated.size());
    }
  }

  std::string file_;
  LuantiMap& map_;
  const Format& format_;
  const LuantiImportOptions& options_;
  const LuantiImportSink& sink_;
  LuantiImportReport report_;
  std::vector<std::int64_t> positions_;  // of sound blocks, ascending
  BlockMaterials block_materials_;
  std::uint64_t done_ = 0;  // block reads
};

}  // namespace

Result<LuantiImportReport, ImportError> import_luanti(const std::string& folder,
                                                      const LuantiImportOptions& options,
                                                      const LuantiImportSink& sink) {
  RUNSTONE_ASSERT(options.edge == 16 || options.edge == 32 || options.edge == 64 ||
                  options.edge == 128);
  auto found = find_luanti_map(folder);
  if (!found) return failure(found.error());
  const Format* format = format_of_file("map.sqlite");  // of rows, whatever keeps them
  RUNSTONE_ASSERT(format != nullptr);
  const auto map = open_luanti_map(*found);
  if (!map) return failure(ImportError{found->map, map.error()});
  if ((*map)->row_count() == 0)
    return failure(ImportError{found->map,
                               "has no blocks: start Luanti once with this world, so that there "
                               "is ground, or give the folder of another world"});
  Format nodes = *format;
  if (options.only_cubes) nodes.material_of = material_of_luanti_cube;
  auto report = Importer(found->map, **map, nodes, options, sink).run();
  if (report) report->has_seed_map = found->has_seed_map;
  return report;
}

}  // namespace runstone
