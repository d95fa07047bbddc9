// ViewCamera: a camera that looks at the middle of a block of chunks, and that the mouse turns around
// it.
#pragma once
#include <array>
#include <span>

#include "client/input/input_event.hpp"
#include "client/render/renderer.hpp"

namespace runstone::bench {

class ViewCamera {
 public:
  /// `size` is that of the block in voxels, which begins at 0 0 0. Angles are in degrees.
  ViewCamera(const std::array<int, 3>& size, double turn, double pitch);

  Camera camera() const;
  /// Turns the camera while the left button is held, and moves it by the wheel. Returns true if it
  /// moved.
  bool feed(std::span<const InputEvent> events);

 private:
  std::array<int, 3> size_;
  double turn_, pitch_;  // radians
  double distance_ = 1;  // as a factor of the one at which all is in view
  bool is_held_ = false;
};

}  // namespace runstone::bench
