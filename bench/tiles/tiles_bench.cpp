#include "bench/tiles/tiles_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "bench/harness/clocks.hpp"
#include "bench/harness/machine_json.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/worlds/measured_worlds.hpp"
#include "common/core/assert.hpp"
#include "common/core/tile_keys.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/runs/reorder.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/tile_rules.hpp"
#include "common/tiles/veil.hpp"
#include "protocol/chunks/chunk_codec.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kLevels = 4, kRepeatedLevels = 6;
/// The part of an endless world that is measured.
constexpr VoxelBox kPart{{0, -64, 0}, {512, 64, 512}};

/// A chunk or a tile, as it is stored and as clients get it.
struct Tile {
  RunChunk voxels, sent;        // without and with a veil; chunks have none
  Bytes stored, packed, coded;  // the first without a veil, packed
  std::size_t quads = 0;
  std::vector<double> make_us, make_one_order_us, veil_us, decode_stored_us, decode_us,
      decode_coded_us, mesh_us;
};
using Level = std::map<ChunkCoord, Tile>;

Level chunks_of(const VoxelWorld& world, unsigned edge) {
  const auto side = static_cast<std::int32_t>(edge);
  const VoxelBox box = world.bounds.value_or(kPart);
  const ChunkCoord first = chunk_of(box.min, side);
  Level out;
  for (std::int32_t z = first.z; z * side < box.max.z; ++z) {
    for (std::int32_t y = first.y; y * side < box.max.y; ++y) {
      for (std::int32_t x = first.x; x * side < box.max.x; ++x) {
        RunChunk chunk = chunk_of_world(world, {x * side, y * side, z * side}, edge);
        if (is_empty(chunk)) continue;
        Tile& tile = out[{x, y, z}];
        tile.voxels = tile.sent = std::move(chunk);
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
    if (found != below.end()) out[i] = &found->second.voxels;
  }
  return out;
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

  /// Makes all tiles of a level in turn.
  void make(const Level& below, Level& level) {
    for (auto& [at, tile] : level) {
      const TileChildren children = children_of(below, at);
      std::uint64_t start = now_ns();
      tile.voxels = build_tile(children, edge_, kTileOrder, visibility_, tiles_);
      tile.make_us.push_back(us_since(start));
      const TurnedChildren turned(children, tile.voxels.order);
      start = now_ns();
      const RunChunk same = build_tile(turned.children, edge_, kTileOrder, visibility_, tiles_);
      tile.make_one_order_us.push_back(us_since(start));
      RUNSTONE_ASSERT(same == tile.voxels);
      start = now_ns();
      auto with_veil = veiled(tile.voxels, visibility_, veils_);
      tile.veil_us.push_back(us_since(start));
      tile.sent = with_veil ? *std::move(with_veil) : tile.voxels;
    }
  }
  static void encode(Level& level) {
    for (auto& [at, tile] : level) {
      tile.stored = encode_chunk(tile.voxels, ChunkEncoding::packed);
      tile.packed = encode_chunk(tile.sent, ChunkEncoding::packed);
      tile.coded = encode_chunk(tile.sent, ChunkEncoding::coded);
    }
  }
  /// Decodes and meshes all tiles of a level in turn.
  void receive(Level& level) {
    const auto decode = [&level](Bytes Tile::* bytes, RunChunk Tile::* expected,
                                 std::vector<double> Tile::* us) {
      for (auto& [at, tile] : level) {
        const std::uint64_t start = now_ns();
        const auto decoded = decode_chunk(tile.*bytes);
        (tile.*us).push_back(us_since(start));
        RUNSTONE_ASSERT(decoded.has_value() && *decoded == tile.*expected);
      }
    };
    decode(&Tile::stored, &Tile::voxels, &Tile::decode_stored_us);
    decode(&Tile::packed, &Tile::sent, &Tile::decode_us);
    decode(&Tile::coded, &Tile::sent, &Tile::decode_coded_us);
    for (auto& [at, tile] : level) {
      const std::uint64_t start = now_ns();
      mesh_rdm(tile.sent, {}, visibility_, meshes_, mesh_);
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
    row.uniform += tile.voxels.is_uniform() ? 1 : 0;
    row.runs += tile.voxels.runs.size();
    row.veiled_runs += tile.sent.runs.size();
    row.bytes += tile.stored.size();
    row.veiled_bytes += tile.packed.size();
    row.coded_bytes += tile.coded.size();
    row.quads += tile.quads;
    if (!tile.make_us.empty()) {
      row.make_us += median(tile.make_us);
      row.make_one_order_us += median(tile.make_one_order_us);
      row.veil_us += median(tile.veil_us);
    }
    if (!tile.decode_us.empty()) {
      row.decode_stored_us += median(tile.decode_stored_us);
      row.decode_us += median(tile.decode_us);
      row.decode_coded_us += median(tile.decode_coded_us);
      row.mesh_us += median(tile.mesh_us);
    }
  }
  return row;
}

Level empty_level_above(const Level& level) {
  Level above;
  for (const auto& [at, tile] : level) above.try_emplace(tile_at(at, 1));
  return above;
}

void measure(const VoxelWorld& world, unsigned edge, unsigned repetitions,
             std::vector<TilesRow>& rows) {
  const VoxelBox box = world.bounds.value_or(kPart);
  Level level = chunks_of(world, edge);
  Passes passes(*world.visibility, edge);
  double decode_below_us = 0;
  for (unsigned number = 0; number <= kLevels; ++number) {
    Level below;
    if (number > 0) {
      below = std::exchange(level, empty_level_above(level));
      for (unsigned i = 0; i < repetitions; ++i) passes.make(below, level);
    }
    Passes::encode(level);
    for (unsigned i = 0; i < repetitions; ++i) passes.receive(level);
    TilesRow row = row_of(level, number);
    row.world = world.name;
    row.edge = edge;
    row.columns = static_cast<std::size_t>(box.max.x - box.min.x) *
                  static_cast<std::size_t>(box.max.z - box.min.z);
    row.decode_children_us = decode_below_us;
    decode_below_us = row.decode_stored_us;
    rows.push_back(row);
  }
}

/// Measures the bytes of a bounded world that is repeated sideways without end, so that no tile lies
/// at its border. Each level repeats after some tiles, and only these are made.
void measure_repeated(const VoxelWorld& world, unsigned edge, std::vector<TilesRow>& rows) {
  const auto side = static_cast<std::int32_t>(edge);
  const ChunkCoord first = chunk_of(world.bounds->min, side);
  const ChunkCoord last =
      chunk_of({world.bounds->max.x - 1, world.bounds->max.y - 1, world.bounds->max.z - 1}, side);
  const std::int32_t width = last.x - first.x + 1, depth = last.z - first.z + 1;
  Passes passes(*world.visibility, edge);
  Level level;
  for (auto& [at, chunk] : chunks_of(world, edge))
    level[{at.x - first.x, at.y, at.z - first.z}].voxels = std::move(chunk.voxels);
  for (unsigned number = 1; number <= kRepeatedLevels; ++number) {
    // The tiles of the level below after which it repeats, and those of this one.
    const auto period = [](std::int32_t chunks, unsigned of) {
      return std::lcm(chunks, 1 << of) >> of;
    };
    const std::int32_t x_below = period(width, number - 1), z_below = period(depth, number - 1);
    const std::int32_t across = period(width, number), along = period(depth, number);
    Level below;
    for (const auto& [at, tile] : level) {
      for (std::int32_t x = at.x; x < 2 * across; x += x_below) {
        for (std::int32_t z = at.z; z < 2 * along; z += z_below)
          below[{x, at.y, z}].voxels = tile.voxels;
      }
    }
    level = empty_level_above(below);
    passes.make(below, level);
    Passes::encode(level);
    TilesRow row = row_of(level, number);
    row.world = world.name + ", repeated";
    row.edge = edge;
    row.columns = (static_cast<std::size_t>(across) * edge << number) *
                  (static_cast<std::size_t>(along) * edge << number);
    rows.push_back(row);
  }
}

/// A view of this radius in chunks sees as many tiles of each level around its centre.
constexpr std::int32_t kViewRadius = 8;

/// Returns the columns of voxels that the tiles of one level in a view cover.
double columns_in_view(unsigned edge, unsigned level) {
  std::size_t tiles = 0;
  for (std::int32_t x = -kViewRadius; x <= kViewRadius; ++x) {
    for (std::int32_t z = -kViewRadius; z <= kViewRadius; ++z)
      tiles += x * x + z * z <= kViewRadius * kViewRadius ? 1 : 0;
  }
  const auto width = static_cast<double>(std::size_t{edge} << level);
  return static_cast<double>(tiles) * width * width;
}

/// The bytes of the tiles of a view that sees this far in a repeated world.
struct ViewTarget {
  unsigned levels;
  double mb_max;
};
constexpr std::array<ViewTarget, 2> kViewTargets = {ViewTarget{4, 1.0}, ViewTarget{6, 1.3}};
/// Bytes for each column of the tiles of level 1 in a repeated world.
constexpr double kLevel1Max = 0.39;

double per(double sum, std::size_t count) {
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

}  // namespace

std::vector<Target> TilesResult::targets() const {
  std::vector<Target> out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].level != 0) continue;
    double make_us = 0, one_order_us = 0;
    for (std::size_t k = i + 1; k < rows.size() && rows[k].level == k - i; ++k) {
      make_us += rows[k].make_us;
      one_order_us += rows[k].make_one_order_us;
    }
    out.push_back(
        without_target(fmt::format("{}, edge {}: making all tiles against one decoding of "
                                   "the chunks of level 0",
                                   rows[i].world, rows[i].edge),
                       fmt::format("{:.2f}x; {:.2f}x if the chunks have one axis order",
                                   make_us / rows[i].decode_us, one_order_us / rows[i].decode_us)));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].level != 1 || (i != 0 && rows[i - 1].level == 0)) continue;  // of a repeated world
    for (std::size_t k = 0; k < 4; ++k) {
      const TilesRow& row = rows[i + k];
      const double sent = per(static_cast<double>(row.coded_bytes), row.columns);
      const double packed = per(static_cast<double>(row.veiled_bytes), row.columns);
      Target target =
          without_target(fmt::format("{}: bytes of level {} for each column", row.world, row.level),
                         fmt::format("{:.4f}; {:.4f} packed", sent, packed));
      if (row.level == 1) {
        target.wanted = fmt::format("at most {}", kLevel1Max);
        target.verdict = sent <= kLevel1Max ? Verdict::met : Verdict::missed;
      }
      out.push_back(std::move(target));
    }
    for (const ViewTarget& view : kViewTargets) {
      double coded_mb = 0, packed_mb = 0;
      for (std::size_t k = i; k < rows.size() && rows[k].level == k - i + 1; ++k) {
        if (rows[k].level > view.levels) break;
        const double columns = columns_in_view(rows[k].edge, rows[k].level) / 1e6;
        coded_mb += per(static_cast<double>(rows[k].coded_bytes), rows[k].columns) * columns;
        packed_mb += per(static_cast<double>(rows[k].veiled_bytes), rows[k].columns) * columns;
      }
      out.push_back(
          {fmt::format("{}: tiles of a view of {} voxels", rows[i].world,
                       kViewRadius * static_cast<std::int32_t>(rows[i].edge) << view.levels),
           fmt::format("at most {:.1f} MB", view.mb_max),
           fmt::format("{:.2f} MB; {:.2f} MB packed", coded_mb, packed_mb),
           coded_mb <= view.mb_max ? Verdict::met : Verdict::missed});
    }
  }
  return out;
}

