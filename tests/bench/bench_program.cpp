#include "tests/bench/bench_program.hpp"

#include <fmt/ostream.h>

#include <fstream>
#include <functional>

#include "tests/bench/bench_options.hpp"
#include "tests/bench/bytes_bench.hpp"
#include "tests/bench/chunk_edge.hpp"
#include "tests/bench/edit_bench.hpp"
#include "tests/bench/log_bench.hpp"
#include "tests/bench/mesh_bench.hpp"
#include "tests/bench/mesh_once.hpp"
#include "tests/bench/net/net_bench.hpp"

namespace runstone::bench {
namespace {

/// Nothing if `file` is empty. Returns whether all went well.
bool write_file(const std::string& file, const std::function<void(std::ostream&)>& write, std::ostream& err) {
  if (file.empty()) return true;
  std::ofstream out(file);
  write(out);
  out.flush();
  if (out) return true;
  fmt::print(err, "runstone-bench: cannot write {}\n", file);
  return false;
}

int mesh(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  const auto result = run_mesh_bench(options, err);
  if (!result) {
    fmt::print(err, "runstone-bench: {}\n", result.error());
    return 1;
  }
  write_machine(result->machine, out);
  fmt::print(out, "{} repetitions of each mesher in each cell, shuffled\n", result->repetitions);
  write_tables(*result, out);
  for (const std::string& cell : result->skipped) fmt::print(out, "\nskipped: {}", cell);
  fmt::print(out, "\n\n");
  write_overview(*result, out);
  fmt::print(out, "\n");
  write_bars(result->bars, out);
  const bool csv = write_file(options.csv, [&](std::ostream& to) { write_csv(*result, to); }, err);
  const bool json = write_file(options.json, [&](std::ostream& to) { write_json(*result, to); }, err);
  return csv && json ? 0 : 1;
}

int chunk_edge(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  const auto rows = run_chunk_edge(options, err);
  if (!rows) {
    fmt::print(err, "runstone-bench: {}\n", rows.error());
    return 1;
  }
  write_machine(this_machine(), out);
  write_table(*rows, out);
  const bool csv = write_file(options.csv, [&](std::ostream& to) { write_csv(*rows, to); }, err);
  const bool json = write_file(options.json, [&](std::ostream& to) { write_json(*rows, to); }, err);
  return csv && json ? 0 : 1;
}

int edits(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  const auto result = run_edit_bench(options, err);
  if (!result) {
    fmt::print(err, "runstone-bench: {}\n", result.error());
    return 1;
  }
  write_machine(result->machine, out);
  write_table(*result, out);
  const bool csv = write_file(options.csv, [&](std::ostream& to) { write_csv(*result, to); }, err);
  const bool json = write_file(options.json, [&](std::ostream& to) { write_json(*result, to); }, err);
  return csv && json ? 0 : 1;
}

int log(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  const auto result = run_log_bench(options, err);
  if (!result) {
    fmt::print(err, "runstone-bench: {}\n", result.error());
    return 1;
  }
  write_machine(this_machine(), out);
  write_table(*result, out);
  return write_file(options.json, [&](std::ostream& to) { write_json(*result, to); }, err) ? 0 : 1;
}

int net(const NetOptions& options, std::ostream& out, std::ostream& err) {
  const auto result = run_net_bench(options, err);
  if (!result) {
    fmt::print(err, "runstone-bench: {}\n", result.error());
    return 1;
  }
  write_tables(*result, out);
  const bool csv = write_file(options.csv, [&](std::ostream& to) { write_csv(*result, to); }, err);
  const bool json = write_file(options.json, [&](std::ostream& to) { write_json(*result, to); }, err);
  return csv && json ? 0 : 1;
}

int bytes(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  const auto result = run_bytes_bench(options, err);
  if (!result) {
    fmt::print(err, "runstone-bench: {}\n", result.error());
    return 1;
  }
  write_machine(result->machine, out);
  write_table(*result, out);
  const bool csv = write_file(options.csv, [&](std::ostream& to) { write_csv(*result, to); }, err);
  const bool json = write_file(options.json, [&](std::ostream& to) { write_json(*result, to); }, err);
  return csv && json ? 0 : 1;
}

int mesh_once(const BenchOptions& options, std::ostream& out, std::ostream& err) {
  const auto done = run_mesh_once(options, out);
  if (!done) fmt::print(err, "runstone-bench: {}\n", done.error());
  return done ? 0 : 1;
}

}  // namespace

int bench_program(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  const ParsedBenchOptions parsed = parse_bench_options(argc, argv, out, err);
  if (!parsed.options) return parsed.exit_code;
  switch (parsed.options->command) {
    case BenchOptions::Command::mesh:
      return mesh(*parsed.options, out, err);
    case BenchOptions::Command::mesh_once:
      return mesh_once(*parsed.options, out, err);
    case BenchOptions::Command::chunk_edge:
      return chunk_edge(*parsed.options, out, err);
    case BenchOptions::Command::bytes:
      return bytes(*parsed.options, out, err);
    case BenchOptions::Command::log:
      return log(*parsed.options, out, err);
    case BenchOptions::Command::edits:
      return edits(*parsed.options, out, err);
    case BenchOptions::Command::net:
      return net(parsed.options->net, out, err);
  }
  return 2;
}

}  // namespace runstone::bench
