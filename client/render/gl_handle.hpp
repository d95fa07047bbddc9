// GlHandle: a move-only owner of a GL name. Thread: the GL thread, with the context current, also
// for destruction.
#pragma once
#include <utility>

#include "client/render/gl_functions.hpp"

namespace runstone {

template <class Traits>
class GlHandle {
 public:
  GlHandle() = default;
  explicit GlHandle(GLuint name) : name_(name) {}
  static GlHandle make() { return GlHandle(Traits::create()); }
  GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlHandle& operator=(GlHandle&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  GlHandle(const GlHandle&) = delete;
  GlHandle& operator=(const GlHandle&) = delete;
  ~GlHandle() {
    if (name_ != 0) Traits::destroy(name_);
  }
  GLuint get() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

 private:
  GLuint name_ = 0;
};

struct GlBufferTraits {
  static GLuint create() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteBuffers(1, &name); }
};
struct GlVertexArrayTraits {
  static GLuint create() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteVertexArrays(1, &name); }
};
struct GlTextureTraits {
  static GLuint create() {
    GLuint name = 0;
    glGenTextures(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteTextures(1, &name); }
};
struct GlFramebufferTraits {
  static GLuint create() {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteFramebuffers(1, &name); }
};
struct GlRenderbufferTraits {
  static GLuint create() {
    GLuint name = 0;
    glGenRenderbuffers(1, &name);
    return name;
  }
  static void destroy(GLuint name) { glDeleteRenderbuffers(1, &name); }
};
struct GlProgramTraits {
  static GLuint create() { return glCreateProgram(); }
  static void destroy(GLuint name) { glDeleteProgram(name); }
};

using GlBuffer = GlHandle<GlBufferTraits>;
using GlVertexArray = GlHandle<GlVertexArrayTraits>;
using GlTexture = GlHandle<GlTextureTraits>;
using GlFramebuffer = GlHandle<GlFramebufferTraits>;
using GlRenderbuffer = GlHandle<GlRenderbufferTraits>;
using GlProgram = GlHandle<GlProgramTraits>;

/// Compiles and links a program. The sources have no #version: they are GLSL 3.30, or GLSL ES 3.00
/// with high precision if the context is one of OpenGL ES, where GL_ES is defined. Throws
/// std::runtime_error with `name` and the driver's log on failure.
GlProgram link_program(const char* name, const char* vertex_source, const char* fragment_source);

}  // namespace runstone
