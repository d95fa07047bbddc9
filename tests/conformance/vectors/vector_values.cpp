#include "tests/conformance/vectors/vector_values.hpp"

#include <array>
#include <cstdio>

#include "common/core/hash.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone::conformance {
namespace {

std::string lane_hex(std::uint64_t lane) {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(lane));
  return digits.data();
}

/// The ground at a voxel of the world. Integers only.
Material ground_at(VoxelPos p) {
  const auto hash = [](std::int32_t a, std::int32_t b, std::int32_t c) {
    return mix64(mix64(mix64(static_cast<std::uint32_t>(a)) ^ static_cast<std::uint32_t>(b)) ^
                 static_cast<std::uint32_t>(c));
  };
  const auto bump = [](std::int32_t v) { return v * v % 23 / 8; };
  const std::int32_t surface = bump(floor_div(p.x, 5)) + bump(floor_div(p.z, 7)) + 1;
  if (p.y > surface + 1) return kEmpty;
  if (p.y == surface + 1) return hash(p.x, 0, p.z) % 41 == 0 ? Material{4} : kEmpty;
  if (p.y == surface) return 3;
  return hash(p.x, p.y, p.z) % 509 == 0 ? Material{700} : Material{1};
}

}  // namespace

Json json_of(const Digest& digest) { return {lane_hex(digest.lane[0]), lane_hex(digest.lane[1])}; }
Json json_of(const VoxelPos& pos) { return {pos.x, pos.y, pos.z}; }
Json json_of(const ChunkCoord& at) { return {at.x, at.y, at.z}; }

const char* name_of(AxisOrder order) {
  static constexpr std::array<const char*, kAxisOrderCount> kNames = {"xyz", "xzy", "yxz",
                                                                      "yzx", "zxy", "zyx"};
  return kNames[static_cast<std::size_t>(order)];
}

std::string raw_hex(const RunChunk& chunk) {
  return to_hex(encode_chunk(chunk, ChunkEncoding::raw));
}

RunChunk ground_chunk(ChunkCoord at, unsigned edge, AxisOrder order) {
  const Extent extent = Extent::cube(edge);
  const VoxelPos origin = origin_of(at, static_cast<std::int32_t>(edge));
  RunBuilder builder(extent, order);
  for (VoxelIndex i = 0; i < extent.volume(); ++i) {
    const LocalPos p = pos_of(i, extent, order);
    builder.append(1, ground_at({origin.x + p.x, origin.y + p.y, origin.z + p.z}));
  }
  return builder.finish();
}

}  // namespace runstone::conformance
