// FaceLayer: the exposed faces of one layer and direction as a picture of materials, which the meshers of
// polygons outline.
#pragma once
#include <cstddef>
#include <vector>

#include "common/mesh/reference/dense_grid.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone::reference {

class FaceLayer {
 public:
  /// Replaces the picture by that of one layer of `grid`, 0 .. side - 1 along the direction's axis; u and v are
  /// those of quads. Returns whether it has a face. O(faces of a full layer).
  bool read(const DenseGrid& grid, const VisibilityTable& visibility, Direction direction, unsigned layer);

  int width() const { return width_; }    // along u
  int height() const { return height_; }  // along v
  /// The material of a face; kEmpty where none is exposed. Requires -1 <= u <= width(), likewise v: nothing
  /// lies around the layer.
  Material at(int u, int v) const { return faces_[index(u, v)]; }
  /// Where at() finds it, for what else is kept of every face; up to index(width(), height()).
  std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(u + 1) +
           static_cast<std::size_t>(width_ + 2) * static_cast<std::size_t>(v + 1);
  }

 private:
  int width_ = 0, height_ = 0;
  std::vector<Material> faces_;
};

}  // namespace runstone::reference
