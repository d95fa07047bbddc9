#include "common/tiles/layer_rows.hpp"

namespace runstone::tiles {
namespace {

/// Clears the bits of `x` (one of `same`'s rows, for line `line_a` of `a`) at which line `line_a` of
/// `a` and line `line_b` of `b` differ in material. Cost: O(words + segments of both lines).
void keep_equal(LayerBits& same, std::size_t line, const LayerRows& a, std::size_t line_a,
                const LayerRows& b, std::size_t line_b) {
  const Material* material_a = a.materials.data() + a.first_segment[line_a];
  const Material* material_b = b.materials.data() + b.first_segment[line_b];
  // Bit 0 of both lines is set, so both step from one before their first segment.
  std::size_t at_a = 0, at_b = 0;
  Row64 differs = 0;  // all bits of the segment that began last
  for (std::size_t w = 0; w < a.words(); ++w) {
    const Row64 changes_a = a.changes.at(line_a, w), changes_b = b.changes.at(line_b, w);
    Row64 unequal = differs;
    for (Row64 starts = changes_a | changes_b; starts != 0; starts &= starts - 1) {
      const unsigned at = lowest_bit(starts);
      at_a += changes_a >> at & 1;
      at_b += changes_b >> at & 1;
      const Row64 now = material_a[at_a - 1] != material_b[at_b - 1] ? ~Row64{0} : 0;
      unequal ^= (differs ^ now) & (~Row64{0} << at);
      differs = now;
    }
    same.at(line, w) &= ~unequal;
  }
}

bool is_zero(const LayerBits& bits, std::size_t line, std::size_t words) {
  Row64 any = 0;
  for (std::size_t w = 0; w < words; ++w) any |= bits.at(line, w);
  return any == 0;
}

}  // namespace

void LayerRows::reset(unsigned edge) {
  const std::size_t side = 2 * std::size_t{edge};
  words_ = (side + 63) / 64;
  if (lines() != side) {
    for (LayerBits* bits : {&changes, &opaque, &solid, &same_along, &same_across, &same_before})
      bits->reset(side, words_, 0);
    // The lines beside the layer lie outside of the children and hide the faces towards them.
    opaque.fill(~Row64{0});
    first_segment.assign(side, 0);
    materials.resize(side * side);
    same_is_zero = same_before_is_zero = true;
  }
  is_uniform = has_rows = has_same_before = false;
  transparent = {};
}

void LayerRows::make_outside() {
  opaque.fill(~Row64{0});
  solid.fill(0);
  transparent = {};
  has_rows = true;
  has_same_before = false;
  find_same_in_layer();
}

void LayerRows::make_uniform(Material only) {
  is_uniform = true;
  material = only;
  has_rows = has_same_before = false;
}

void LayerRows::make_rows(const VisibilityTable& visibility) {
  if (has_rows) return;
  const Visibility kind = visibility[material];
  transparent = {};
  if (kind == Visibility::transparent) transparent.add(material);
  for (std::size_t w = 0; w < words(); ++w) {
    for (std::size_t line = 0; line < lines(); ++line) {
      changes.at(line, w) = w == 0 ? 1 : 0;
      opaque.at(line, w) = kind == Visibility::opaque ? ~Row64{0} : 0;
      solid.at(line, w) = kind == Visibility::empty ? 0 : ~Row64{0};
    }
  }
  std::fill(first_segment.begin(), first_segment.end(), 0);
  materials[0] = material;
  has_rows = true;
  find_same_in_layer();
}

void LayerRows::find_same_in_layer() {
  if (!transparent.any()) {
    if (!same_is_zero) {
      same_along.fill(0);
      same_across.fill(0);
      same_is_zero = true;
    }
    return;
  }
  same_is_zero = false;
  const auto see_through = [this](std::size_t line, std::size_t w) {
    return solid.at(line, w) & ~opaque.at(line, w);
  };
  for (std::size_t line = 0; line < lines(); ++line) {
    for (std::size_t w = 0; w < words(); ++w) {
      const Row64 here = see_through(line, w);
      const bool last = w + 1 == words();
      const Row64 next = here >> 1 | (last ? 0 : see_through(line, w + 1) << 63);
      const Row64 cut = changes.at(line, w) >> 1 | (last ? 0 : changes.at(line, w + 1) << 63);
      same_along.at(line, w) = here & next & ~cut;
      same_across.at(line, w) = line + 1 < lines() ? here & see_through(line + 1, w) : 0;
    }
    if (transparent.has_others && !is_zero(same_across, line, words()))
      keep_equal(same_across, line, *this, line, *this, line + 1);
  }
}

void LayerRows::find_same_before(const LayerRows& before) {
  if (has_same_before) return;
  has_same_before = true;
  if (!transparent.any() || !before.transparent.any()) {
    if (!same_before_is_zero) same_before.fill(0);
    same_before_is_zero = true;
    return;
  }
  same_before_is_zero = false;
  std::vector<Row64>& out = same_before.all();
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = solid.all()[i] & ~opaque.all()[i] & before.solid.all()[i] & ~before.opaque.all()[i];
  }
  if (!transparent.may_differ(before.transparent)) return;
  for (std::size_t line = 0; line < lines(); ++line) {
    if (!is_zero(same_before, line, words()))
      keep_equal(same_before, line, *this, line, before, line);
  }
}

}  // namespace runstone::tiles
