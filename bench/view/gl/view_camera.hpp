// ViewCamera: a camera that looks at the middle of a block of chunks, and that the mouse turns
// around it.
#pragma once
#include <array>
#include <span>

#include "client/input/input_event.hpp"
#include "client/render/renderer.hpp"

namespace runstone::bench {

class ViewCamera {
 public:
  /// Looks at the middle of the box from `low` to `high`, in voxels. Angles are in degrees.
  ViewCamera(const std::array<int, 3>& low, const std::array<int, 3>& high, double turn,
             double pitch);

  Camera camera() const;
  /// Turns the camera while the left button is held, and moves it by the wheel. Returns true if it
  /// moved.
  bool feed(std::span<const InputEvent> events);

 private:
  std::array<double, 3> middle_{};
  double radius_;        // of the box, voxels
  double turn_, pitch_;  // radians
  double distance_ = 1;  // as a factor of the one at which all is in view
  bool is_held_ = false;
};

}  // namespace runstone::bench
