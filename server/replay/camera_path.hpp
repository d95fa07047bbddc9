// CameraPath: where the camera of a timelapse is at each moment, from a text file. A line a station:
//   WHEN X Y Z YAW PITCH      # WHEN is a sequence number, or a share of the timelapse: 25%
// X Y Z is the eye in voxels; angles in degrees, as the client's scripts take them: yaw 0 looks along +z and
// grows towards +x, pitch is positive upward. Between two stations everything changes linearly with the
// sequence, yaw the short way round; before the first and after the last the camera stands still.
#pragma once
#include <cstddef>
#include <string_view>
#include <vector>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "protocol/codec/draw_order.hpp"

namespace runstone {

class CameraPath {
 public:
  static constexpr std::size_t kStationsMax = 10'000;

  /// `file` is only for messages. `first` and `last`: the sequences of which shares are shares. Stations must
  /// ascend strictly; there must be one at least.
  static Result<CameraPath, TextError> parse(std::string_view text, std::string_view file,
                                             Sequence first, Sequence last);

  /// Eye and angles at this moment; field of view and distances are the defaults. O(log stations).
  DrawCamera at(Sequence seq) const;

 private:
  struct Station {
    double when = 0;  // sequence, not whole where it was a share
    DrawCamera camera;
  };
  std::vector<Station> stations_;
};

}  // namespace runstone
