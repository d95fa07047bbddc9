// ScenarioModel: the voxel models of the thesis' 37 profiling scenarios (chapter 8.2), one chunk
// each, as formulas over columns. Scenario 5 is not among them: its noise is not known, and its
// voxels are data (columns_world.hpp). The thesis has z up: its z is y here, and its y is z here.
// Its flattened order y, z, x is zyx here. A model only says which voxels are solid. All formulas
// except Waves (the thesis' ComplexShape) use integers. The sums of three sines of Waves differ
// from zero by far more than the results of two maths libraries differ; a test pins the distance.
#pragma once
#include <array>
#include <cstdint>
#include <variant>

#include "common/core/result.hpp"
#include "common/runs/extent.hpp"

namespace runstone {

inline constexpr unsigned kScenarioCount = 37;

/// A column of a model: bit y % 64 of word y / 64 is its voxel at height y.
using ColumnBits = std::array<std::uint64_t, 2>;

namespace scenario {

/// Each formula gives a model with an edge of 8 .. 128 voxels, a power of two; x, y and z are 0 ..
/// edge - 1.

/// x < floor(edge / x_fraction), and the same for y and z. Fractions are at least 1; if all are 1,
/// every voxel is solid.
struct Fraction {
  unsigned x_fraction, y_fraction, z_fraction;
};
/// Voxels nearer than `radius` to the corner between the eight middle voxels.
struct Sphere {
  unsigned radius;
};
/// floor(a / w) is even on all three axes, w = max(1, floor(edge / (2 gaps + 0.75))).
struct Strips {
  unsigned x_gaps, y_gaps, z_gaps;
};
/// sin(omega x / 2 pi) + sin(omega y / 2 pi) + sin(omega z / 2 pi) > 0.
struct Waves {
  unsigned omega;
};
/// x + y + z is even.
struct Chessboard {};
/// One draw of a congruential generator per voxel, x outermost, y innermost. A voxel is solid if
/// the draw is below `threshold`, in units of 1 / 2^23.
struct Random {
  std::uint32_t threshold, seed;
};

}  // namespace scenario

class ScenarioModel {
 public:
  using Formula = std::variant<scenario::Fraction, scenario::Sphere, scenario::Strips,
                               scenario::Waves, scenario::Chessboard, scenario::Random>;

  /// Requires an edge that scenario_edge_valid() allows.
  ScenarioModel(const Formula& formula, unsigned edge);

  unsigned edge() const { return edge_; }
  /// Requires x, z < edge. Cost: O(1); Waves and Random: O(edge).
  ColumnBits column(unsigned x, unsigned z) const;

 private:
  Formula formula_;
  unsigned edge_;
  std::array<ColumnBits, 3> solid_{};    // Strips: along x, y and z
  std::array<double, kSideMax> wave_{};  // Waves: by coordinate
};

/// Returns true for 8, 16, 32, 64 and 128.
bool scenario_edge_valid(unsigned edge);

/// Returns the model of scenario 1 .. 37 at `edge`, with the parameters of its measurement (12: gap
/// count 2, as in the maps, not the 7 of the shipped asset). Fails with not_found for 5 and for
/// numbers out of range, and with bad_value for another edge.
Result<ScenarioModel> scenario_model(unsigned number, unsigned edge);

}  // namespace runstone
