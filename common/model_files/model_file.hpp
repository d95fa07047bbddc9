// Reads models from files of other programs: .obj with .mtl, .stl, .ply, .gltf and .glb. The program
// runstone-read-model parses them in a child process with bounded memory and time, because parsers of
// such files have faults. This process decodes only what the child sends, and trusts none of it.
//
//   const auto read = read_model_file("statue.obj", {});
//   if (!read) return error(read.error());  // "statue.obj: needs more than 2 GiB of memory"
//   for (const std::string& notice : read->notices) warn(notice);
//   use(read->model);
//
// Thread: any, several at a time. A call blocks until the child ends, at most the limit of time.
#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "common/core/result.hpp"
#include "common/models/model_bytes.hpp"
#include "common/models/model_format.hpp"

namespace runstone {

struct ModelFileOptions {
  /// The axis of the file that points up. Unset: usual_up() of the format.
  std::optional<ModelUp> up = std::nullopt;
  /// MiB of the child's address space, and of the model in this process; 1 .. 1,048,576. Less than
  /// about 64 is not enough to begin.
  std::uint64_t memory_mib = 2048;
  /// The child is killed after this time; 1 ms .. 1 day.
  std::chrono::milliseconds time_max{std::chrono::minutes(1)};
  /// Triangles that the model may have; 1 .. kModelTrianglesMax.
  std::size_t triangles_max = kModelTrianglesMax;
  /// The child is killed soon after this returns false. Empty: it always goes on.
  std::function<bool()> should_continue = {};
  /// Path of runstone-read-model. If it is empty, the variable RUNSTONE_READ_MODEL names it,
  /// otherwise it is `runstone-read-model` in the folder of the running program.
  std::string program = {};
};

/// Reads a model. The axes of the result are those of a world: x east, y up, z south. The model is
/// valid. Fails with one printable line that begins with the name of the file, if
///   - the file is no regular file, or has no ending of a model;
///   - the child says that it cannot be read, and why;
///   - a limit is exceeded, or the child cannot be started or ends in another way.
Result<ReadModel, std::string> read_model_file(const std::string& file,
                                               const ModelFileOptions& options);

}  // namespace runstone
