// TextureArray: the textures of a world on the GPU, an array with a layer for each picture, and the
// layer of each side of each material (texture_glsl.hpp). All layers have the size of the largest
// picture; the pixels of smaller ones are repeated. Thread: the GL thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "client/render/drawn_textures.hpp"
#include "client/render/gl_handle.hpp"

namespace runstone {

class TextureArray {
 public:
  /// Makes an array without pictures. It takes no memory on the GPU.
  TextureArray() = default;
  /// Replaces the textures. The array has layers for all pictures of the list, also for those that
  /// are not here yet. Pictures that it has already are not copied again, unless it has to grow
  /// because the list has, or a picture is larger than those before. Leaves other textures bound.
  /// Cost: O(materials), and O(pixels) for each new picture.
  void set(const DrawnTexturesPtr& textures);
  /// Returns true if no side of any material shows a picture.
  bool empty() const { return held_.empty(); }
  /// Binds the textures to texture units `unit` and `unit` + 1, and sets the uniforms
  /// `texture_layers` and `textures`. Requires !empty() and that the program is in use.
  void bind(const GlProgram& program, GLint unit) const;

  std::uint64_t byte_size() const;
  /// Returns the number of pictures for which the driver's arrays have no layer. Their sides show
  /// the look of their material.
  std::size_t left_out() const { return left_out_; }

 private:
  /// Makes an empty array.
  void make(std::uint16_t edge, std::size_t layers);
  void write(std::size_t layer, const TextureLevels& picture) const;
  void fill_sides(const DrawnTextures& textures);

  GlTexture array_, sides_;
  std::uint16_t edge_ = 0;                        // of a layer, pixels
  std::size_t layers_ = 0;                        // of the array
  std::map<TextureLevelsPtr, std::size_t> held_;  // pictures and their layers
  std::size_t left_out_ = 0;
};

/// Returns the pixels of one level of a layer with this edge: those of the picture's own level of
/// this size, or its first level with repeated pixels. Requires edge >= 1, a power of two.
std::vector<std::uint8_t> layer_pixels(const TextureLevels& picture, std::size_t edge);

}  // namespace runstone
