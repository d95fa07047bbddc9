#include "bench/map/map_bench.hpp"

#include <fmt/ostream.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "bench/harness/machine_json.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/map/map_worlds.hpp"
#include "common/core/hash.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "server/map/map_world.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"

namespace runstone::bench {
namespace {

constexpr double kPresentMsMax = 20, kPastMsMax = 100, kWholeMsMax = 3'000;
constexpr std::size_t kCacheBytes = std::size_t{128} << 20;
constexpr const char* kPresent = "the present, from stored chunks";
constexpr const char* kPast = "a moment of the log's first tenth, with opening it";

using Clock = std::chrono::steady_clock;
using Picture = std::shared_ptr<const std::string>;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double cpu_ms_since(std::int64_t start_ns) {
  return static_cast<double>(thread_cpu_ns() - start_ns) / 1e6;
}

/// The size and the time of the last change of each file, without the one in which readers of SQLite
/// share their locks.
using Files = std::map<std::string, std::pair<std::uintmax_t, std::filesystem::file_time_type>>;

Files files_in(const std::string& folder) {
  Files out;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    if (!name.ends_with("-shm")) out[name] = {file.file_size(), file.last_write_time()};
  }
  return out;
}

/// A world that is drawn, with caches that can be emptied.
struct DrawnWorld {
  explicit DrawnWorld(const std::string& folder_) : folder(folder_), world(folder_, caches) {}
  /// Opens the world.
  Result<void, std::string> open() {
    const auto opened = world.refresh(1, 0);
    if (!opened) return failure(opened.error().message());
    return {};
  }
  StoreResult<Picture> draw(const MapMoment& moment, const MapPlace& place) {
    return world.draw(moment, place, [] { return true; });
  }
  const std::string folder;
  MapCaches caches{kCacheBytes};
  MapWorld world;
};

/// Adds the times of tiles that `draw` draws.
template <class Draw>
Result<MapTimes, std::string> time_tiles(const char* what, unsigned count, DrawnWorld& drawn,
                                         Draw&& draw) {
  SplitMix64 rng(5);
  MapTimes out;
  out.what = what;
  out.tiles = count;
  std::vector<double> times, cpu_times;
  for (unsigned i = 0; i < count; ++i) {
    const MapPlace place{0, rng.between(-1, 0), rng.between(-1, 0)};
    drawn.caches.clear();
    const auto start = Clock::now();
    const std::int64_t cpu_start = thread_cpu_ns();
    const StoreResult<Picture> picture = draw(place, rng);
    cpu_times.push_back(cpu_ms_since(cpu_start));
    times.push_back(ms_since(start));
    if (!picture) return failure(picture.error().message());
    out.bytes += static_cast<double>((*picture)->size()) / count;
  }
  out.median_ms = median(times);
  out.cpu_ms = median(cpu_times);
  out.slowest_ms = quantile(times, 1);
  return out;
}

Result<void, std::string> draw_stored(const BenchOptions& options, MapResult& result,
                                      std::ostream& progress) {
  const test::TempFolder temp;
  const std::string folder = temp / "world";
  const auto chunks = make_stored_world(folder, options.edits);
  if (!chunks) return failure(chunks.error());
  result.chunks = *chunks;
  fmt::print(progress, "the world of stored chunks is there\n");
  DrawnWorld drawn(folder);
  if (auto opened = drawn.open(); !opened) return opened;
  auto present = time_tiles(
      kPresent, options.repetitions, drawn,
      [&](const MapPlace& place, SplitMix64&) { return drawn.draw(drawn.world.present(), place); });
  if (!present) return failure(present.error());
  result.times.push_back(*std::move(present));
  const auto reader = open_world(folder, StoreAccess::read_only);
  if (!reader) return failure(reader.error().message());
  const auto generator = make_generator((*reader)->meta().generator, (*reader)->meta().materials);
  if (!generator) return failure(generator.error().what);
  auto past = time_tiles(kPast, options.repetitions, drawn,
                         [&](const MapPlace& place, SplitMix64& rng) -> StoreResult<Picture> {
                           const Sequence at = 1 + rng.next() % (options.edits / 10);
                           const auto moment = MapMoment::open(folder, **generator, at);
                           if (!moment) return failure(moment.error());
                           return drawn.draw(**moment, place);
                         });
  if (!past) return failure(past.error());
  result.times.push_back(*std::move(past));
  return {};
}

/// Returns the tiles of a zoom that meet the box.
std::vector<MapPlace> places_of(const VoxelBox& box, std::uint8_t zoom) {
  const std::int32_t width = kMapTileSide << zoom;
  std::vector<MapPlace> out;
  for (std::int32_t z = floor_div(box.min.z, width); z * width < box.max.z; ++z) {
    for (std::int32_t x = floor_div(box.min.x, width); x * width < box.max.x; ++x)
      out.push_back({zoom, x, z});
  }
  return out;
}

Result<void, std::string> draw_luanti(const BenchOptions& options, MapResult& result,
                                      std::ostream& progress) {
  const test::TempFolder temp;
  const std::string folder = temp / "world";
  const auto bounds = make_luanti_world(folder, options.luanti);
  if (!bounds) return failure(bounds.error());
  fmt::print(progress, "the Luanti world is there\n");
  std::vector<double> times, cpu_times;
  for (unsigned i = 0; i < options.repetitions; ++i) {
    // A server that runs the world holds these files open.
    const auto server = open_world(folder, StoreAccess::read_write);
    if (!server) return failure(server.error().message());
    const Files before = files_in(folder);
    const auto start = Clock::now();
    const std::int64_t cpu_start = thread_cpu_ns();
    DrawnWorld drawn(folder);
    if (auto opened = drawn.open(); !opened) return opened;
    result.whole_tiles = 0;
    for (std::uint8_t zoom = 0; zoom <= kMapZoomMax; ++zoom) {
      for (const MapPlace& place : places_of(*bounds, zoom)) {
        const auto picture = drawn.draw(drawn.world.present(), place);
        if (!picture) return failure(picture.error().message());
        ++result.whole_tiles;
      }
    }
    cpu_times.push_back(cpu_ms_since(cpu_start));
    times.push_back(ms_since(start));
    result.writes += files_in(folder) == before ? 0 : 1;
  }
  result.whole_ms = median(times);
  result.whole_cpu_ms = median(cpu_times);
  return {};
}

Target at_most(const std::string& what, double measured, double wanted) {
  return {what, fmt::format("{:.0f} ms", wanted), fmt::format("{:.1f} ms", measured),
          measured <= wanted ? Verdict::met : Verdict::missed};
}

}  // namespace

