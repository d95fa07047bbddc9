#include "common/generate/column.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

/// The same column as a plain array over y in [-20, 30).
struct PlainColumn {
  static constexpr int kMin = -20, kMax = 30;
  std::vector<Material> voxels = std::vector<Material>(kMax - kMin, kEmpty);

  void paint(int from, int to, Material m) {
    for (int y = kMin; y < kMax; ++y) {
      if (y >= from && y < to) voxels[static_cast<std::size_t>(y - kMin)] = m;
    }
  }
  void flood(int to, Material m) {
    for (int y = kMin; y < to && y < kMax; ++y) {
      Material& v = voxels[static_cast<std::size_t>(y - kMin)];
      if (v == kEmpty) v = m;
    }
  }
  Material at(int y) const {
    return y < kMin || y >= kMax ? kEmpty : voxels[static_cast<std::size_t>(y - kMin)];
  }
  int top() const {
    for (int y = kMax; y-- > kMin;) {
      if (at(y) != kEmpty) return y + 1;
    }
    return kMin;
  }
};

bool agrees(const Column& column, const PlainColumn& plain) {
  for (int y = -30; y < 40; ++y) {
    if (column.at(y) != plain.at(y)) return false;
  }
  return column.top() == plain.top();
}

}  // namespace

TEST_CASE("painting a column does what painting an array does", "[generate]") {
  SplitMix64 random(Catch::rngSeed());
  Column column;
  for (int round = 0; round < 300; ++round) {
    column.reset(PlainColumn::kMin, PlainColumn::kMax);
    PlainColumn plain;
    for (int step = 0; step < 12; ++step) {
      const int from = random.between(-25, 35), to = random.between(-25, 35);
      const auto material = static_cast<Material>(random.below(4));
      if (random.below(4) == 0) {
        column.flood(to, material);
        plain.flood(to, material);
      } else {
        column.paint(from, to, material);
        plain.paint(from, to, material);
      }
      CAPTURE(round, step, from, to, material);
      REQUIRE(agrees(column, plain));
    }
    // Emits a window, with empty voxels outside the bounds.
    const int at = random.between(-40, 40);
    RunBuilder out(Extent{8, 16, 8}, AxisOrder::yxz);
    for (int line = 0; line < 64; ++line) column.emit(at, 16, out);
    const RunChunk chunk = out.finish();
    for (int y = 0; y < 16; ++y) {
      REQUIRE(material_at(chunk, {3, static_cast<std::uint8_t>(y), 5}) == plain.at(at + y));
    }
  }
}

TEST_CASE("the array detects a wrong column", "[generate]") {
  Column column;
  column.reset(PlainColumn::kMin, PlainColumn::kMax);
  PlainColumn plain;
  column.paint(0, 5, 1);
  plain.paint(0, 6, 1);
  CHECK_FALSE(agrees(column, plain));
}
