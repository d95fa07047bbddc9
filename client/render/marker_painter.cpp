#include "client/render/marker_painter.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/gtc/type_ptr.hpp>
#include <vector>

namespace runstone {
namespace {

/// The corners of the unit cube as the ends of 12 edges and of 12 diagonals of faces, and as 12
/// triangles. Bits 0, 1, 2 of a corner are x, y, z.
constexpr int kEdgeVertices = 24, kDiagonalVertices = 24;
constexpr int kCubeVertices = 36;
constexpr std::array<std::uint8_t, kEdgeVertices> kEdges = {0, 1, 1, 3, 3, 2, 2, 0, 4, 5, 5, 7,
                                                            7, 6, 6, 4, 0, 4, 1, 5, 2, 6, 3, 7};
constexpr std::array<std::uint8_t, kDiagonalVertices> kDiagonals = {
    0, 6, 2, 4, 1, 7, 3, 5, 0, 5, 1, 4, 2, 7, 3, 6, 0, 3, 1, 2, 4, 7, 5, 6};
constexpr std::array<std::uint8_t, kCubeVertices> kFaces = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5,
                                                            0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3,
                                                            0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};

constexpr const char* kMarkerVertexShader =
    "layout(location = 0) in vec3 corner;\n"
    "uniform mat4 clip;\n"
    "uniform vec3 origin;\n"
    "uniform vec3 size;\n"
    "void main() { gl_Position = clip * vec4(origin + corner * size, 1.0); }\n";

constexpr const char* kMarkerFragmentShader =
    "uniform vec4 colour;\n"
    "out vec4 fragment;\n"
    "void main() { fragment = colour; }\n";

}  // namespace

MarkerPainter::MarkerPainter()
    : program_(link_program("marker", kMarkerVertexShader, kMarkerFragmentShader)),
      array_(GlVertexArray::make()),
      corners_(GlBuffer::make()) {
  std::vector<float> corners;
  const auto add = [&](std::uint8_t c) {
    corners.insert(corners.end(), {static_cast<float>(c & 1), static_cast<float>(c >> 1 & 1),
                                   static_cast<float>(c >> 2)});
  };
  std::for_each(kEdges.begin(), kEdges.end(), add);
  std::for_each(kDiagonals.begin(), kDiagonals.end(), add);
  std::for_each(kFaces.begin(), kFaces.end(), add);
  glBindVertexArray(array_.get());
  glBindBuffer(GL_ARRAY_BUFFER, corners_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(float)),
               corners.data(), GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void MarkerPainter::draw(std::span<const Marker> markers, const glm::dvec3& eye,
                         const glm::mat4& clip) {
  if (markers.empty()) return;
  glUseProgram(program_.get());
  glUniformMatrix4fv(glGetUniformLocation(program_.get(), "clip"), 1, GL_FALSE,
                     glm::value_ptr(clip));
  glBindVertexArray(array_.get());
  for (const Marker& m : markers) {
    // An outline is a little larger than its voxel. Otherwise the depth test would hide parts of
    // it.
    const double grow = m.filled ? 0.0 : 0.01;
    const glm::vec3 origin(glm::dvec3{m.x, m.y, m.z} - grow - eye);
    const glm::vec3 size(glm::dvec3{m.size_x, m.size_y, m.size_z} + 2 * grow);
    glUniform3fv(glGetUniformLocation(program_.get(), "origin"), 1, glm::value_ptr(origin));
    glUniform3fv(glGetUniformLocation(program_.get(), "size"), 1, glm::value_ptr(size));
    glUniform4f(glGetUniformLocation(program_.get(), "colour"), static_cast<float>(m.r) / 255.0F,
                static_cast<float>(m.g) / 255.0F, static_cast<float>(m.b) / 255.0F, 1.0F);
    if (m.filled) {
      glDrawArrays(GL_TRIANGLES, kEdgeVertices + kDiagonalVertices, kCubeVertices);
    } else {
      glDrawArrays(GL_LINES, 0, kEdgeVertices + (m.crossed ? kDiagonalVertices : 0));
    }
  }
}

}  // namespace runstone
