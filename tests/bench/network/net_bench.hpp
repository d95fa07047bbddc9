// `runstone-bench net`: the network lab.
#pragma once
#include <iosfwd>

#include "common/core/result.hpp"
#include "tests/bench/harness/machine.hpp"
#include "tests/bench/network/lab.hpp"
#include "tests/bench/network/net_options.hpp"

namespace runstone::bench {

struct NetResult {
  Machine machine;
  std::string link;  // which kind was used, and why not a better one
  LabFindings findings;
};

/// Runs the experiments that were asked for, one after another. Starts programs of ours, which have to lie beside this
/// one; with the rights to do so it makes network namespaces, which are gone with it. Progress goes to `progress`.
/// Fails if namespaces were asked for and cannot be had, if a program fails, or if it is interrupted.
Result<NetResult, std::string> run_net_bench(const NetOptions& options, std::ostream& progress);

void write_tables(const NetResult& result, std::ostream& out);
void write_csv(const NetResult& result, std::ostream& out);
void write_json(const NetResult& result, std::ostream& out);

}  // namespace runstone::bench
