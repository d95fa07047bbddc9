// FarFades: chunks and tiles that replaced their octant of the parent, or were replaced by it, a
// short time ago. Meanwhile both bodies are drawn. The finer one is drawn in full, because the
// meshes beside it leave out the faces that it covers. The octant, which is in front of it nearly
// everywhere, loses or gains one pixel after another in a fixed pattern
// (client/render/terrain_glsl.hpp). So at least one body is drawn in full at every time, and no gap
// opens. Transparent faces would be blended twice, so the finer body draws them only in the pixels
// that the octant lacks.
//
// Pure. One thread. Bound: kFadesMax; further changes happen at once.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/core/coords.hpp"

namespace runstone {

inline constexpr double kFadeSeconds = 0.3;
inline constexpr std::size_t kFadesMax = 256;

class FarFades {
 public:
  /// Begins the fade of a chunk or tile, from the next advance() on. `is_coming`: it has replaced
  /// its octant; otherwise the octant has replaced it. Returns false if there are too many fades.
  bool begin(const ChunkKey& key, bool is_coming);
  void end(const ChunkKey& key) { fades_.erase(key); }
  /// Sets the time. Returns the chunks and tiles whose fade has ended, ascending. A time before the
  /// begin of a fade ends it.
  std::vector<ChunkKey> advance(double seconds);

  bool empty() const { return fades_.empty(); }
  std::vector<ChunkKey> keys() const;
  bool has(const ChunkKey& key) const { return fades_.contains(key); }
  /// Returns true if the chunk or tile was replaced by its octant, which appears.
  bool is_leaving(const ChunkKey& key) const;
  /// Returns true if the chunk or tile has replaced its octant, which dissolves.
  bool is_coming(const ChunkKey& key) const;
  /// Returns the share of its pixels that the octant in the place of this chunk or tile does not
  /// draw: it grows from 0 if the chunk or tile is coming, and falls from 1 if it is leaving.
  /// Returns 0 if there is no fade.
  float octant_gone(const ChunkKey& key) const;

 private:
  struct Fade {
    bool is_coming = true;
    std::optional<double> begin;  // nullopt before the first advance()
    float share = 0;              // of the time that has passed
  };
  const Fade* find(const ChunkKey& key) const;

  std::map<ChunkKey, Fade> fades_;
};

}  // namespace runstone
