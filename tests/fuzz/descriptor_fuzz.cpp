// Any bytes as a descriptor and as a record: what decodes is valid, means exactly its own bytes, and its
// geometry agrees with itself.
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/edits/edit_geometry.hpp"
#include "common/edits/edit_record.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  const ByteView in(data, size);
  if (const auto edit = decode_descriptor(in)) {
    RUNSTONE_ASSERT(validate(*edit).has_value());
    const Bytes again = encode(*edit);
    RUNSTONE_ASSERT(again == Bytes(in.begin(), in.end()));
    RUNSTONE_ASSERT(again.size() <= descriptor_bytes_max(kind_of(*edit)));
    const VoxelBox box = bounding_box(*edit);
    RUNSTONE_ASSERT(touches(*edit, box) && counted_voxels(*edit) > 0);
    const std::uint64_t bound = touched_chunks_bound(*edit, 128);
    if (bound <= 1000) {
      const auto chunks = touched_chunks(*edit, 128);
      RUNSTONE_ASSERT(!chunks.empty() && chunks.size() <= bound);
    }
  }
  if (const auto record = decode_record(in)) {
    RUNSTONE_ASSERT(encode_record(*record) == Bytes(in.begin(), in.end()));
  }
  return 0;
}
