#include "bench/voxelise/voxelise_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/harness/machine_json.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/voxelise/dense_voxeliser.hpp"
#include "bench/voxelise/oracle_sample.hpp"
#include "bench/voxelise/peak_memory.hpp"
#include "common/core/hash.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "common/voxelise/voxelise.hpp"
#include "tests/support/voxelise/meshes.hpp"

namespace runstone::bench {
namespace {

constexpr const char* kSolid = "solid";
constexpr const char* kByteGrid = "solid, byte grid";
constexpr const char* kColoured = "solid, coloured";
/// The targets are for a statue of about a million triangles at this side.
constexpr unsigned kTargetSide = 1024;
constexpr std::size_t kTargetTriangles = 900'000;
/// The tests of a triangle that a sample of voxels may cost the oracle: some seconds.
constexpr std::size_t kOracleTests = 200'000'000;
constexpr double kTargetSeconds = 10, kTargetTimes = 3, kTargetMemoryTimes = 4;
constexpr std::uint64_t kTargetBytes = std::uint64_t{256} << 20;

using VoxeliseWay = std::function<Result<Voxelised>(const VoxelPieceSink&)>;

/// Measures a way. The digest of the pieces is made, and the sample is taken, in a call of its own,
/// whose time does not count.
Result<VoxeliseRow, std::string> measure_way(const std::string& name, const VoxeliseWay& way,
                                             unsigned repetitions, std::uint64_t& digest,
                                             OracleSample& sample, OracleShape shape) {
  VoxeliseRow row;
  row.way = name;
  digest = 0;
  sample.begin();
  auto done = way([&](VoxelPiece&& piece) -> Result<void> {
    sample.take(piece);
    row.runs += piece.voxels.runs.size();
    row.run_bytes += piece.voxels.runs.byte_size();
    for (std::size_t i = 0; i < piece.voxels.runs.size(); ++i)
      digest = mix64(
          digest ^ (std::uint64_t{piece.voxels.runs.end(i)} << 16 | piece.voxels.runs.material(i)));
    return {};
  });
  if (!done) return failure(std::string(done.error().what));
  row.voxels = done->voxels;
  row.compared = sample.count();
  row.differing = sample.differing(shape);
  std::vector<double> cpu, wall;
  for (unsigned i = 0; i < repetitions; ++i) {
    const PeakMemory memory;
    const auto start = std::chrono::steady_clock::now();
    const std::int64_t cpu_start = thread_cpu_ns();
    done = way([](VoxelPiece&&) -> Result<void> { return {}; });
    cpu.push_back(static_cast<double>(thread_cpu_ns() - cpu_start) / 1e9);
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (!done) return failure(std::string(done.error().what));
    row.peak_bytes = std::max(row.peak_bytes, memory.bytes());
  }
  row.cpu_s = median(cpu);
  row.wall_s = median(wall);
  return row;
}

std::uint64_t bytes_of(const Model& mesh) {
  return mesh.positions.size() * sizeof(mesh.positions[0]) +
         mesh.triangles.size() * sizeof(mesh.triangles[0]) +
         mesh.colours.size() * sizeof(mesh.colours[0]);
}

/// Gives each vertex a colour, so that the statue has many.
Model coloured_statue(Model mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const std::uint64_t bits = mix64(i / 64);
    mesh.colours.push_back({static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
                            static_cast<std::uint8_t>(bits >> 16), 255});
  }
  return mesh;
}

const VoxeliseRow* target_row(const VoxeliseResult& result, const char* way) {
  const VoxeliseRow* out = nullptr;
  for (const VoxeliseRow& row : result.rows) {
    if (row.way == way && row.side == kTargetSide && row.triangles > kTargetTriangles) out = &row;
  }
  return out;
}

Verdict verdict_if(bool met) { return met ? Verdict::met : Verdict::missed; }

}  // namespace

std::vector<Target> VoxeliseResult::targets() const {
  const VoxeliseRow* runs = target_row(*this, kSolid);
  const VoxeliseRow* grid = target_row(*this, kByteGrid);
  if (runs == nullptr || grid == nullptr) return {};
  const double times = grid->cpu_s / runs->cpu_s;
  const auto with_model = [](const VoxeliseRow& row) { return row.model_bytes + row.peak_bytes; };
  const double memory_times =
      static_cast<double>(with_model(*grid)) / static_cast<double>(with_model(*runs));
  const std::uint64_t bytes_max = kTargetBytes + 5 * runs->run_bytes;
  return {
      {"10^6 triangles into 1024^3, one core", fmt::format("{:.0f} s", kTargetSeconds),
       fmt::format("{:.2f} s", runs->cpu_s), verdict_if(runs->cpu_s <= kTargetSeconds)},
      {"peak memory, with the triangles", fmt::format("{} MB", bytes_max / 1'000'000),
       fmt::format("{} MB", with_model(*runs) / 1'000'000),
       verdict_if(with_model(*runs) <= bytes_max)},
      {"faster than the byte grid", fmt::format("{:.0f} times", kTargetTimes),
       fmt::format("{:.1f} times", times), verdict_if(times >= kTargetTimes)},
      {"less memory than the byte grid, with the triangles",
       fmt::format("{:.0f} times", kTargetMemoryTimes), fmt::format("{:.1f} times", memory_times),
       verdict_if(memory_times >= kTargetMemoryTimes)}};
}

