#include "server/replay/replay_commands.hpp"

#include <charconv>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string_view>

#include "common/core/hex.hpp"
#include "common/os/progress_line.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/subcommand.hpp"
#include "server/replay/video.hpp"

namespace runstone {
namespace {

/// Parses one side of a frame. Returns false if the text is no number within the bounds.
bool parse_side(std::string_view text, std::uint16_t& out) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const auto [rest, error] = std::from_chars(begin, end, out);
  return error == std::errc{} && rest == end && out >= kDrawSideMin && out <= kDrawSideMax;
}

/// Parses "1280x720". Returns what is wrong with the text, or "".
std::string parse_size(std::string_view text, PictureSize& out) {
  const std::size_t cross = text.find('x');
  PictureSize size;
  if (cross == std::string_view::npos || !parse_side(text.substr(0, cross), size.width) ||
      !parse_side(text.substr(cross + 1), size.height)) {
    return "expected WIDTHxHEIGHT, 16 to 8192 each";
  }
  out = size;
  return {};
}

nlohmann::ordered_json report_json(const Store& store, const TimelapseReport& report,
                                   bool has_video) {
  return {{"world_id", to_hex(store.meta().world_id)},
          {"frames", report.frames},
          {"first_seq", report.first},
          {"last_seq", report.last},
          {"edits", report.last - report.first},
          {"chunks", report.chunks},
          {"chunks_sent", report.chunks_sent},
          {"renderer", report.renderer},
          {"seconds", report.seconds},
          {"draw_seconds", report.draw_seconds},
          {"video", has_video}};
}

}  // namespace

void declare_timelapse(SubcommandOptions& command_line, TimelapseCommandOptions& options) {
  TimelapseOptions& timelapse = options.timelapse;
  command_line.common(options.common, "folder of the world; a server may be running it");
  command_line.folder("FOLDER", timelapse.folder, "folder for the frames; it must hold none yet");
  command_line.parsed(
      "--from",
      [&timelapse](const std::string& text) -> std::string {
        Sequence from = 0;
        const char* const end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data(), end, from);
        if (error != std::errc{} || rest != end || from > kSequenceMax) {
          return "expected a sequence number";
        }
        timelapse.from = from;
        return {};
      },
      "sequence number of the edit that the first frame shows last; "
      "default: before the first edit");
  command_line.moment("--at", options.at, "moment of the last frame");
  command_line.number("--every", timelapse.every, 1, kSequenceMax,
                      "edits from one frame to the next; default: "
                      "so many that there are about 300 frames");
  command_line.parsed(
      "--size", [&timelapse](const std::string& text) { return parse_size(text, timelapse.size); },
      "WIDTHxHEIGHT of the frames; default 1280x720");
  command_line.existing_file("--camera", timelapse.camera,
                             "file with the camera's path; default: a view of all edits");
  command_line.number("--radius", timelapse.radius, 0, 32,
                      "chunks of untouched world around the edits; default 3");
  command_line.number("--fps", options.fps, 1, 120, "frames a second of the video; default 30");
  command_line.text("--client", timelapse.client,
                    "path of runstone-client; default: RUNSTONE_CLIENT, "
                    "or runstone-client beside this program");
}

Result<int, std::string> run_timelapse(const TimelapseCommandOptions& options, std::ostream& out) {
  const auto world = open_for_reading(options.common.world, options.at);
  if (!world) return failure(world.error());
  Store& store = *world->store;
  const auto report = [&] {
    ProgressLine line("frames drawn", options.common.progress);
    return make_timelapse(store, *world->generator, options.timelapse, world->end,
                          [&](std::uint64_t done, std::uint64_t all) { line.show(done, all); });
  }();
  if (!report) return failure(report.error());
  out << std::fixed << std::setprecision(1);
  print_world(out, store);
  row(out, "frames") << report->frames << ", sequences " << report->first << " to " << report->last
                     << '\n';
  row(out, "chunks") << report->chunks << " drawn, sent " << report->chunks_sent << " times\n";
  row(out, "drawn by") << report->renderer << ", " << report->draw_seconds << " s\n";
  row(out, "time") << report->seconds << " s\n";
  const std::string& folder = options.timelapse.folder;
  const auto fps = static_cast<std::uint32_t>(options.fps);
  const auto video = make_video(folder, fps);
  if (video) {
    row(out, "video") << folder << "/timelapse.mp4\n";
  } else {
    row(out, "video") << "none: " << video.error() << ". By hand, in " << folder << ":\n"
                      << video_command(fps) << '\n';
  }
  const auto written =
      write_report(options.common.json, report_json(store, *report, video.has_value()).dump(1));
  if (!written) return failure(written.error());
  return kReplayEqual;
}

}  // namespace runstone
