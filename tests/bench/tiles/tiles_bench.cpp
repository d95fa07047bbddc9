#include "tests/bench/tiles/tiles_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/core/assert.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/reorder.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/veil.hpp"
#include "protocol/codec/chunk_codec.hpp"
#include "tests/bench/harness/clocks.hpp"
#include "tests/bench/harness/machine_json.hpp"
#include "tests/bench/harness/statistics.hpp"
#include "tests/bench/worlds/measured_worlds.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kLevels = 4;
constexpr double kTargetShare = 2;
/// The part of an endless world that is measured.
constexpr VoxelBox kPart{{0, -64, 0}, {512, 64, 512}};

/// A chunk or a tile: as it was built, veiled, and the veiled bytes on the wire.
struct Tile {
  RunChunk built, veiled;
  Bytes packed;
  std::size_t built_bytes = 0, quads = 0;
  std::vector<double> build_us, build_one_order_us, veil_us, decode_us, mesh_us;
};
using Level = std::map<ChunkCoord, Tile>;

bool has_voxels(const RunChunk& chunk) {
  return !chunk.is_uniform() || chunk.runs.material(0) != kEmpty;
}

Level chunks_of(const VoxelWorld& world, unsigned edge) {
  const auto side = static_cast<std::int32_t>(edge);
  const VoxelBox box = world.bounds.value_or(kPart);
  const ChunkCoord first = chunk_of(box.min, side);
  Level out;
  for (std::int32_t z = first.z; z * side < box.max.z; ++z) {
    for (std::int32_t y = first.y; y * side < box.max.y; ++y) {
      for (std::int32_t x = first.x; x * side < box.max.x; ++x) {
        RunChunk chunk = chunk_of_world(world, {x * side, y * side, z * side}, edge);
        if (!has_voxels(chunk)) continue;
        Tile& tile = out[{x, y, z}];
        tile.veiled = chunk;
        tile.built = std::move(chunk);
      }
    }
  }
  return out;
}

TileChildren children_of(const Level& below, const ChunkCoord& at) {
  TileChildren out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto bit = [i](unsigned shift) { return static_cast<std::int32_t>(i >> shift & 1); };
    const auto found = below.find({2 * at.x + bit(0), 2 * at.y + bit(1), 2 * at.z + bit(2)});
    if (found != below.end()) out[i] = &found->second.built;
  }
  return out;
}

/// Returns the axis order of most runs of the children, in which few of them have to be turned.
AxisOrder order_of(const TileChildren& children) {
  std::array<std::size_t, kAxisOrderCount> runs{};
  for (const RunChunk* child : children) {
    if (child != nullptr && !child->is_uniform())
      runs[static_cast<std::size_t>(child->order)] += child->runs.size();
  }
  return kAxisOrders[static_cast<std::size_t>(std::max_element(runs.begin(), runs.end()) -
                                              runs.begin())];
}

/// Children in one axis order.
struct TurnedChildren {
  std::array<RunChunk, 8> chunks;
  TileChildren children{};

  TurnedChildren(const TileChildren& from, AxisOrder order) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (from[i] == nullptr) continue;
      chunks[i] = reorder(*from[i], order);
      children[i] = &chunks[i];
    }
  }
};

double us_since(std::uint64_t start_ns) { return static_cast<double>(now_ns() - start_ns) / 1000; }

class Passes {
 public:
  Passes(const VisibilityTable& visibility, unsigned edge) : visibility_(visibility), edge_(edge) {}

