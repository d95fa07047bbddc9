// BuildHead and BuildMaterial: the contents of an .rsb besides its cells: what the build is, and the
// materials that its cells name. A build has no ids of any world: another world
// finds its materials by their names, or makes them of colour, visibility, body, look and shape.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/core/build_info.hpp"
#include "common/core/bytes.hpp"
#include "common/core/material_row.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Builds are cut into sections of this edge from their lowest corner on. The last section along an
/// axis ends with the build.
inline constexpr std::uint32_t kBuildSectionEdge = 64;
inline constexpr std::uint32_t kBuildSectionVolumeMax =
    kBuildSectionEdge * kBuildSectionEdge * kBuildSectionEdge;

/// Cells have 16 bits, and 0 is an untouched cell.
inline constexpr std::size_t kBuildMaterialsMax = 65535;
inline constexpr std::size_t kBuildStatesBytesMax = 256;
/// A material of a build. Several may have one name, if their states differ.
struct BuildMaterial {
  MaterialRow row;
  // For blocks of other programs, such as "facing=north,half=bottom", ascending by key; at most
  // kBuildStatesBytesMax bytes of UTF-8 without control characters. Empty: none.
  std::string states;
  friend bool operator==(const BuildMaterial&, const BuildMaterial&) = default;
};

/// The materials of a build ascend by name and then by states, so none occurs twice. Fails with
/// bad_value, limit_exceeded or not_canonical; the offset is the index of the material. Cost:
/// O(bytes), and check_shape() for each different shape.
Result<void> validate_build_materials(std::span<const BuildMaterial> materials);

/// Writes and reads the payload of the head. Writing requires valid values. The offset of an error
/// is a byte of the payload.
struct BuildHead {
  BuildInfo info;
  std::uint32_t material_count = 0;
};
Bytes encode_build_head(const BuildHead& head);
Result<BuildHead> decode_build_head(ByteView in);

/// Appends one valid material.
void encode_build_material(const BuildMaterial& material, Bytes& out);
/// Returns true if a material is no cube. Cost: O(materials).
bool has_shape(std::span<const BuildMaterial> materials);
/// Decodes exactly `count` materials, and appends them to `out`. They need not ascend: call
/// validate_build_materials() for all. `with_shapes`: they may have shapes. The offset of an error
/// is a byte of the payload.
Result<void> decode_build_materials(ByteView in, std::uint32_t count, bool with_shapes,
                                    std::vector<BuildMaterial>& out);

}  // namespace runstone
