// FramesResult: everything that `runstone-bench frames` measured, a row for each mesher in each world, as
// CSV, JSON and tables of Markdown.
#pragma once
#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/harness/machine.hpp"

namespace runstone::bench {

struct FramesRow {
  std::string world, mesher;
  /// "plain": indexed triangles, one vertex format and shader for all meshers. "quads": the same shader, but
  /// packed quads of 8 bytes, an instance each, as the client draws them. "product": the client's renderer,
  /// whose sky, fog and light cost more a pixel, and whose picture cannot be compared.
  std::string path;
  std::size_t vertices =
      0;  // 4 a quad, as the thesis counts; those that a triangle mesh shares count once
  std::size_t triangles = 0;
  std::size_t upload_bytes = 0;
  unsigned frames = 0;  // timed
  double p50_ms = 0, p90_ms = 0, p99_ms = 0;
  /// Of plain and quads rows with something to draw. Sums over the chunks, each for itself; shares of the triangles.
  std::optional<std::size_t> t_junctions;   // places (tests/reference/t_junctions.hpp)
  std::optional<double> thin_16, thin_100;  // longer than 1:16, 1:100 (thin_triangles.hpp)
  /// Likewise; means over the pictures.
  std::optional<double> covered_pixels;    // with something drawn in them
  std::optional<double> overdraw;          // fragments that pass the depth test, a covered pixel
  std::optional<double> depth_complexity;  // fragments without a depth test, a covered pixel
  std::optional<double> lanes;             // lanes of 2 x 2 blocks that shade a fragment: 1 .. 4
  std::optional<double> seam_pixels;       // unlike the picture of culled faces
  std::optional<double> pinhole_pixels;  // of these, those inside a plane of it (drawn_picture.hpp)

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
  unsigned frames = 0;    // asked for
  unsigned pictures = 0;  // of each mesher in each world, compared
  std::vector<FramesRow> rows;
  std::vector<std::string> skipped;  // what was not measured, each with the reason

  /// Whether the processor draws: then vertices cost far more, beside pixels, than on a GPU.
  bool is_software() const;
  /// Over the plain rows. None if they all have the same number of vertices.
  std::optional<FramesFit> fit() const;
};

/// One line of names, then one a row. Empty where there is no figure.
void write_csv(const FramesResult& result, std::ostream& out);
void write_json(const FramesResult& result, std::ostream& out);

/// Means by mesher over the worlds that all of them drew, then frames a second by world, then what was
/// skipped.
void write_tables(const FramesResult& result, std::ostream& out);

}  // namespace runstone::bench
