// The target decodes any bytes as a descriptor and as a record. A decoded value is valid, encodes
// to the same bytes, and its geometry is consistent.
#include <cstdint>
#include <vector>

#include "common/core/assert.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_record.hpp"

namespace runstone {
namespace {

/// A paste is small enough to be counted in all its chunks: each touched cell lies in one of them.
void check_paste(const EditDescriptor& edit) {
  constexpr std::int32_t kEdge = 64;
  std::uint64_t voxels = 0;
  std::vector<IndexSpan> spans;
  for (const ChunkCoord at : touched_chunks(edit, kEdge)) {
    spans.clear();
    append_spans(edit, origin_of(at, kEdge), Extent::cube(kEdge), AxisOrder::zxy, spans);
    RUNSTONE_ASSERT(!spans.empty());
    for (const IndexSpan& span : spans) voxels += span.last - span.first;
  }
  RUNSTONE_ASSERT(voxels == counted_voxels(edit));
  RUNSTONE_ASSERT(material_max(edit) >= edit.mask.material);
}

}  // namespace
}  // namespace runstone

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  const ByteView in(data, size);
  if (const auto edit = decode_descriptor(in)) {
    RUNSTONE_ASSERT(validate(*edit).has_value());
    const Bytes again = encode(*edit);
    RUNSTONE_ASSERT(again == Bytes(in.begin(), in.end()));
    RUNSTONE_ASSERT(again.size() <= descriptor_bytes_max(kind_of(*edit)));
    const VoxelBox box = bounding_box(*edit);
    RUNSTONE_ASSERT(touches(*edit, box) == has_voxels(*edit));
    RUNSTONE_ASSERT((counted_voxels(*edit) > 0) == has_voxels(*edit));
    if (std::holds_alternative<Paste>(edit->shape)) check_paste(*edit);
    const std::uint64_t bound = touched_chunks_bound(*edit, 128);
    if (bound <= 1000) {
      const auto chunks = touched_chunks(*edit, 128);
      RUNSTONE_ASSERT(chunks.empty() != has_voxels(*edit) && chunks.size() <= bound);
      for (const ChunkCoord at : chunks) RUNSTONE_ASSERT(touches(*edit, box_of(at, 128)));
    }
  }
  if (const auto record = decode_record(in)) {
    RUNSTONE_ASSERT(encode_record(*record) == Bytes(in.begin(), in.end()));
  }
  return 0;
}
