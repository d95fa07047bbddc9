#include "client/far/far_cover.hpp"

#include "client/far/child_bits.hpp"

namespace runstone {

const FarCover::Node* FarCover::find(const ChunkKey& key) const {
  const auto found = nodes_.find(key);
  return found == nodes_.end() ? nullptr : &found->second;
}

FarCover::Node& FarCover::make(const ChunkKey& key) {
  const auto [found, is_new] = nodes_.try_emplace(key);
  if (is_new && key.lod < kTileLevelMax) {
    Node& parent = make(tile_parent(key));
    parent.children = with_bit(parent.children, child_bit(key), true);
  }
  return found->second;
}

void FarCover::erase_if_unused(const ChunkKey& key) {
  const auto found = nodes_.find(key);
  if (found->second.is_present || found->second.children != 0) return;
  nodes_.erase(found);
  if (key.lod == kTileLevelMax) return;
  const ChunkKey up = tile_parent(key);
  Node& parent = nodes_.at(up);
  parent.children = with_bit(parent.children, child_bit(key), false);
  erase_if_unused(up);
}

void FarCover::put(const ChunkKey& key, bool is_open) {
  Node& node = make(key);
  if (!node.is_present && key.lod < kTileLevelMax) {
    Node& parent = nodes_.at(tile_parent(key));
    parent.present_children = with_bit(parent.present_children, child_bit(key), true);
  }
  if (node.is_present && node.is_open == is_open) return;
  node.is_present = true;
  node.is_open = is_open;
  update(key, node, above(key));
}

void FarCover::remove(const ChunkKey& key) {
  const auto found = nodes_.find(key);
  if (found == nodes_.end() || !found->second.is_present) return;
  Node& node = found->second;
  node.is_present = node.is_open = false;
  if (key.lod < kTileLevelMax) {
    Node& parent = nodes_.at(tile_parent(key));
    parent.present_children = with_bit(parent.present_children, child_bit(key), false);
  }
  update(key, node, above(key));
  erase_if_unused(key);
}

FarCover::Above FarCover::above(const ChunkKey& key) const {
  if (key.lod == kTileLevelMax) return Above::nothing;
  const ChunkKey up = tile_parent(key);
  return below(nodes_.at(up), above(up));
}

FarCover::Above FarCover::below(const Node& node, Above above) {
  if (!node.is_present) return above == Above::nothing ? Above::nothing : Above::hiding;
  return above != Above::hiding && node.is_open ? Above::open : Above::hiding;
}

void FarCover::update(const ChunkKey& key, Node& node, Above above) {
  node.is_shown = node.is_present && above != Above::hiding;
  const Above next = below(node, above);
  for (unsigned i = 0; i < kTileChildren; ++i) {
    if (!has_child(node.children, i)) continue;
    const ChunkKey child = tile_child(key, i);
    update(child, nodes_.at(child), next);
  }
}

bool FarCover::shows(const ChunkKey& key) const {
  const Node* const node = find(key);
  return node != nullptr && node->is_shown;
}

TileParts FarCover::parts(const ChunkKey& key) const {
  const Node* const node = find(key);
  if (node == nullptr || !node->is_shown) return {};
  if (!node->is_open || node->present_children == 0) return {true, 0};
  return {false, static_cast<std::uint8_t>(~node->present_children)};
}

}  // namespace runstone
