#include "tests/support/scenarios/scenario_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace runstone::test {
namespace {

const double kPi = std::acos(-1.0);

enum class Formula { all, half_x, half_y, half_z, ball, strips, waves, checkerboard, draws };

struct Model {
  unsigned number;
  Formula shape;
  std::array<float, 3> values;  // radius; gaps of x, y, z; omega; threshold
};
/// scenarios.csv, line by line. Scenario 5 is data, not a formula.
constexpr std::array<Model, 36> kModels = {{{1, Formula::all, {}},
                                            {2, Formula::half_x, {}},
                                            {3, Formula::half_z, {}},
                                            {4, Formula::half_y, {}},
                                            {6, Formula::ball, {4}},
                                            {7, Formula::ball, {8}},
                                            {8, Formula::ball, {16}},
                                            {9, Formula::strips, {1, 1, 1}},
                                            {10, Formula::strips, {2, 2, 2}},
                                            {11, Formula::strips, {3, 3, 3}},
                                            {12, Formula::strips, {2, 2, 2}},
                                            {13, Formula::strips, {15, 15, 15}},
                                            {14, Formula::waves, {2}},
                                            {15, Formula::waves, {4}},
                                            {16, Formula::waves, {10}},
                                            {17, Formula::checkerboard, {}},
                                            {18, Formula::draws, {0.99f}},
                                            {19, Formula::draws, {0.75f}},
                                            {20, Formula::draws, {0.5f}},
                                            {21, Formula::draws, {0.25f}},
                                            {22, Formula::draws, {0.01f}},
                                            {23, Formula::strips, {0, 15, 0}},
                                            {24, Formula::strips, {0, 7, 0}},
                                            {25, Formula::strips, {0, 3, 0}},
                                            {26, Formula::strips, {0, 2, 0}},
                                            {27, Formula::strips, {0, 1, 0}},
                                            {28, Formula::strips, {0, 0, 15}},
                                            {29, Formula::strips, {0, 0, 7}},
                                            {30, Formula::strips, {0, 0, 3}},
                                            {31, Formula::strips, {0, 0, 2}},
                                            {32, Formula::strips, {0, 0, 1}},
                                            {33, Formula::strips, {15, 0, 0}},
                                            {34, Formula::strips, {7, 0, 0}},
                                            {35, Formula::strips, {3, 0, 0}},
                                            {36, Formula::strips, {2, 0, 0}},
                                            {37, Formula::strips, {1, 0, 0}}}};

const Model& model_of(unsigned number) {
  const auto found = std::find_if(kModels.begin(), kModels.end(),
                                  [&](const Model& model) { return model.number == number; });
  if (found == kModels.end()) std::abort();
  return *found;
}

double wave(double omega, int c) { return std::sin(omega * c / (2 * kPi)); }

bool in_strip(int c, int n, float gaps) {
  const int width = std::max(1, static_cast<int>(std::floor(n / (2.0 * gaps + 0.75))));
  return (c / width) % 2 == 0;
}

/// Returns the draws of one chunk in the thesis' order, each as the fraction that the thesis
/// compares.
std::vector<float> draws(int n) {
  std::uint64_t state = 1;
  std::vector<float> out;
  for (int i = 0; i < n * n * n; ++i) {
    state = (196314165 * state + 907633515) % 4294967296;
    out.push_back(static_cast<float>(std::floor(static_cast<double>(state) / 512) / 8388608));
  }
  return out;
}

/// Returns true if the model is solid at a voxel, given in the thesis' axes, of a chunk of `n`
/// voxels a side.
bool is_solid(const Model& model, const std::vector<float>& random, int n, int x, int y, int z) {
  const auto& values = model.values;
  switch (model.shape) {
    case Formula::all:
      return true;
    case Formula::half_x:
      return x < n / 2;
    case Formula::half_y:
      return y < n / 2;
    case Formula::half_z:
      return z < n / 2;
    case Formula::ball:
      return std::sqrt(std::pow(x - n / 2, 2) + std::pow(y - n / 2, 2) + std::pow(z - n / 2, 2)) <
             values[0];
    case Formula::strips:
      return in_strip(x, n, values[0]) && in_strip(y, n, values[1]) && in_strip(z, n, values[2]);
    case Formula::waves:
      return wave(values[0], x) + wave(values[0], y) + wave(values[0], z) > 0;
    case Formula::checkerboard:
      return (x + y + z) % 2 == 0;
    case Formula::draws:
      return random[static_cast<std::size_t>((x * n + y) * n + z)] < values[0];
  }
  std::abort();
}

}  // namespace

DenseChunk scenario_dense(unsigned number, unsigned edge) {
  const Model& model = model_of(number);
  const int n = static_cast<int>(edge);
  const std::vector<float> random = model.shape == Formula::draws ? draws(n) : std::vector<float>();
  DenseChunk out(Extent::cube(edge));
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) {
        if (is_solid(model, random, n, x, y, z)) out.set(x, z, y, 1);
      }
    }
  }
  return out;
}

double smallest_wave_sum() {
  double smallest = std::numeric_limits<double>::infinity();
  for (const double omega : {2.0, 4.0, 10.0}) {
    std::vector<double> s;
    for (int c = 0; c < 128; ++c) s.push_back(wave(omega, c));
    for (std::size_t x = 0; x < s.size(); ++x) {
      for (std::size_t y = 0; y <= x; ++y) {
        for (std::size_t z = 0; z <= y; ++z) {
          if (x != 0) smallest = std::min(smallest, std::abs(s[x] + s[y] + s[z]));
        }
      }
    }
  }
  return smallest;
}

}  // namespace runstone::test
