#include "bench/app/bench_program.hpp"

#include <fmt/ostream.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/app/program_options.hpp"
#include "bench/client/client_bench.hpp"
#include "bench/edits/edit_bench.hpp"
#include "bench/edits/log_bench.hpp"
#include "bench/edits/store_bench.hpp"
#include "bench/frames/frames_bench.hpp"
#include "bench/harness/machine_json.hpp"
#include "bench/map/map_bench.hpp"
#include "bench/meshing/chunk_edge.hpp"
#include "bench/meshing/edit_to_mesh.hpp"
#include "bench/meshing/mesh_bench.hpp"
#include "bench/meshing/mesh_once.hpp"
#include "bench/network/net_bench.hpp"
#include "bench/servers/fan_out_bench.hpp"
#include "bench/servers/relay_bench.hpp"
#include "bench/storage/storage_bench.hpp"
#include "bench/thesis/scenario_bench.hpp"
#include "bench/tiles/tiles_bench.hpp"
#include "bench/view/view_bench.hpp"
#include "bench/voxelise/voxelise_bench.hpp"
#include "bench/wire/bytes_bench.hpp"
#include "bench/wire/bytes_to_quads.hpp"
#include "bench/wire/veil_bench.hpp"
#include "common/os/output_file.hpp"

namespace runstone::bench {
namespace {

/// Writes a file. Does nothing if the name is empty. Returns false if the file cannot be written.
bool write_file(const std::string& file, const std::function<void(std::ostream&)>& write,
                std::ostream& err) {
  if (file.empty()) return true;
  std::ostringstream out;
  write(out);
  const auto written = write_output_file(file, out.str());
  if (!written) fmt::print(err, "runstone-bench: {}\n", written.error());
  return written.has_value();
}

/// Prints a result and writes its CSV (if it has one) and its JSON to the files that the options
/// name. Prints the error if there is no result. Returns the exit code.
template <class T, class Options, class Print>
int finish(const Result<T, std::string>& result, const Options& options, std::ostream& err,
           Print&& print) {
  if (!result) {
    fmt::print(err, "runstone-bench: {}\n", result.error());
    return 1;
  }
  print(*result);
  bool done = true;
  if constexpr (requires(std::ostream& to) { write_csv(*result, to); }) {
    done = write_file(options.csv, [&](std::ostream& to) { write_csv(*result, to); }, err);
  }
  return write_file(
             options.json, [&](std::ostream& to) { write_json(*result, to); }, err) &&
                 done
             ? 0
             : 1;
}

int mesh(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_mesh_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    fmt::print(out, "{} repetitions of each mesher in each cell, shuffled\n", result.repetitions);
    write_tables(result, out);
    for (const std::string& cell : result.skipped) fmt::print(out, "\nskipped: {}", cell);
    fmt::print(out, "\n\n");
    write_overview(result, out);
    fmt::print(out, "\n");
    write_targets(result.targets, out);
  });
}

int chunk_edge(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_chunk_edge(options, err), options, err, [&](const auto& rows) {
    write_machine(this_machine(), out);
    write_table(rows, out);
  });
}

int edit_to_mesh(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_edit_to_mesh(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int edits(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_edit_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int log(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_log_bench(options, err), options, err, [&](const auto& result) {
    write_machine(this_machine(), out);
    write_table(result, out);
  });
}

int stores(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_store_bench(options, err), options, err, [&](const auto& result) {
    write_machine(this_machine(), out);
    write_table(result, out);
  });
}

int relay(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_relay_bench(options, err), options, err, [&](const auto& rows) {
    write_machine(this_machine(), out);
    write_table(rows, out);
  });
}

int fan_out(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_fan_out_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int net(const NetOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_net_bench(options, err), options, err,
                [&](const auto& result) { write_tables(result, out); });
}

int bytes(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_bytes_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int bytes_to_quads(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_bytes_to_quads(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int veil(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_veil_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int tiles(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_tiles_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int map(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_map_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int voxelise(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_voxelise_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int frames(const FramesOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_frames_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_tables(result, out);
  });
}

int view(const ViewOptions& options, std::ostream& out, std::ostream& err) {
  const auto result = run_view(options);
  if (!result) {
    fmt::print(err, "runstone-bench: {}\n", result.error());
    return 1;
  }
  write_machine(this_machine(), out);
  write_table(*result, out);
  return 0;
}

int client(const ClientBenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_client_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_tables(result, out);
  });
}

int storage(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  return finish(run_storage_bench(options, err), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    fmt::print(out, "{} repetitions of each store on each volume, shuffled; Morton codes by {}\n",
               result.repetitions, result.morton_code);
    write_tables(result, out);
    for (const std::string& cell : result.skipped) fmt::print(out, "\nskipped: {}\n", cell);
  });
}

int mesh_once(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  const auto done = run_mesh_once(options, out);
  if (!done) fmt::print(err, "runstone-bench: {}\n", done.error());
  return done ? 0 : 1;
}

int scenarios(const ScenarioTable& table, const BenchOptions& options, std::ostream& out,
              std::ostream& err) {
  return finish(Result<ScenarioTable, std::string>(table), options, err, [&](const auto& result) {
    write_machine(result.machine, out);
    write_table(result, out);
  });
}

int machine(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  const Machine machine = this_machine();
  write_machine(machine, out);
  const auto write = [&](std::ostream& to) { to << json_of(machine).dump(1) << '\n'; };
  return write_file(options.json, write, err) ? 0 : 1;
}

}  // namespace

int bench_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  const ParsedProgramOptions parsed = parse_program_options(argc, argv, out, err);
  if (!parsed.options) return parsed.exit_code;
  const ProgramOptions& options = *parsed.options;
  switch (options.command) {
    case Command::mesh:
      return mesh(options.bench, out, err);
    case Command::mesh_once:
      return mesh_once(options.bench, out, err);
    case Command::edit_to_mesh:
      return edit_to_mesh(options.bench, out, err);
    case Command::storage:
      return storage(options.bench, out, err);
    case Command::chunk_edge:
      return chunk_edge(options.bench, out, err);
    case Command::bytes:
      return bytes(options.bench, out, err);
    case Command::bytes_to_quads:
      return bytes_to_quads(options.bench, out, err);
    case Command::veil:
      return veil(options.bench, out, err);
    case Command::tiles:
      return tiles(options.bench, out, err);
    case Command::voxelise:
      return voxelise(options.bench, out, err);
    case Command::map:
      return map(options.bench, out, err);
    case Command::log:
      return log(options.bench, out, err);
    case Command::stores:
      return stores(options.bench, out, err);
    case Command::relay:
      return relay(options.bench, out, err);
    case Command::fan_out:
      return fan_out(options.bench, out, err);
    case Command::edits:
      return edits(options.bench, out, err);
    case Command::net:
      return net(options.net, out, err);
    case Command::frames:
      return frames(options.frames, out, err);
    case Command::view:
      return view(options.view, out, err);
    case Command::client:
      return client(options.client, out, err);
    case Command::scenario_facts:
      return scenarios(scenario_facts(err), options.bench, out, err);
    case Command::scenario_times:
      return scenarios(scenario_times(options.bench.repetitions, err), options.bench, out, err);
    case Command::machine:
      return machine(options.bench, out, err);
  }
  return 2;
}

}  // namespace runstone::bench
