#include "common/sculpt/height_field.hpp"

#include <algorithm>
#include <array>

namespace runstone {
namespace {

/// Replaces each value of a line by the sum of those up to `radius` away. `line` steps by `stride`
/// through `values`.
void sum_line(std::vector<std::int64_t>& values, std::size_t start, std::size_t stride,
              std::size_t count, std::size_t radius, std::vector<std::int64_t>& prefix) {
  prefix.assign(count + 1, 0);
  for (std::size_t i = 0; i < count; ++i) prefix[i + 1] = prefix[i] + values[start + i * stride];
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t low = i > radius ? i - radius : 0, high = std::min(count, i + radius + 1);
    values[start + i * stride] = prefix[high] - prefix[low];
  }
}

/// Replaces each value by the sum over a square, twice.
void sum_squares(std::vector<std::int64_t>& values, std::size_t width, std::size_t radius) {
  if (values.empty()) return;
  const std::size_t depth = values.size() / width;
  std::vector<std::int64_t> prefix;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t z = 0; z < depth; ++z) sum_line(values, z * width, 1, width, radius, prefix);
    for (std::size_t x = 0; x < width; ++x) sum_line(values, x, width, depth, radius, prefix);
  }
}

}  // namespace

HeightField height_field(std::span<const std::int32_t> surface, std::int32_t width) {
  HeightField out{width, {}, {}};
  out.heights.reserve(surface.size());
  out.has_surface.reserve(surface.size());
  for (const std::int32_t y : surface) {
    out.has_surface.push_back(y != kNoSurface);
    out.heights.push_back(y == kNoSurface ? 0 : y * kHeightUnit);
  }
  return out;
}

HeightField moved_to(const HeightField& from, std::span<const std::int32_t> weights,
                     const HeightField& target) {
  HeightField out = from;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out.has_surface[i])
      out.heights[i] += (target.heights[i] - out.heights[i]) * weights[i] / kFullWeight;
  }
  return out;
}

HeightField mean_heights(const HeightField& field, std::int32_t radius) {
  // Heights are taken relative to one of them, so that the sums of large fields fit 64 bits: a
  // sum of the weights is below 2^29 for a radius of 64, and a difference of heights below 2^20.
  std::int64_t base = 0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.has_surface[i]) base = field.heights[i];
  }
  std::vector<std::int64_t> sums(field.size()), counts(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (!field.has_surface[i]) continue;
    sums[i] = field.heights[i] - base;
    counts[i] = 1;
  }
  const auto width = static_cast<std::size_t>(field.width);
  sum_squares(sums, width, static_cast<std::size_t>(radius));
  sum_squares(counts, width, static_cast<std::size_t>(radius));
  HeightField out = field;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out.has_surface[i]) out.heights[i] = base + sums[i] / counts[i];
  }
  return out;
}

HeightField eroded(const HeightField& field, std::span<const std::int32_t> weights,
                   std::int32_t times) {
  HeightField out = field;
  const auto width = static_cast<std::size_t>(field.width);
  std::vector<std::int64_t> change(field.size());
  for (std::int32_t step = 0; step < times; ++step) {
    std::fill(change.begin(), change.end(), 0);
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (weights[i] == 0 || !out.has_surface[i]) continue;
      const std::size_t x = i % width;
      const std::array<std::size_t, 4> beside = {x > 0 ? i - 1 : i, x + 1 < width ? i + 1 : i,
                                                 i >= width ? i - width : i,
                                                 i + width < out.size() ? i + width : i};
      std::array<std::int64_t, 4> excess{};
      std::int64_t sum = 0, most = 0;
      for (std::size_t n = 0; n < beside.size(); ++n) {
        const std::size_t other = beside[n];
        if (weights[other] == 0 || !out.has_surface[other]) continue;
        excess[n] = std::max<std::int64_t>(0, out.heights[i] - out.heights[other] - kHeightUnit);
        sum += excess[n];
        most = std::max(most, excess[n]);
      }
      if (sum == 0) continue;
      const std::int64_t given = most / 2 * weights[i] / kFullWeight;
      for (std::size_t n = 0; n < beside.size(); ++n) {
        const std::int64_t part = given * excess[n] / sum;
        change[i] -= part;
        change[beside[n]] += part;
      }
    }
    for (std::size_t i = 0; i < out.size(); ++i) out.heights[i] += change[i];
  }
  return out;
}

}  // namespace runstone