std::vector<Target> MapResult::targets() const {
  std::vector<Target> out;
  for (const MapTimes& each : times)
    out.push_back(
        at_most(each.what, each.median_ms, each.what == kPresent ? kPresentMsMax : kPastMsMax));
  out.push_back(at_most("the whole Luanti world, all zooms", whole_ms, kWholeMsMax));
  out.push_back({"drawings that changed a file in the world's folder", "0", std::to_string(writes),
                 writes == 0 ? Verdict::met : Verdict::missed});
  return out;
}

Result<MapResult, std::string> run_map_bench(const BenchOptions& options, std::ostream& progress) {
  MapResult result;
  result.machine = this_machine();
  result.repetitions = options.repetitions;
  result.edits = options.edits;
  if (auto drawn = draw_stored(options, result, progress); !drawn) return failure(drawn.error());
  if (auto drawn = draw_luanti(options, result, progress); !drawn) return failure(drawn.error());
  return result;
}

void write_table(const MapResult& result, std::ostream& out) {
  fmt::print(out, "{} stored chunks, {} edits; tiles of 512 x 512 pixels, caches empty\n\n",
             result.chunks, result.edits);
  fmt::print(out,
             "| tile of | tiles | median ms | slowest ms | processor ms | bytes |\n"
             "|---|---|---|---|---|---|\n");
  for (const MapTimes& each : result.times) {
    fmt::print(out, "| {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.0f} |\n", each.what, each.tiles,
               each.median_ms, each.slowest_ms, each.cpu_ms, each.bytes);
  }
  fmt::print(
      out,
      "\nThe whole Luanti world, {} tiles of all zooms: {:.0f} ms ({:.0f} ms of the processor), {} "
      "drawings that changed a file\n\n",
      result.whole_tiles, result.whole_ms, result.whole_cpu_ms, result.writes);
  write_targets(result.targets(), out);
}

void write_json(const MapResult& result, std::ostream& out) {
  nlohmann::ordered_json json = {{"machine", json_of(result.machine)},
                                 {"repetitions", result.repetitions},
                                 {"edits", result.edits},
                                 {"chunks", result.chunks},
                                 {"whole_tiles", result.whole_tiles},
                                 {"whole_ms", result.whole_ms},
                                 {"whole_cpu_ms", result.whole_cpu_ms},
                                 {"writes", result.writes}};
  for (const MapTimes& each : result.times) {
    json["times"].push_back({{"what", each.what},
                             {"tiles", each.tiles},
                             {"median_ms", each.median_ms},
                             {"slowest_ms", each.slowest_ms},
                             {"cpu_ms", each.cpu_ms},
                             {"bytes", each.bytes}});
  }
  out << json.dump(1) << '\n';
}

}  // namespace runstone::bench
