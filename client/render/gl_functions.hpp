// The functions of OpenGL, and which API they belong to: OpenGL 3.3 core or newer, or OpenGL ES 3.0
// or newer. ES is what small boards have, and WebGL 2 in a browser is OpenGL ES 3.0. Renderers use
// what both have; the few differences are asked for here.
#pragma once
#include <glad/gl.h>

namespace runstone {

/// A function that returns a GL function by name. eglGetProcAddress, OSMesaGetProcAddress and
/// glfwGetProcAddress have this type.
using GlContextLoader = void (*(*)(const char*))();

/// Loads the functions of the current context. The program has one set of functions: a second call
/// replaces it, so contexts of both APIs cannot be used side by side. Throws std::runtime_error if
/// the loader finds none, or the version is too old.
void load_gl(GlContextLoader loader);

/// Returns true if the functions are those of OpenGL ES. Valid after load_gl().
bool is_gl_es();

/// Returns glClipControl() of OpenGL 4.5 or of GL_EXT_clip_control, or null if the context has
/// neither. Valid after load_gl().
PFNGLCLIPCONTROLPROC clip_control();

/// Returns true if the context has glTexStorage2D(): OpenGL 4.2 and OpenGL ES 3.0. Valid after
/// load_gl().
bool has_texture_storage();

}  // namespace runstone
