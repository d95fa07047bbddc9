#include "client/platform/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace runstone {

struct Window::State {
  GLFWwindow* window = nullptr;
  WindowInput pending;  // presses since the last poll
  bool captured = false;
  bool have_cursor = false;  // false until the first position after a capture, which is no movement
  double cursor_x = 0, cursor_y = 0;

  void capture(bool on) {
    captured = on;
    have_cursor = false;
    glfwSetInputMode(window, GLFW_CURSOR, on ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  }
  bool held(int key) const { return glfwGetKey(window, key) == GLFW_PRESS; }
  bool button_held(int button) const {
    return captured && glfwGetMouseButton(window, button) == GLFW_PRESS;
  }
};

namespace {

std::string glfw_error_text() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "unknown GLFW error";
}

/// Returns true if the key has this letter, one of a to z, in the user's keyboard layout. GLFW's key
/// codes name places of an American keyboard; a German one has Y and Z the other way round. In a
/// layout without such letters the place decides.
bool is_letter(char letter, int key, int code) {
  const char* const name = glfwGetKeyName(key, code);
  const bool is_latin = name != nullptr && name[0] >= 'a' && name[0] <= 'z';
  return is_latin ? name[0] == letter : key == GLFW_KEY_A + (letter - 'a');
}

class WindowContext final : public GlContext {
 public:
  explicit WindowContext(GLFWwindow* window) : window_(window) {
    glfwMakeContextCurrent(window_);
    if (glfwGetCurrentContext() != window_)
      throw std::runtime_error("no OpenGL in the window: " + glfw_error_text());
    glfwSwapInterval(1);
  }
  ~WindowContext() override { glfwMakeContextCurrent(nullptr); }

  Loader loader() const override { return &glfwGetProcAddress; }
  const char* name() const override { return "GLFW"; }
  bool is_window() const override { return true; }
  void swap() override { glfwSwapBuffers(window_); }

 private:
  GLFWwindow* const window_;
};

}  // namespace

Window::Window(int width, int height, const std::string& title)
    : state_(std::make_unique<State>()) {
  if (glfwInit() != GLFW_TRUE) throw std::runtime_error("no window: " + glfw_error_text());
  constexpr std::array<std::array<int, 2>, 2> kVersions = {{{4, 5}, {3, 3}}};
  for (const auto& [major, minor] : kVersions) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    state_->window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (state_->window != nullptr) break;
  }
  if (state_->window == nullptr) {
    const std::string text = glfw_error_text();
    glfwTerminate();
    throw std::runtime_error("no window: " + text);
  }
  glfwSetWindowUserPointer(state_->window, state_.get());
  glfwSetMouseButtonCallback(state_->window, [](GLFWwindow* w, int button, int action, int) {
    State& state = *static_cast<State*>(glfwGetWindowUserPointer(w));
    if (action != GLFW_PRESS) return;
    if (!state.captured) return state.capture(true);
    if (button == GLFW_MOUSE_BUTTON_LEFT) ++state.pending.remove_clicks;
    if (button == GLFW_MOUSE_BUTTON_RIGHT) ++state.pending.place_clicks;
    if (button == GLFW_MOUSE_BUTTON_MIDDLE) ++state.pending.pick_clicks;
  });
  glfwSetCursorPosCallback(state_->window, [](GLFWwindow* w, double x, double y) {
    State& state = *static_cast<State*>(glfwGetWindowUserPointer(w));
    if (state.captured && state.have_cursor) {
      state.pending.look_dx += x - state.cursor_x;
      state.pending.look_dy += y - state.cursor_y;
    }
    state.have_cursor = state.captured;
    state.cursor_x = x;
    state.cursor_y = y;
  });
  glfwSetScrollCallback(state_->window, [](GLFWwindow* w, double, double dy) {
    static_cast<State*>(glfwGetWindowUserPointer(w))->pending.scroll += dy > 0   ? 1
                                                                        : dy < 0 ? -1
                                                                                 : 0;
  });
  glfwSetKeyCallback(state_->window, [](GLFWwindow* w, int key, int code, int action, int mods) {
    State& state = *static_cast<State*>(glfwGetWindowUserPointer(w));
    if (action != GLFW_PRESS) return;
    if (key >= GLFW_KEY_0 && key <= GLFW_KEY_9) state.pending.digit = key - GLFW_KEY_0;
    if (key == GLFW_KEY_F2) state.pending.screenshot = true;
    if (key == GLFW_KEY_LEFT_BRACKET) --state.pending.scrub;
    if (key == GLFW_KEY_RIGHT_BRACKET) ++state.pending.scrub;
    if ((mods & GLFW_MOD_CONTROL) != 0) {
      if (is_letter('z', key, code)) state.pending.undo = true;
      if (is_letter('y', key, code)) state.pending.redo = true;
    }
    if (key == GLFW_KEY_HOME) state.pending.live = true;
    if (key == GLFW_KEY_G) ++state.pending.ground;
    if (key == GLFW_KEY_F) ++state.pending.walking;
    if (key == GLFW_KEY_ESCAPE) {
      if (state.captured) return state.capture(false);
      state.pending.escape = true;
    }
  });
}

Window::~Window() {
  glfwDestroyWindow(state_->window);
  glfwTerminate();
}

WindowInput Window::poll() {
  glfwPollEvents();
  WindowInput input = std::exchange(state_->pending, WindowInput{});
  input.forward = state_->held(GLFW_KEY_W);
  input.back = state_->held(GLFW_KEY_S);
  input.left = state_->held(GLFW_KEY_A);
  input.right = state_->held(GLFW_KEY_D);
  input.up = state_->held(GLFW_KEY_SPACE);
  input.down = state_->held(GLFW_KEY_LEFT_SHIFT);
  input.fast = state_->held(GLFW_KEY_LEFT_CONTROL);
  input.remove_held = state_->button_held(GLFW_MOUSE_BUTTON_LEFT);
  input.place_held = state_->button_held(GLFW_MOUSE_BUTTON_RIGHT);
  input.close = glfwWindowShouldClose(state_->window) == GLFW_TRUE;
  return input;
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(state_->window, title.c_str());
}
std::array<int, 2> Window::framebuffer_size() const {
  std::array<int, 2> size{};
  glfwGetFramebufferSize(state_->window, &size[0], &size[1]);
  return {std::max(size[0], 1), std::max(size[1], 1)};
}
bool Window::mouse_captured() const { return state_->captured; }

std::unique_ptr<GlContext> make_window_context(Window& window) {
  return std::make_unique<WindowContext>(window.state_->window);
}

}  // namespace runstone
