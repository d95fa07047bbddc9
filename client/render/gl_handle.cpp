#include "client/render/gl_handle.hpp"

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace runstone {
namespace {

constexpr const char* kHeader = "#version 330 core\n";
constexpr const char* kHeaderOfEs =
    "#version 300 es\n"
    "precision highp float;\n"
    "precision highp int;\n"
    "precision highp sampler2D;\n"
    "precision highp sampler3D;\n"
    "precision highp usampler2D;\n"
    "precision highp sampler2DArray;\n"
    "precision highp sampler2DArrayShadow;\n";

GLuint compile(const char* name, GLenum type, const char* source) {
  const GLuint shader = glCreateShader(type);
  const std::array<const char*, 2> parts = {is_gl_es() ? kHeaderOfEs : kHeader, source};
  glShaderSource(shader, 2, parts.data(), nullptr);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok != GL_TRUE) {
    std::vector<char> log(4096);
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    glDeleteShader(shader);
    throw std::runtime_error(std::string("shader ") + name + " does not compile: " + log.data());
  }
  return shader;
}

}  // namespace

GlProgram link_program(const char* name, const char* vertex_source, const char* fragment_source) {
  const GLuint vertex = compile(name, GL_VERTEX_SHADER, vertex_source);
  const GLuint fragment = compile(name, GL_FRAGMENT_SHADER, fragment_source);
  GlProgram program = GlProgram::make();
  glAttachShader(program.get(), vertex);
  glAttachShader(program.get(), fragment);
  glLinkProgram(program.get());
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint ok = 0;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &ok);
  if (ok != GL_TRUE) {
    std::vector<char> log(4096);
    glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(std::string("program ") + name + " does not link: " + log.data());
  }
  return program;
}

}  // namespace runstone
