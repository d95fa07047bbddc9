#include "client/render/shape_texture.hpp"

#include "client/render/texel_store.hpp"
#include "common/core/ids.hpp"

namespace runstone {
namespace {

std::uint32_t texel_of(const ShapeFace& face) {
  std::uint32_t out = 0;
  unsigned shift = 0;
  for (const std::uint8_t value :
       {face.depth, face.far_depth, face.u0, face.u1, face.v0, face.v1}) {
    out |= std::uint32_t{value} << shift;
    shift += 5;
  }
  return out;
}

}  // namespace

std::vector<std::uint32_t> shape_texels(const ShapeTable& shapes) {
  std::vector<std::uint32_t> out(kMaterialCountMax);
  std::vector<std::uint32_t> first;
  for (const ShapeTable::Entry& entry : shapes.shapes()) {
    first.push_back(static_cast<std::uint32_t>(out.size()));
    for (const ShapeFace& face : entry.faces.faces()) out.push_back(texel_of(face));
  }
  for (std::size_t id = 0; id < kMaterialCountMax; ++id) {
    const std::uint16_t number = shapes.number(static_cast<Material>(id));
    if (number != 0) out[id] = first[number - 1U];
  }
  out.resize((out.size() + kTexelRow - 1) / kTexelRow * kTexelRow);
  return out;
}

ShapeTexture::ShapeTexture() : texture_(GlTexture::make()) { set({}); }

void ShapeTexture::set(const ShapeTable& shapes) {
  const std::vector<std::uint32_t> texels = shape_texels(shapes);
  bytes_ = texels.size() * sizeof(std::uint32_t);
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R32UI, kTexelRow,
               static_cast<GLsizei>(texels.size() / kTexelRow), 0, GL_RED_INTEGER, GL_UNSIGNED_INT,
               texels.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void ShapeTexture::bind(const GlProgram& program, GLint unit) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glUniform1i(glGetUniformLocation(program.get(), "shapes"), unit);
}

}  // namespace runstone
