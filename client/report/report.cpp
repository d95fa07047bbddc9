#include "client/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "common/core/hex.hpp"
#include "common/os/output_file.hpp"
#include "common/runs/dense.hpp"

namespace runstone {
namespace {

using Json = nlohmann::ordered_json;

Json summary_value(const std::optional<std::int64_t>& value) {
  if (!value) return nullptr;
  if (*value == Histogram::kInfinite) return "inf";
  return *value;
}

Json histogram_summary(const Histogram& histogram) {
  Json out;
  out["count"] = histogram.count();
  out["infinite"] = histogram.infinite();
  if (histogram.below_zero() != 0) out["below_zero"] = histogram.below_zero();
  out["p50"] = summary_value(histogram.percentile(0.50));
  out["p90"] = summary_value(histogram.percentile(0.90));
  out["p99"] = summary_value(histogram.percentile(0.99));
  out["max"] = summary_value(histogram.max());
  const auto mean = histogram.mean();
  out["mean"] = mean ? Json(*mean) : Json(nullptr);
  return out;
}

Json path_json(const PathReport& path) {
  Json out;
  out["edits"] = path.edits;
  out["without_effect"] = path.without_effect;
  out["left_view"] = path.left_view;
  out["unknown_submit"] = path.unknown_submit;
  Json since = Json::object(), step = Json::object();
  for (std::size_t s = 0; s < kLatencyStageCount; ++s) {
    const char* const name = to_string(static_cast<LatencyStage>(s));
    if (path.since_submit[s].count() != 0) since[name] = histogram_summary(path.since_submit[s]);
    if (path.step[s].count() != 0) step[name] = histogram_summary(path.step[s]);
  }
  out["since_submit"] = std::move(since);
  out["step"] = std::move(step);
  return out;
}

Json ms(const std::optional<TimeUs>& us) {
  return us ? Json(static_cast<double>(*us) / 1000) : Json(nullptr);
}

Json part_json(const JoinedPart& part) {
  return Json{{"chunks", part.chunks},
              {"meshed", part.done},
              {"first_ms", ms(part.first_us)},
              {"most_ms", ms(part.most_us)},
              {"all_ms", ms(part.all_us)}};
}

Json replica_json(const Replica& replica) {
  const ReplicaCounters& c = replica.counters();
  const LocalEditCounters& local = replica.local_edits().counters();
  return Json{{"confirmed_chunks", replica.confirmed_count()},
              {"awaiting", replica.awaiting_count()},
              {"unavailable", replica.unavailable_count()},
              {"local_not_durable", replica.local_edits().all().size()},
              {"newest", replica.newest()},
              {"durable", replica.durable()},
              {"snapshots_taken", c.snapshots_taken},
              {"snapshots_stale", c.snapshots_stale},
              {"answers_outside", c.answers_outside},
              {"commits", c.commits},
              {"chunk_edits_applied", c.chunk_edits_applied},
              {"chunk_edits_contained", c.chunk_edits_contained},
              {"chunk_edits_buffered", c.chunk_edits_buffered},
              {"buffer_overflows", c.buffer_overflows},
              {"confirmed_stacks", c.confirmed_stacks.text()},
              {"predicted_stacks", c.predicted_stacks.text()},
              {"gaps", c.gaps},
              {"requests", c.requests},
              {"digests_checked", c.digests_checked},
              {"fell_behind", c.fell_behind},
              {"drifted", c.drifted},
              {"repaired", c.repaired},
              {"claims_refuted", c.claims_refuted},
              {"adopted", c.adopted},
              {"tiles_adopted", c.tiles_adopted},
              {"tiles_same", c.tiles_same},
              {"claimed", c.claimed},
              {"same_taken", c.same_taken},
              {"updates_taken", c.updates_taken},
              {"local_submitted", local.submitted},
              {"local_confirmed", local.confirmed},
              {"local_rejected", local.rejected},
              {"local_durable", local.durable},
              {"local_offered_again", local.offered_again},
              {"dropped_by_epoch", c.dropped_by_epoch}};
}

Json memory_json(const MemoryUse& use, const BudgetReport& budget) {
  return Json{{"budget_bytes", budget.bytes_max},
              {"peak_bytes", budget.peak_bytes},
              {"bytes", use.total()},
              {"chunk_bytes", use.chunks},
              {"edit_bytes", use.edits},
              {"mesh_bytes", use.meshes},
              {"gpu_bytes", use.gpu},
              {"texture_bytes", use.textures},
              {"view_shrinks", budget.shrinks},
              {"view_growths", budget.growths},
              {"view_radius", budget.radii.h},
              {"view_radius_wanted", budget.wanted.h}};
}

Json far_json(const FarReport& far) {
  return Json{{"tiles", far.tiles},
              {"bytes", far.bytes},
              {"budget_bytes", far.bytes_max},
              {"levels", far.levels},
              {"levels_wanted", far.wanted},
              {"reach", far.reach},
              {"coarse_ms", ms(far.horizon.coarse_us)},
              {"all_ms", ms(far.horizon.all_us)}};
}

Json cache_json(const std::optional<CacheCounters>& c) {
  if (!c) return nullptr;
  return Json{{"hits", c->hits},
              {"misses", c->misses},
              {"kept", c->kept},
              {"evicted", c->evicted},
              {"corrupt", c->corrupt},
              {"not_common", c->not_common},
              {"databases_set_aside", c->databases_set_aside}};
}

/// Returns milliseconds, "inf", or "-" if nothing was measured.
std::string cell(const std::optional<std::int64_t>& us) {
  if (!us) return "-";
  if (*us == Histogram::kInfinite) return "inf";
  return fmt::format("{:.2f}", static_cast<double>(*us) / 1000);
}

void add_row(std::string& out, const char* path, const char* stage, const Histogram& h) {
  if (h.count() == 0) return;
  fmt::format_to(std::back_inserter(out), "{:<15} {:<10} {:>8} {:>10} {:>10} {:>10} {:>10}\n", path,
                 stage, h.count(), cell(h.percentile(0.5)), cell(h.percentile(0.9)),
                 cell(h.percentile(0.99)), cell(h.max()));
}

double per_chunk(const MeshStats& meshes) {
  return meshes.chunks == 0 ? 0
                            : static_cast<double>(meshes.jobs) / static_cast<double>(meshes.chunks);
}

/// `edge`: of a chunk, voxels; 0 or less before a world was open.
void add_chunk_lines(std::string& out, const ClientReport& report, std::int32_t edge) {
  const auto into = std::back_inserter(out);
  const SnapshotStats& snapshots = report.snapshots;
  const auto each = [&snapshots](std::uint64_t total) {
    return snapshots.count == 0 ? 0.0
                                : static_cast<double>(total) / static_cast<double>(snapshots.count);
  };
  const MeshStats& meshes = report.meshes;
  const Extent extent = Extent::cube(static_cast<unsigned>(std::max(edge, 0)));
  fmt::format_to(into,
                 "chunks: {} snapshots; means: {:.0f} runs, {:.0f} bytes on the wire, "
                 "{:.0f} as raw runs, {} as a dense grid; unpack {:.1f} us, mesh {:.1f} us\n",
                 snapshots.count, snapshots.runs.mean().value_or(0), each(snapshots.wire_bytes),
                 each(snapshots.raw_bytes), extent.volume() * sizeof(Material),
                 snapshots.unpack_ns.mean().value_or(0) / 1000,
                 meshes.whole_ns.mean().value_or(0) / 1000);
  fmt::format_to(into, "meshes per chunk: {:.2f} ({} of {} chunks)\n", per_chunk(meshes),
                 meshes.jobs, meshes.chunks);
  fmt::format_to(into,
                 "meshes of changed layers only: {}, each {:.1f} us; {:.1f} MiB of meshes kept\n",
                 meshes.layers_ns.count(), meshes.layers_ns.mean().value_or(0) / 1000,
                 static_cast<double>(meshes.kept_bytes) / (1 << 20));
}

}  // namespace

BudgetReport report_of(const MemoryBudget& budget) {
  return {budget.bytes_max(), budget.peak_bytes(), budget.shrinks(),
          budget.growths(),   budget.radii(),      budget.wanted()};
}

void set_far_budget(FarReport& report, const FarBudget& budget) {
  report.bytes_max = budget.bytes_max();
  report.wanted = budget.wanted();
}

std::string to_json(const ClientReport& report, const ClientSession& session) {
  Json out;
  out["world_id"] = session.welcome() ? Json(to_hex(session.welcome()->world_id)) : Json(nullptr);
  out["renderer"] = report.renderer;
  out["seconds"] = report.seconds;
  if (session.clock().known()) {
    out["clock"] = Json{{"offset_us", session.clock().offset_us()},
                        {"error_us", session.clock().error_us()},
                        {"round_trip_us", session.clock().round_trip_us()}};
  } else {
    out["clock"] = nullptr;
  }
  Json latency;
  for (std::size_t w = 0; w < kEditPathCount; ++w) {
    const auto path = static_cast<EditPath>(w);
    latency[to_string(path)] = path_json(report.latency[path]);
  }
  latency["local_durable"] = histogram_summary(report.latency.durable);
  latency["local_rejected"] = report.latency.rejected;
  latency["local_unseen"] = report.latency.unseen;
  latency["local_refused"] = report.edits_refused;
  out["latency_us"] = std::move(latency);
  out["join"] = Json{{"near", part_json(report.join.near)}, {"view", part_json(report.join.view)}};
  const SnapshotStats& snapshots = report.snapshots;
  const char* encoding = "none";
  if (session.welcome()) encoding = name_of(session.welcome()->encoding);
  out["snapshots"] = Json{{"encoding", encoding},
                          {"count", snapshots.count},
                          {"wire_bytes", snapshots.wire_bytes},
                          {"raw_bytes", snapshots.raw_bytes},
                          {"runs", histogram_summary(snapshots.runs)},
                          {"unpack_ns", histogram_summary(snapshots.unpack_ns)}};
  const MeshStats& meshes = report.meshes;
  out["mesh"] = Json{{"jobs", meshes.jobs},
                     {"chunks", meshes.chunks},
                     {"per_chunk", per_chunk(meshes)},
                     {"kept_bytes", meshes.kept_bytes},
                     {"whole_ns", histogram_summary(meshes.whole_ns)},
                     {"layers_ns", histogram_summary(meshes.layers_ns)}};
  out["memory"] = memory_json(report.memory, report.budget);
  out["far_ground"] = far_json(report.far);
  out["cache"] = cache_json(report.cache);
  out["frames"] = Json{{"presented", report.frames.presented},
                       {"draw_us", histogram_summary(report.frames.draw_us)},
                       {"upload_us", histogram_summary(report.frames.upload_us)}};
  out["net"] = Json{{"bytes_received", report.net.bytes_received},
                    {"bytes_sent", report.net.bytes_sent},
                    {"control_bytes", report.net.control_bytes},
                    {"edit_bytes", report.net.edit_bytes},
                    {"chunk_bytes", report.net.chunk_bytes},
                    {"messages_received", report.net.messages_received},
                    {"connections", report.net.connections}};
  out["replica"] = replica_json(session.replica());
  out["dense_expansions"] = dense_expansions();
  return out.dump(2) + "\n";
}

std::string to_table(const ClientReport& report, const ClientSession& session) {
  std::string out;
  const auto into = std::back_inserter(out);
  fmt::format_to(into, "{:<15} {:<10} {:>8} {:>10} {:>10} {:>10} {:>10}\n", "edits (ms)", "until",
                 "count", "p50", "p90", "p99", "max");
  for (std::size_t w = 0; w < kEditPathCount; ++w) {
    const auto path = static_cast<EditPath>(w);
    for (std::size_t s = 0; s < kLatencyStageCount; ++s) {
      add_row(out, to_string(path), to_string(static_cast<LatencyStage>(s)),
              report.latency[path].since_submit[s]);
    }
  }
  add_row(out, "local", "durable", report.latency.durable);
  if (session.clock().known()) {
    fmt::format_to(into, "clock offset error: at most {:.3f} ms\n",
                   static_cast<double>(session.clock().error_us()) / 1000);
  }
  if (report.edits_refused != 0)
    fmt::format_to(into, "edits refused by this client: {}\n", report.edits_refused);
  add_chunk_lines(out, report, session.replica().chunk_edge());
  const BudgetReport& budget = report.budget;
  if (budget.shrinks != 0) {
    fmt::format_to(into,
                   "memory: the budget of {} MiB made the view shrink {} times and grow {} times; "
                   "its radius is {} of {} chunks\n",
                   budget.bytes_max >> 20, budget.shrinks, budget.growths, budget.radii.h,
                   budget.wanted.h);
  }
  if (report.frames.presented != 0) {
    fmt::format_to(into, "frames: {}, each {} ms (p50)\n", report.frames.presented,
                   cell(report.frames.draw_us.percentile(0.5)));
  }
  fmt::format_to(into, "drift: {} of {} digests checked\n", session.replica().counters().drifted,
                 session.replica().counters().digests_checked);
  fmt::format_to(into, "dense expansions: {}\n", dense_expansions());
  return out;
}

Result<void, std::string> write_digests(const std::string& file, const ClientSession& session) {
  const Replica& replica = session.replica();
  Json chunks = Json::array();
  for (const ChunkKey& key : replica.confirmed_keys()) {
    const ChunkPtr chunk = replica.confirmed(key);
    chunks.push_back(Json{{"lod", key.lod},
                          {"x", key.at.x},
                          {"y", key.at.y},
                          {"z", key.at.z},
                          {"epoch", chunk->version.epoch},
                          {"seq", chunk->version.seq},
                          {"digest", to_hex(digest_of(chunk->voxels))}});
  }
  Json out;
  out["world_id"] = session.welcome() ? Json(to_hex(session.welcome()->world_id)) : Json(nullptr);
  out["seq"] = replica.newest();
  out["chunks"] = std::move(chunks);
  return write_output_file(file, out.dump(1) + "\n");
}

}  // namespace runstone
