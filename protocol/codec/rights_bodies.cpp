#include <cstdint>
#include <utility>

#include "protocol/codec/body_reader.hpp"

namespace runstone {
namespace {

/// Requires a corner of a box within the world.
bool take_corner(const wire::Corner* from, VoxelPos& to) {
  if (from == nullptr) return false;
  to = {from->x(), from->y(), from->z()};
  const auto inside = [](std::int32_t c) { return c >= -kWorldLimit && c <= kWorldLimit; };
  return inside(to.x) && inside(to.y) && inside(to.z);
}

Result<void> take_ground_box(const wire::GroundBox& t, GroundBox& box) {
  box.seq = t.seq();
  box.priority = t.priority();
  box.admits = t.admits();
  if (box.seq == 0 || box.seq > kSequenceMax) return bad("ground box: seq is out of range");
  if (!take_corner(t.min(), box.box.min) || !take_corner(t.max(), box.box.max) || box.box.empty())
    return bad("ground box: empty or outside the world");
  if (box.priority < -kGroundPriorityMax || box.priority > kGroundPriorityMax)
    return bad("ground box: priority is not within 1000");
  if (!take_text(t.name(), 1, kGroundNameBytesMax, box.name))
    return bad("ground box: name is not 1 .. 32 bytes of text");
  if (!take_text(t.owner(), 0, kPlayerNameBytesMax, box.owner))
    return bad("ground box: owner is not 0 .. 32 bytes of text");
  return {};
}

}  // namespace

Result<Message> BodyReader::read(const wire::Permissions& t) const {
  Permissions m;
  m.rights = t.rights();
  m.edit_volume_max = t.edit_volume_max();
  m.edit_budget = {t.edits_per_second(), t.edit_burst()};
  if ((m.edit_budget.per_second == 0) != (m.edit_budget.burst == 0))
    return bad("permissions.edits_per_second and edit_burst are not both 0 or both above");
  if (!take_text(t.role(), 1, kGroundNameBytesMax, m.role))
    return bad("permissions.role is not 1 .. 32 bytes of text");
  if (!take_text(t.edits_refused(), 0, kTextBytesMax, m.edits_refused))
    return bad("permissions.edits_refused is not 0 .. 256 bytes of text");
  return m;
}

Result<Message> BodyReader::read(const wire::ProtectedGround& t) const {
  const auto removed = count_of(t.removed(), kGroundBoxesMax);
  const auto count = count_of(t.boxes(), kGroundBoxesMax);
  if (!removed || !count || *removed + *count == 0)
    return bad("protected ground has no change, or a list of more than 1024");
  // The verifier checks the alignment of a list, not that of its entries.
  if (*removed != 0 &&
      reinterpret_cast<std::uintptr_t>(t.removed()->Data()) % sizeof(Sequence) != 0)
    return bad("protected ground: removed boxes are not aligned");
  ProtectedGround m;
  if (*removed != 0) m.removed.assign(t.removed()->begin(), t.removed()->end());
  for (std::uint32_t i = 0; i < *removed; ++i) {
    if (m.removed[i] == 0 || m.removed[i] > kSequenceMax)
      return bad("protected ground: removed seq is out of range");
    if (i > 0 && m.removed[i] <= m.removed[i - 1])
      return bad("protected ground: removed boxes do not ascend");
  }
  m.boxes.resize(*count);
  for (std::uint32_t i = 0; i < *count; ++i) {
    if (const auto ok = take_ground_box(*t.boxes()->Get(i), m.boxes[i]); !ok)
      return failure(ok.error());
    if (i > 0 && m.boxes[i].seq <= m.boxes[i - 1].seq)
      return bad("protected ground: boxes do not ascend");
  }
  return m;
}

}  // namespace runstone
