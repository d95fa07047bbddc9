#include "bench/storage/storage_result.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/harness/machine_json.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/worlds/measured_worlds.hpp"

namespace runstone::bench {
namespace {

nlohmann::ordered_json json_of(const StorageRow& row) {
  return {
      {"world", row.world},       {"part", row.part},         {"edge", row.edge},
      {"store", row.store},       {"runs", row.runs},         {"bytes", row.bytes},
      {"build_ns", row.build_ns}, {"read_ns", row.read_ns},   {"walk_ns", row.walk_ns},
      {"edit_ns", row.edit_ns},   {"brush_ns", row.brush_ns}, {"brush_voxels", row.brush_voxels}};
}

std::string group_of(const std::string& world) {
  if (world == "luanti" || world == "scenarios") return world;
  return landscape_names().contains(world) || world == "hills_plain" ? "landscapes" : "patterns";
}

/// The figures of one store over the volumes of a group.
struct Samples {
  std::string store;
  std::vector<double> bytes, bytes_per_voxel, build, read, walk, edit, brush, brush_per_voxel;

  void add(const StorageRow& row) {
    bytes.push_back(static_cast<double>(row.bytes));
    bytes_per_voxel.push_back(row.bytes_per_voxel());
    build.push_back(row.build_ns);
    read.push_back(row.read_ns);
    walk.push_back(row.walk_ns);
    edit.push_back(row.edit_ns);
    brush.push_back(row.brush_ns);
    brush_per_voxel.push_back(row.brush_ns_per_voxel());
  }
};

struct Group {
  std::string name;
  unsigned edge = 0;
  std::vector<Samples> stores;  // in the order measured
};

std::vector<Group> groups_of(const std::vector<StorageRow>& rows) {
  std::vector<Group> out;
  for (const StorageRow& row : rows) {
    const std::string name = group_of(row.world);
    auto group = std::find_if(out.begin(), out.end(),
                              [&](const Group& g) { return g.name == name && g.edge == row.edge; });
    if (group == out.end()) group = out.insert(out.end(), Group{name, row.edge, {}});
    auto& stores = group->stores;
    auto store = std::find_if(stores.begin(), stores.end(),
                              [&](const Samples& s) { return s.store == row.store; });
    if (store == stores.end()) {
      store = stores.insert(stores.end(), Samples{});
      store->store = row.store;
    }
    store->add(row);
  }
  return out;
}

}  // namespace

void write_csv(const StorageResult& result, std::ostream& out) {
  fmt::print(
      out,
      "world,part,edge,store,runs,bytes,build_ns,read_ns,walk_ns,edit_ns,brush_ns,brush_voxels\n");
  for (const StorageRow& row : result.rows) {
    fmt::print(out, "{},{},{},{},{},{},{:.1f},{:.3f},{:.6f},{:.2f},{:.1f},{:.1f}\n", row.world,
               row.part, row.edge, row.store, row.runs, row.bytes, row.build_ns, row.read_ns,
               row.walk_ns, row.edit_ns, row.brush_ns, row.brush_voxels);
  }
}

void write_json(const StorageResult& result, std::ostream& out) {
  nlohmann::ordered_json json = {{"machine", json_of(result.machine)},
                                 {"repetitions", result.repetitions},
                                 {"morton_code", result.morton_code},
                                 {"rows", nlohmann::ordered_json::array()},
                                 {"skipped", result.skipped}};
  for (const StorageRow& row : result.rows) json["rows"].push_back(json_of(row));
  out << json.dump(1) << '\n';
}

void write_tables(const StorageResult& result, std::ostream& out) {
  for (const Group& group : groups_of(result.rows)) {
    const std::size_t volumes = group.stores.front().bytes.size();
    fmt::print(
        out,
        "\n**{}**, edge {}, {} volume{}\n\n"
        "| store | bytes | B/voxel | build µs | read ns | walk ns/voxel | edit ns | brush µs | "
        "brush ns/voxel |\n"
        "|---|---|---|---|---|---|---|---|---|\n",
        group.name, group.edge, volumes, volumes == 1 ? "" : "s");
    for (const Samples& s : group.stores) {
      fmt::print(out,
                 "| {} | {:.0f} | {:.4f} | {:.2f} | {:.2f} | {:.4f} | {:.1f} | {:.2f} | {:.2f} |\n",
                 s.store, geometric_mean(s.bytes), geometric_mean(s.bytes_per_voxel),
                 geometric_mean(s.build) / 1000, geometric_mean(s.read), geometric_mean(s.walk),
                 geometric_mean(s.edit), geometric_mean(s.brush) / 1000,
                 geometric_mean(s.brush_per_voxel));
    }
  }
}

}  // namespace runstone::bench