  /// Builds and veils all tiles of a level in turn.
  void build(const Level& below, Level& level) {
    for (auto& [at, tile] : level) {
      const TileChildren children = children_of(below, at);
      const AxisOrder order = order_of(children);
      const TurnedChildren turned(children, order);
      std::uint64_t start = now_ns();
      RunChunk built = build_tile(children, edge_, order, visibility_, tiles_);
      tile.build_us.push_back(us_since(start));
      start = now_ns();
      const RunChunk same = build_tile(turned.children, edge_, order, visibility_, tiles_);
      tile.build_one_order_us.push_back(us_since(start));
      RUNSTONE_ASSERT(same == built);
      tile.veiled = built;
      start = now_ns();
      veil(tile.veiled, visibility_, veils_);
      tile.veil_us.push_back(us_since(start));
      tile.built = std::move(built);
    }
  }
  /// Packs all tiles of a level.
  static void pack(Level& level) {
    for (auto& [at, tile] : level) {
      tile.packed = encode_chunk(tile.veiled, ChunkEncoding::packed);
      tile.built_bytes = encode_chunk(tile.built, ChunkEncoding::packed).size();
    }
  }
  /// Decodes and meshes all tiles of a level in turn.
  void receive(Level& level) {
    for (auto& [at, tile] : level) {
      const std::uint64_t start = now_ns();
      const auto decoded = decode_chunk(tile.packed);
      tile.decode_us.push_back(us_since(start));
      RUNSTONE_ASSERT(decoded.has_value() && *decoded == tile.veiled);
    }
    for (auto& [at, tile] : level) {
      const std::uint64_t start = now_ns();
      mesh_rdm(tile.veiled, {}, visibility_, meshes_, mesh_);
      tile.mesh_us.push_back(us_since(start));
      tile.quads = mesh_.quad_count();
    }
  }

 private:
  const VisibilityTable& visibility_;
  unsigned edge_;
  TileScratch tiles_;
  VeilScratch veils_;
  RdmScratch meshes_;
  ChunkMesh mesh_;
};

TilesRow row_of(const Level& level, unsigned number) {
  TilesRow row;
  row.level = number;
  row.tiles = level.size();
  for (const auto& [at, tile] : level) {
    row.uniform += tile.veiled.is_uniform() ? 1 : 0;
    row.runs += tile.built.runs.size();
    row.veiled_runs += tile.veiled.runs.size();
    row.bytes += tile.built_bytes;
    row.veiled_bytes += tile.packed.size();
    row.quads += tile.quads;
    if (!tile.build_us.empty()) {
      row.build_us += median(tile.build_us);
      row.build_one_order_us += median(tile.build_one_order_us);
      row.veil_us += median(tile.veil_us);
    }
    row.decode_us += median(tile.decode_us);
    row.mesh_us += median(tile.mesh_us);
  }
  return row;
}

void measure(const VoxelWorld& world, unsigned edge, unsigned repetitions,
             std::vector<TilesRow>& rows) {
  const VoxelBox box = world.bounds.value_or(kPart);
  Level level = chunks_of(world, edge);
  Passes passes(*world.visibility, edge);
  double decode_below_us = 0;
  for (unsigned number = 0; number <= kLevels; ++number) {
    if (number > 0) {
      Level above;
      for (const auto& [at, tile] : level) {
        const auto half = [](std::int32_t c) { return c >> 1; };
        above.try_emplace({half(at.x), half(at.y), half(at.z)});
      }
      for (unsigned i = 0; i < repetitions; ++i) passes.build(level, above);
      level = std::move(above);
    }
    Passes::pack(level);
    for (unsigned i = 0; i < repetitions; ++i) passes.receive(level);
    TilesRow row = row_of(level, number);
    row.world = world.name;
    row.edge = edge;
    row.columns = static_cast<std::size_t>(box.max.x - box.min.x) *
                  static_cast<std::size_t>(box.max.z - box.min.z);
    row.decode_children_us = decode_below_us;
    decode_below_us = row.decode_us;
    rows.push_back(row);
  }
}

double per(double sum, std::size_t count) {
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

}  // namespace

