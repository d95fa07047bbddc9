// LayerRows: one layer of a tile's children (twice their edge along both sides) in bit rows, with
// the materials of the segments of its lines. Internal to tiles.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/ids.hpp"
#include "common/mesh/visibility.hpp"
#include "common/tiles/layer_bits.hpp"

namespace runstone::tiles {

/// The transparent materials of a layer. Faces between two voxels of one transparent material are
/// not drawn, so layers without such materials or with a single one are compared by bits alone.
struct TransparentMaterials {
  Material first = kEmpty;  // kEmpty: there is none
  bool has_others = false;

  bool any() const { return first != kEmpty; }
  void add(Material material) {
    if (first == kEmpty) first = material;
    has_others = has_others || first != material;
  }
  /// Returns true if voxels of the two sets can differ in material.
  bool may_differ(const TransparentMaterials& other) const {
    return has_others || other.has_others || first != other.first;
  }
};

struct LayerRows {
  LayerBits
      changes;  // the voxel differs in material from the one before it; bit 0 of a line is set
  LayerBits opaque;
  LayerBits solid;  // not empty: opaque or transparent
  /// Voxels of the same transparent material: bit i is set if voxel i has a neighbour of its own
  /// material at i + 1 of its line, at i of the next line, or at i of the layer before.
  LayerBits same_along, same_across, same_before;

  std::vector<std::uint32_t> first_segment;  // of each line, in `materials`
  std::vector<Material> materials;           // of the segments of the lines; lines may share them
  TransparentMaterials transparent;

  bool is_uniform = false;
  Material material = kEmpty;  // of a uniform layer
  bool has_rows = false;       // false for a uniform layer whose rows are not made yet
  bool has_same_before = false;
  bool same_is_zero = false;  // of same_along and same_across
  bool same_before_is_zero = false;

  /// Makes room for the layers of children of `edge`.
  void reset(unsigned edge);
  /// Makes a layer that lies outside of the children: it hides all faces towards it.
  void make_outside();
  /// Sets the layer to one material. Its rows are made by make_rows() if they are needed.
  void make_uniform(Material only);
  /// Makes the rows of a uniform layer, if there are none. Requires the layer to have some state.
  void make_rows(const VisibilityTable& visibility);
  /// Computes same_along and same_across from the other rows.
  void find_same_in_layer();
  /// Computes same_before, unless it is known. Both layers require rows.
  void find_same_before(const LayerRows& before);

  std::size_t lines() const { return first_segment.size(); }
  std::size_t words() const { return words_; }

 private:
  std::size_t words_ = 0;
};

}  // namespace runstone::tiles
