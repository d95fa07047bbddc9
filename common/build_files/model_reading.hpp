// ModelReading: how a file of triangles or points becomes a build (docs/models.md).
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "common/formats/rsb_build.hpp"
#include "common/model_files/model_file.hpp"
#include "common/voxelise/voxelise.hpp"

namespace runstone {

inline constexpr std::uint32_t kModelVoxelsUsual = 128;

struct ModelReading {
  /// Voxels of the longest side, 1 .. kVoxeliseSideMax.
  std::uint32_t voxels = kModelVoxelsUsual;
  /// In place of `voxels`. In a format without units a unit is a metre.
  std::optional<double> voxels_per_metre = std::nullopt;
  /// The inside is filled. A model that is no closed surface is filled by its winding number.
  bool is_solid = true;
  /// The surface that is set besides the inside. A solid with a surface is up to a voxel thicker, and
  /// keeps walls in which no voxel has its centre. If it is unset, a solid model gets no surface. A
  /// hollow model, and one in which no voxel is inside, then gets a thin one.
  std::optional<SurfaceMode> surface = std::nullopt;
  /// Where closed parts overlap, the inside is filled, too.
  bool fills_overlaps = false;
  /// Quarter turns about the axis that points up, 0 .. 3, to the left as seen from above.
  int quarters = 0;
  ModelFileOptions file;
};

/// Returns the surface of a word: none, thin, thick or all. nullopt: it is no such word.
std::optional<SurfaceMode> surface_of_word(std::string_view word);

/// Takes a line for the person who reads a file, such as "the mesh is open".
using ReadNotice = std::function<void(const std::string&)>;

/// Returns true if the ending of a file is that of a model.
bool is_model_file(std::string_view file);
/// The endings of models, for messages: ".obj, .stl, .ply, .gltf, .glb".
std::string model_endings();

/// Reads a model in a child process, and makes a build of it, whose materials are its colours. The error
/// is one line that begins with the name of the file. Blocks on the child. Memory: the model, and
/// `bytes_max` of the build.
Result<FileBuild, std::string> read_model_build(const std::string& file,
                                                const ModelReading& reading, std::size_t bytes_max,
                                                const ReadNotice& notice);

}  // namespace runstone
