// `runstone-bench fan-out`: measures the cost of sending one commit to many clients. The cost of the
// server's sessions is compared with a floor. The floor is the cost of a loop that sends the same
// bytes and only calls OpenSSL or the kernel.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/bench_options.hpp"
#include "bench/harness/machine.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// The processor time of the sending thread, divided by the number of receivers: the median of the
/// rounds, in microseconds. The two senders take turns: each runs a block of rounds.
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

/// Connects options.clients receivers to each sender, without encryption and with it. Sends bodies of
/// several sizes, with a short and a long pause between two rounds. Each sender has one thread that reads
/// for all of its receivers. Fails if the system allows too few open files, or if a receiver cannot
/// connect.
Result<FanOutResult, std::string> run_fan_out_bench(const BenchOptions& options,
                                                    std::ostream& progress);

void write_table(const FanOutResult& result, std::ostream& out);
void write_json(const FanOutResult& result, std::ostream& out);

}  // namespace runstone::bench
