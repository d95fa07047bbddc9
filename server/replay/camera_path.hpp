// CameraPath: the position of a timelapse's camera at each moment, from a text file with one
// station on each line:
//   WHEN X Y Z YAW PITCH      # WHEN is a sequence number, or a percentage of the timelapse: 25%
// X Y Z is the eye in voxels. Angles are degrees as in the client's scripts: yaw 0 looks along +z
// and grows towards +x, pitch is positive upward. Between two stations everything changes linearly
// with the sequence number, the yaw the shorter way. Before the first station and after the last
// the camera stands still.
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

  /// Parses a path. 0% is `first` and 100% is `last`; `file` is only for messages. Fails if the
  /// stations do not ascend strictly, or if there is none.
  static Result<CameraPath, TextError> parse(std::string_view text, std::string_view file,
                                             Sequence first, Sequence last);

  /// Returns eye and angles at this moment, with the default field of view and distances. Cost:
  /// O(log stations).
  DrawCamera at(Sequence seq) const;

 private:
  struct Station {
    double when = 0;  // sequence number; a percentage may give a fraction
    DrawCamera camera;
  };
  std::vector<Station> stations_;
};

}  // namespace runstone
