// BrushStroke: the settings of a brush and the places of a stroke, as they travel in previews. Each
// client works out from its own shown runs what the stroke changes (client/tools/ground_stroke.hpp).
// A stroke is in no log.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

enum class BrushKind : std::uint8_t { terrain, path };

struct BrushStroke {
  BrushKind brush = BrushKind::terrain;
  std::uint8_t mode = 0;   // 0 .. kTerrainModeMax, or 0 .. kPathModeMax
  std::uint16_t size = 1;  // voxels: radius 1 .. kTerrainSizeMax, or width 1 .. kPathSizeMax
  // These four are those of a terrain brush. A path has the values here.
  std::uint8_t falloff = 0;    // 0 .. kFalloffMax
  std::uint16_t strength = 1;  // 1 .. kTerrainStrengthMax
  bool lowers = false;
  std::uint32_t seed = 1;  // 0 .. kBrushSeedMax

  Material material = kEmpty;  // the one that the player holds
  Mask mask;
  /// What the player typed: a filter, and a mix that stands for the material. They may have
  /// mistakes. Printable UTF-8 of up to kBrushTextBytesMax bytes; empty: none.
  std::string where, mix;
  /// 1 .. kPreviewStrokePlacesMax voxels of the world. Consecutive ones differ by at most
  /// kStrokeStepMax along each axis.
  std::vector<VoxelPos> places;
  friend bool operator==(const BrushStroke&, const BrushStroke&) = default;
};

/// Returns a bound of the work that a stroke costs those who show it: the columns that it reads,
/// times the rounds of `erode`, and the columns that its places or its curve pass over. Requires
/// valid values. Cost: O(places).
std::uint64_t stroke_work(const BrushStroke& stroke);

/// Returns success for a stroke that may be shared: its values are in their ranges, and its work
/// and its bytes have their bounds. Otherwise names the value. Cost: O(places + bytes).
Result<void> check_stroke(const BrushStroke& stroke);

/// Returns the bytes of a stroke, at most kPreviewStrokeBytesMax. Requires one that passes
/// check_stroke().
Bytes encode_stroke(const BrushStroke& stroke);
/// Reads all bytes as a stroke. Fails as check_stroke() does.
Result<BrushStroke> decode_stroke(ByteView bytes);

}  // namespace runstone
