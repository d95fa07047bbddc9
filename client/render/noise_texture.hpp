// NoiseTexture: smooth noise that repeats, on the GPU. Clouds are made of its red channel, and the
// tint of ground by its place of the green one. The values are the same in every run, so pictures
// of one place are equal. Thread: the GL thread.
#pragma once
#include <cstdint>
#include <vector>

#include "client/render/gl_handle.hpp"

namespace runstone {

/// Returns side * side values from 0 to 255, row by row: fractal noise that continues from the last
/// row and column into the first. Its largest spots are side / cells wide; each octave has spots of
/// half the width and half the strength, down to two values. The least value is 0 and the greatest
/// 255. Requires powers of two, 1 <= cells <= side / 2. Pure.
std::vector<std::uint8_t> repeating_noise(unsigned side, unsigned cells, std::uint64_t seed);

class NoiseTexture {
 public:
  static constexpr unsigned kSide = 256;  // texels

  NoiseTexture();
  /// Binds the texture to a texture unit, for the sampler `noise`. Requires that the program is in
  /// use.
  void bind(const GlProgram& program, GLint unit) const;

 private:
  GlTexture texture_;
};

}  // namespace runstone
