// TimelapseOptions: what the command line of runstone-replay says about a timelapse.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/ids.hpp"
#include "protocol/codec/draw_order.hpp"

namespace CLI {
class App;
}

namespace runstone {

struct TimelapseOptions {
  std::string folder;  // for the frames; empty: no timelapse
  std::optional<Sequence>
      from;            // the first frame shows the world after this edit; nothing: before the first
  Sequence every = 0;  // edits a frame; 0: as many as make some 300 frames
  PictureSize size;
  std::string camera;        // file (camera_path.hpp); empty: an oblique view of all that is edited
  std::uint32_t radius = 3;  // chunks of untouched world around what is edited, 0 .. 32
  std::uint32_t fps = 30;    // frames a second of the video, 1 .. 120
  std::string client;        // as DrawChildOptions::program
};

/// Adds the options to a command line; they are checked when it is parsed. `out` must live until then.
void add_timelapse_options(CLI::App& app, TimelapseOptions& out);

}  // namespace runstone
