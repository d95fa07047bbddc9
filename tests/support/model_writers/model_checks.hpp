// ModelChecks: writes builds as models, reads them with the plain reader, and compares their
// triangles with the build cell by cell.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/formats/rsb_build.hpp"
#include "common/model_writers/model_writing.hpp"
#include "tests/support/model_writers/written_model.hpp"

namespace runstone::test {

/// The endings of models that are written.
const std::vector<std::string>& model_endings_written();

/// Returns the bytes of a file.
Bytes model_bytes(const std::string& file, const FileBuild& build, const ModelWriting& writing);

/// Writes a build in the format of an ending, and reads it.
WrittenModel model_of(const std::string& ending, const FileBuild& build,
                      const ModelWriting& writing = {});

/// A unit face: the cell and the direction of its face. The value is its colour.
using CellFace = std::tuple<int, int, int, int>;
using CellFaces = std::map<CellFace, std::string>;

/// Returns the exposed faces of a build with their colours, cell by cell, as if every material were
/// a cube.
CellFaces exposed_cell_faces(const FileBuild& build);

/// Checks that the triangles cover each face exactly once, in its colour, and nothing else: by
/// points of each face that lie on no edge, and by the sum of the areas. `scale` is the side of a
/// cell in the model.
void check_faces(const CellFaces& expected, const WrittenModel& model, double scale = 1);
inline void check_faces(const FileBuild& build, const WrittenModel& model, double scale = 1) {
  check_faces(exposed_cell_faces(build), model, scale);
}

/// Return how many directed edges have another number of opposites, by the places of their ends and
/// by their vertices.
std::size_t open_edges_by_place(const WrittenModel& model);
std::size_t open_edges_by_vertex(const WrittenModel& model);

}  // namespace runstone::test
