#include <fmt/ostream.h>

#include "bench/view/view_bench.hpp"

namespace runstone::bench {

void write_table(const ViewResult& result, std::ostream& out) {
  fmt::print(out, "{}: {} chunks; {}\n\n", result.world, result.chunks, result.renderer);
  fmt::print(out, "| mesher | quads | bytes on the GPU | µs to mesh | of that | µs to draw |\n");
  fmt::print(out, "|---|---|---|---|---|---|\n");
  for (const ViewRow& row : result.rows) {
    fmt::print(out, "| {} | {} | {} | {:.0f} | {} | {:.0f} |\n", row.mesher, row.quads,
               row.gpu_bytes, row.mesh_us, row.timed, row.draw_us);
  }
}

}  // namespace runstone::bench
