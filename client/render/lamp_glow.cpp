#include "client/render/lamp_glow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace runstone {
namespace {

constexpr int kCell = 4;  // voxels

/// The lamps of a cell.
struct LampCell {
  glm::vec3 places{0}, colours{0};  // sums
  int count = 0;
};

glm::vec3 linear_emission(LightCode code) {
  const auto channel = [code](unsigned i) {
    const float root = static_cast<float>(emission_of(code, i)) / 15.0F;
    return root * root;
  };
  return {channel(0), channel(1), channel(2)};
}

float brightest(const glm::vec3& colour) { return std::max({colour.r, colour.g, colour.b}); }

}  // namespace

std::vector<LampGlow> lamp_glows(const RunChunk& codes) {
  const int row = static_cast<int>(codes.extent.x + kCell - 1) / kCell;  // cells
  std::vector<LampCell> cells;                                           // none without lamps
  for_each_light_box(
      codes, [&](const std::array<int, 3>& first, const std::array<int, 3>& last, LightCode code) {
        const glm::vec3 colour = linear_emission(code);
        if (brightest(colour) <= 0) return;
        cells.resize(static_cast<std::size_t>(row * row * row));
        std::array<int, 3> begin{}, end{};  // of the part of the box in a cell
        const auto for_each_part = [&](std::size_t axis, auto&& f) {
          for (begin[axis] = first[axis]; begin[axis] < last[axis]; begin[axis] = end[axis]) {
            end[axis] = std::min(last[axis], (begin[axis] / kCell + 1) * kCell);
            f();
          }
        };
        const auto add_part = [&] {
          LampCell& cell = cells[static_cast<std::size_t>(
              (begin[2] / kCell * row + begin[1] / kCell) * row + begin[0] / kCell)];
          const glm::ivec3 low(begin[0], begin[1], begin[2]), high(end[0], end[1], end[2]);
          const glm::ivec3 size = high - low;
          const int count = size.x * size.y * size.z;
          cell.places += static_cast<float>(count) * 0.5F * glm::vec3(low + high);
          cell.colours += static_cast<float>(count) * colour;
          cell.count += count;
        };
        for_each_part(2, [&] { for_each_part(1, [&] { for_each_part(0, add_part); }); });
      });
  std::vector<LampGlow> out;
  for (const LampCell& cell : cells) {
    if (cell.count == 0) continue;
    const auto count = static_cast<float>(cell.count);
    const glm::vec3 colour = cell.colours / count;
    out.push_back({cell.places / count, colour,
                   1.2F + 1.4F * std::sqrt(brightest(colour)) + 0.35F * std::cbrt(count)});
  }
  const auto order = [](const LampGlow& glow) {
    return std::tuple(-brightest(glow.colour), glow.at.x, glow.at.y, glow.at.z);
  };
  std::sort(out.begin(), out.end(),
            [&](const LampGlow& a, const LampGlow& b) { return order(a) < order(b); });
  if (out.size() > kGlowsOfChunkMax) out.resize(kGlowsOfChunkMax);
  return out;
}

void LampGlows::set(ChunkCoord at, std::int32_t edge, std::vector<LampGlow> glows) {
  if (glows.empty()) return remove(at);
  const VoxelPos origin = origin_of(at, edge);
  chunks_.insert_or_assign(
      at, Glows{{origin.x, origin.y, origin.z}, static_cast<float>(edge), std::move(glows)});
}

void LampGlows::find(const glm::dvec3& eye, float far, std::size_t count_max,
                     std::vector<GlowInView>& out) const {
  out.clear();
  for (const auto& [key, chunk] : chunks_) {
    const glm::vec3 origin(chunk.origin - eye);
    const glm::vec3 nearest = glm::clamp(glm::vec3(0), origin, origin + chunk.edge);
    if (glm::dot(nearest, nearest) >= far * far) continue;
    for (const LampGlow& glow : chunk.glows) {
      const glm::vec3 at = origin + glow.at;
      if (glm::dot(at, at) < far * far) out.push_back({at, glow.colour, glow.radius});
    }
  }
  const std::size_t count = std::min(out.size(), count_max);
  std::partial_sort(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count), out.end(),
                    [](const GlowInView& a, const GlowInView& b) {
                      return glm::dot(a.at, a.at) < glm::dot(b.at, b.at);
                    });
  out.resize(count);
}

}  // namespace runstone
