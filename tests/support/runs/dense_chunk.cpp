#include "tests/support/runs/dense_chunk.hpp"

#include <cstdlib>
#include <ostream>
#include <string_view>

#include "common/runs/dense.hpp"

namespace runstone::test {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr std::uint64_t kPrime = 2305843009213693951ULL;  // 2^61 - 1

// A second implementation of the digest's definition, so that a mistake in common/core shows:
// SplitMix64's finaliser, the salts as the ASCII that they spell, and remainders instead of
// Mersenne folding.
std::uint64_t scramble(std::uint64_t v) {
  v += 11400714819323198485ULL;
  v ^= v >> 30;
  v *= 13787848793156543929ULL;
  v ^= v >> 27;
  v *= 10723151780598845931ULL;
  v ^= v >> 31;
  return v;
}

std::uint64_t ascii(std::string_view eight) {
  std::uint64_t v = 0;
  for (const char c : eight) v = v * 256 + static_cast<unsigned char>(c);
  return v;
}

std::uint64_t residue(std::uint64_t seed) { return 1 + scramble(seed) % (kPrime - 1); }

std::uint64_t factor_of_axis(std::uint64_t lane, std::uint64_t axis, int at) {
  return residue(ascii("Runstone") ^ (lane * 65536 + axis * 256 + static_cast<std::uint64_t>(at)));
}

std::uint64_t factor_of_material(std::uint64_t lane, Material material) {
  return material == 0 ? 0 : residue(ascii("Material") ^ (lane * 4294967296ULL) ^ material);
}

std::uint64_t times(std::uint64_t a, std::uint64_t b) {
  return static_cast<std::uint64_t>(static_cast<Wide>(a) * b % kPrime);
}

// Returns the axis letters of an order, fastest first: its name.
std::string_view letters(AxisOrder order) {
  switch (order) {
    case AxisOrder::xyz:
      return "xyz";
    case AxisOrder::xzy:
      return "xzy";
    case AxisOrder::yxz:
      return "yxz";
    case AxisOrder::yzx:
      return "yzx";
    case AxisOrder::zxy:
      return "zxy";
    case AxisOrder::zyx:
      return "zyx";
  }
  std::abort();
}

std::int32_t& along(VoxelPos& p, char letter) {
  return letter == 'x' ? p.x : letter == 'y' ? p.y : p.z;
}
int side(Extent e, char letter) { return letter == 'x' ? e.x : letter == 'y' ? e.y : e.z; }

// Steps to the next voxel in flattened order, like an odometer.
void advance(VoxelPos& p, Extent extent, AxisOrder order) {
  for (const char letter : letters(order)) {
    if (++along(p, letter) < side(extent, letter)) return;
    along(p, letter) = 0;
  }
}

}  // namespace

DenseChunk::DenseChunk(Extent extent)
    : extent_(extent),
      voxels_(static_cast<std::size_t>(extent.x) * static_cast<std::size_t>(extent.y) *
              static_cast<std::size_t>(extent.z)) {
  count_dense_expansion();
}

DenseChunk DenseChunk::of(const RunChunk& chunk) {
  DenseChunk out(chunk.extent);
  VoxelPos p{};
  std::uint32_t index = 0;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
    const Run run = chunk.runs[i];
    for (; index < run.end; ++index) {
      out.set(p.x, p.y, p.z, run.material);
      advance(p, chunk.extent, chunk.order);
    }
  }
  if (index != out.voxels_.size()) std::abort();
  return out;
}

std::size_t DenseChunk::slot(int x, int y, int z) const {
  if (!inside(x, y, z)) std::abort();
  return static_cast<std::size_t>((z * side_y() + y) * side_x() + x);
}

bool DenseChunk::fill(AxisOrder order, VoxelIndex first, std::uint32_t count, Material material) {
  bool changed = false;
  VoxelPos p = dense_pos(extent_, order, first);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (at(p.x, p.y, p.z) != material) {
      set(p.x, p.y, p.z, material);
      changed = true;
    }
    advance(p, extent_, order);
  }
  return changed;
}

Digest DenseChunk::digest() const {
  Digest out;
  for (std::uint64_t lane = 0; lane < 2; ++lane) {
    std::vector<std::uint64_t> a;
    for (int x = 0; x < side_x(); ++x) a.push_back(factor_of_axis(lane, 0, x));
    std::uint64_t sum = 0;
    Material known = 0;
    std::uint64_t g = 0;
    for (int z = 0; z < side_z(); ++z) {
      const std::uint64_t c = factor_of_axis(lane, 2, z);
      for (int y = 0; y < side_y(); ++y) {
        std::uint64_t line = 0;
        for (int x = 0; x < side_x(); ++x) {
          if (at(x, y, z) != known) {
            known = at(x, y, z);
            g = factor_of_material(lane, known);
          }
          if (g != 0) line = (line + times(g, a[static_cast<std::size_t>(x)])) % kPrime;
        }
        if (line != 0) sum = (sum + times(line, times(factor_of_axis(lane, 1, y), c))) % kPrime;
      }
    }
    out.lane[lane] = sum;
  }
  return out;
}

std::uint32_t DenseChunk::run_count(AxisOrder order) const {
  std::uint32_t runs = 1;
  VoxelPos p{};
  Material before = at(0, 0, 0);
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    const Material here = at(p.x, p.y, p.z);
    if (here != before) ++runs;
    before = here;
    advance(p, extent_, order);
  }
  return runs;
}

VoxelPos dense_pos(Extent extent, AxisOrder order, std::uint32_t index) {
  VoxelPos p{};
  for (const char letter : letters(order)) {
    const auto n = static_cast<std::uint32_t>(side(extent, letter));
    along(p, letter) = static_cast<std::int32_t>(index % n);
    index /= n;
  }
  return p;
}

std::optional<VoxelPos> first_difference(const DenseChunk& a, const DenseChunk& b) {
  for (int z = 0; z < a.side_z(); ++z) {
    for (int y = 0; y < a.side_y(); ++y) {
      for (int x = 0; x < a.side_x(); ++x) {
        if (!b.inside(x, y, z) || a.at(x, y, z) != b.at(x, y, z)) return VoxelPos{x, y, z};
      }
    }
  }
  return std::nullopt;
}

std::ostream& operator<<(std::ostream& out, const DenseChunk& chunk) {
  return out << "DenseChunk " << chunk.side_x() << 'x' << chunk.side_y() << 'x' << chunk.side_z();
}

}  // namespace runstone::test
