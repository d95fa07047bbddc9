#include "common/model_reader/gltf_extensions.hpp"

#include <cstddef>
#include <vector>

#include "common/model_reader/gltf_head.hpp"
#include "common/models/printable_line.hpp"

namespace runstone {
namespace {

constexpr std::size_t kExtensionsMax = 64;
constexpr std::size_t kExtensionNameBytesMax = 100;  // of a message

constexpr std::string_view kQuantisation = "KHR_mesh_quantization";

bool is_read(std::string_view extension) {
  // Materials of all kinds have a base colour beside what the extension says. Lights are no triangles.
  constexpr std::string_view kMaterials = "KHR_materials_";
  return extension == "KHR_draco_mesh_compression" || extension == kQuantisation ||
         extension == "KHR_texture_transform" || extension == "KHR_lights_punctual" ||
         extension.substr(0, kMaterials.size()) == kMaterials;
}

/// Returns what to do about an extension that is not read.
std::string_view advice(std::string_view extension) {
  if (extension == "EXT_meshopt_compression" || extension == "KHR_meshopt_compression")
    return "export the model without compression, or with that of Draco";
  if (extension == "KHR_texture_basisu" || extension == "EXT_texture_webp" ||
      extension == "EXT_texture_avif" || extension == "MSFT_texture_dds")
    return "export the model with textures of PNG or JPEG";
  return "export the model without it";
}

}  // namespace

std::vector<std::string> required_extensions(std::string_view json) {
  std::vector<std::string> names;
  const std::size_t key = json.find("\"extensionsRequired\"");
  if (key == std::string_view::npos) return names;
  const std::size_t open = json.find('[', key);
  if (open == std::string_view::npos) return names;
  std::string_view list = json.substr(open, json.find(']', open) - open);
  while (names.size() < kExtensionsMax) {
    const std::size_t begin = list.find('"');
    if (begin == std::string_view::npos) break;
    const std::size_t end = list.find('"', begin + 1);
    if (end == std::string_view::npos) break;
    names.emplace_back(list.substr(begin + 1, end - begin - 1));
    list.remove_prefix(end + 1);
  }
  return names;
}

Result<Extensions, std::string> check_extensions(const OpenedFile& file) {
  Extensions out;
  for (const std::string& name : required_extensions(gltf_head(file).json)) {
    if (!is_read(name))
      return failure("requires the extension \"" + printable_line(name, kExtensionNameBytesMax) +
                     "\" of glTF, which is not read: " + std::string(advice(name)));
    if (name == kQuantisation) out.is_quantised = true;
  }
  return out;
}

}  // namespace runstone
