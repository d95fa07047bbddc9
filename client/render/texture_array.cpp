#include "client/render/texture_array.hpp"

#include <algorithm>
#include <bit>

#include "client/render/texel_store.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {
namespace {

/// The texels of `sides_` for a material.
constexpr std::size_t kSideTexels = 8;
constexpr std::size_t kSideTexelsAll = kMaterialCountMax * kSideTexels;
static_assert(kSideTexels == 8);  // RUNSTONE_TO_TEXTURE_GLSL has this number
static_assert(kSideTexelsAll % kTexelRow == 0 && kDirectionCount <= kSideTexels);

std::size_t layers_max() {
  GLint out = 0;
  glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &out);
  return static_cast<std::size_t>(std::max(out, 1));
}

}  // namespace

std::vector<std::uint8_t> layer_pixels(const TextureLevels& picture, std::size_t edge) {
  if (edge <= picture.edge) {
    const auto level = static_cast<std::size_t>(std::bit_width(picture.edge / edge) - 1);
    return picture.levels[level];
  }
  const std::size_t repeats = edge / picture.edge;
  const std::vector<std::uint8_t>& from = picture.levels.front();
  std::vector<std::uint8_t> out;
  out.reserve(edge * edge * 4);
  for (std::size_t y = 0; y < edge; ++y) {
    for (std::size_t x = 0; x < edge; ++x) {
      const auto at = from.begin() +
                      static_cast<std::ptrdiff_t>((y / repeats * picture.edge + x / repeats) * 4);
      out.insert(out.end(), at, at + 4);
    }
  }
  return out;
}

void TextureArray::set(const DrawnTexturesPtr& textures) {
  left_out_ = 0;
  std::vector<TextureLevelsPtr> wanted;
  std::uint16_t edge = 0;
  if (textures) {
    for (const TextureLevelsPtr& picture : textures->pictures) {
      if (!picture) continue;
      wanted.push_back(picture);
      edge = std::max(edge, picture->edge);
    }
  }
  if (wanted.empty()) {
    held_.clear();
    array_ = GlTexture();
    sides_ = GlTexture();
    layers_ = 0;
    return;
  }
  const auto kept = static_cast<std::size_t>(
      std::count_if(wanted.begin(), wanted.end(),
                    [this](const TextureLevelsPtr& picture) { return held_.contains(picture); }));
  const std::size_t most = layers_max();
  const std::size_t listed = textures->pictures.size();
  if (kept != held_.size() || edge != edge_ || std::min(listed, most) > layers_)
    make(edge, std::min(std::bit_ceil(listed), most));
  glBindTexture(GL_TEXTURE_2D_ARRAY, array_.get());
  for (const TextureLevelsPtr& picture : wanted) {
    if (held_.contains(picture)) continue;
    if (held_.size() == layers_) {
      ++left_out_;
      continue;
    }
    const std::size_t layer = held_.size();
    write(layer, *picture);
    held_.emplace(picture, layer);
  }
  fill_sides(*textures);
}

void TextureArray::make(std::uint16_t edge, std::size_t layers) {
  held_.clear();
  edge_ = edge;
  layers_ = layers;
  array_ = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D_ARRAY, array_.get());
  const int levels = std::bit_width(edge_);
  for (int level = 0; level < levels; ++level) {
    const GLsizei side = edge_ >> level;
    glTexImage3D(GL_TEXTURE_2D_ARRAY, level, GL_SRGB8_ALPHA8, side, side,
                 static_cast<GLsizei>(layers_), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  }
  const auto parameter = [](GLenum name, GLenum value) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, name, static_cast<GLint>(value));
  };
  parameter(GL_TEXTURE_MAX_LEVEL, static_cast<GLenum>(levels - 1));
  parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  parameter(GL_TEXTURE_WRAP_S, GL_REPEAT);
  parameter(GL_TEXTURE_WRAP_T, GL_REPEAT);
}

void TextureArray::write(std::size_t layer, const TextureLevels& picture) const {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  for (GLint level = 0; (edge_ >> level) > 0; ++level) {
    const GLsizei side = edge_ >> level;
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, static_cast<GLint>(layer), side, side, 1,
                    GL_RGBA, GL_UNSIGNED_BYTE,
                    layer_pixels(picture, static_cast<std::size_t>(side)).data());
  }
}

void TextureArray::fill_sides(const DrawnTextures& textures) {
  std::vector<std::uint16_t> texels(kSideTexelsAll);
  const std::span<const TextureEntry> entries = textures.table->entries();
  for (std::size_t i = 0; i < std::min(entries.size(), textures.pictures.size()); ++i) {
    const auto held = held_.find(textures.pictures[i]);
    if (held == held_.end()) continue;
    for (const TextureUse& use : entries[i].uses) {
      for (std::size_t side = 0; side < kDirectionCount; ++side) {
        if ((use.sides >> side & 1U) != 0)
          texels[use.material * kSideTexels + side] = static_cast<std::uint16_t>(held->second + 1);
      }
    }
  }
  if (!sides_) sides_ = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, sides_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R16UI, kTexelRow,
               static_cast<GLsizei>(texels.size() / kTexelRow), 0, GL_RED_INTEGER,
               GL_UNSIGNED_SHORT, texels.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void TextureArray::bind(const GlProgram& program, GLint unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, sides_.get());
  glUniform1i(glGetUniformLocation(program.get(), "texture_layers"), unit);
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit + 1));
  glBindTexture(GL_TEXTURE_2D_ARRAY, array_.get());
  glUniform1i(glGetUniformLocation(program.get(), "textures"), unit + 1);
}

std::uint64_t TextureArray::byte_size() const {
  if (held_.empty()) return 0;
  std::uint64_t pixels = 0;
  for (std::size_t side = edge_; side > 0; side /= 2) pixels += std::uint64_t{side} * side;
  return pixels * 4 * layers_ + kSideTexelsAll * sizeof(std::uint16_t);
}

}  // namespace runstone
