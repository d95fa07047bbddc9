#include "server/replay/replay_program.hpp"

#include <chrono>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "common/core/hex.hpp"
#include "common/os/progress_line.hpp"
#include "common/os/steady_clock.hpp"
#include "server/replay/digest_list.hpp"
#include "server/replay/keyframes_program.hpp"
#include "server/replay/moments_program.hpp"
#include "server/replay/play_into.hpp"
#include "server/replay/replay.hpp"
#include "server/replay/replay_bench.hpp"
#include "server/replay/replay_options.hpp"
#include "server/replay/rlog_file.hpp"
#include "server/replay/timelapse_program.hpp"
#include "server/store/store.hpp"

namespace runstone {

namespace {

double rate_of(const ReplayReport& report, double seconds) {
  return seconds > 0 ? static_cast<double>(report.edits) / seconds : 0;
}

std::ostream& row(std::ostream& out, const char* name) {
  return out << std::left << std::setw(12) << name << std::right;
}

void print_table(std::ostream& out, const WorldInfo& store, const ReplayReport& report,
                 double seconds, bool verified) {
  const WorldMeta& meta = store.meta();
  out << std::fixed;
  row(out, "world") << to_hex(meta.world_id) << "  " << store.file() << '\n';
  row(out, "base") << meta.generator.name << " version " << meta.generator.version << ", seed "
                   << meta.generator.seed << '\n';
  row(out, "edits") << report.edits << ", up to sequence " << report.seq << '\n';
  row(out, "chunks") << report.digests.size() << " edited\n";
  row(out, "voxels") << report.voxels_changed << " changed\n";
  row(out, "stacks") << report.stack_depths.text() << " (depth:count)\n";
  row(out, "snapshots") << report.snapshots_compared << " compared\n";
  row(out, "keyframes") << report.keyframes_compared << " chunks compared\n";
  row(out, "lists") << report.listed_compared << " chunks compared\n";
  row(out, "left out") << report.not_compared
                       << " newer than the end, or of another level of detail\n";
  if (verified) row(out, "rows") << "all read and sound\n";
  row(out, "time") << std::setprecision(3) << seconds << " s, " << std::setprecision(0)
                   << rate_of(report, seconds) << " edits/s\n";
  row(out, "digest") << to_hex(report.world_digest) << '\n';
  row(out, "result") << (report.differences == 0
                             ? "equal"
                             : std::to_string(report.differences) + " differences")
                     << '\n';
  if (report.first) row(out, "first") << report.first->message() << '\n';
}

/// A digest list that also says what the replay found.
std::string report_json(const WorldInfo& store, const ReplayReport& report, double seconds) {
  const DigestList list{store.meta().world_id, report.seq, report.digests};
  nlohmann::ordered_json more = {{"edits", report.edits},
                                 {"chunks", report.digests.size()},
                                 {"voxels_changed", report.voxels_changed},
                                 {"stack_depths", report.stack_depths.text()},
                                 {"snapshots_compared", report.snapshots_compared},
                                 {"keyframes_compared", report.keyframes_compared},
                                 {"listed_compared", report.listed_compared},
                                 {"not_compared", report.not_compared},
                                 {"differences", report.differences},
                                 {"first_difference", report.first ? report.first->message() : ""},
                                 {"world_digest", to_hex(report.world_digest)},
                                 {"seconds", seconds},
                                 {"edits_per_second", rate_of(report, seconds)}};
  std::string json = to_json(list);
  json.resize(json.rfind('}'));  // opened again for one more member
  return json + ",\n\"report\":" + more.dump() + "}\n";
}

int cannot_read(std::ostream& err, const std::string& message) {
  err << "runstone-replay: " << message << '\n';
  return static_cast<int>(ReplayExit::cannot_read);
}

/// The report of a mode that compares nothing. The exit code.
int write_report(const ReplayOptions& options, std::ostream& err,
                 const nlohmann::ordered_json& json) {
  if (options.json.empty()) return static_cast<int>(ReplayExit::equal);
  const auto written = write_text_file(options.json, json.dump(1) + "\n");
  return written ? static_cast<int>(ReplayExit::equal)
                 : cannot_read(err, written.error().message());
}

int export_log(const ReplayOptions& options, std::ostream& out, std::ostream& err) {
  auto store = open_world(options.world, StoreAccess::read_only);
  if (!store) return cannot_read(err, store.error().message());
  const auto done = export_rlog(**store, options.export_to, options.at);
  if (!done) return cannot_read(err, done.error());
  row(out, "world") << to_hex((*store)->meta().world_id) << "  " << (*store)->file() << '\n';
  row(out, "edits") << done->edits << ", sequences " << done->first << " to " << done->last << '\n';
  row(out, "written") << options.export_to << ", " << done->bytes << " bytes\n";
  return write_report(options, err,
                      {{"edits", done->edits},
                       {"first", done->first},
                       {"last", done->last},
                       {"bytes", done->bytes}});
}

int import_log(const ReplayOptions& options, std::ostream& out, std::ostream& err) {
  const auto done = import_rlog(options.world, options.import_from);
  if (!done) return cannot_read(err, done.error());
  row(out, "world") << options.world << (done->made_world ? ", made\n" : "\n");
  row(out, "edits") << done->added << " added, " << done->known << " known, " << done->compacted
                    << " compacted\n";
  row(out, "log") << "ends with sequence " << done->last << '\n';
  const int written = write_report(options, err,
                                   {{"made_world", done->made_world},
                                    {"added", done->added},
                                    {"known", done->known},
                                    {"compacted", done->compacted},
                                    {"last", done->last},
                                    {"stopped", done->stopped}});
  if (done->stopped.empty()) return written;
  return cannot_read(err, done->stopped);
}

int run(const ReplayOptions& options, std::ostream& out, std::ostream& err) {
  auto opened = open_world(options.world, StoreAccess::read_only);
  if (!opened) return cannot_read(err, opened.error().message());
  WorldReader& store = **opened;
  const WorldMeta& meta = store.meta();
  const auto generator = make_generator(meta.generator, meta.materials);
  if (!generator) {
    return cannot_read(err, store.file() + ": this program cannot make the base of generator " +
                                meta.generator.name + " version " +
                                std::to_string(meta.generator.version) + ": " +
                                generator.error().what);
  }
  Replayer replayer(store, **generator);
  for (const std::string& file : options.against) {
    const auto list = read_digests_json(file);
    if (!list) return cannot_read(err, list.error().message());
    if (list->world_id != meta.world_id) return cannot_read(err, file + ": is about another world");
    replayer.expect(file, *list);
  }
  if (options.verify) {
    if (const auto checked = store.check(); !checked)
      return cannot_read(err, checked.error().message());
    const auto kept = store.keyframe_chunks();
    if (!kept) return cannot_read(err, kept.error().message());
    replayer.expect_keyframes(*kept);
  }

  const auto start = std::chrono::steady_clock::now();
  StoreResult<ReplayReport> report = [&] {
    ProgressLine line("edits replayed", options.progress);
    return replayer.run(options.at, [&](Sequence done, Sequence last) { line.show(done, last); });
  }();
  const double seconds = seconds_since(start);
  if (!report) return cannot_read(err, report.error().message());
  print_table(out, store, *report, seconds, options.verify);
  if (!options.json.empty()) {
    const auto written = write_text_file(options.json, report_json(store, *report, seconds));
    if (!written) return cannot_read(err, written.error().message());
  }
  return static_cast<int>(report->differences == 0 ? ReplayExit::equal : ReplayExit::different);
}

}  // namespace

int replay_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  auto [parsed, exit_code] = parse_replay_options(argc, argv, out, err);
  if (!parsed) return exit_code;
  ReplayOptions& options = *parsed;
  if (options.moment) {
    const auto store = open_world(options.world, StoreAccess::read_only);
    if (!store) return cannot_read(err, store.error().message());
    const auto at = sequence_of(**store, *options.moment);
    if (!at) return cannot_read(err, at.error().message());
    options.at = *at;
  }
  const auto exit_of = [&](const Result<void, std::string>& done) {
    return done ? static_cast<int>(ReplayExit::equal) : cannot_read(err, done.error());
  };
  if (!options.export_to.empty()) return export_log(options, out, err);
  if (!options.import_from.empty()) return import_log(options, out, err);
  if (options.bench) return exit_of(bench_replay(options, out));
  if (!options.into.empty()) {
    const auto code = play_into(options);
    return code ? *code : cannot_read(err, code.error());
  }
  if (options.keyframes) return exit_of(make_keyframes(options, out));
  if (!options.write_to.empty()) return exit_of(write_moment(options, out));
  if (options.diff) return exit_of(diff_moments(options, out));
  if (!options.timelapse.folder.empty()) return exit_of(timelapse_program(options, out));
  return run(options, out, err);
}

}  // namespace runstone
