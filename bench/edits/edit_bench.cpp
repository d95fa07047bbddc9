#include "bench/edits/edit_bench.hpp"

#include <fmt/ostream.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "bench/edits/replay_case.hpp"
#include "bench/edits/rights_case.hpp"
#include "bench/edits/stack_case.hpp"
#include "bench/edits/strand_case.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/harness/target_json.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::bench {
namespace {

EditRow row_of(std::string what, std::size_t chunks, std::size_t edits,
               const std::vector<double>& us) {
  return {std::move(what), chunks, edits, median(us), quantile(us, 0.9)};
}

Target at_most(std::string what, double us, double bar_us) {
  return {std::move(what), fmt::format("{:.0f} µs", bar_us), fmt::format("{:.1f} µs", us),
          us <= bar_us ? Verdict::met : Verdict::missed};
}
Target at_least(std::string what, double rate, double target) {
  return {std::move(what), fmt::format("{:.0f}/s", target), fmt::format("{:.0f}/s", rate),
          rate >= target ? Verdict::met : Verdict::missed};
}

void measure_stacks(EditBenchResult& result, unsigned repetitions) {
  const Chunk ground = terrain_chunk({0, 0, 0});
  for (const EditMix mix : {EditMix::by_hand, EditMix::by_brush}) {
    const std::string name = mix == EditMix::by_hand ? "by hand" : "by brush";
    for (const std::size_t edits : {1U, 10U, 100U, 1'000U}) {
      const StackTiming timing = time_stack(ground, mixed_edits(mix, edits, edits), repetitions);
      result.rows.push_back(
          row_of(fmt::format("mixed edits {} as a stack", name), 1, edits, timing.stacked_us));
      result.rows.push_back(
          row_of(fmt::format("mixed edits {} one by one", name), 1, edits, timing.one_by_one_us));
      if (edits != 1'000) continue;
      const double stacked = median(timing.stacked_us);
      result.targets.push_back(without_target(
          fmt::format("1,000 mixed edits {} on one chunk of terrain as a stack", name),
          fmt::format("{:.1f} µs, {:.1f}x as fast as one by one", stacked,
                      median(timing.one_by_one_us) / stacked)));
    }
  }
}

void measure_spreads(EditBenchResult& result, unsigned repetitions) {
  const VoxelPos ground = {40, 0, 40};
  const EditDescriptor dig{FillSphere{ground, 50}, {}, kEmpty};
  const EditDescriptor fill{FillSphere{ground, 50}, {MaskKind::only_empty, kEmpty}, 4};
  const EditDescriptor path{FillStroke{{{0, 2, 0}, {60, 6, 20}, {90, 2, 80}}, 3}, {}, 6};
  const EditDescriptor tunnel{FillStroke{{{0, -20, 0}, {120, -10, 90}}, 8}, {}, kEmpty};
  const auto measure = [&](const char* what, const EditDescriptor& edit) {
    const SpreadTiming timing = time_spread(edit, repetitions);
    result.rows.push_back(row_of(what, timing.chunks, 1, timing.us));
    return timing;
  };
  const SpreadTiming sphere = measure("sphere of radius 50 emptied", dig);
  result.targets.push_back(
      at_most(fmt::format("sphere of radius 50 over terrain, {} chunks: apply", sphere.chunks),
              median(sphere.us), 1'000));
  measure("sphere of radius 50 filled where empty", fill);
  measure("stroke of radius 3 over 150 voxels", path);
  measure("stroke of radius 8 over 150 voxels emptied", tunnel);
}

void measure_rights(EditBenchResult& result, unsigned repetitions) {
  constexpr std::size_t kBoxes = 10'000, kDecisions = 1'000;
  for (const Ground ground : {Ground::spread, Ground::nested}) {
    const char* name = ground == Ground::spread ? "boxes apart" : "boxes and large regions";
    const std::vector<double> us = time_rights(ground, kBoxes, kDecisions, repetitions);
    result.rows.push_back(
        row_of(fmt::format("rights of a voxel among 10000 {}", name), 1, kDecisions, us));
    const double each_us = median(us) / kDecisions;
    Target target =
        without_target(fmt::format("rights of a single voxel, 10,000 protected {}", name),
                       fmt::format("{:.2f} µs", each_us));
    if (ground == Ground::spread) {
      target.wanted = "1 µs";
      target.verdict = each_us <= 1 ? Verdict::met : Verdict::missed;
    }
    result.targets.push_back(std::move(target));
  }
}

void measure_strand(EditBenchResult& result, unsigned repetitions) {
  constexpr double kShareMax = 1.05;
  StrandTiming timing = time_strand(repetitions);
  for (std::vector<double>* samples : {&timing.near_us, &timing.far_us}) {
    for (double& us : *samples) us *= kStrandEdits;
  }
  result.rows.push_back(
      row_of("edits of 20 players on the world strand", 1, kStrandEdits, timing.near_us));
  result.rows.push_back(
      row_of(fmt::format("edits of 20 players who see {} levels of tiles on the world strand",
                         kStrandLevels),
             1, kStrandEdits, timing.far_us));
  const double share = median(timing.far_us) / median(timing.near_us);
  result.targets.push_back({"an edit on the world strand with tiles, against without",
                            fmt::format("at most {:.2f}x", kShareMax),
                            fmt::format("{:.2f}x", share),
                            share <= kShareMax ? Verdict::met : Verdict::missed});
}

Result<void, std::string> measure_replay(EditBenchResult& result, std::size_t edits,
                                         unsigned repetitions) {
  const test::TempFolder folder;
  const auto timing = time_replay(edits, repetitions, folder.path());
  if (!timing) return failure(timing.error());
  const auto row = [&](const char* what, const std::vector<double>& rates) {
    std::vector<double> us;
    for (const double rate : rates) us.push_back(static_cast<double>(edits) / rate * 1e6);
    result.rows.push_back(row_of(what, timing->chunks, edits, us));
  };
  row("replay of single voxels: log read and verified and applied and digests compared",
      timing->from_log);
  row("single voxels one after another: applied", timing->apply);
  row("single voxels one after another: applied and dirty layers meshed", timing->remesh);
  result.targets.push_back(at_least("replay of single voxels from the log, edge 32, all of it",
                                    median(timing->from_log), 500'000));
  result.targets.push_back(
      at_least("the same from memory, apply only", median(timing->apply), 500'000));
  result.targets.push_back(at_least("the same with remeshing of dirty layers after each edit",
                                    median(timing->remesh), 100'000));
  return {};
}

}  // namespace

Result<EditBenchResult, std::string> run_edit_bench(const BenchOptions& options,
                                                    std::ostream& progress) {
  EditBenchResult result;
  result.machine = this_machine();
  measure_stacks(result, options.repetitions);
  fmt::print(progress, "stacks\n");
  measure_spreads(result, options.repetitions);
  fmt::print(progress, "spheres and strokes\n");
  measure_rights(result, options.repetitions);
  fmt::print(progress, "rights\n");
  measure_strand(result, std::max(3U, options.repetitions / 3));
  fmt::print(progress, "world strand\n");
  progress.flush();
  const unsigned replays = std::max(1U, options.repetitions / 10);
  const auto replayed = measure_replay(result, options.edits, replays);
  if (!replayed) return failure(replayed.error());
  fmt::print(progress, "replay\n");
  return result;
}

void write_table(const EditBenchResult& result, std::ostream& out) {
  fmt::print(
      out,
      "\n| case | chunks | edits | median µs | p90 | µs an edit |\n|---|---|---|---|---|---|\n");
  for (const EditRow& row : result.rows) {
    fmt::print(out, "| {} | {} | {} | {:.2f} | {:.2f} | {:.3f} |\n", row.what, row.chunks,
               row.edits, row.median_us, row.p90_us,
               row.median_us / static_cast<double>(row.edits));
  }
  fmt::print(out, "\n");
  write_targets(result.targets, out);
}

void write_csv(const EditBenchResult& result, std::ostream& out) {
  fmt::print(out, "case,chunks,edits,median_us,p90_us\n");
  for (const EditRow& row : result.rows) {
    fmt::print(out, "{},{},{},{:.3f},{:.3f}\n", row.what, row.chunks, row.edits, row.median_us,
               row.p90_us);
  }
}

void write_json(const EditBenchResult& result, std::ostream& out) {
  nlohmann::ordered_json json = {{"commit", result.machine.commit},
                                 {"cpu", result.machine.cpu},
                                 {"compiler", result.machine.compiler},
                                 {"rows", nlohmann::ordered_json::array()},
                                 {"bars", json_of(result.targets)}};
  for (const EditRow& row : result.rows) {
    json["rows"].push_back({{"case", row.what},
                            {"chunks", row.chunks},
                            {"edits", row.edits},
                            {"median_us", row.median_us},
                            {"p90_us", row.p90_us}});
  }
  out << json.dump(1) << '\n';
}

}  // namespace runstone::bench
