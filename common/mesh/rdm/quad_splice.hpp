// QuadSplice: replaces stretches of quads in a QuadLayers, in place. Internal to rdm.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/mesh/chunk_mesh.hpp"
#include "common/mesh/quad.hpp"

namespace runstone::rdm {

class QuadSplice {
 public:
  /// Some quads of one layer, which others replace.
  struct Stretch {
    std::size_t layer = 0;             // in QuadLayers::first
    std::uint32_t begin = 0, end = 0;  // in QuadLayers::quads
    const Quad* quads = nullptr;       // the new ones
    std::uint32_t count = 0;
  };

  void clear() { stretches_.clear(); }
  /// Adds a stretch. Requires ascending layers, and quads that stay in place until apply().
  void add(const Stretch& stretch) { stretches_.push_back(stretch); }

  /// Replaces all stretches. Quads between two stretches move only if the stretches before them
  /// changed the number of quads. Cost: O(new quads + quads that move + layers).
  void apply(QuadLayers& out);

 private:
  std::vector<Stretch> stretches_;
  std::vector<std::ptrdiff_t> shift_;  // scratch: of the quads behind each stretch
};

}  // namespace runstone::rdm
