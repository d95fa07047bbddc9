#include "bench/frames/frames_bench.hpp"

namespace runstone::bench {

Result<FramesResult, std::string> run_frames_bench(const FramesOptions&, std::ostream&) {
  return failure("this build has no client, so it cannot draw: build with RUNSTONE_CLIENT=ON");
}

}  // namespace runstone::bench
