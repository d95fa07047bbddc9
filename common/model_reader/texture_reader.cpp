#include "common/model_reader/texture_reader.hpp"

#include <algorithm>
#include <climits>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include "common/core/png_head.hpp"
#include "common/model_reader/folder_files.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_NO_LINEAR
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace runstone {
namespace {

constexpr std::uint64_t kImageFileBytesMax = std::uint64_t{512} << 20;

std::string quoted(const std::string& name) { return "the texture \"" + name + "\""; }

void apply(TextureReader::Alpha alpha, std::vector<std::uint8_t>& texels) {
  if (alpha.rule == AlphaRule::blend) return;
  for (std::size_t i = 3; i < texels.size(); i += 4) {
    const bool is_opaque = alpha.rule == AlphaRule::opaque || texels[i] >= alpha.cutoff;
    texels[i] = is_opaque ? 255 : 0;
  }
}

}  // namespace

Result<Bytes, ModelFolder::Refusal> TextureReader::load(const std::string& path) const {
  const std::string decoded = percent_decoded(path);
  auto opened = folder_.open(path);
  if (!opened && decoded != path) opened = folder_.open(decoded);
  if (!opened) {
    auto beside = folder_.open(last_name(decoded));
    if (!beside) return failure(opened.error());
    opened = std::move(beside);
  }
  if (opened->bytes() > kImageFileBytesMax) return failure(ModelFolder::Refusal::unreadable);
  Bytes bytes(static_cast<std::size_t>(opened->bytes()));
  bytes.resize(opened->read(bytes.data(), bytes.size(), 0));
  return bytes;
}

Result<std::optional<std::uint32_t>, std::string> TextureReader::from_file(const std::string& path,
                                                                           Alpha alpha) {
  const Key key{path, alpha.rule, alpha.cutoff};
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  const auto bytes = load(path);
  if (!bytes) {
    notices_.add(quoted(path) + ", " + ModelFolder::words(bytes.error()) +
                 ", is left out: its material is plain");
    return known_[key] = std::nullopt;
  }
  return from_bytes(path, *bytes, alpha);
}

Result<std::optional<std::uint32_t>, std::string> TextureReader::from_bytes(const std::string& name,
                                                                            ByteView bytes,
                                                                            Alpha alpha) {
  const Key key{name, alpha.rule, alpha.cutoff};
  if (const auto known = known_.find(key); known != known_.end()) return known->second;
  auto number = decode(name, bytes, alpha);
  if (number) known_[key] = *number;
  return number;
}

Result<std::optional<std::uint32_t>, std::string> TextureReader::decode(const std::string& name,
                                                                        ByteView bytes,
                                                                        Alpha alpha) {
  const auto unreadable = [&](const char* why) {
    notices_.add(quoted(name) + " is left out, because it is no PNG, JPEG, BMP or TGA (" +
                 (why != nullptr ? why : "unknown") + "): its material is plain");
    return Number();
  };
  int width = 0, height = 0, channels = 0;
  if (bytes.size() > INT_MAX) return unreadable("too long");
  const auto size = static_cast<int>(bytes.size());
  // stb does not tell sides that are too large.
  if (const auto sides = png_sides(bytes)) {
    width = static_cast<int>(std::min<std::uint32_t>(sides->width, INT_MAX));
    height = static_cast<int>(std::min<std::uint32_t>(sides->height, INT_MAX));
  }
  const bool is_known = stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) != 0;
  if (width > static_cast<int>(kModelTextureSideMax) ||
      height > static_cast<int>(kModelTextureSideMax)) {
    return failure(quoted(name) + " has " + std::to_string(width) + " x " + std::to_string(height) +
                   " texels, and at most 16,384 a side are read");
  }
  if (!is_known || width < 1 || height < 1) return unreadable(stbi_failure_reason());
  const auto w = static_cast<std::uint32_t>(width), h = static_cast<std::uint32_t>(height);
  const std::size_t texel_bytes = std::size_t{4} * w * h;
  if (textures_.size() >= kModelTexturesMax)
    return failure(std::string("the file has more than 1,024 textures"));
  if (texel_bytes > kModelTextureBytesMax - bytes_)
    return failure("the textures up to " + quoted(name) + " take more than 512 MiB");
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> texels(
      stbi_load_from_memory(bytes.data(), size, &width, &height, &channels, 4), &stbi_image_free);
  if (!texels) {
    const char* why = stbi_failure_reason();
    if (why != nullptr && std::string_view(why) == "outofmem") throw std::bad_alloc();
    return unreadable(why);
  }
  if (static_cast<std::uint32_t>(width) != w || static_cast<std::uint32_t>(height) != h)
    return unreadable("two sizes");
  ModelTexture texture{w, h, {texels.get(), texels.get() + texel_bytes}};
  apply(alpha, texture.texels);
  bytes_ += texel_bytes;
  textures_.push_back(std::move(texture));
  return Number(static_cast<std::uint32_t>(textures_.size() - 1));
}

}  // namespace runstone
