#include "server/replay/timelapse_program.hpp"

#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>

#include "common/core/hex.hpp"
#include "common/os/progress_line.hpp"
#include "server/replay/digest_list.hpp"
#include "server/replay/timelapse.hpp"
#include "server/replay/video.hpp"
#include "server/store/world_folder.hpp"

namespace runstone {
namespace {

std::ostream& row(std::ostream& out, const char* name) {
  return out << std::left << std::setw(12) << name << std::right;
}

std::string report_json(const WorldInfo& store, const TimelapseReport& report, bool has_video) {
  const nlohmann::ordered_json json = {{"world_id", to_hex(store.meta().world_id)},
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
  return json.dump(2) + "\n";
}

}  // namespace

Result<void, std::string> timelapse_program(const ReplayOptions& options, std::ostream& out) {
  const auto failure = [](std::string why) { return Unexpected<std::string>{std::move(why)}; };
  const auto store = open_world(options.world, StoreAccess::read_only);
  if (!store) return failure(store.error().message());
  const auto generator = generator_of(**store);
  if (!generator) return failure(generator.error());
  const TimelapseOptions& wanted = options.timelapse;
  const auto report = [&] {
    ProgressLine line("frames drawn", options.progress);
    return make_timelapse(**store, **generator, wanted, options.at,
                          [&](std::uint64_t done, std::uint64_t all) { line.show(done, all); });
  }();
  if (!report) return failure(report.error());
  out << std::fixed << std::setprecision(1);
  row(out, "world") << to_hex((*store)->meta().world_id) << "  " << (*store)->file() << '\n';
  row(out, "frames") << report->frames << ", sequences " << report->first << " to " << report->last
                     << '\n';
  row(out, "chunks") << report->chunks << " on the stage, sent " << report->chunks_sent
                     << " times\n";
  row(out, "drawn by") << report->renderer << ", " << report->draw_seconds << " s\n";
  row(out, "time") << report->seconds << " s\n";
  const auto video = make_video(wanted.folder, wanted.fps);
  if (video) {
    row(out, "video") << wanted.folder << "/timelapse.mp4\n";
  } else {
    row(out, "video") << "none: " << video.error() << ". By hand, in " << wanted.folder << ":\n"
                      << video_command(wanted.fps) << '\n';
  }
  if (options.json.empty()) return {};
  const auto written =
      write_text_file(options.json, report_json(**store, *report, video.has_value()));
  if (!written) return failure(written.error().message());
  return {};
}

}  // namespace runstone
