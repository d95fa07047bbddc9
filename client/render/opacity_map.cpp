#include "client/render/opacity_map.hpp"

#include <algorithm>
#include <bit>

namespace runstone {
namespace {

constexpr std::uint32_t kTableEntries =
    OpacityMap::kTableSide * OpacityMap::kTableSide * OpacityMap::kTableSide;
constexpr std::uint32_t kWordsAtFirst = 1U << 18;
constexpr std::uint32_t kNone = 0, kAll = 1;  // the two words that chunks share
constexpr std::uint32_t kHasWords = 1U << 15;

std::uint32_t shifts_of(AxisOrder order, unsigned edge_bits) {
  const auto axes = axes_of(order);
  std::uint32_t out = 0;
  for (unsigned rank = 0; rank < 3; ++rank)
    out |= rank * edge_bits << (5 * static_cast<unsigned>(axes[rank]));
  return out;
}

}  // namespace

OpacityMap::OpacityMap()
    : bits_(GL_R32UI, sizeof(std::uint32_t), kWordsAtFirst),
      table_(GL_RG32UI, sizeof(Entry), kTableEntries) {
  constexpr std::array<std::uint32_t, 2> kShared = {0U, ~0U};
  bits_.add(kShared.data(), 2);
  const std::vector<Entry> empty(kTableEntries);
  table_.add(empty.data(), kTableEntries);
}

std::size_t OpacityMap::place(ChunkCoord at) {
  const auto wrap = [](std::int32_t v) { return static_cast<std::size_t>(v & (kTableSide - 1)); };
  return wrap(at.x) | wrap(at.y) << 6 | wrap(at.z) << 12;
}

void OpacityMap::write(ChunkCoord at, Entry entry) {
  table_.write(static_cast<std::uint32_t>(place(at)), &entry, 1);
}

void OpacityMap::set(ChunkCoord at, std::int32_t edge, const OpacityBits& bits) {
  if (edge_ == 0 && std::has_single_bit(static_cast<unsigned>(edge))) edge_ = edge;
  if (edge != edge_) return;
  const auto [found, is_new] = slots_.try_emplace(at);
  Slot& slot = found->second;
  if (slot.words != 0) bits_.remove(slot.first, slot.words);
  slot = {bits.all ? kAll : kNone, static_cast<std::uint32_t>(bits.words.size())};
  if (slot.words == 0) return write(at, {slot.first, 0});
  slot.first = bits_.add(bits.words.data(), slot.words);
  const auto edge_bits = static_cast<unsigned>(std::countr_zero(static_cast<unsigned>(edge)));
  write(at, {slot.first, shifts_of(bits.order, edge_bits) | kHasWords});
}

void OpacityMap::remove(ChunkCoord at) {
  const auto found = slots_.find(at);
  if (found == slots_.end()) return;
  if (found->second.words != 0) bits_.remove(found->second.first, found->second.words);
  slots_.erase(found);
  write(at, {});
}

void OpacityMap::bind(const GlProgram& program, GLint unit) const {
  const auto texture = [&](const char* name, GLint at, const TexelStore& store) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(at));
    glBindTexture(GL_TEXTURE_BUFFER, store.texture());
    glUniform1i(glGetUniformLocation(program.get(), name), at);
  };
  texture("opacity", unit, bits_);
  texture("opacity_table", unit + 1, table_);
  glUniform1i(glGetUniformLocation(program.get(), "edge_bits"),
              edge_ == 0 ? 0 : std::countr_zero(static_cast<unsigned>(edge_)));
}

std::uint64_t OpacityMap::used_bytes() const { return bits_.used_bytes() + table_.used_bytes(); }

}  // namespace runstone
