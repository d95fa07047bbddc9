#include "common/veil/veil_patch_bytes.hpp"

#include "common/core/assert.hpp"
#include "common/veil/veil.hpp"

namespace runstone {

void write_patch_bytes(const VeilPatch& patch, ByteWriter& out) {
  RUNSTONE_ASSERT(patch.order == kVeilOrder);
  out.varint(patch.spans.size());
  std::uint32_t end = 0;
  const VeilSpan* before = nullptr;
  for (const VeilSpan& span : patch.spans) {
    const bool repeats = before != nullptr && before->material == span.material;
    out.varint(span.first - end);
    out.varint(2 * (std::uint64_t{span.count} - 1) + (repeats ? 1 : 0));
    if (!repeats) out.varint(span.material);
    end = span.first + span.count;
    before = &span;
  }
}

Result<VeilPatch> read_patch_bytes(ByteView bytes, Extent extent) {
  constexpr std::size_t kSpanBytesMin = 2;
  VeilPatch out{extent, kVeilOrder, {}};
  ByteReader in(bytes);
  const std::uint32_t volume = extent.volume();
  const std::uint64_t count = in.varint_max(volume, "spans of a patch");
  if (in.ok() && count > in.left() / kSpanBytesMin)
    in.reject(ErrorCode::truncated, "spans of a patch");
  if (in.ok()) out.spans.reserve(static_cast<std::size_t>(count));
  std::uint32_t end = 0;
  for (std::uint64_t i = 0; i < count && in.ok(); ++i) {
    if (end == volume) {
      in.reject(ErrorCode::bad_value, "a span leaves the chunk");
      break;
    }
    VeilSpan span;
    span.first =
        end + static_cast<std::uint32_t>(in.varint_max(volume - end - 1, "first voxel of a span"));
    const std::uint64_t length =
        in.varint_max(2 * (std::uint64_t{volume} - span.first - 1) + 1, "voxels of a span");
    span.count = static_cast<std::uint32_t>(length / 2 + 1);
    if (length % 2 == 0) {
      span.material = static_cast<Material>(in.varint_max(kMaterialCountMax - 1, "material"));
      if (in.ok() && i != 0 && span.material == out.spans.back().material)
        in.reject(ErrorCode::not_canonical, "a material is repeated");
    } else if (i == 0) {
      in.reject(ErrorCode::bad_value, "the first span has no material");
    } else if (span.first == end) {
      in.reject(ErrorCode::not_canonical, "spans of one material touch");
    } else {
      span.material = out.spans.back().material;
    }
    end = span.first + span.count;
    out.spans.push_back(span);
  }
  if (const auto finished = in.finish(); !finished) return failure(finished.error());
  return out;
}

}  // namespace runstone