Result<TilesResult, std::string> run_tiles_bench(const BenchOptions& options,
                                                 std::ostream& progress) {
  const auto worlds = MeasuredWorlds::open(options.worlds, options.luanti);
  if (!worlds) return failure(worlds.error());
  TilesResult out;
  out.machine = this_machine();
  out.repetitions = options.repetitions;
  for (std::size_t w = 0; w < worlds->size(); ++w) {
    for (const unsigned edge : options.edges) {
      const VoxelWorld& world = *worlds->voxels(w);
      measure(world, edge, options.repetitions, out.rows);
      if (world.bounds) measure_repeated(world, edge, out.rows);
      fmt::print(progress, "{} edge {}\n", worlds->name(w), edge);
      progress.flush();
    }
  }
  return out;
}

namespace {

std::string name_of(const TilesRow& row) {
  return fmt::format("{} | {} | {}", row.world, row.edge, row.level);
}

/// Bytes for each column of voxels at level 0.
std::string bytes_per_column(std::size_t bytes, const TilesRow& row) {
  const double value = per(static_cast<double>(bytes), row.columns);
  return fmt::format("{:.{}f}", value, value < 0.001 ? 6 : 4);
}

/// A mean of a tile, or a dash if it was not measured.
std::string mean_us(double sum, const TilesRow& row) {
  return sum == 0 ? "–" : fmt::format("{:.1f}", per(sum, row.tiles));
}

}  // namespace

