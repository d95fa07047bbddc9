#include "bench/meshing/mesh_result.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/harness/machine_json.hpp"
#include "bench/harness/statistics.hpp"

namespace runstone::bench {
namespace {

std::string ratio_text(const std::optional<double>& ratio) {
  return ratio ? fmt::format("{:.3f}", *ratio) : "";
}

nlohmann::ordered_json json_of(const MeshRow& row) {
  nlohmann::ordered_json out = {{"world", row.world},
                                {"part", row.part},
                                {"edge", row.edge},
                                {"order", row.order},
                                {"rank", row.rank},
                                {"mesher", row.mesher},
                                {"runs", row.runs},
                                {"median_ns", row.timing.median_ns},
                                {"min_ns", row.timing.min_ns},
                                {"p90_ns", row.timing.p90_ns}};
  for (std::size_t p = 0; p < kPhaseCount; ++p) {
    out[std::string(kPhaseNames[p]) + "_ns"] = row.timing.phase_ns[p];
  }
  out["ns_per_run"] = row.ns_per_run();
  out["quads"] = row.timing.quads;
  const MeshFigures& mesh = row.timing.mesh;
  out["vertices"] = mesh.vertices;
  out["triangles"] = mesh.triangles;
  out["t_junctions"] = mesh.t_junctions.places;
  out["t_junction_edges"] = mesh.t_junctions.edges;
  out["thin_16"] = mesh.thin.above_16;
  out["thin_100"] = mesh.thin.above_100;
  out["mesh_bytes"] = mesh.bytes;
  out["storage_bytes"] = row.timing.storage_bytes;
  out["allocations"] = row.timing.allocations;
  out["copy_ns"] = row.timing.copy_ns;
  if (row.against_decode) out["against_decode"] = *row.against_decode;
  if (row.against_mask) out["against_mask"] = *row.against_mask;
  return out;
}

/// The sums of one mesher over the volumes of a world.
struct Total {
  std::size_t volumes = 0, runs = 0, quads = 0, storage = 0, allocations = 0;
  std::size_t vertices = 0, triangles = 0, t_junctions = 0, thin_16 = 0, thin_100 = 0;
  double median = 0, min = 0, p90 = 0, copy = 0;
  std::array<double, kPhaseCount> phase{};
  std::vector<double> against_decode, against_mask;
  double decode = 0, mask = 0;  // medians of the two baselines, over the rows with ratios