std::vector<Target> TilesResult::targets() const {
  std::vector<Target> out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].level != 0) continue;
    double build_us = 0, one_order_us = 0;
    for (std::size_t k = i + 1; k < rows.size() && rows[k].level != 0; ++k) {
      build_us += rows[k].build_us + rows[k].veil_us;
      one_order_us += rows[k].build_one_order_us + rows[k].veil_us;
    }
    const double share = build_us / rows[i].decode_us;
    out.push_back({fmt::format("{}, edge {}: build and veil of all tiles against one decoding of "
                               "the chunks of level 0",
                               rows[i].world, rows[i].edge),
                   fmt::format("at most {:.0f}x", kTargetShare),
                   fmt::format("{:.2f}x; {:.2f}x if the chunks have one axis order", share,
                               one_order_us / rows[i].decode_us),
                   share <= kTargetShare ? Verdict::met : Verdict::missed});
  }
  return out;
}

Result<TilesResult, std::string> run_tiles_bench(const BenchOptions& options,
                                                 std::ostream& progress) {
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return Unexpected<std::string>{worlds.error()};
  TilesResult out;
  out.machine = this_machine();
  out.repetitions = options.repetitions;
  for (std::size_t w = 0; w < worlds->size(); ++w) {
    for (const unsigned edge : options.edges) {
      measure(*worlds->voxels(w), edge, options.repetitions, out.rows);
      fmt::print(progress, "{} edge {}\n", worlds->name(w), edge);
      progress.flush();
    }
  }
  return out;
}

void write_table(const TilesResult& result, std::ostream& out) {
  fmt::print(
      out,
      "{} passes over the tiles of a level; times are means of a tile\n\n"
      "| world | edge | level | tiles | uniform | runs | veiled | bytes / column | veiled | "
      "build µs | of one order | veil µs | decode of the children µs | build and veil / decode | quads | "
      "mesh µs |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      result.repetitions);
  for (const TilesRow& row : result.rows) {
    const std::size_t n = row.tiles;
    fmt::print(out, "| {} | {} | {} | {} | {} | {:.0f} | {:.0f} | {:.4f} | {:.4f} |", row.world,
               row.edge, row.level, n, row.uniform, per(static_cast<double>(row.runs), n),
               per(static_cast<double>(row.veiled_runs), n),
               per(static_cast<double>(row.bytes), row.columns),
               per(static_cast<double>(row.veiled_bytes), row.columns));
    if (row.level == 0) {
      fmt::print(out, " – | – | – | – | – |");
    } else {
      fmt::print(out, " {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.2f} |", per(row.build_us, n),
                 per(row.build_one_order_us, n), per(row.veil_us, n),
                 per(row.decode_children_us, n),
                 (row.build_us + row.veil_us) / row.decode_children_us);
    }
    fmt::print(out, " {:.0f} | {:.1f} |\n", per(static_cast<double>(row.quads), n),
               per(row.mesh_us, n));
  }
  fmt::print(out, "\n");
  write_targets(result.targets(), out);
}

void write_json(const TilesResult& result, std::ostream& out) {
  nlohmann::ordered_json json = {{"machine", json_of(result.machine)},
                                 {"repetitions", result.repetitions},
                                 {"rows", nlohmann::ordered_json::array()},
                                 {"targets", nlohmann::ordered_json::array()}};
  for (const TilesRow& row : result.rows) {
    json["rows"].push_back({{"world", row.world},
                            {"edge", row.edge},
                            {"level", row.level},
                            {"columns", row.columns},
                            {"tiles", row.tiles},
                            {"uniform", row.uniform},
                            {"runs", row.runs},
                            {"veiled_runs", row.veiled_runs},
                            {"bytes", row.bytes},
                            {"veiled_bytes", row.veiled_bytes},
                            {"quads", row.quads},
                            {"build_us", row.build_us},
                            {"build_one_order_us", row.build_one_order_us},
                            {"veil_us", row.veil_us},
                            {"decode_us", row.decode_us},
                            {"decode_children_us", row.decode_children_us},
                            {"mesh_us", row.mesh_us}});
  }
  for (const Target& target : result.targets()) {
    json["targets"].push_back({{"case", target.what},
                               {"target", target.wanted},
                               {"measured", target.measured},
                               {"verdict", name_of(target.verdict)}});
  }
  out << json.dump(1) << '\n';
}

}  // namespace runstone::bench
