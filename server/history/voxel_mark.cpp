#include "server/history/voxel_mark.hpp"

#include <algorithm>
#include <vector>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/restore/voxel_restore.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {
namespace {

/// The newest records whose shapes have the voxel, ascending.
struct VoxelRecords {
  std::vector<EditRecord> records;
  bool is_set = false;  // the first one has no mask, so that older ones do not matter
  bool is_cut = false;  // older ones may matter and were not read
};

StoreResult<VoxelRecords> read_records(LogReader& reader, const LogRange& range, VoxelPos at) {
  VoxelRecords out;
  const VoxelBox voxel{at, {at.x + 1, at.y + 1, at.z + 1}};
  std::size_t looks = 0;
  Sequence last = range.last.version.seq;
  for (Sequence width = 4096; last >= range.first && !out.is_set; width *= 2) {
    if (looks >= kVoxelMarkLooksMax) {
      out.is_cut = true;
      break;
    }
    LogQuery query;
    query.box = voxel;
    query.last = last;
    query.first = last - range.first >= width ? last - width + 1 : range.first;
    std::vector<EditRecord> window;
    const auto read = reader.query_log(query, [&](const EditRecord& record) {
      ++looks;
      if (!touches(record.edit, voxel)) return true;
      if (record.edit.mask.kind == MaskKind::everything) {
        window.clear();
        out.is_set = true;
      }
      window.push_back(record);
      return true;
    });
    if (!read) return failure(read.error());
    out.records.insert(out.records.begin(), window.begin(), window.end());
    last = query.first - 1;
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
