// ModelReading: how a file of triangles or points becomes a build (docs/models.md).
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "common/formats/rsb_build.hpp"
#include "common/model_files/model_file.hpp"
#include "common/models/model_choices.hpp"

namespace runstone {

struct ModelReading : ModelChoices {
  /// `file.up` is not used: ModelChoices has it.
  ModelFileOptions file;
  /// Takes the share of the voxels that are made, above 0 .. 1, on the thread of the call. It is
  /// not called while the file is read. Empty: nobody wants to know.
  std::function<void(double share)> progress = {};
};

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
