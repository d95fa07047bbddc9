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
  std::map<std::tuple<int, int, int>, LampCell> cells;
  for_each_light_box(
      codes, [&](const std::array<int, 3>& first, const std::array<int, 3>& last, LightCode code) {
        const glm::vec3 colour = linear_emission(code);
        if (brightest(colour) <= 0) return;
        for (int z = first[2]; z < last[2]; ++z) {
          for (int y = first[1]; y < last[1]; ++y) {
            for (int x = first[0]; x < last[0]; ++x) {
              LampCell& cell = cells[{x / kCell, y / kCell, z / kCell}];
              cell.places += glm::vec3(x, y, z) + 0.5F;
              cell.colours += colour;
              ++cell.count;
            }
          }
        }
      });
  std::vector<LampGlow> out;
  for (const auto& [key, cell] : cells) {
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
  chunks_.insert_or_assign(at, Glows{{origin.x, origin.y, origin.z}, std::move(glows)});
}

void LampGlows::find(const glm::dvec3& eye, float far, std::size_t count_max,
                     std::vector<GlowInView>& out) const {
  out.clear();
  for (const auto& [key, chunk] : chunks_) {
    const glm::vec3 origin(chunk.origin - eye);
    for (const LampGlow& glow : chunk.glows) {
      const glm::vec3 at = origin + glow.at;
      if (glm::dot(at, at) < far * far) out.push_back({at, glow.colour, glow.radius});
    }
  }
  std::ranges::sort(out, {}, [](const GlowInView& glow) { return glm::dot(glow.at, glow.at); });
  if (out.size() > count_max) out.resize(count_max);
}

}  // namespace runstone
