#include "server/replay/replay_commands.hpp"

#include <chrono>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "common/core/hex.hpp"
#include "common/os/progress_line.hpp"
#include "common/os/steady_clock.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/digest_list.hpp"
#include "server/replay/replayer.hpp"
#include "server/replay/subcommand.hpp"
#include "server/replay/tile_check.hpp"
#include "server/store/removed_history.hpp"

namespace runstone {
namespace {

double rate_of(const ReplayReport& report, double seconds) {
  return seconds > 0 ? static_cast<double>(report.edits) / seconds : 0;
}

/// The replay and, unless it is quick, the comparison of the tiles.
struct VerifyReport {
  ReplayReport replay;
  std::optional<TileReport> tiles;
  std::uint64_t differences() const {
    return replay.differences + (tiles ? tiles->differences : 0);
  }
  /// Returns an empty text if there is none.
  std::string first_difference() const {
    if (replay.first) return replay.first->message();
    return tiles ? tiles->first : "";
  }
};

/// Returns the text of the row "result". It is "equal" only if everything agrees and no edit is
/// lost, so that a script may look for this word.
std::string result_text(std::uint64_t differences, bool has_loss) {
  const std::string count = std::to_string(differences) + " differences";
  if (has_loss)
    return "incomplete: " + count + " in what is left; the row LOST says what is missing";
  return differences == 0 ? "equal" : count;
}

void print_table(std::ostream& out, const Store& store, const VerifyReport& whole,
                 const LogEnd& head, double seconds) {
  const ReplayReport& report = whole.replay;
  const WorldMeta& meta = store.meta();
  out << std::fixed;
  print_world(out, store);
  row(out, "base") << meta.generator.name << " version " << meta.generator.version << ", seed "
                   << meta.generator.seed << '\n';
  if (head.version.seq > 0) row(out, "history") << removed_up_to(head) << '\n';
  row(out, "edits") << report.edits << ", up to sequence " << report.seq << '\n';
  row(out, "chunks") << report.digests.size() << " edited\n";
  row(out, "voxels") << report.voxels_changed << " changed\n";
  row(out, "stacks") << report.stack_depths.text() << " (depth:count)\n";
  row(out, "snapshots") << report.snapshots_compared << " compared\n";
  row(out, "keyframes") << report.keyframes_compared << " chunks compared\n";
  if (whole.tiles) {
    row(out, "tiles") << whole.tiles->compared << " compared, " << whole.tiles->not_compared
                      << " left out, because edits below them are in no snapshot\n";
  }
  row(out, "lists") << report.listed_compared << " chunks compared\n";
  row(out, "left out") << report.not_compared
                       << " newer than the end, or of another level of detail\n";
  if (whole.tiles) {
    row(out, "rows") << (whole.tiles->differences == 0
                             ? "all read and sound\n"
                             : "all read; rows of tiles may not be sound, see the differences\n");
  }
  row(out, "time") << std::setprecision(3) << seconds << " s, " << std::setprecision(0)
                   << rate_of(report, seconds) << " edits/s\n";
  row(out, "digest") << to_hex(report.world_digest) << '\n';
  row(out, "result") << result_text(whole.differences(), store.loss().has_value()) << '\n';
  if (whole.differences() != 0) row(out, "first") << whole.first_difference() << '\n';
}

/// Returns a digest list with one more member, "report".
std::string report_json(const Store& store, const VerifyReport& whole, double seconds) {
  const ReplayReport& report = whole.replay;
  const DigestList list{store.meta().world_id, report.seq, report.digests};
  nlohmann::ordered_json more = {
      {"edits", report.edits},
      {"chunks", report.digests.size()},
      {"voxels_changed", report.voxels_changed},
      {"stack_depths", report.stack_depths.text()},
      {"snapshots_compared", report.snapshots_compared},
      {"keyframes_compared", report.keyframes_compared},
      {"listed_compared", report.listed_compared},
      {"not_compared", report.not_compared},
      {"tiles_compared", whole.tiles ? whole.tiles->compared : 0},
      {"tiles_not_compared", whole.tiles ? whole.tiles->not_compared : 0},
      {"differences", whole.differences()},
      {"first_difference", whole.first_difference()},
      {"lost", store.loss() ? store.loss()->message() : ""},
      {"world_digest", to_hex(report.world_digest)},
      {"seconds", seconds},
      {"edits_per_second", rate_of(report, seconds)}};
  std::string json = to_json(list);
  json.resize(json.rfind('}'));  // removes the end of the object, so that a member can follow
  return json + ",\n\"report\":" + more.dump() + "}";
}

/// Passes the lists to the replayer, and also the keyframes unless the replay is quick.
Result<void, std::string> expect_all(Replayer& replayer, Store& store,
                                     const VerifyOptions& options) {
  for (const std::string& file : options.against) {
    const auto list = read_digests_json(file);
    if (!list) return failure(list.error().message());
    if (list->world_id != store.meta().world_id) return failure(file + ": is about another world");
    replayer.expect(file, *list);
  }
  if (options.quick) return {};
  if (const auto checked = store.check(); !checked) return failure(checked.error().message());
  return {};
}

/// Replays the log at one moment of the world: retention of a running server moves edits from the
/// log into the base.
StoreResult<ReplayReport> replay_at_one_moment(Replayer& replayer, Store& store,
                                               const VerifyOptions& options, Sequence end) {
  if (const auto begun = store.begin_reads(); !begun) return failure(begun.error());
  if (!options.quick) {
    const auto keyframes = store.keyframe_chunks();
    if (!keyframes) return failure(keyframes.error());
    replayer.expect_keyframes(*keyframes);
  }
  ProgressLine line("edits replayed", options.common.progress);
  auto replayed = replayer.run(end, [&](Sequence done, Sequence last) { line.show(done, last); });
  if (const auto ended = store.end_reads(); !ended && replayed) return failure(ended.error());
  return replayed;
}

}  // namespace

void declare_verify(SubcommandOptions& command_line, VerifyOptions& options) {
  command_line.common(options.common, "folder of the world; a server may be running it");
  command_line.moment("--at", options.at, "end of the replay");
  command_line.texts("--against", options.against,
                     "compare with these digest lists of servers, clients or replays");
  command_line.flag(
      "--quick", options.quick,
      "do not read and check every row of every table, nor compare keyframes and tiles");
}

Result<int, std::string> run_verify(const VerifyOptions& options, std::ostream& out) {
  const auto world = open_for_reading(options.common.world, options.at);
  if (!world) return failure(world.error());
  Store& store = *world->store;
  Replayer replayer(store, *world->generator);
  if (const auto expected = expect_all(replayer, store, options); !expected) {
    return failure(expected.error());
  }
  const auto start = std::chrono::steady_clock::now();
  StoreResult<ReplayReport> replayed = replay_at_one_moment(replayer, store, options, world->end);
  const double seconds = seconds_since(start);
  if (!replayed) return failure(replayed.error().message());
  VerifyReport report{*std::move(replayed), std::nullopt};
  if (!options.quick) {
    ProgressLine line("tiles compared", options.common.progress);
    auto tiles =
        check_tiles(options.common.world, store, *world->generator,
                    [&](std::uint64_t done, std::uint64_t last) { line.show(done, last); });
    if (!tiles) return failure(tiles.error().message());
    report.tiles = *std::move(tiles);
  }
  const auto head = store.log_head();
  if (!head) return failure(head.error().message());
  print_table(out, store, report, *head, seconds);
  const auto written = write_report(options.common.json, report_json(store, report, seconds));
  if (!written) return failure(written.error());
  return report.differences() == 0 && !store.loss() ? kReplayEqual : kReplayDifferent;
}

}  // namespace runstone
