#include "server/history/voxel_mark.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_memory.hpp"
#include "common/edits/restore/voxel_restore.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {
namespace {

constexpr Sequence kWindowFirst = 4'096;
// A window is read to its end if it has no more records than this, whatever it costs.
constexpr Sequence kWindowMin = 1'024;
constexpr std::uint64_t kWindowCostMax = 1'024;
constexpr std::size_t kBytesOfCost = 1'024;

/// The newest records whose shapes have the voxel, ascending.
struct VoxelRecords {
  std::vector<EditRecord> records;
  bool is_set = false;  // the first one has no mask, so that older ones do not matter
  bool is_cut = false;  // older ones may matter and were not read
  std::uint64_t cost = 0;
};

/// Reads the records first .. last. The result is cut, and its records do not count, if they cost
/// more than `cost_max`.
StoreResult<VoxelRecords> read_window(LogReader& reader, const VoxelBox& voxel, Sequence first,
                                      Sequence last, std::uint64_t cost_max) {
  VoxelRecords window;
  LogQuery query;
  query.box = voxel;
  query.first = first;
  query.last = last;
  const auto pays = [&](std::uint64_t cost) {
    window.cost += cost;
    window.is_cut = window.is_cut || window.cost > cost_max;
    return !window.is_cut;
  };
  // The query passes segments of the index, and then the records in them.
  query.wants = [&](const VoxelBox& /*box*/, Sequence /*last*/) { return pays(1); };
  const auto read = reader.query_log(query, [&](const EditRecord& record) {
    if (!pays(memory_bytes(record.edit) / kBytesOfCost)) return false;
    if (!touches(record.edit, voxel)) return true;
    if (record.edit.mask.kind == MaskKind::everything) {
      window.records.clear();
      window.is_set = true;
    }
    window.records.push_back(record);
    return true;
  });
  if (!read) return failure(read.error());
  return window;
}

StoreResult<VoxelRecords> read_records(LogReader& reader, const LogRange& range, VoxelPos at) {
  VoxelRecords out;
  const VoxelBox voxel{at, {at.x + 1, at.y + 1, at.z + 1}};
  Sequence last = range.last.version.seq;
  for (Sequence width = kWindowFirst; last >= range.first && !out.is_set;) {
    if (out.cost >= kVoxelMarkCostMax) {
      out.is_cut = true;
      break;
    }
    const Sequence first = last - range.first >= width ? last - width + 1 : range.first;
    const bool is_least = width <= kWindowMin;
    auto window = read_window(reader, voxel, first, last, is_least ? UINT64_MAX : kWindowCostMax);
    if (!window) return failure(window.error());
    out.cost += window->cost;
    if (window->is_cut) {
      width = std::max(kWindowMin, width / 4);
      continue;
    }
    out.records.insert(out.records.begin(), std::make_move_iterator(window->records.begin()),
                       std::make_move_iterator(window->records.end()));
    out.is_set = window->is_set;
    last = first - 1;
    width *= 2;
  }
  return out;
}

/// Returns the material of the voxel before the log.
StoreResult<Material> base_material(WorldReader& reader, const Generator& generator, VoxelPos at) {
  const std::int32_t edge = reader.meta().chunk_edge;
  const auto chunk = base_chunk_in_any_order(reader, generator, {0, chunk_of(at, edge)});
  if (!chunk) return failure(chunk.error());
  return material_at(chunk->voxels, local_of(at, edge));
}

}  // namespace

StoreResult<FoundLogMarks> read_voxel_mark(WorldReader& reader, const Generator& generator,
                                           VoxelPos at) {
  const auto range = reader.log_range();
  if (!range) return failure(range.error());
  FoundLogMarks out;
  out.first = std::max<Sequence>(1, range->first);
  const auto found = read_records(reader, *range, at);
  if (!found) return failure(found.error());
  out.cost = found->cost;
  if (found->records.empty() || found->is_cut) return out;
  Material before = kEmpty;
  if (!found->is_set) {
    const auto base = base_material(reader, generator, at);
    if (!base) return failure(base.error());
    before = *base;
  }
  VoxelRestore voxel({at}, {before});
  ApplyScratch scratch;
  const EditRecord* newest = nullptr;
  for (const EditRecord& record : found->records) {
    const Material present = voxel.now()[0];
    voxel.add(record.edit, false, scratch);
    if (record.edit.mask.kind == MaskKind::everything || voxel.now()[0] != present)
      newest = &record;
  }
  if (newest == nullptr || static_cast<std::uint8_t>(newest->cause) > kLogMarkCauseMax) return out;
  out.marks.push_back({newest->version.seq, newest->time_us, newest->op.author, newest->cause,
                       kind_of(newest->edit)});
  return out;
}

}  // namespace runstone
