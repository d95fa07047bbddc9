#include "protocol/codec/patch_list.hpp"

#include "common/core/assert.hpp"
#include "common/veil/veil_patch_bytes.hpp"
#include "protocol/limits.hpp"

namespace runstone {

void put_patches(ByteWriter& out, std::span<const ChunkPatch> patches, Sequence seq) {
  RUNSTONE_ASSERT(patches.size() <= kVeilPatchesMax);
  KeyWriter keys;
  Bytes bytes;
  for (const ChunkPatch& patch : patches) {
    RUNSTONE_ASSERT(patch.previous <= seq && !patch.patch.empty());
    keys.put(out, {0, patch.at});
    out.varint(seq - patch.previous);
    bytes.clear();
    ByteWriter spans(bytes);
    write_patch_bytes(patch.patch, spans);
    out.varint(bytes.size());
    out.bytes(bytes);
  }
}

ChunkPatch take_patch(ByteReader& in, KeyReader& keys, Sequence seq, bool may_stay,
                      std::int32_t edge) {
  const ChunkKey key = keys.take(in);
  const std::uint64_t back = in.varint_max(seq, "previous sequence lies before the log");
  if (in.ok() && back == 0 && !may_stay)
    in.reject(ErrorCode::bad_value, "a patch does not follow its chunk");
  const std::uint64_t size = in.varint_max(in.left(), "patch is too long");
  const ByteView bytes = in.bytes(static_cast<std::size_t>(size));
  if (!in.ok()) return {};
  auto patch = read_patch_bytes(bytes, Extent::cube(static_cast<unsigned>(edge)));
  if (!patch) {
    in.reject(patch.error().code, patch.error().what);
    return {};
  }
  if (patch->empty()) in.reject(ErrorCode::not_canonical, "a patch has no spans");
  return {key.at, seq - back, *std::move(patch)};
}

}  // namespace runstone
