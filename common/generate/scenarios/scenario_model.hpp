// ScenarioModel: the voxel models of the thesis' 37 profiling scenarios (chapter 8.2), one chunk each, as
// formulas over columns. Scenario 5 is not among them: its noise is another's, and its voxels are data
// (columns_world.hpp). The thesis has z up; here its z is y and its y is z. Its flattened order y, z, x is
// our zyx. Solid or not is all a model says. Everything but ComplexShape is integers; its sums of three sines
// keep clear of zero by far more than any two maths libraries differ (a test pins how far).
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

/// Each of these is a model of an edge of 8 .. 128 voxels, a power of two; x, y and z are 0 .. edge - 1.

/// x < floor(edge / x_fraction), and so on. Fractions from 1 up; all 1: everything.
struct Fraction {
  unsigned x_fraction, y_fraction, z_fraction;
};
/// Nearer than `radius` to the corner between the eight middle voxels.
struct Sphere {
  unsigned radius;
};
/// floor(a / w) even on all three axes, w = max(1, floor(edge / (2 gaps + 0.75))).
struct Strips {
  unsigned x_gaps, y_gaps, z_gaps;
};
/// sin(omega x / 2 pi) + sin(omega y / 2 pi) + sin(omega z / 2 pi) > 0.
struct Waves {
  unsigned omega;
};
/// x + y + z even.
struct Chessboard {};
/// One draw of a congruential generator a voxel, x outermost, y innermost; solid below `threshold` in 1 /
/// 2^23.
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
  /// Requires x, z < edge. Cost: a few operations, or O(edge) for Waves and Random.
  ColumnBits column(unsigned x, unsigned z) const;

 private:
  Formula formula_;
  unsigned edge_;
  std::array<ColumnBits, 3> solid_{};    // Strips: along x, y and z
  std::array<double, kSideMax> wave_{};  // Waves: by coordinate
};

/// 8, 16, 32, 64 or 128.
bool scenario_edge_valid(unsigned edge);

/// The model of scenario 1 .. 37 at `edge`, with the parameters it was measured with (12: gap count 2, as the
/// maps had it, not the 7 of the shipped asset). Fails with not_found for 5 and numbers beyond, with
/// bad_value for another edge.
Result<ScenarioModel> scenario_model(unsigned number, unsigned edge);

}  // namespace runstone
