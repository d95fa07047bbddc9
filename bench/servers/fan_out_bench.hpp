// What it costs to send one commit to many clients, beside the floor: the same bytes, sent by a loop
// that only calls OpenSSL or the kernel.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "bench/harness/machine.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Processor time of a receiver in microseconds: medians of the rounds. Both senders are measured in
/// turn, a block of rounds each.
struct FanOutRow {
  std::size_t body_bytes = 0;
  bool is_encrypted = false;
  unsigned pause_ms = 0;  // between two rounds
  double floor_us = 0, sessions_us = 0;
  double ratio() const { return sessions_us / floor_us; }
};

struct FanOutResult {
  Machine machine;
  std::size_t receivers = 0;
  std::vector<FanOutRow> rows;
};

/// Connects `receivers` clients to each sender, without encryption and with it, and sends bodies of
/// several sizes, with and without a pause between two rounds. A thread reads for all clients.
Result<FanOutResult, std::string> run_fan_out_bench(const BenchOptions& options,
                                                    std::ostream& progress);

void write_table(const FanOutResult& result, std::ostream& out);
void write_json(const FanOutResult& result, std::ostream& out);

}  // namespace runstone::bench
