// Timelapse: a world as it grew, a picture every so many edits, replayed from base and log. Pictures are drawn by a
// child (draw_child.hpp), which gets the stage once and after that only the chunks that changed.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/generate/generator.hpp"
#include "server/replay/timelapse_options.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct TimelapseReport {
  Sequence first = 0, last = 0;  // of the first frame and the last
  std::uint64_t frames = 0;
  std::size_t chunks = 0;         // on the stage
  std::uint64_t chunks_sent = 0;  // to be drawn: once each, and again when it changed
  double seconds = 0;             // in all, without the video
  double draw_seconds = 0;        // of them, meshing, drawing and writing pictures
  std::string renderer;
};

inline constexpr std::uint64_t kTimelapseFramesMax = 999'999;

/// "frame-000001.png" and so on.
std::string frame_name(std::uint64_t number);

/// Draws the frames into options.folder, which is made if it does not exist, and must hold none yet. The first shows
/// the world after options.from, the last the one after min(at, last edit), the others each `every` edits more.
/// `progress` is called after each frame, with the frames done and all of them. Errors are one line of text. Blocks
/// on the disk and on the child.
Result<TimelapseReport, std::string> make_timelapse(
    WorldReader& reader, const Generator& generator, const TimelapseOptions& options, Sequence at,
    const std::function<void(std::uint64_t, std::uint64_t)>& progress);

}  // namespace runstone
