// `runstone-bench view`: the same chunks three times side by side, drawn by the client's renderer:
// culled faces, binary greedy and RDM, with the edges of their quads.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "bench/view/view_options.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

struct ViewRow {
  std::string mesher, timed;
  std::size_t quads = 0, gpu_bytes = 0;
  double mesh_us = 0;  // to mesh all chunks; the median
  double draw_us = 0;  // to draw a frame of its part, with all effects; the median
};
struct ViewResult {
  std::string world, renderer;
  std::size_t chunks = 0;
  std::vector<ViewRow> rows;
};

/// Draws a PNG file, or shows a window until it is closed; the mouse turns the chunks and the wheel
/// comes nearer. Fails if there is no OpenGL or no display, if the world cannot be read, or if the
/// file cannot be written.
Result<ViewResult, std::string> run_view(const ViewOptions& options);

/// Prints a table of Markdown.
void write_table(const ViewResult& result, std::ostream& out);

}  // namespace runstone::bench