void write_table(const TilesResult& result, std::ostream& out) {
  fmt::print(out,
             "\n| world | edge | level | tiles | uniform | runs | runs, veiled | stored | veiled, "
             "packed | sent |\n"
             "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const TilesRow& row : result.rows) {
    fmt::print(out, "| {} | {} | {} | {:.0f} | {:.0f} | {} | {} | {} |\n", name_of(row), row.tiles,
               row.uniform, per(static_cast<double>(row.runs), row.tiles),
               per(static_cast<double>(row.veiled_runs), row.tiles),
               bytes_per_column(row.bytes, row), bytes_per_column(row.veiled_bytes, row),
               bytes_per_column(row.level == 0 ? row.veiled_bytes : row.coded_bytes, row));
  }
  fmt::print(out,
             "\n{} passes over the tiles of a level; times are means of a tile, in µs\n\n"
             "| world | edge | level | make | make, of one order | veil | decode, stored | decode, "
             "packed | decode, sent | decode the children | make / decode | quads | mesh |\n"
             "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
             result.repetitions);
  for (const TilesRow& row : result.rows) {
    if (row.decode_us == 0) continue;  // only the bytes were measured
    fmt::print(
        out, "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.0f} | {} |\n", name_of(row),
        mean_us(row.make_us, row), mean_us(row.make_one_order_us, row), mean_us(row.veil_us, row),
        mean_us(row.decode_stored_us, row), mean_us(row.decode_us, row),
        mean_us(row.decode_coded_us, row), mean_us(row.decode_children_us, row),
        row.decode_children_us == 0 ? "–"
                                    : fmt::format("{:.2f}", row.make_us / row.decode_children_us),
        per(static_cast<double>(row.quads), row.tiles), mean_us(row.mesh_us, row));
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
                            {"coded_bytes", row.coded_bytes},
                            {"quads", row.quads},
                            {"make_us", row.make_us},
                            {"make_one_order_us", row.make_one_order_us},
                            {"veil_us", row.veil_us},
                            {"decode_stored_us", row.decode_stored_us},
                            {"decode_us", row.decode_us},
                            {"decode_coded_us", row.decode_coded_us},
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
