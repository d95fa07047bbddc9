// GltfBuffers: the bytes of the buffers of a .gltf or .glb, wherever they lie: in the second chunk,
// in the text as base64, or in a file beside the model. Thread: one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "common/model_reader/gltf_head.hpp"
#include "common/model_reader/model_folder.hpp"

namespace runstone {

class GltfBuffers {
 public:
  /// Keeps references. `buffers` is the array of the JSON; `head` is that of `file`.
  GltfBuffers(const ModelFolder& folder, const OpenedFile& file, const GltfHead& head,
              const nlohmann::json& buffers)
      : folder_(folder), file_(file), head_(head), buffers_(buffers) {}

  /// Reads `count` bytes of a buffer from `offset`. Fails if the buffer does not exist, cannot be
  /// opened, or ends before. The error is one line. Throws nlohmann::json::exception if the JSON is
  /// none of glTF.
  Result<void, std::string> read(std::uint64_t buffer, std::uint64_t offset, void* to,
                                 std::size_t count);

 private:
  struct Source {
    std::string bytes;               // of a buffer in the text
    std::optional<OpenedFile> file;  // of a buffer beside the model
    bool is_chunk = false;           // in the second chunk of the file
  };
  Result<Source, std::string> open(const nlohmann::json& buffer);

  const ModelFolder& folder_;
  const OpenedFile& file_;
  const GltfHead& head_;
  const nlohmann::json& buffers_;
  std::map<std::uint64_t, Source> sources_;
};

/// Returns the bytes of base64 with or without padding, or nullopt if another character is in it.
std::optional<std::string> base64_decoded(std::string_view text);

}  // namespace runstone
