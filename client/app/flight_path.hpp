// FlightPath: the path of a camera through a world, for measurements. A line of the file is a
// place: `X Y Z YAW PITCH FRAMES`, in voxels and degrees as in scripts; FRAMES is the number of
// frames from the place before to this one. `#` starts a comment. Between two places the camera
// moves and turns evenly. Pure.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class FlightPath {
 public:
  struct Place {
    WorldPos at;
    double yaw = 0, pitch = 0;  // radians
  };

  /// Returns the number of frames.
  std::uint32_t frames() const { return frames_; }
  /// Returns the place of a frame, 0 .. frames() - 1.
  Place place(std::uint32_t frame) const;

  /// Fails with the first wrong line, and if there are fewer than two places.
  static Result<FlightPath, TextError> parse(std::string_view text, std::string_view file);

 private:
  struct Stop {
    Place place;
    std::uint32_t frame = 0;  // at which the camera is there
  };
  std::vector<Stop> stops_;
  std::uint32_t frames_ = 0;
};

}  // namespace runstone
