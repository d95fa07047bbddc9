// FrameLook: the light, the weather and the effort with which a frame is drawn.
#pragma once
#include <cstdint>

namespace runstone {

enum class Quality : std::uint8_t {
  low,     // no light of lamps, no dark rooms and corners, no shadows
  medium,  // all light, and shadows in half the resolution with hard edges
  high,    // all light, and shadows with soft edges
};

struct FrameLook {
  /// The time of day as a share of it: 0 is midnight, 0.25 sunrise, 0.5 noon, 0.75 sunset. Values
  /// outside 0 .. 1 wrap around.
  double time_of_day = 0.4;
  /// Seconds by which moving surfaces advance: water and the pulse of ghosts. Pictures with equal
  /// values are equal.
  double seconds = 0;
  Quality quality = Quality::high;
  /// The world is drawn with this share of the frame's width and height, and stretched. The user
  /// interface is not. 0 < scale <= 1.
  double scale = 1;
  /// True: a frame shows the light and shadows of exactly the present world. False: those of distant
  /// changes may be some frames old, so that no frame takes long. Pictures in files are exact.
  bool exact = true;
};

}  // namespace runstone
