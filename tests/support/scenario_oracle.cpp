#include "tests/support/scenario_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace runstone::test {
namespace {

const double kPi = std::acos(-1.0);

double wave(double omega, int c) { return std::sin(omega * c / (2 * kPi)); }

bool in_strip(int c, int n, int gaps) {
  const int width = std::max(1, static_cast<int>(std::floor(n / (2.0 * gaps + 0.75))));
  return (c / width) % 2 == 0;
}

/// The draws of one chunk in the thesis' order, each as the fraction it compares.
std::vector<float> draws(int n) {
  std::uint64_t state = 1;
  std::vector<float> out;
  for (int i = 0; i < n * n * n; ++i) {
    state = (196314165 * state + 907633515) % 4294967296;
    out.push_back(static_cast<float>(std::floor(static_cast<double>(state) / 512) / 8388608));
  }
  return out;
}

}  // namespace

DenseChunk scenario_dense(unsigned number, unsigned edge) {
  const int n = static_cast<int>(edge);
  const std::vector<float> random = number >= 18 && number <= 22 ? draws(n) : std::vector<float>();
  const auto solid = [&](int x, int y, int z) {  // the thesis' axes
    const auto half = [n](int c) { return c < n / 2; };
    const auto ball = [&](double radius) {
      return std::sqrt(std::pow(x - n / 2, 2) + std::pow(y - n / 2, 2) + std::pow(z - n / 2, 2)) <
             radius;
    };
    const auto strips = [&](int kx, int ky, int kz) {
      return in_strip(x, n, kx) && in_strip(y, n, ky) && in_strip(z, n, kz);
    };
    const auto waves = [&](double omega) {
      return wave(omega, x) + wave(omega, y) + wave(omega, z) > 0;
    };
    const auto drawn = [&](float threshold) {
      return random[static_cast<std::size_t>((x * n + y) * n + z)] < threshold;
    };
    switch (number) {  // scenarios.csv, line by line
      case 1:
        return true;
      case 2:
        return half(x);
      case 3:
        return half(z);
      case 4:
        return half(y);
      case 6:
        return ball(4);
      case 7:
        return ball(8);
      case 8:
        return ball(16);
      case 9:
        return strips(1, 1, 1);
      case 10:
        return strips(2, 2, 2);
      case 11:
        return strips(3, 3, 3);
      case 12:
        return strips(2, 2, 2);
      case 13:
        return strips(15, 15, 15);
      case 14:
        return waves(2);
      case 15:
        return waves(4);
      case 16:
        return waves(10);
      case 17:
        return (x + y + z) % 2 == 0;
      case 18:
        return drawn(0.99f);
      case 19:
        return drawn(0.75f);
      case 20:
        return drawn(0.5f);
      case 21:
        return drawn(0.25f);
      case 22:
        return drawn(0.01f);
      case 23:
        return strips(0, 15, 0);
      case 24:
        return strips(0, 7, 0);
      case 25:
        return strips(0, 3, 0);
      case 26:
        return strips(0, 2, 0);
      case 27:
        return strips(0, 1, 0);
      case 28:
        return strips(0, 0, 15);
      case 29:
        return strips(0, 0, 7);
      case 30:
        return strips(0, 0, 3);
      case 31:
        return strips(0, 0, 2);
      case 32:
        return strips(0, 0, 1);
      case 33:
        return strips(15, 0, 0);
      case 34:
        return strips(7, 0, 0);
      case 35:
        return strips(3, 0, 0);
      case 36:
        return strips(2, 0, 0);
      case 37:
        return strips(1, 0, 0);
      default:
        std::abort();
    }
  };
  DenseChunk out(Extent::cube(edge));
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) {
        if (solid(x, y, z)) out.set(x, z, y, 1);
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
