#include "client/render/light_texture.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <glm/gtc/type_ptr.hpp>

namespace runstone {
namespace {

/// Red lies in the lowest bits of LightLevels, so it is the first byte.
constexpr GLenum kTexelType = GL_UNSIGNED_BYTE;
static_assert(std::endian::native == std::endian::little);

/// A stretch of a box that does not pass the end of the ring: its first coordinate in the ring and
/// its length.
struct Stretch {
  std::int32_t first = 0, length = 0;
};

std::array<Stretch, 2> stretches(std::int32_t min, std::int32_t max, std::int32_t size) {
  const std::int32_t first = min - floor_div(min, size) * size;
  const std::int32_t length = std::min(max - min, size - first);
  return {{{first, length}, {0, max - min - length}}};
}

}  // namespace

LightTexture::LightTexture() : texture_(GlTexture::make()) {}

void LightTexture::copy(const LightField& field, std::span<const VoxelBox> changed) {
  if (bytes_ != 0 && changed.empty()) return;
  const std::int32_t width = field.width(), height = field.height();
  glBindTexture(GL_TEXTURE_3D, texture_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (bytes_ == 0) {
    bytes_ = field.ring().size() * sizeof(LightLevels);
    glTexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, width, height, width, 0, GL_RGBA, kTexelType,
                 field.ring().data());
    for (const int filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTexParameteri(GL_TEXTURE_3D, static_cast<GLenum>(filter), GL_LINEAR);
    for (const int wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
      glTexParameteri(GL_TEXTURE_3D, static_cast<GLenum>(wrap), GL_REPEAT);
    return;
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, width);
  glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, height);
  for (const VoxelBox& box : changed) {
    for (const Stretch& z : stretches(box.min.z, box.max.z, width)) {
      for (const Stretch& y : stretches(box.min.y, box.max.y, height)) {
        for (const Stretch& x : stretches(box.min.x, box.max.x, width)) {
          if (x.length == 0 || y.length == 0 || z.length == 0) continue;
          const std::size_t from =
              (static_cast<std::size_t>(z.first) * static_cast<std::size_t>(height) +
               static_cast<std::size_t>(y.first)) *
                  static_cast<std::size_t>(width) +
              static_cast<std::size_t>(x.first);
          glTexSubImage3D(GL_TEXTURE_3D, 0, x.first, y.first, z.first, x.length, y.length, z.length,
                          GL_RGBA, kTexelType, field.ring().data() + from);
        }
      }
    }
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
}

void LightTexture::bind(const GlProgram& program, GLint unit, const LightField& field,
                        const glm::dvec3& eye) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_3D, texture_.get());
  glUniform1i(glGetUniformLocation(program.get(), "light_field"), unit);
  const glm::dvec3 size{field.width(), field.height(), field.width()};
  const VoxelPos min = field.box().min;
  const glm::dvec3 corner{min.x, min.y, min.z};
  const auto set = [&program](const char* name, const glm::vec3& value) {
    glUniform3fv(glGetUniformLocation(program.get(), name), 1, glm::value_ptr(value));
  };
  set("field_scale", glm::vec3(1.0 / size));
  set("field_offset", glm::vec3((eye - corner) / size));
  // The place of the corner in the ring.
  set("field_turn", glm::vec3(glm::fract(corner / size)));
}

}  // namespace runstone
