// LampGlow: the air that a lamp makes glow around itself. Pure.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <span>
#include <vector>

#include "client/render/light_chunk.hpp"
#include "common/core/coords.hpp"

namespace runstone {

struct LampGlow {
  glm::vec3 at{0};      // the middle of the lamps, in voxels from the origin of the chunk
  glm::vec3 colour{0};  // linear
  float radius = 1;     // voxels
};

/// Returns the glows of a chunk: one for the lamps of each cell of 4 x 4 x 4 voxels, of the cells
/// with the brightest lamps first, at most kGlowsOfChunkMax. The radius grows with brightness and
/// number of the lamps. Requires a cube. Cost: O(runs + cells that
/// the runs of lamps touch).
inline constexpr std::size_t kGlowsOfChunkMax = 64;
std::vector<LampGlow> lamp_glows(const RunChunk& codes);

/// A glow in the view of a frame.
struct GlowInView {
  glm::vec3 at{0};  // from the eye, voxels
  glm::vec3 colour{0};
  float radius = 1;
};

/// The glows of all chunks that have lamps.
class LampGlows {
 public:
  /// Replaces the glows of a chunk. `edge` is in voxels.
  void set(ChunkCoord at, std::int32_t edge, std::vector<LampGlow> glows);
  void remove(ChunkCoord at) { chunks_.erase(at); }
  /// Puts the glows nearer than `far` into `out`, from near to far, at most `count_max`. Cost:
  /// O(chunks with lamps + glows near enough * log count_max).
  void find(const glm::dvec3& eye, float far, std::size_t count_max,
            std::vector<GlowInView>& out) const;

 private:
  struct Glows {
    glm::dvec3 origin{0};  // world voxels
    float edge = 0;        // voxels
    std::vector<LampGlow> glows;
  };
  std::map<ChunkCoord, Glows> chunks_;
};

}  // namespace runstone
