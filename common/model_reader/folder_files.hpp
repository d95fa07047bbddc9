// FolderFiles: gives Assimp the files of a ModelFolder, and remembers what it refused. Assimp writes no
// file through it. Thread: one. Calls block on the disk.
#pragma once
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/model_reader/model_folder.hpp"
#include "common/model_reader/plain_gltf.hpp"

namespace runstone {

class FolderFiles : public Assimp::IOSystem {
 public:
  /// A file that Assimp wanted and did not get.
  struct Refused {
    std::string path;  // any bytes
    ModelFolder::Refusal why;
  };

  /// `folder` must outlive this object.
  explicit FolderFiles(const ModelFolder& folder) : folder_(folder) {}

  /// Gives Assimp this in place of the model, and its floats as kFloatsFile. Call it before Assimp
  /// reads.
  void replace_model(PlainGltf model) { replaced_ = std::move(model); }

  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

  /// Returns the first files that were refused, each once and as the model names it.
  const std::vector<Refused>& refused() const { return refused_; }
  /// Returns true if a file besides the model was opened.
  bool has_opened_others() const { return has_opened_others_; }

 private:
  Result<OpenedFile, ModelFolder::Refusal> open(const std::string& path) const;
  bool is_searched(const std::string& path) const;
  void refuse(const std::string& path, ModelFolder::Refusal why) const;

  const ModelFolder& folder_;
  std::optional<PlainGltf> replaced_;
  mutable std::vector<Refused> refused_;
  bool has_opened_others_ = false;
};

/// Returns the text with the bytes in place of each "%20" and the like, as addresses in .gltf have
/// them.
std::string percent_decoded(const std::string& text);
/// Returns the part of a path behind its last slash or backslash.
std::string last_name(const std::string& path);

}  // namespace runstone
