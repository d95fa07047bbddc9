#include "common/model_reader/gltf_extensions.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/models/printable_line.hpp"

namespace runstone {
namespace {

constexpr std::size_t kExtensionsMax = 64;
constexpr std::size_t kExtensionNameBytesMax = 100;  // of a message
constexpr std::size_t kGlbHeadBytes = 20;            // of the file, and of its first chunk

bool is_read(std::string_view extension) {
  // Materials of all kinds have a base colour beside what the extension says. Lights are no triangles.
  constexpr std::string_view kMaterials = "KHR_materials_";
  return extension == "KHR_draco_mesh_compression" || extension == "KHR_texture_transform" ||
         extension == "KHR_lights_punctual" || extension.substr(0, kMaterials.size()) == kMaterials;
}

/// Returns what to do about an extension that is not read.
std::string_view advice(std::string_view extension) {
  if (extension == "EXT_meshopt_compression" || extension == "KHR_meshopt_compression" ||
      extension == "KHR_mesh_quantization")
    return "export the model without compression, or with that of Draco";
  if (extension == "KHR_texture_basisu" || extension == "EXT_texture_webp" ||
      extension == "EXT_texture_avif" || extension == "MSFT_texture_dds")
    return "export the model with textures of PNG or JPEG";
  return "export the model without it";
}

/// Returns the JSON of a .gltf or .glb, or an empty text.
std::string json_of(const OpenedFile& file) {
  std::array<std::uint8_t, kGlbHeadBytes> head{};
  const std::size_t got = file.read(head.data(), head.size(), 0);
  std::uint64_t begin = 0, bytes = file.bytes();
  if (got == head.size() && std::memcmp(head.data(), "glTF", 4) == 0) {
    begin = kGlbHeadBytes;
    bytes = std::uint64_t{head[12]} | std::uint64_t{head[13]} << 8 | std::uint64_t{head[14]} << 16 |
            std::uint64_t{head[15]} << 24;
    bytes = std::min<std::uint64_t>(bytes, file.bytes() - begin);
  }
  std::string json(static_cast<std::size_t>(bytes), '\0');
  json.resize(file.read(json.data(), json.size(), begin));
  return json;
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

Result<void, std::string> check_extensions(const OpenedFile& file) {
  for (const std::string& name : required_extensions(json_of(file))) {
    if (!is_read(name))
      return failure("requires the extension \"" + printable_line(name, kExtensionNameBytesMax) +
                     "\" of glTF, which is not read: " + std::string(advice(name)));
  }
  return {};
}

}  // namespace runstone
