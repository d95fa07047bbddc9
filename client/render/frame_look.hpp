// FrameLook: the time of day, the effort, the edges and the resolution with which a frame is drawn.
#pragma once
#include <cstdint>

namespace runstone {

enum class Quality : std::uint8_t {
  low,     // no light of lamps, no dark rooms and corners, no shadows
  medium,  // all light, and shadows in half the resolution with hard edges
  high,    // all light, and shadows with soft edges
};

enum class Antialiasing : std::uint8_t {
  automatic,  // MSAA on a GPU at quality medium and high, otherwise off
  off,
  fxaa,  // the finished picture is smoothed along its edges
  msaa,  // several samples a pixel
};

struct FrameLook {
  /// The time of day as a share of a day: 0 is midnight, 0.25 sunrise, 0.5 noon, 0.75 sunset.
  /// Values outside 0 .. 1 wrap around.
  double time_of_day = 0.4;
  /// Seconds by which moving things advance: water, clouds and the pulse of ghosts. Pictures of the
  /// same view with equal values are equal.
  double seconds = 0;
  Quality quality = Quality::high;
  Antialiasing antialiasing = Antialiasing::off;
  /// The world is drawn with this share of the frame's width and height, and stretched. The user
  /// interface is not. 0 < scale <= 1.
  double scale = 1;
  /// True: light and shadows are exactly those of the present world. False: light and shadows of
  /// distant changes may be some frames old, so that no frame takes long. Screenshots are exact.
  bool exact = true;
};

}  // namespace runstone
