#include "common/patterns/bound_mix.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/materials/material_lookup.hpp"

namespace runstone {
namespace {

/// The steps between two parts of a gradient.
constexpr std::int64_t kGradientUnit = 1 << 16;

/// Returns the distance of a voxel from the middle, in halves of a voxel. The root of IEEE 754 is
/// exact to the last bit, so it is the same on every machine.
double distance2(VoxelPos voxel, VoxelPos middle2) {
  const auto square = [](std::int32_t v, std::int32_t m2) {
    const double d = 2.0 * v - m2;
    return d * d;
  };
  return std::sqrt(square(voxel.x, middle2.x) + square(voxel.y, middle2.y) +
                   square(voxel.z, middle2.z));
}

/// The parts of a list that are compared one after another, which is faster than a search.
constexpr std::size_t kShortListMax = 8;

}  // namespace

Result<BoundMix, PatternError> BoundMix::of(const Mix& mix, const MaterialTable& table,
                                            const PatternFrame& frame) {
  BoundMix out;
  out.frame_ = frame;
  if (auto error = out.add(mix, table, out.root_)) return failure(*std::move(error));
  return out;
}

BoundMix BoundMix::of(Material material) {
  BoundMix out;
  out.root_.material = material;
  return out;
}

std::optional<PatternError> BoundMix::add(const Mix& mix, const MaterialTable& table, Choice& out) {
  if (mix.kind == MixKind::material) {
    auto material = find_material(table, mix.material.name);
    if (!material) return PatternError{mix.material.column, material.error()};
    out.material = *material;
    return std::nullopt;
  }
  const std::size_t index = nodes_.size();
  out.node = index;
  Node node;
  node.kind = mix.kind;
  node.low = mix.low;
  node.high = mix.high;
  // Each node has a key of its own, so that the choices of a part do not depend on those around it.
  node.key = mix64(frame_.seed + mix64(index));
  if (mix.kind == MixKind::clumps) node.clumps = ClumpNoise(node.key, mix.size);
  nodes_.push_back(std::move(node));
  std::uint64_t end = 0;
  for (const Mix& part : mix.parts) {
    end += static_cast<std::uint64_t>(std::max(part.weight, 1));
    Choice choice;
    choice.end = end;
    if (auto error = add(part, table, choice)) return error;
    nodes_[index].choices.push_back(choice);
  }
  return std::nullopt;
}

std::optional<Material> BoundMix::single() const {
  return root_.node ? std::nullopt : std::optional(root_.material);
}

std::size_t BoundMix::choice_at(Node& node, VoxelPos voxel) const {
  const std::size_t last = node.choices.size() - 1;
  if (node.kind == MixKind::list || node.kind == MixKind::clumps) {
    const std::uint64_t number =
        node.kind == MixKind::clumps ? node.clumps.at(voxel) : voxel_hash(node.key, voxel) >> 32;
    const std::uint64_t weight = (number * node.choices[last].end) >> 32;
    const auto found =
        std::upper_bound(node.choices.begin(), node.choices.end(), weight,
                         [](std::uint64_t value, const Choice& c) { return value < c.end; });
    return static_cast<std::size_t>(found - node.choices.begin());
  }
  std::int64_t above_low = 0;  // in steps along the whole gradient
  const std::int64_t steps = static_cast<std::int64_t>(last) * kGradientUnit;
  const std::int64_t span = std::int64_t{node.high} - node.low;
  if (node.kind == MixKind::height) {
    above_low = std::clamp<std::int64_t>(std::int64_t{voxel.y} - node.low, 0, span) * steps / span;
  } else {
    const double share =
        (distance2(voxel, frame_.middle2) / 2 - node.low) / static_cast<double>(span);
    above_low = static_cast<std::int64_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(steps));
  }
  const auto part = static_cast<std::size_t>(above_low / kGradientUnit);
  const auto rest = static_cast<std::uint64_t>(above_low % kGradientUnit);
  return part + ((voxel_hash(node.key, voxel) >> 48) < rest ? 1 : 0);
}

Material BoundMix::at(VoxelPos voxel) {
  const Choice* choice = &root_;
  while (choice->node) {
    Node& node = nodes_[*choice->node];
    choice = &node.choices[choice_at(node, voxel)];
  }
  return choice->material;
}

std::size_t BoundMix::short_list() const {
  if (!root_.node) return 0;
  const Node& node = nodes_[*root_.node];
  if (node.kind != MixKind::list || node.choices.size() > kShortListMax) return 0;
  const bool is_flat = std::none_of(node.choices.begin(), node.choices.end(),
                                    [](const Choice& choice) { return choice.node.has_value(); });
  return is_flat ? node.choices.size() : 0;
}

void BoundMix::read_column(VoxelPos low, std::span<Material> out) {
  const std::size_t parts = short_list();
  if (parts == 0) {
    for (Material& material : out) {
      material = at(low);
      ++low.y;
    }
    return;
  }
  const Node& node = nodes_[*root_.node];
  std::array<std::uint64_t, kShortListMax> ends{};
  std::array<Material, kShortListMax> materials{};
  for (std::size_t i = 0; i < parts; ++i) {
    ends[i] = node.choices[i].end;
    materials[i] = node.choices[i].material;
  }
  const std::uint64_t total = ends[parts - 1];
  const std::uint64_t column = voxel_column_hash(node.key, low.x, low.z);
  auto y = static_cast<std::uint32_t>(low.y);
  for (Material& material : out) {
    const std::uint64_t weight = ((voxel_hash_in(column, y++) >> 32) * total) >> 32;
    std::size_t part = 0;
    for (std::size_t i = 0; i + 1 < parts; ++i) part += weight >= ends[i] ? 1 : 0;
    material = materials[part];
  }
}

}  // namespace runstone
