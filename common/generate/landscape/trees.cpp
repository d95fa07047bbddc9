#include "common/generate/landscape/trees.hpp"

#include <array>
#include <cstdlib>
#include <span>

#include "common/core/hash.hpp"

namespace runstone {
namespace {

/// The squares of the radii of a crown's layers, from the lowest.
constexpr std::array<std::uint8_t, 5> kSmallOak = {5, 10, 10, 8, 3};
constexpr std::array<std::uint8_t, 6> kBigOak = {6, 13, 17, 17, 11, 4};
constexpr std::array<std::uint8_t, 7> kBirch = {2, 5, 5, 5, 4, 2, 1};
constexpr std::array<std::uint8_t, 11> kSmallPine = {8, 9, 6, 5, 5, 4, 2, 2, 1, 1, 0};
constexpr std::array<std::uint8_t, 15> kBigPine = {10, 13, 13, 10, 9, 9, 8, 5, 5, 4, 2, 2, 1, 1, 0};
constexpr std::array<std::uint8_t, 2> kShrub = {2, 1};

struct Form {
  std::span<const std::uint8_t> crown;
  std::int32_t crown_begin;
  std::int32_t trunk;
};

Form form_of(const Tree& tree) {
  const bool is_big = (tree.random >> 8) % 3 == 0;
  const auto extra = static_cast<std::int32_t>((tree.random >> 16) % 3);
  switch (tree.kind) {
    case TreeKind::oak:
      return is_big ? Form{kBigOak, 4 + extra, 7 + extra} : Form{kSmallOak, 3 + extra, 5 + extra};
    case TreeKind::birch:
      return {kBirch, 4 + extra, 8 + extra};
    case TreeKind::pine:
      return is_big ? Form{kBigPine, 3 + extra, 14 + extra}
                    : Form{kSmallPine, 2 + extra, 9 + extra};
    case TreeKind::shrub:
      break;
  }
  return {kShrub, 0, 1};
}

}  // namespace

std::optional<TreeStretch> crown_at(const Tree& tree, std::int32_t dx, std::int32_t dz) {
  const Form form = form_of(tree);
  const std::int32_t squared = dx * dx + dz * dz;
  // The outer columns of a crown are ragged.
  const std::uint64_t column = static_cast<std::uint64_t>((dx + kTreeReach) * 16 + dz + kTreeReach);
  const std::int32_t trimmed =
      squared + (squared > 3 && tree.kind != TreeKind::shrub
                     ? static_cast<std::int32_t>(mix64(tree.random ^ column) % 4)
                     : 0);
  std::int32_t first = -1, last = -1;
  for (std::size_t layer = 0; layer < form.crown.size(); ++layer) {
    if (trimmed > form.crown[layer]) continue;
    last = static_cast<std::int32_t>(layer);
    if (first < 0) first = last;
  }
  if (first < 0) return std::nullopt;
  return TreeStretch{form.crown_begin + first, form.crown_begin + last + 1};
}

std::int32_t trunk_height(const Tree& tree) { return form_of(tree).trunk; }

Material trunk_of(TreeKind kind, const LandMaterials& materials) {
  return kind == TreeKind::birch ? materials.birch_log : materials.log;
}

Material leaves_of(TreeKind kind, const LandMaterials& materials) {
  switch (kind) {
    case TreeKind::birch:
      return materials.birch_leaves;
    case TreeKind::pine:
      return materials.pine_leaves;
    case TreeKind::oak:
    case TreeKind::shrub:
      break;
  }
  return materials.leaves;
}

}  // namespace runstone
