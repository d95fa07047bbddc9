#include "client/render/quad_spans.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/assert.hpp"

namespace runstone {
namespace {

void append(QuadSpan span, std::vector<QuadSpan>& out) {
  if (span.count == 0) return;
  if (!out.empty() && out.back().first + out.back().count == span.first) {
    out.back().count += span.count;
  } else {
    out.push_back(span);
  }
}

}  // namespace

QuadSpans::QuadSpans(const QuadLayers& layers, std::int32_t edge, std::uint32_t first)
    : edge_(edge), first_(first) {
  RUNSTONE_ASSERT(layers.first.back() == layers.quads.size());
  if (layers.quads.empty()) return;
  starts_.reserve(static_cast<std::size_t>(kDirectionCount * edge) + 1);
  for (std::size_t d = 0; d < kDirectionCount; ++d) {
    for (std::size_t l = 0; l < static_cast<std::size_t>(edge); ++l)
      starts_.push_back(layers.first[d * kSideMax + l]);
  }
  starts_.push_back(layers.first.back());
}

QuadSpan QuadSpans::all() const {
  return starts_.empty() ? QuadSpan{first_, 0} : QuadSpan{first_, starts_.back()};
}

QuadSpan QuadSpans::span(int direction, int from, int to) const {
  const std::uint32_t begin = starts_[static_cast<std::size_t>(direction * edge_ + from)];
  const std::uint32_t end = starts_[static_cast<std::size_t>(direction * edge_ + to)];
  return {first_ + begin, end - begin};
}

void QuadSpans::append_facing(const std::array<double, 3>& eye, std::vector<QuadSpan>& out) const {
  if (starts_.empty()) return;
  for (int d = 0; d < kDirectionCount; ++d) {
    const double at = eye[static_cast<std::size_t>(d / 2)];
    const auto layer = [this](double v) {
      return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(edge_)));
    };
    // The plane of layer l is at l + 1 if the direction is positive, and otherwise at l.
    if (d % 2 == 1) {
      append(span(d, 0, layer(std::ceil(at))), out);
    } else {
      append(span(d, layer(std::floor(at)), edge_), out);
    }
  }
}

void QuadSpans::append_back_to_front(const std::array<double, 3>& eye, std::vector<QuadSpan>& out,
                                     std::uint8_t hidden_sides) const {
  if (starts_.empty()) return;
  std::vector<std::pair<double, QuadSpan>> planes;
  for (int d = 0; d < kDirectionCount; ++d) {
    for (int l = 0; l < edge_; ++l) {
      const QuadSpan of_layer = span(d, l, l + 1);
      const bool is_hidden = (hidden_sides >> d & 1) != 0 && l == (d % 2 == 1 ? edge_ - 1 : 0);
      if (of_layer.count == 0 || is_hidden) continue;
      const double plane = l + d % 2;
      planes.emplace_back(std::abs(eye[static_cast<std::size_t>(d / 2)] - plane), of_layer);
    }
  }
  std::sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second.first < b.second.first;
  });
  for (const auto& [distance, of_layer] : planes) append(of_layer, out);
}

}  // namespace runstone
