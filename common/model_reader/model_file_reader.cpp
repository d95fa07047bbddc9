#include "common/model_reader/model_file_reader.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "common/model_reader/folder_files.hpp"
#include "common/model_reader/gltf_extensions.hpp"
#include "common/model_reader/plain_gltf.hpp"
#include "common/model_reader/ply_reader.hpp"

namespace runstone {
namespace {

constexpr std::size_t kAssimpLineBytesMax = 200;

bool is_parser_of(const aiImporterDesc& parser, ModelFormat format) {
  const std::string_view endings = parser.mFileExtensions;
  switch (format) {
    case ModelFormat::obj:
      return endings == "obj";
    case ModelFormat::stl:
      return endings == "stl";
    case ModelFormat::ply:
      return false;  // read_ply()
    case ModelFormat::gltf:
    case ModelFormat::glb:
      break;
  }
  // glTF 1 has a parser of its own.
  return std::string_view(parser.mName) == "glTF2 Importer";
}

/// Removes all parsers but that of a format: Assimp would choose one by the content of the file.
void keep_parser_of(ModelFormat format, Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* const about = importer.GetImporterInfo(i);
    if (about != nullptr && is_parser_of(*about, format)) continue;
    Assimp::BaseImporter* const parser = importer.GetImporter(i);
    importer.UnregisterLoader(parser);
    delete parser;
  }
}

std::string refused_line(const FolderFiles::Refused& refused) {
  return "refers to \"" + refused.path + "\", " + ModelFolder::words(refused.why);
}

std::string error_line(const Assimp::Importer& importer, const FolderFiles& files,
                       ModelFormat format) {
  if (const std::exception_ptr thrown = importer.GetException()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::length_error&) {
      return "has a count that is too large";
    } catch (...) {
    }
  }
  // An .obj can be read without its materials, a .gltf cannot without its buffers.
  if (format != ModelFormat::obj && !files.refused().empty())
    return refused_line(files.refused().front());
  const std::string_view text = importer.GetErrorString();
  if (text.find("bad_alloc") != std::string_view::npos) throw std::bad_alloc();
  return "cannot be read: " + printable_line(text, kAssimpLineBytesMax);
}

}  // namespace

Result<ReadModel, std::string> read_model_in(const ModelFolder& folder, const SceneRules& rules) {
  ReaderNotices notices;
  if (rules.format == ModelFormat::ply) {
    auto model = read_ply(folder, rules, notices);
    if (!model) return failure(model.error());
    return ReadModel{*std::move(model), notices.take()};
  }
  auto owned = std::make_unique<FolderFiles>(folder);
  if (rules.format == ModelFormat::gltf || rules.format == ModelFormat::glb) {
    const auto file = folder.open(folder.name());
    if (!file) return failure(std::string(ModelFolder::words(file.error())));
    const auto extensions = check_extensions(*file);
    if (!extensions) return failure(extensions.error());
    if (extensions->is_quantised) {
      auto plain = plain_gltf(folder, *file);
      if (!plain) return failure(plain.error());
      owned->replace_model(*std::move(plain));
    }
  }
  Assimp::Importer importer;
  keep_parser_of(rules.format, importer);
  const FolderFiles& files = *owned;
  importer.SetIOHandler(owned.release());  // the importer owns it
  // Texture places become those of a model, which count from above.
  const aiScene* const read =
      importer.ReadFile(folder.name(), aiProcess_Triangulate | aiProcess_FlipUVs);
  if (read == nullptr) return failure(error_line(importer, files, rules.format));
  for (const FolderFiles::Refused& refused : files.refused())
    notices.add("the file " + refused_line(refused) + ": it is left out");
  SceneRules scene_rules = rules;
  scene_rules.lacks_materials =
      rules.format == ModelFormat::obj && !files.refused().empty() && !files.has_opened_others();
  const std::unique_ptr<aiScene> scene(importer.GetOrphanedScene());
  auto model = model_of_scene(*scene, scene_rules, folder, notices);
  if (!model) return failure(model.error());
  return ReadModel{*std::move(model), notices.take()};
}

}  // namespace runstone
