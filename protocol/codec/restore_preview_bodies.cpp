#include <utility>

#include "protocol/codec/body_reader.hpp"

namespace runstone {

Result<Message> BodyReader::read(const wire::RestorePreview& t) const {
  const auto count = count_of(t.edits(), kRestorePreviewEditsMax);
  if (!count) return bad("restore preview has more than 512 edits");
  RestorePreview m;
  m.command = t.command();
  m.voxels = t.voxels();
  m.chunks = t.chunks();
  m.is_cut = t.cut();
  if (!take_text(t.preview(), 0, kPreviewIdBytesMax, m.preview))
    return bad("restore preview: id is not 0 .. 32 bytes of text");
  m.edits.reserve(*count);
  std::size_t bytes = 0;
  for (std::uint32_t i = 0; i < *count; ++i) {
    bytes += view_of(t.edits()->Get(i)->edit()).size();
    if (bytes > kRestorePreviewBytesMax) return bad("restore preview is too long");
    auto edit = decode_voxel_edit(view_of(t.edits()->Get(i)->edit()));
    if (!edit) return failure(edit.error());
    m.edits.push_back(*std::move(edit));
  }
  return m;
}

}  // namespace runstone
