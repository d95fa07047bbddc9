#include "common/generate/scenarios/scenario_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

using namespace scenario;

/// Returns bits [from, to) of a column. Requires to <= 128.
ColumnBits bits_between(unsigned from, unsigned to) {
  ColumnBits out{};
  for (unsigned word = 0; word < 2; ++word) {
    const unsigned low = std::clamp(from, 64 * word, 64 * word + 64) - 64 * word;
    const unsigned high = std::clamp(to, 64 * word, 64 * word + 64) - 64 * word;
    if (low < high) out[word] = ~std::uint64_t{0} >> (64 - (high - low)) << low;
  }
  return out;
}

bool bit(const ColumnBits& bits, unsigned at) { return (bits[at / 64] >> (at % 64) & 1) != 0; }

ColumnBits strips_along(unsigned gaps, unsigned edge) {
  // floor(edge / (2 gaps + 3/4)) in integers.
  const unsigned width = std::max(1u, 4 * edge / (8 * gaps + 3));
  ColumnBits out{};
  for (unsigned at = 0; at < edge; ++at) {
    if (at / width % 2 == 0) out[at / 64] |= std::uint64_t{1} << (at % 64);
  }
  return out;
}

/// The thesis' random stream: state = a * state + c before each draw. The upper 23 bits are the
/// draw.
struct Stream {
  std::uint32_t state;
  std::uint32_t draw() {
    state = 196314165u * state + 907633515u;
    return state >> 9;
  }
  /// Skips draws by squaring the step. Cost: O(log count).
  void skip(std::uint32_t count) {
    std::uint32_t factor = 196314165u, summand = 907633515u;
    for (; count != 0; count /= 2) {
      if (count % 2 != 0) state = factor * state + summand;
      summand += factor * summand;
      factor *= factor;
    }
  }
};

/// Returns a threshold of the thesis, which is a float, in units of 1 / 2^23. Draws below it are
/// solid.
std::uint32_t threshold_of(float threshold) {
  return static_cast<std::uint32_t>(std::ceil(static_cast<double>(threshold) * (1 << 23)));
}

std::optional<ScenarioModel::Formula> formula_of(unsigned number) {
  constexpr unsigned kGaps[] = {15, 7, 3, 2, 1};  // of the strips of one axis, in the thesis' order
  switch (number) {
    case 1:
      return Fraction{1, 1, 1};
    case 2:
      return Fraction{2, 1, 1};
    case 3:
      return Fraction{1, 2, 1};  // half along the thesis' z
    case 4:
      return Fraction{1, 1, 2};  // half along the thesis' y
    case 6:
      return Sphere{4};
    case 7:
      return Sphere{8};
    case 8:
      return Sphere{16};
    case 9:
      return Strips{1, 1, 1};
    case 10:
    case 12:
      return Strips{2, 2, 2};
    case 11:
      return Strips{3, 3, 3};
    case 13:
      return Strips{15, 15, 15};
    case 14:
      return Waves{2};
    case 15:
      return Waves{4};
    case 16:
      return Waves{10};
    case 17:
      return Chessboard{};
    case 18:
      return Random{threshold_of(0.99f), 1};
    case 19:
      return Random{threshold_of(0.75f), 1};
    case 20:
      return Random{threshold_of(0.5f), 1};
    case 21:
      return Random{threshold_of(0.25f), 1};
    case 22:
      return Random{threshold_of(0.01f), 1};
    default:
      break;
  }
  if (number >= 23 && number <= 27) return Strips{0, 0, kGaps[number - 23]};  // the thesis' y
  if (number >= 28 && number <= 32) return Strips{0, kGaps[number - 28], 0};  // the thesis' z
  if (number >= 33 && number <= 37) return Strips{kGaps[number - 33], 0, 0};
  return std::nullopt;
}

/// Returns a column of each formula.
struct ColumnOf {
  unsigned edge, x, z;
  const std::array<ColumnBits, 3>& solid;
  const std::array<double, kSideMax>& wave;

  ColumnBits operator()(const Fraction& f) const {
    const bool inside = x < edge / f.x_fraction && z < edge / f.z_fraction;
    return bits_between(0, inside ? edge / f.y_fraction : 0);
  }
  ColumnBits operator()(const Sphere& f) const {
    const auto from_middle = [this](unsigned at) {
      return static_cast<int>(at) - static_cast<int>(edge / 2);
    };
    const int dx = from_middle(x);
    const int dz = from_middle(z);
    const int left = static_cast<int>(f.radius * f.radius) - dx * dx - dz * dz;
    if (left <= 0) return {};
    int reach = 0;  // the largest integer whose square is below `left`
    while ((reach + 1) * (reach + 1) < left) ++reach;
    const int middle = static_cast<int>(edge / 2);
    return bits_between(static_cast<unsigned>(std::max(middle - reach, 0)),
                        std::min(static_cast<unsigned>(middle + reach + 1), edge));
  }
  ColumnBits operator()(const Strips&) const {
    return bit(solid[0], x) && bit(solid[2], z) ? solid[1] : ColumnBits{};
  }
  ColumnBits operator()(const Waves&) const {
    ColumnBits out{};
    for (unsigned y = 0; y < edge; ++y) {
      if (wave[x] + wave[y] + wave[z] > 0) out[y / 64] |= std::uint64_t{1} << (y % 64);
    }
    return out;
  }
  ColumnBits operator()(const Chessboard&) const {
    const std::uint64_t even = 0x5555'5555'5555'5555;
    const ColumnBits inside = bits_between(0, edge);
    const std::uint64_t bits = (x + z) % 2 == 0 ? even : ~even;
    return {bits & inside[0], bits & inside[1]};
  }
  ColumnBits operator()(const Random& f) const {
    Stream stream{f.seed};
    stream.skip((x * edge + z) * edge);
    ColumnBits out{};
    for (unsigned y = 0; y < edge; ++y) {
      if (stream.draw() < f.threshold) out[y / 64] |= std::uint64_t{1} << (y % 64);
    }
    return out;
  }
};

}  // namespace

ScenarioModel::ScenarioModel(const Formula& formula, unsigned edge)
    : formula_(formula), edge_(edge) {
  RUNSTONE_ASSERT(scenario_edge_valid(edge));
  if (const auto* strips = std::get_if<Strips>(&formula)) {
    solid_ = {strips_along(strips->x_gaps, edge), strips_along(strips->y_gaps, edge),
              strips_along(strips->z_gaps, edge)};
  }
  if (const auto* waves = std::get_if<Waves>(&formula)) {
    for (unsigned at = 0; at < edge; ++at) {
      wave_[at] = std::sin(static_cast<double>(waves->omega * at) / (2 * std::numbers::pi));
    }
  }
}

ColumnBits ScenarioModel::column(unsigned x, unsigned z) const {
  RUNSTONE_DASSERT(x < edge_ && z < edge_);
  return std::visit(ColumnOf{edge_, x, z, solid_, wave_}, formula_);
}

bool scenario_edge_valid(unsigned edge) {
  return edge == 8 || edge == 16 || edge == 32 || edge == 64 || edge == 128;
}

Result<ScenarioModel> scenario_model(unsigned number, unsigned edge) {
  const auto formula = formula_of(number);
  if (!formula) return fail(ErrorCode::not_found, "no formula for a scenario of this number");
  if (!scenario_edge_valid(edge))
    return fail(ErrorCode::bad_value, "a scenario's edge is 8, 16, 32, 64 or 128");
  return ScenarioModel(*formula, edge);
}

}  // namespace runstone
