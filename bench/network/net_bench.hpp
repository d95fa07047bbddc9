// `runstone-bench net`: experiments with the network.
#pragma once
#include <iosfwd>

#include "bench/harness/machine.hpp"
#include "bench/network/net_options.hpp"
#include "bench/network/testbed.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

struct NetResult {
  Machine machine;
  std::string link;  // the kind of link, and the reason if it is not the better one
  NetFindings findings;
};

/// Runs the wanted experiments one after another. Starts programs of the product, which must lie
/// beside this one. Makes network namespaces if it has the rights; they disappear with it. Prints
/// progress to `progress`. Fails if namespaces are wanted and cannot be made, if a program fails,
/// or if it is interrupted.
Result<NetResult, std::string> run_net_bench(const NetOptions& options, std::ostream& progress);

void write_tables(const NetResult& result, std::ostream& out);
void write_csv(const NetResult& result, std::ostream& out);
void write_json(const NetResult& result, std::ostream& out);

}  // namespace runstone::bench
