#include "common/mesh/shapes/face_lists.hpp"

#include <algorithm>
#include <bit>

#include "common/mesh/shapes/shape_mesher.hpp"

namespace runstone::shape_mesh {

void FaceLists::begin() {
  room_ = 0;
  room_in_all_ = 0;
  for (Pass& pass : passes_) {
    for (std::size_t i = 0; i < kListCount; ++i) pass.end[i] = pass.buffers[i].data();
  }
}

std::size_t FaceLists::capacity() const {
  std::size_t out = 0;
  for (const Pass& pass : passes_) {
    for (const std::vector<Quad>& buffer : pass.buffers) out += buffer.size();
  }
  return out;
}

bool FaceLists::grow(std::size_t in_one, std::size_t in_all) {
  constexpr std::size_t kLeast = 2'048;
  std::size_t all = 0;
  for (Pass& pass : passes_) {
    for (std::size_t i = 0; i < kListCount; ++i)
      all += static_cast<std::size_t>(pass.end[i] - pass.buffers[i].data());
  }
  if (all >= kShapeQuadsMax) return false;
  room_in_all_ = std::max(in_all, kRoomMax);
  room_ = room_in_all_;
  for (Pass& pass : passes_) {
    for (std::size_t i = 0; i < kListCount; ++i) {
      std::vector<Quad>& buffer = pass.buffers[i];
      const auto size = static_cast<std::size_t>(pass.end[i] - buffer.data());
      if (buffer.size() - size < in_one) {
        buffer.resize(size + size / 2 + std::max(in_one, kLeast));
        pass.end[i] = buffer.data() + size;
      }
      room_ = std::min(room_, buffer.size() - size);
    }
  }
  return true;
}

/// Joins each quad to the last one that equals it but for the place along `along`, if that one ends
/// where it begins. The quads of one key ascend along `along`, so no other one can end there.
std::size_t FaceLists::join(Quad* first, const Quad* end, Direction d, Axis along) {
  const auto count = static_cast<std::size_t>(end - first);
  if (count < 2) return count;
  const unsigned place = place_shift(along), size = size_shift(d, along);
  const std::uint64_t ignored = std::uint64_t{127} << place | std::uint64_t{127} << size;
  const auto bits = static_cast<unsigned>(std::bit_width(2 * count - 1));
  table_.assign(std::size_t{1} << bits, 0);
  const std::size_t last_slot = table_.size() - 1;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Quad quad = first[i];
    const std::uint64_t key = quad.bits & ~ignored;
    auto slot = static_cast<std::size_t>(key * 0x9e37'79b9'7f4a'7c15 >> (64 - bits));
    while (table_[slot] != 0 && (first[table_[slot] - 1].bits & ~ignored) != key)
      slot = (slot + 1) & last_slot;
    if (table_[slot] != 0) {
      Quad& before = first[table_[slot] - 1];
      const std::uint64_t before_end =
          (before.bits >> place & 127) + (before.bits >> size & 127) + 1;
      if (before_end == (quad.bits >> place & 127)) {
        before.bits += std::uint64_t{1} << size;
        continue;
      }
    }
    first[kept] = quad;
    table_[slot] = static_cast<std::uint32_t>(++kept);
  }
  return kept;
}

void FaceLists::finish(AxisOrder order, ShapeQuads& out) {
  for (const bool is_transparent : {false, true}) {
    Pass& lists = pass(is_transparent);
    std::size_t count = 0;
    for (std::size_t i = 0; i < kListCount; ++i) {
      const auto d = static_cast<Direction>(i / 4);
      const std::size_t joins = i % 4;
      const JoinAxes axes = join_axes(order, d);
      Quad* const first = lists.buffers[i].data();
      if ((joins & kJoinsFirst) != 0)
        lists.end[i] = first + join(first, lists.end[i], d, axes.first);
      if ((joins & kJoinsSecond) != 0)
        lists.end[i] = first + join(first, lists.end[i], d, axes.second);
      count += static_cast<std::size_t>(lists.end[i] - first);
    }
    std::vector<Quad>& to = is_transparent ? out.transparent : out.opaque;
    to.resize(count);
    Quad* next = to.data();
    for (std::size_t i = 0; i < kListCount; ++i)
      next = std::copy(lists.buffers[i].data(), lists.end[i], next);
  }
}

}  // namespace runstone::shape_mesh
