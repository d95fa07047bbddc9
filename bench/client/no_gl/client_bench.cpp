#include "bench/client/client_bench.hpp"

namespace runstone::bench {

Result<ClientBenchResult, std::string> run_client_bench(const ClientBenchOptions&, std::ostream&) {
  return failure("this build has no client, so it cannot draw: build with RUNSTONE_CLIENT=ON");
}

}  // namespace runstone::bench
