#include "common/mesh/shapes/face_lists.hpp"

#include <bit>

namespace runstone::shape_mesh {

std::size_t FaceLists::size() const {
  std::size_t out = 0;
  for (const OfPass& pass : passes_) {
    for (const std::vector<Quad>& quads : pass) out += quads.size();
  }
  return out;
}

void FaceLists::clear() {
  for (OfPass& pass : passes_) {
    for (std::vector<Quad>& quads : pass) quads.clear();
  }
}

/// Joins each quad to the last one that equals it but for the place along `along`, if that one ends
/// where it begins. The quads of one key ascend along `along`, so no other one can end there.
void FaceLists::join(std::vector<Quad>& quads, Direction d, Axis along) {
  if (quads.size() < 2) return;
  const unsigned place = place_shift(along), size = size_shift(d, along);
  const std::uint64_t ignored = std::uint64_t{127} << place | std::uint64_t{127} << size;
  const auto bits = static_cast<unsigned>(std::bit_width(2 * quads.size() - 1));
  table_.assign(std::size_t{1} << bits, 0);
  const std::size_t last_slot = table_.size() - 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    const Quad quad = quads[i];
    const std::uint64_t key = quad.bits & ~ignored;
    std::size_t slot = key * 0x9e37'79b9'7f4a'7c15 >> (64 - bits);
    while (table_[slot] != 0 && (quads[table_[slot] - 1].bits & ~ignored) != key)
      slot = (slot + 1) & last_slot;
    if (table_[slot] != 0) {
      Quad& before = quads[table_[slot] - 1];
      const std::uint64_t end = (before.bits >> place & 127) + (before.bits >> size & 127) + 1;
      if (end == (quad.bits >> place & 127)) {
        before.bits += std::uint64_t{1} << size;
        continue;
      }
    }
    quads[kept] = quad;
    table_[slot] = static_cast<std::uint32_t>(++kept);
  }
  quads.resize(kept);
}

void FaceLists::finish(AxisOrder order, ShapeQuads& out) {
  for (const bool is_transparent : {false, true}) {
    std::vector<Quad>& to = is_transparent ? out.transparent : out.opaque;
    to.clear();
    OfPass& lists = pass(is_transparent);
    std::size_t count = 0;
    for (std::size_t i = 0; i < kDirectionCount; ++i) {
      const auto d = static_cast<Direction>(i);
      const JoinAxes axes = join_axes(order, d);
      for (const Joins joins : {kJoinsNone, kJoinsFirst, kJoinsSecond, kJoinsBoth}) {
        std::vector<Quad>& quads = lists[list_of(d, joins)];
        if ((joins & kJoinsFirst) != 0) join(quads, d, axes.first);
        if ((joins & kJoinsSecond) != 0) join(quads, d, axes.second);
        count += quads.size();
      }
    }
    to.reserve(count);
    for (const std::vector<Quad>& quads : lists) to.insert(to.end(), quads.begin(), quads.end());
  }
}

}  // namespace runstone::shape_mesh
