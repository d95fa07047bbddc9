// The chunks of a .vox: models, palette, materials, and the nodes of the scene graph, as views of the
// file. Internal to the reader of .vox. Every byte is untrusted.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/formats/vox.hpp"

namespace runstone {

struct VoxModel {
  std::int32_t x = 0, y = 0, z = 0;  // sides in the axes of the file, 1 .. kVoxModelSideMax
  ByteView voxels;                   // x, y, z, colour each; of Teardown: a zlib stream of colours
  std::size_t offset = 0;            // of `voxels` in the file
  bool is_packed = false;            // as Teardown does it
  bool has_voxels = false;           // the chunk of the voxels was found
};

/// A matrix of three rows, in each of which one entry is 1 or -1: the entry `from[i]` of row i.
struct VoxTurn {
  std::array<std::uint8_t, 3> from = {0, 1, 2};
  std::array<std::int8_t, 3> sign = {1, 1, 1};
  friend bool operator==(const VoxTurn&, const VoxTurn&) = default;
};

/// A point p of the child is at turn * p + shift in the parent.
struct VoxPlace {
  VoxTurn turn;
  std::array<std::int32_t, 3> shift{};
};

struct VoxNode {
  enum class Kind : std::uint8_t { transform, group, shape };
  Kind kind = Kind::group;
  bool is_hidden = false;
  std::int32_t layer = -1;  // of a transform
  VoxPlace place;           // of a transform
  std::vector<std::int32_t>
      children;            // nodes of a transform or group; model of a shape, first frame
  std::size_t offset = 0;  // of the chunk in the file
};

/// An entry of MATL as far as it is known here.
struct VoxMaterial {
  std::string_view type;
  double weight = -1, trans = -1, rough = -1, emit = -1;  // negative: not given
  bool has_name = false;                                  // written by this project:
  std::string_view name, states, look;
};

struct VoxFile {
  std::vector<VoxModel> models;
  std::array<std::array<std::uint8_t, 4>, kVoxColours> palette{};  // by colour of a voxel
  std::array<VoxMaterial, kVoxColours> materials;
  std::array<std::uint8_t, kVoxColours>
      shown_at{};                       // place of a colour in the palette on the screen
  std::vector<std::string_view> notes;  // of the rows of the palette
  std::map<std::int32_t, VoxNode> nodes;
  std::map<std::int32_t, bool> hidden_layers;
  std::string_view name, author;  // of the build, if this project wrote the file
  TimeUs created_us = 0;
  VoxelPos origin;
};

/// Reads all chunks. Fails if a chunk is cut, has a field outside its range, or if there are more
/// than kVoxNodesMax nodes or models. The offset of an error is a byte of the file.
Result<VoxFile> read_vox_file(ByteView file);

}  // namespace runstone
