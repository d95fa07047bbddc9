#include "bench/network/memory_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include "server/store/store.hpp"

namespace runstone::bench {
namespace {

constexpr unsigned kCells = 10'000;  // of the real world's bounds, at least
constexpr unsigned kCellsQuick = 1'000;
constexpr double kAllKbMax = 7, kMixedKbMax = 9;  // the targets
constexpr double kLoadSeconds = 300;
constexpr double kSettleSeconds = 2;
constexpr double kKb = 1024;

/// The range of cells that contains the base chunks of a world.
struct Bounds {
  ChunkCoord min, max;  // both inclusive
  std::int32_t x() const { return max.x - min.x + 1; }
  std::int32_t y() const { return max.y - min.y + 1; }
  std::int32_t z() const { return max.z - min.z + 1; }
};

Bounds bounds_of(const std::vector<StoredChunk>& chunks) {
  Bounds out{chunks.front().key.at, chunks.front().key.at};
  for (const StoredChunk& chunk : chunks) {
    const ChunkCoord at = chunk.key.at;
    out.min = {std::min(out.min.x, at.x), std::min(out.min.y, at.y), std::min(out.min.z, at.z)};
    out.max = {std::max(out.max.x, at.x), std::max(out.max.y, at.y), std::max(out.max.z, at.z)};
  }
  return out;
}

/// A world of copies: its size, and the view that contains all of it.
struct Copies {
  std::string world;
  std::size_t cells = 0, mixed = 0;  // mixed: of several materials
  std::int32_t radius_h = 0, radius_v = 0;
};

Result<Copies, std::string> lay_copies(const std::string& from, const std::string& to,
                                       unsigned cells) {
  auto source = open_world(from, StoreAccess::read_only);
  if (!source) return failure(source.error().message());
  const auto chunks = (*source)->base_chunks();
  if (!chunks) return failure(chunks.error().message());
  if (chunks->empty()) return failure("the imported world is empty");
  const Bounds bounds = bounds_of(*chunks);
  const auto of_one = static_cast<double>(bounds.x() * bounds.y() * bounds.z());
  const auto columns = static_cast<std::int32_t>(std::ceil(std::sqrt(cells / of_one)));
  const auto rows = static_cast<std::int32_t>(std::ceil(cells / of_one / columns));

  WorldMeta meta = (*source)->meta();
  const auto edge = static_cast<double>(meta.chunk_edge);
  const std::int32_t width = columns * bounds.x(), depth = rows * bounds.z();
  const std::int32_t middle = bounds.min.y + bounds.y() / 2;
  meta.spawn = {(bounds.min.x + width / 2 + 0.5) * edge, (middle + 0.5) * edge,
                (bounds.min.z + depth / 2 + 0.5) * edge};
  auto target = create_world(to, meta);
  if (!target) return failure(target.error().message());
  Copies out;
  out.world = to;
  out.cells = static_cast<std::size_t>(width * bounds.y() * depth);
  out.radius_h = static_cast<std::int32_t>(std::ceil(std::hypot(width / 2 + 1, depth / 2 + 1)));
  out.radius_v = bounds.y() / 2;
  std::vector<std::pair<ChunkKey, ChunkPtr>> copy(chunks->size());
  for (std::int32_t i = 0; i < columns * rows; ++i) {
    for (std::size_t j = 0; j < chunks->size(); ++j) {
      ChunkKey key = (*chunks)[j].key;
      if (i == 0) {
        auto chunk = (*source)->load_base(key);
        if (!chunk) return failure(chunk.error().message());
        copy[j].second = std::make_shared<const Chunk>(**std::move(chunk));
      }
      key.at.x += i % columns * bounds.x();
      key.at.z += i / columns * bounds.z();
      copy[j].first = key;
      if (!copy[j].second->voxels.is_uniform()) ++out.mixed;
    }
    if (const auto saved = (*target)->save_base(copy); !saved)
      return failure(saved.error().message());
  }
  return out;
}

/// The growth of a server's resident set while a client loaded a view.
struct Growth {
  double bytes = 0, chunks = 0;
};

Result<Growth, std::string> load_view(Testbed& testbed, const std::string& world,
                                      std::vector<std::string> flags, const Copies& copies) {
  auto link = testbed.make_link(test::link_profiles().front());
  if (!link) return failure(link.error());
  flags.insert(flags.end(), {"--view-radius-max", "64"});
  auto server = testbed.start_server(**link, world, flags);
  if (!server) return failure(server.error());
  if (!pause_for(kSettleSeconds)) return failure("interrupted");
  const auto before = static_cast<double>(server->program->resident_bytes());
  const std::string script = testbed.fresh("script.txt");
  write_text(script, fmt::format("wait loaded {}\nquit\n", kLoadSeconds));
  auto client = testbed.start_client(**link, "runstone-client",
                                     {"--connect", server->address, "--no-render", "--no-cache",
                                      "--view", fmt::to_string(copies.radius_h), "--view-vertical",
                                      fmt::to_string(copies.radius_v), "--script", script});
  if (!client) return failure(client.error());
  if (const auto ended = testbed.finish(**client, 2 * kLoadSeconds); !ended)
    return failure(ended.error());
  if (!pause_for(kSettleSeconds)) return failure("interrupted");
  Growth out;
  out.bytes = static_cast<double>(server->program->resident_bytes()) - before;
  if (const auto ended = testbed.stop_server(*server); !ended) return failure(ended.error());
  out.chunks = counter_in(server->program->log(), "chunks_resident");
  if (out.chunks < static_cast<double>(copies.cells)) {
    return failure(fmt::format("{} of {} chunks were in memory", out.chunks, copies.cells));
  }
  return out;
}

}  // namespace

Done measure_memory(Testbed& testbed, NetFindings& findings) {
  const auto imported = testbed.imported_world();
  if (!imported) return failure(imported.error());
  const auto copies = lay_copies(*imported, testbed.fresh("copies"),
                                 testbed.options().quick ? kCellsQuick : kCells);
  if (!copies) return failure(copies.error());
  const auto real = load_view(testbed, copies->world, {}, *copies);
  if (!real) return failure(real.error());
  const auto empty = load_view(testbed, testbed.fresh("empty"), {"--generator", "empty"}, *copies);
  if (!empty) return failure(empty.error());

  const auto cells = static_cast<double>(copies->cells), mixed = static_cast<double>(copies->mixed);
  const double uniform_kb = empty->bytes / kKb / empty->chunks;
  const double all_kb = (real->bytes / kKb - (real->chunks - cells) * uniform_kb) / cells;
  const double mixed_kb = (real->bytes / kKb - (real->chunks - mixed) * uniform_kb) / mixed;
  fmt::format_to(std::back_inserter(findings.tables),
                 "\n### Memory of the server\n\n"
                 "Resident set, before and after a client loaded the real world, "
                 "laid side by side, and as large a view of an empty world.\n\n"
                 "| cells of the real world | of several materials | chunks loaded | grew by MB | "
                 "empty: chunks loaded | grew by MB | KB an empty chunk | KB a cell | "
                 "KB a chunk of several materials |\n"
                 "|---|---|---|---|---|---|---|---|---|\n"
                 "| {} | {} | {:.0f} | {} | {:.0f} | {} | {} | {} | {} |\n",
                 copies->cells, copies->mixed, real->chunks, number_text(real->bytes / 1e6),
                 empty->chunks, number_text(empty->bytes / 1e6), number_text(uniform_kb),
                 number_text(all_kb), number_text(mixed_kb));
  const auto add = [&](const char* name, double value) {
    findings.figures.push_back({"memory", "loopback", "loopback", "real world", name, value});
  };
  add("cells", cells);
  add("mixed", mixed);
  add("loaded", real->chunks);
  add("grown_bytes", real->bytes);
  add("empty_loaded", empty->chunks);
  add("empty_grown_bytes", empty->bytes);
  if (testbed.options().quick) return {};
  const auto target = [&](const char* name, double kb, double most) {
    findings.targets.push_back({name, number_text(most) + " KB", number_text(kb) + " KB",
                                kb <= most ? Verdict::met : Verdict::missed});
  };
  target("server memory a loaded chunk of the real world: of several materials", mixed_kb,
         kMixedKbMax);
  target("the same: all", all_kb, kAllKbMax);
  return {};
}

}  // namespace runstone::bench