Result<VoxeliseResult, std::string> run_voxelise_bench(const BenchOptions& options,
                                                       std::ostream& progress) {
  VoxeliseResult result;
  result.machine = this_machine();
  result.repetitions = options.repetitions;
  for (const std::size_t triangles : options.triangles) {
    const Model plain = test::statue_mesh(triangles);
    const Model coloured = coloured_statue(plain);
    for (const unsigned side : options.edges) {
      OracleSample sample(
          plain, side, std::clamp<std::size_t>(kOracleTests / plain.triangles.size(), 200, 20'000));
      const auto add = [&](const std::string& name, const VoxeliseWay& way, std::uint64_t& digest,
                           OracleShape shape = OracleShape::none) -> Result<void, std::string> {
        auto row = measure_way(name, way, options.repetitions, digest, sample, shape);
        if (!row) return failure(row.error());
        row->triangles = plain.triangles.size();
        row->model_bytes = bytes_of(name == kColoured ? coloured : plain);
        row->side = side;
        fmt::print(progress, "{}: {} triangles, {} voxels\n", name, row->triangles, side);
        result.rows.push_back(*std::move(row));
        return {};
      };
      VoxeliseOptions solid;
      solid.scale.longest_side = side;
      std::uint64_t of_runs = 0, of_grid = 0, unused = 0;
      if (auto added = add(
              kSolid, [&](const auto& sink) { return voxelise(plain, solid, sink); }, of_runs);
          !added)
        return failure(added.error());
      if (auto added = add(
              kByteGrid, [&](const auto& sink) { return dense_voxelise(plain, solid, sink); },
              of_grid);
          !added)
        return failure(added.error());
      if (of_runs != of_grid) return failure("the byte grid has other voxels");
      if (auto added = add(
              kColoured, [&](const auto& sink) { return voxelise(coloured, solid, sink); }, unused);
          !added)
        return failure(added.error());
      for (const auto& [name, mode] :
           {std::pair{"surface, conservative", SurfaceMode::conservative},
            std::pair{"surface, 26-separating", SurfaceMode::separating_26},
            std::pair{"surface, 6-separating", SurfaceMode::separating_6}}) {
        VoxeliseOptions surface = solid;
        surface.is_solid = false;
        surface.surface = mode;
        if (auto added = add(
                name, [&](const auto& sink) { return voxelise(plain, surface, sink); }, unused,
                mode);
            !added)
          return failure(added.error());
      }
    }
  }
  return result;
}

void write_table(const VoxeliseResult& result, std::ostream& out) {
  fmt::print(
      out,
      "\n| mesh into | triangles | longest side | processor s | s | peak MB besides the mesh "
      "| voxels | runs | "
      "MB of runs | wrong, of those compared |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const VoxeliseRow& row : result.rows) {
    fmt::print(out, "| {} | {} | {} | {:.3f} | {:.3f} | {:.1f} | {} | {} | {:.1f} | {} of {} |\n",
               row.way, row.triangles, row.side, row.cpu_s, row.wall_s,
               static_cast<double>(row.peak_bytes) / 1e6, row.voxels, row.runs,
               static_cast<double>(row.run_bytes) / 1e6, row.differing, row.compared);
  }
  fmt::print(out, "\n");
  write_targets(result.targets(), out);
}

void write_json(const VoxeliseResult& result, std::ostream& out) {
  nlohmann::ordered_json json = {{"machine", json_of(result.machine)},
                                 {"repetitions", result.repetitions}};
  for (const VoxeliseRow& row : result.rows) {
    json["rows"].push_back({{"way", row.way},
                            {"triangles", row.triangles},
                            {"side", row.side},
                            {"cpu_s", row.cpu_s},
                            {"wall_s", row.wall_s},
                            {"model_bytes", row.model_bytes},
                            {"peak_bytes", row.peak_bytes},
                            {"voxels", row.voxels},
                            {"runs", row.runs},
                            {"run_bytes", row.run_bytes},
                            {"compared", row.compared},
                            {"differing", row.differing}});
  }
  out << json.dump(1) << '\n';
}

}  // namespace runstone::bench
