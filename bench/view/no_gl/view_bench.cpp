#include "bench/view/view_bench.hpp"

namespace runstone::bench {

Result<ViewResult, std::string> run_view(const ViewOptions&) {
  return failure("this build has no client, so it cannot draw: build with RUNSTONE_CLIENT=ON");
}

}  // namespace runstone::bench