  void add(const MeshRow& row) {
    ++volumes;
    runs += row.runs;
    quads += row.timing.quads;
    vertices += row.timing.mesh.vertices;
    triangles += row.timing.mesh.triangles;
    t_junctions += row.timing.mesh.t_junctions.places;
    thin_16 += row.timing.mesh.thin.above_16;
    thin_100 += row.timing.mesh.thin.above_100;
    storage += row.timing.storage_bytes;
    allocations += row.timing.allocations;
    median += row.timing.median_ns;
    min += row.timing.min_ns;
    p90 += row.timing.p90_ns;
    copy += row.timing.copy_ns;
    for (std::size_t p = 0; p < kPhaseCount; ++p) phase[p] += row.timing.phase_ns[p];
    if (row.against_decode) {
      against_decode.push_back(*row.against_decode);
      decode += *row.against_decode * row.timing.median_ns;
    }
    if (row.against_mask) {
      against_mask.push_back(*row.against_mask);
      mask += *row.against_mask * row.timing.median_ns;
    }
  }
};

/// Returns the geometric mean, and the ratio of sums if it differs.
std::string ratios(const std::vector<double>& each, double sum, double ours) {
  if (each.empty()) return "–";
  const std::string mean = fmt::format("{:.2f}", geometric_mean(each));
  return each.size() == 1 ? mean : fmt::format("{}; {:.2f}", mean, sum / ours);
}

void write_total(const std::string& mesher, const Total& total, std::ostream& out) {
  const auto volumes = static_cast<double>(total.volumes);
  const auto us = [&](double sum) { return fmt::format("{:.2f}", sum / volumes / 1000); };
  const auto mean = [&](std::size_t sum) {
    return fmt::format("{:.0f}", static_cast<double>(sum) / volumes);
  };
  fmt::print(out, "| {} | {} | {} | {} |", mesher, us(total.median), us(total.min), us(total.p90));
  for (const double phase : total.phase) fmt::print(out, " {} |", phase == 0 ? "–" : us(phase));
  fmt::print(out, " {:.1f} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.1f} |\n",
             total.median / static_cast<double>(total.runs), mean(total.quads),
             mean(total.vertices), mean(total.triangles), mean(total.t_junctions),
             mean(total.thin_16), mean(total.thin_100), mean(total.storage),
             mean(total.allocations), ratios(total.against_decode, total.decode, total.median),
             ratios(total.against_mask, total.mask, total.median), total.median / total.copy);
}

/// The rows of one mesher over the volumes of a world, at one edge and in one rank of order.
struct Group {
  std::string world, order;
  unsigned edge = 0;
  std::vector<std::pair<std::string, Total>> meshers;  // in the order measured
};

std::vector<Group> groups_of(const std::vector<MeshRow>& rows) {
  std::vector<Group> out;
  for (const MeshRow& row : rows) {
    if (!row.has_faces) continue;
    const std::string& order = row.rank == "between" ? row.order : row.rank;
    const auto same = [&](const Group& g) {
      return g.world == row.world && g.edge == row.edge && g.order == order;
    };
    auto group = std::find_if(out.begin(), out.end(), same);
    if (group == out.end()) group = out.insert(out.end(), Group{row.world, order, row.edge, {}});
    auto& meshers = group->meshers;
    auto mesher = std::find_if(meshers.begin(), meshers.end(),
                               [&](const auto& m) { return m.first == row.mesher; });
    if (mesher == meshers.end()) mesher = meshers.insert(meshers.end(), {row.mesher, Total{}});
    mesher->second.add(row);
  }
  return out;
}

}  // namespace

std::string MeshRow::cell() const {
  return fmt::format("{} {} edge {} order {} {}", world, part, edge, order, mesher);
}

void write_csv(const MeshResult& result, std::ostream& out) {
  fmt::print(
      out,
      "world,part,edge,order,rank,mesher,runs,median_ns,min_ns,p90_ns,decode_ns,octree_ns,mask_ns,"
      "mesh_ns,ns_per_run,quads,vertices,triangles,t_junctions,t_junction_edges,thin_16,thin_100,"
      "mesh_bytes,storage_bytes,allocations,copy_ns,against_decode,against_mask\n");
  for (const MeshRow& row : result.rows) {
    const Timing& t = row.timing;
    fmt::print(out, "{},{},{},{},{},{},{},{:.1f},{:.1f},{:.1f},", row.world, row.part, row.edge,
               row.order, row.rank, row.mesher, row.runs, t.median_ns, t.min_ns, t.p90_ns);
    for (const double phase : t.phase_ns) fmt::print(out, "{:.1f},", phase);
    fmt::print(out, "{:.2f},{},{},{},{},{},{},{},{},", row.ns_per_run(), t.quads, t.mesh.vertices,
               t.mesh.triangles, t.mesh.t_junctions.places, t.mesh.t_junctions.edges,
               t.mesh.thin.above_16, t.mesh.thin.above_100, t.mesh.bytes);
    fmt::print(out, "{},{},{:.1f},{},{}\n", t.storage_bytes, t.allocations, t.copy_ns,
               ratio_text(row.against_decode), ratio_text(row.against_mask));
  }
}

void write_json(const MeshResult& result, std::ostream& out) {
  nlohmann::ordered_json json = {{"machine", json_of(result.machine)},
                                 {"repetitions", result.repetitions},
                                 {"rows", nlohmann::ordered_json::array()},
                                 {"skipped", result.skipped},
                                 {"summary", nlohmann::ordered_json::array()}};
  for (const MeshRow& row : result.rows) json["rows"].push_back(json_of(row));
  for (const Target& target : result.targets) {
    json["summary"].push_back({{"case", target.what},
                               {"bar", target.wanted},
                               {"measured", target.measured},
                               {"verdict", name_of(target.verdict)}});
  }
  out << json.dump(1) << '\n';
}

void write_tables(const MeshResult& result, std::ostream& out) {
  for (const Group& group : groups_of(result.rows)) {
    const Total& first = group.meshers.front().second;
    const bool one = first.volumes == 1;
    fmt::print(out, "\n**{}**, edge {}, {} order, {} volume{}, {} runs{}\n\n", group.world,
               group.edge, group.order, first.volumes, one ? "" : "s", first.runs / first.volumes,
               one ? "" : " on average");
    fmt::print(out,
               "| mesher | median µs | min | p90 | decode | octree | mask | mesh | ns/run | "
               "quads | vertices | triangles | T-junctions | thin 1:16 | 1:100 | storage B | "
               "allocations | x decode + binary | x mask ready | copies |\n");
    fmt::print(
        out, "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const auto& [mesher, total] : group.meshers) write_total(mesher, total, out);
  }
}

void write_overview(const MeshResult& result, std::ostream& out) {
  fmt::print(out,
             "| world | edge | order | volumes | runs | quads | median µs | ns/run | "
             "x decode + binary | x mask ready | copies |\n"
             "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Group& group : groups_of(result.rows)) {
    for (const auto& [mesher, total] : group.meshers) {
      if (mesher != "rdm") continue;
      fmt::print(out, "| {} | {} | {} | {} | {} | {} | {:.2f} | {:.1f} | {} | {} | {:.0f} |\n",
                 group.world, group.edge, group.order, total.volumes, total.runs / total.volumes,
                 total.quads / total.volumes,
                 total.median / static_cast<double>(total.volumes) / 1000,
                 total.median / static_cast<double>(total.runs),
                 ratios(total.against_decode, total.decode, total.median),
                 ratios(total.against_mask, total.mask, total.median), total.median / total.copy);
    }
  }
}

}  // namespace runstone::bench
