#include "client/render/opacity_bits.hpp"

#include <algorithm>

namespace runstone {
namespace {

/// Sets the bits [first, last). Requires first < last.
void set_bits(std::vector<std::uint32_t>& words, std::uint32_t first, std::uint32_t last) {
  const std::uint32_t head = ~0U << (first % 32);
  const std::uint32_t tail = ~0U >> (31 - (last - 1) % 32);
  const std::size_t from = first / 32, to = (last - 1) / 32;
  if (from == to) {
    words[from] |= head & tail;
    return;
  }
  words[from] |= head;
  std::fill(words.begin() + static_cast<std::ptrdiff_t>(from + 1),
            words.begin() + static_cast<std::ptrdiff_t>(to), ~0U);
  words[to] |= tail;
}

}  // namespace

OpaqueMaterials opaque_materials(const MaterialTable& materials) {
  OpaqueMaterials out(materials.size());
  for (std::size_t id = 0; id < out.size(); ++id) {
    out[id] = materials[static_cast<Material>(id)].visibility == Visibility::opaque;
  }
  return out;
}

OpacityBits opacity_bits(const RunChunk& chunk, const OpaqueMaterials& opaque) {
  const auto is_opaque = [&](std::size_t run) {
    const Material id = chunk.runs.material(run);
    return id >= opaque.size() || opaque[id];
  };
  OpacityBits out;
  out.order = chunk.order;
  std::size_t opaque_runs = 0;
  for (std::size_t run = 0; run < chunk.runs.size(); ++run) opaque_runs += is_opaque(run) ? 1 : 0;
  out.all = opaque_runs == chunk.runs.size();
  if (out.all || opaque_runs == 0) return out;
  out.words.resize(chunk.volume() / 32);
  std::uint32_t first = 0;
  for (std::size_t run = 0; run < chunk.runs.size(); ++run) {
    const std::uint32_t last = chunk.runs.end(run);
    if (is_opaque(run)) set_bits(out.words, first, last);
    first = last;
  }
  return out;
}

}  // namespace runstone
