#include "bench/client/client_result.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/harness/machine_json.hpp"

namespace runstone::bench {
namespace {

constexpr double kBudgetMs = 8;
constexpr std::size_t kOwnFramesMax = 2;
constexpr double kEffectsMax = 1.6;

Verdict verdict_of(bool is_met) { return is_met ? Verdict::met : Verdict::missed; }

const EffectsRow* find(const std::vector<EffectsRow>& rows, const std::string& world,
                       const std::string& mesher, const std::string& quality) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const EffectsRow& row) {
    return row.world == world && row.mesher == mesher && row.quality == quality;
  });
  return found == rows.end() ? nullptr : &*found;
}

/// Returns the greatest ratio of the medians of two ways to draw, over the worlds that have both.
std::optional<double> worst_ratio(const std::vector<EffectsRow>& rows, const EffectsRow& above,
                                  const EffectsRow& below) {
  std::optional<double> out;
  for (const EffectsRow& row : rows) {
    const EffectsRow* const a = find(rows, row.world, above.mesher, above.quality);
    const EffectsRow* const b = find(rows, row.world, below.mesher, below.quality);
    if (a != nullptr && b != nullptr) out = std::max(out.value_or(0), a->p50_ms / b->p50_ms);
  }
  return out;
}

EffectsRow way(const char* mesher, const char* quality) {
  EffectsRow out;
  out.mesher = mesher;
  out.quality = quality;
  return out;
}

Target ratio_target(const char* what, double at_most, std::optional<double> ratio) {
  Target out{what, fmt::format("at most {:.1f}x", at_most), "", Verdict::not_measured};
  if (!ratio) return out;
  out.measured = fmt::format("{:.2f}x", *ratio);
  out.verdict = verdict_of(*ratio <= at_most);
  return out;
}

}  // namespace

std::vector<Target> ClientBenchResult::targets() const {
  std::vector<Target> out;
  if (!bursts.empty()) {
    const BurstRow& row = bursts.front();
    out.push_back({fmt::format("{} edits of others in one frame: added work of a frame", row.edits),
                   fmt::format("at most {:.0f} ms", kBudgetMs),
                   fmt::format("{:.1f} ms", row.worst_added_ms),
                   verdict_of(row.worst_added_ms <= kBudgetMs)});
    const double more_ms = row.slowest_ms - row.still_slowest_ms;
    out.push_back(
        {"the same with the light and shadows that change: slowest frame, beyond that without edits",
         fmt::format("at most {:.0f} ms", kBudgetMs), fmt::format("{:.1f} ms", more_ms),
         verdict_of(more_ms <= kBudgetMs)});
  }
  out.push_back({"own edit to changed pixels", fmt::format("at most {} frames", kOwnFramesMax),
                 fmt::format("{} frames", own_edit.frames_max),
                 own_edit.edits == 0 ? Verdict::not_measured
                                     : verdict_of(own_edit.frames_max <= kOwnFramesMax)});
  out.push_back(ratio_target("frame of RDM quads against culled faces, all effects on", 1,
                             worst_ratio(effects, way("rdm", "high"), way("culled", "high"))));
  out.push_back(ratio_target("corners and shadows on (medium) against off (low), RDM quads",
                             kEffectsMax,
                             worst_ratio(effects, way("rdm", "medium"), way("rdm", "low"))));
  out.push_back(ratio_target("the same, soft shadows (high)", kEffectsMax,
                             worst_ratio(effects, way("rdm", "high"), way("rdm", "low"))));
  return out;
}

void write_json(const ClientBenchResult& result, std::ostream& out) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["machine"] = json_of(result.machine);
  json["gl"] = Json{{"renderer", result.gl_renderer}, {"context", result.gl_context}};
  json["width"] = result.width;
  json["height"] = result.height;
  for (const BurstRow& row : result.bursts) {
    json["bursts"].push_back(Json{{"budget", row.budget},
                                  {"edits", row.edits},
                                  {"bursts", row.bursts},
                                  {"worst_added_ms", row.worst_added_ms},
                                  {"worst_mesh_ms", row.worst_mesh_ms},
                                  {"worst_upload_ms", row.worst_upload_ms},
                                  {"total_ms", row.total_ms},
                                  {"frames_min", row.frames_min},
                                  {"frames_max", row.frames_max},
                                  {"carried_max", row.carried_max},
                                  {"still_ms", row.still_ms},
                                  {"slowest_ms", row.slowest_ms},
                                  {"still_slowest_ms", row.still_slowest_ms}});
  }
  json["own_edit"] = Json{{"edits", result.own_edit.edits},
                          {"frames_max", result.own_edit.frames_max},
                          {"frames_mean", result.own_edit.frames_mean}};
  for (const EffectsRow& row : result.effects) {
    json["effects"].push_back(Json{{"world", row.world},
                                   {"mesher", row.mesher},
                                   {"quality", row.quality},
                                   {"quads_drawn", row.quads_drawn},
                                   {"frames", row.frames},
                                   {"p50_ms", row.p50_ms},
                                   {"p90_ms", row.p90_ms}});
  }
  out << json.dump(2) << "\n";
}

void write_tables(const ClientBenchResult& result, std::ostream& out) {
  fmt::print(out, "OpenGL: {}, {}; {}x{} pixels.\n\n", result.gl_renderer, result.gl_context,
             result.width, result.height);
  write_targets(result.targets(), out);
  fmt::print(out,
             "\n### Bursts\n\n| uploads a frame | edits | bursts | worst frame: added ms | worst "
             "mesh ms | worst upload ms | added ms of a burst | frames | most carried over | ms of "
             "a frame without | slowest: ms | slowest without: ms "
             "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const BurstRow& row : result.bursts) {
    fmt::print(
        out,
        "| {} | {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {} to {} | {} | {:.1f} | {:.1f} | "
        "{:.1f} |\n",
        row.budget, row.edits, row.bursts, row.worst_added_ms, row.worst_mesh_ms,
        row.worst_upload_ms, row.total_ms, row.frames_min, row.frames_max, row.carried_max,
        row.still_ms, row.slowest_ms, row.still_slowest_ms);
  }
  fmt::print(out,
             "\n### Own edits\n\n| edits | frames to changed pixels, mean | most |\n|---|---|---|\n"
             "| {} | {:.2f} | {} |\n",
             result.own_edit.edits, result.own_edit.frames_mean, result.own_edit.frames_max);
  fmt::print(out,
             "\n### Effects\n\n| world | mesh | quality | quads drawn | frames | p50 ms | p90 ms "
             "|\n|---|---|---|---|---|---|---|\n");
  for (const EffectsRow& row : result.effects) {
    fmt::print(out, "| {} | {} | {} | {} | {} | {:.1f} | {:.1f} |\n", row.world, row.mesher,
               row.quality, row.quads_drawn, row.frames, row.p50_ms, row.p90_ms);
  }
}

}  // namespace runstone::bench
