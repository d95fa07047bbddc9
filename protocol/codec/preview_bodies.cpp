#include <cstdint>
#include <optional>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"
#include "protocol/codec/body_reader.hpp"
#include "protocol/codec/preview_list.hpp"

namespace runstone {
namespace {

Result<std::vector<EditDescriptor>> read_list(ByteView bytes) {
  std::vector<EditDescriptor> edits;
  if (bytes.size() > kPreviewListBytesMax) return bad("preview: its edits are too long");
  ByteReader in(bytes);
  while (!in.at_end()) {
    if (edits.size() == kPreviewEditsMax) return bad("preview: too many edits");
    const std::uint64_t length = in.varint_max(kPreviewBytesMax, "preview: an edit is too long");
    const ByteView descriptor = in.bytes(static_cast<std::size_t>(length));
    if (!in.ok()) return failure(in.error());
    auto edit = decode_voxel_edit(descriptor);
    if (!edit) return failure(edit.error());
    edits.push_back(*std::move(edit));
  }
  return edits;
}

/// Reads the stroke of a preview; no bytes are no stroke.
Result<std::optional<BrushStroke>> read_stroke(ByteView bytes, bool has_edits) {
  if (bytes.empty()) return std::optional<BrushStroke>();
  if (!has_edits) return bad("preview: a stroke without edits");
  auto stroke = decode_stroke(bytes);
  if (!stroke) return failure(stroke.error());
  return std::optional(*std::move(stroke));
}

}  // namespace

Bytes encode_preview(const std::vector<EditDescriptor>& edits) {
  Bytes bytes;
  ByteWriter out(bytes);
  for (const EditDescriptor& edit : edits) {
    const Bytes descriptor = encode(edit);
    out.varint(descriptor.size());
    out.bytes(descriptor);
  }
  return bytes;
}

bool is_light_preview(const EditDescriptor& edit, std::int32_t chunk_edge) {
  if (touched_chunks_bound(edit, chunk_edge) > kPreviewChunksMax) return false;
  const auto* const paste = std::get_if<Paste>(&edit.shape);
  return paste == nullptr || paste->orientation == Orientation{} ||
         paste->clipboard->extent().volume() <= kPreviewTurnedVoxelsMax;
}

bool may_be_shared(const std::vector<EditDescriptor>& edits, std::int32_t chunk_edge) {
  if (edits.size() > kPreviewEditsMax) return false;
  for (const EditDescriptor& edit : edits) {
    if (!validate(edit) || !is_light_preview(edit, chunk_edge)) return false;
  }
  return encode_preview(edits).size() <= kPreviewListBytesMax;
}

Result<Message> BodyReader::read(const wire::PreviewShare& t) const {
  auto edits = read_list(view_of(t.edits()));
  if (!edits) return failure(edits.error());
  auto stroke = read_stroke(view_of(t.stroke()), !edits->empty());
  if (!stroke) return failure(stroke.error());
  return Message{PreviewShare{*std::move(edits), *std::move(stroke)}};
}

Result<Message> BodyReader::read(const wire::PlayerPreview& t) const {
  auto edits = read_list(view_of(t.edits()));
  if (!edits) return failure(edits.error());
  auto stroke = read_stroke(view_of(t.stroke()), !edits->empty());
  if (!stroke) return failure(stroke.error());
  return Message{PlayerPreview{t.author(), *std::move(edits), *std::move(stroke)}};
}

}  // namespace runstone
