// Model: triangles with colours, as files of other programs hold them (.obj, .stl, .ply, .gltf, .glb).
// A model knows no format: readers make it, the voxeliser (common/voxelise) makes runs of it, and
// writers make files of it. It is untrusted until validate() accepts it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// The maximum numbers of a model. 10^8 triangles take 1.2 GB of indices alone.
inline constexpr std::size_t kModelTrianglesMax = 100'000'000;
inline constexpr std::size_t kModelVerticesMax = 100'000'000;
inline constexpr std::size_t kModelMaterialsMax = 65'535;
inline constexpr std::size_t kModelTexturesMax = 1'024;
inline constexpr std::uint32_t kModelTextureSideMax = 16'384;                 // texels
inline constexpr std::size_t kModelTextureBytesMax = std::size_t{512} << 20;  // all together
inline constexpr std::size_t kModelNameBytesMax = 64;

/// A colour with the values that files hold: not linear (sRGB), alpha 255 is opaque.
using ModelColour = std::array<std::uint8_t, 4>;

struct ModelTexture {
  std::uint32_t width = 0, height = 0;  // texels, at least 1
  std::vector<std::uint8_t> texels;     // 4 bytes each, rows from above to below
};

struct ModelMaterial {
  std::string name;  // any printable text, 0 .. kModelNameBytesMax bytes
  ModelColour colour{255, 255, 255, 255};
  std::optional<std::uint32_t> texture;  // it is multiplied with the colour
};

struct Model {
  /// In the axes of a world: x east, y up, z south. Finite.
  std::vector<std::array<float, 3>> positions;
  /// From (0, 0), the upper left corner of a texture, to (1, 1); beyond them it repeats. Empty, or one
  /// for each position.
  std::vector<std::array<float, 2>> texture_places;
  /// They are multiplied with the colour of the material. Empty, or one for each position.
  std::vector<ModelColour> colours;
  /// Three positions each, counter-clockwise from outside. None: the model is a cloud of points.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  /// Empty, or one for each triangle.
  std::vector<std::uint32_t> material_of;
  std::vector<ModelMaterial> materials;
  std::vector<ModelTexture> textures;
  /// The length of a unit of the positions, if the format says one; glTF: 1.
  std::optional<double> metres_per_unit;

  bool is_cloud() const { return triangles.empty(); }
};

/// Fails with bad_value or limit_exceeded for the first field outside its range. Cost: O(bytes).
Result<void> validate(const Model& model);

}  // namespace runstone
