// FramesResult: everything that `runstone-bench frames` measures, a row for each mesher in each
// world, as CSV, JSON and tables of Markdown.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/machine.hpp"

namespace runstone::bench {

struct FramesRow {
  std::string world, mesher;
  /// The way to draw:
  /// - "plain": indexed triangles, one vertex format and shader for all meshers;
  /// - "quads": the same shader with packed quads of 8 bytes, an instance each, as the client draws
  ///   them;
  /// - "product": the client's renderer. Its sky, fog and light cost more a pixel, and its picture
  ///   cannot be compared.
  std::string path;
  // A quad has 4, as the thesis counts. Vertices that a triangle mesh shares count once.
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::size_t upload_bytes = 0;
  unsigned frames = 0;  // timed frames
  double p50_ms = 0, p90_ms = 0, p99_ms = 0;
  /// Figures of the plain and quads rows with something to draw: sums over the chunks, each counted
  /// alone, and shares of the triangles.
  std::optional<std::size_t> t_junctions;   // places (tests/reference/t_junctions.hpp)
  std::optional<double> thin_16, thin_100;  // longer than 1:16, 1:100 (thin_triangles.hpp)
  /// Figures of the same rows: means over the pictures.
  std::optional<double> covered_pixels;    // with something drawn in them
  std::optional<double> overdraw;          // fragments that pass the depth test, per covered pixel
  std::optional<double> depth_complexity;  // fragments without a depth test, per covered pixel
  std::optional<double> lanes;             // lanes of 2 x 2 blocks per shaded fragment: 1 .. 4
  std::optional<double> seam_pixels;       // that differ from the picture of culled faces
  // seam pixels inside a plane of that picture (drawn_picture.hpp)
  std::optional<double> pinhole_pixels;

  double fps() const { return 1000 / p50_ms; }
};

/// p50_ms = intercept_ms + ms_per_million_vertices * vertices / 10^6, by least squares.
struct FramesFit {
  double intercept_ms = 0, ms_per_million_vertices = 0;
  double r2 = 0;  // the share of the variance that the line explains
};

struct FramesResult {
  Machine machine;
  std::string gl_renderer, gl_version, gl_context;
  int width = 0, height = 0;
  unsigned frames = 0;    // wanted frames
  unsigned pictures = 0;  // compared pictures of each mesher in each world
  std::vector<FramesRow> rows;
  std::vector<std::string> skipped;  // cells that were not measured, each with the reason

  /// Returns true if the processor draws. Then vertices cost far more, compared with pixels, than
  /// on a GPU.
  bool is_software() const;
  /// Returns the fit over the plain rows, or nullopt if all have the same number of vertices.
  std::optional<FramesFit> fit() const;
};

/// Writes a line of names, then a line for each row. A missing figure is empty.
void write_csv(const FramesResult& result, std::ostream& out);
void write_json(const FramesResult& result, std::ostream& out);

/// Prints the means by mesher over the worlds that all of them drew, the frames a second by world,
/// and the skipped cells.
void write_tables(const FramesResult& result, std::ostream& out);

}  // namespace runstone::bench
