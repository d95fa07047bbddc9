// BuildInfo and BuildMaterial: the contents of an .rsb besides its cells: what the build is, who
// made it, and the materials that its cells name. A build has no ids of any world: another world
// finds its materials by their names, or makes them of colour, visibility, body and look.
#pragma once
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/material_row.hpp"
#include "common/core/result.hpp"
#include "common/runs/extent.hpp"

namespace runstone {

/// The maximum side of a build, in voxels. 2^14 sections fit along an axis, so that the number of a
/// section has at most 42 bits, and a volume has at most 60.
inline constexpr std::uint32_t kBuildSideMax = std::uint32_t{1} << 20;
/// Builds are cut into sections of this edge from their lowest corner on. The last section along an
/// axis ends with the build.
inline constexpr std::uint32_t kBuildSectionEdge = 64;
inline constexpr std::uint32_t kBuildSectionVolumeMax =
    kBuildSectionEdge * kBuildSectionEdge * kBuildSectionEdge;

inline constexpr std::size_t kBuildNameBytesMax = 64;
inline constexpr std::size_t kBuildAuthorBytesMax = 32;
inline constexpr std::size_t kBuildTagBytesMax = 32;
inline constexpr std::size_t kBuildTagsMax = 16;
/// Cells have 16 bits, and 0 is an untouched cell.
inline constexpr std::size_t kBuildMaterialsMax = 65535;
inline constexpr std::size_t kBuildStatesBytesMax = 256;
/// The latest time of a build, in microseconds since 1970: 2^53.
inline constexpr TimeUs kBuildTimeMax = TimeUs{1} << 53;

struct BuildSides {
  std::uint32_t x = 1, y = 1, z = 1;  // voxels, 1 .. kBuildSideMax each
  friend auto operator<=>(const BuildSides&, const BuildSides&) = default;
  constexpr std::uint64_t volume() const { return std::uint64_t{x} * y * z; }
};

struct BuildInfo {
  std::string name;               // 1 .. kBuildNameBytesMax bytes, is_plain_name()
  std::string author;             // name of the player who made it, or empty; as `name`
  std::vector<std::string> tags;  // at most kBuildTagsMax, ascending, different; as `name`
  TimeUs created_us = 0;          // UTC, 0 .. kBuildTimeMax; 0: not known
  BuildSides sides;
  VoxelPos origin;  // of the lowest corner in the world from which the build was copied
  friend bool operator==(const BuildInfo&, const BuildInfo&) = default;
};

/// A material of a build. Several may have one name, if their states differ.
struct BuildMaterial {
  MaterialRow row;
  // For blocks of other programs, such as "facing=north,half=bottom", ascending by key; at most
  // kBuildStatesBytesMax bytes of UTF-8 without control characters. Empty: none.
  std::string states;
  friend bool operator==(const BuildMaterial&, const BuildMaterial&) = default;
};

/// Fails with bad_value or limit_exceeded for the first field outside its range. Cost: O(bytes).
Result<void> validate(const BuildInfo& info);
/// The materials of a build ascend by name and then by states, so none occurs twice. Fails with
/// bad_value, limit_exceeded or not_canonical; the offset is the index of the material.
Result<void> validate_build_materials(std::span<const BuildMaterial> materials);

/// Writes and reads the payload of the head, with the number of materials. Writing requires valid
/// values. The offset of an error is a byte of the payload.
Bytes encode_build_info(const BuildInfo& info, std::size_t material_count);
struct BuildHead {
  BuildInfo info;
  std::uint32_t material_count = 0;
};
Result<BuildHead> decode_build_info(ByteView in);

/// Appends one valid material.
void encode_build_material(const BuildMaterial& material, Bytes& out);
/// Decodes exactly `count` materials, and appends them to `out`. They need not ascend: call
/// validate_build_materials() for all. The offset of an error is a byte of the payload.
Result<void> decode_build_materials(ByteView in, std::uint32_t count,
                                    std::vector<BuildMaterial>& out);

}  // namespace runstone
