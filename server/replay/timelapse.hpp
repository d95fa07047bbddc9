// Timelapse: draws a world as it grew, one picture every so many edits, replayed from base and log.
// A child process draws the pictures (draw_child.hpp). It gets all chunks that are drawn once, and
// after that only the chunks that changed.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/generate/generator.hpp"
#include "protocol/codec/draw_order.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

struct TimelapseOptions {
  std::string folder;            // for the frames
  std::optional<Sequence> from;  // last edit of the first frame; nullopt: before the first edit
  Sequence every = 0;            // edits a frame; 0: as many as make about 300 frames
  PictureSize size;
  std::string camera;        // file (camera_path.hpp); empty: an oblique view of all edits
  std::uint64_t radius = 3;  // chunks of untouched world around the edits, 0..32
  std::string client;        // see DrawChildOptions::program
};

struct TimelapseReport {
  Sequence first = 0, last = 0;  // moments of the first and the last frame
  std::uint64_t frames = 0;
  std::size_t chunks = 0;         // drawn
  std::uint64_t chunks_sent = 0;  // to the child: each chunk once, and again after each change
  double seconds = 0;             // without the video
  double draw_seconds = 0;        // the part of it for meshing, drawing and writing pictures
  std::string renderer;
};

inline constexpr std::uint64_t kTimelapseFramesMax = 999'999;

/// Returns the file name of a frame: "frame-000001.png" for 1.
std::string frame_name(std::uint64_t number);

/// Draws the frames into options.folder, which is made if it does not exist and must hold no
/// frames. The first frame shows the world after options.from, the last frame the world after
/// min(at, last edit); between two frames lie `every` edits. Calls `progress` after each frame with
/// the number of frames done and their total. Errors are one line of text. Blocks on the disk and
/// on the child.
Result<TimelapseReport, std::string> make_timelapse(
    WorldReader& reader, const Generator& generator, const TimelapseOptions& options, Sequence at,
    const std::function<void(std::uint64_t, std::uint64_t)>& progress);

}  // namespace runstone
