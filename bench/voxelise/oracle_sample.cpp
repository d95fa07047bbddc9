#include "bench/voxelise/oracle_sample.hpp"

#include <algorithm>

#include "common/core/hash.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::bench {
namespace {

constexpr std::int32_t kSampleSection = 64;
constexpr std::uint64_t kSampleSeed = 48;

struct SampleBounds {
  std::array<double, 3> low{};
  double longest = 0;
};

SampleBounds sample_bounds(const Model& mesh) {
  SampleBounds out;
  for (std::size_t i = 0; i < 3; ++i) {
    double low = mesh.positions[mesh.triangles[0][0]][i], high = low;
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t vertex : triangle) {
        low = std::min<double>(low, mesh.positions[vertex][i]);
        high = std::max<double>(high, mesh.positions[vertex][i]);
      }
    }
    out.low[i] = low;
    out.longest = std::max(out.longest, high - low);
  }
  return out;
}

VoxelPos section_of(VoxelPos p) {
  const auto floor = [](std::int32_t v) { return v / kSampleSection * kSampleSection; };
  return {floor(p.x), floor(p.y), floor(p.z)};
}

}  // namespace

OracleSample::OracleSample(const Model& mesh, std::uint32_t longest_side, std::size_t count) {
  const SampleBounds bounds = sample_bounds(mesh);
  const double scale = double{1} * longest_side / bounds.longest;
  const test::VoxelOracle oracle(mesh, scale);
  const VoxelPos sides = oracle.sides();
  SplitMix64 rng(kSampleSeed);
  for (std::size_t i = 0; i < count; ++i) {
    VoxelPos at{rng.between(0, sides.x - 1), rng.between(0, sides.y - 1),
                rng.between(0, sides.z - 1)};
    if (i % 2 == 0) {
      const auto& triangle =
          mesh.triangles[rng.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
      const auto& corner = mesh.positions[triangle[rng.below(3)]];
      const auto near = [&](std::size_t axis, std::int32_t side) {
        const auto v = static_cast<std::int32_t>((double{corner[axis]} - bounds.low[axis]) * scale);
        return std::clamp(v + rng.between(-1, 1), 0, side - 1);
      };
      at.x = near(0, sides.x);
      at.y = near(1, sides.y);
      at.z = near(2, sides.z);
    }
    in_section_[section_of(at)].push_back(voxels_.size());
    voxels_.push_back(at);
  }
  for (std::size_t shape = 0; shape < expected_.size(); ++shape) {
    for (const VoxelPos& at : voxels_) {
      const auto mode = static_cast<OracleShape>(shape);
      expected_[shape].push_back(mode == OracleShape::none ? oracle.is_inside(at)
                                                           : oracle.is_surface(at, mode));
    }
  }
  begin();
}

void OracleSample::take(const VoxelPiece& piece) {
  const auto found = in_section_.find(piece.origin);
  if (found == in_section_.end()) return;
  for (const std::size_t i : found->second) {
    const VoxelPos& at = voxels_[i];
    const LocalPos local{static_cast<std::uint8_t>(at.x - piece.origin.x),
                         static_cast<std::uint8_t>(at.y - piece.origin.y),
                         static_cast<std::uint8_t>(at.z - piece.origin.z)};
    is_set_[i] = material_at(piece.voxels, local) != kEmpty;
  }
}

std::size_t OracleSample::differing(OracleShape shape) const {
  const std::vector<bool>& expected = expected_[static_cast<std::size_t>(shape)];
  std::size_t out = 0;
  for (std::size_t i = 0; i < voxels_.size(); ++i) out += is_set_[i] != expected[i] ? 1 : 0;
  return out;
}

}  // namespace runstone::bench
