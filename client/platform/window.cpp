#include "client/platform/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include "client/input/gamepad.hpp"

namespace runstone {

struct Window::State {
  GLFWwindow* window = nullptr;
  std::vector<InputEvent> events;    // since the last poll
  std::vector<std::string> dropped;  // likewise: paths of files
  bool captured = false;
  bool have_cursor = false;  // false until the first position after a capture, which is no movement
  double cursor_x = 0, cursor_y = 0;
  GamepadReader gamepad;

  /// Adds the events of the first gamepad that GLFW knows. Without focus it counts as released.
  void read_gamepad() {
    std::optional<GamepadSample> sample;
    const bool has_focus = glfwGetWindowAttrib(window, GLFW_FOCUSED) == GLFW_TRUE;
    for (int id = GLFW_JOYSTICK_1; has_focus && !sample && id <= GLFW_JOYSTICK_LAST; ++id) {
      GLFWgamepadstate read{};
      if (glfwGetGamepadState(id, &read) != GLFW_TRUE) continue;
      sample.emplace();
      std::ranges::transform(read.buttons, sample->buttons.begin(),
                             [](unsigned char button) { return button == GLFW_PRESS; });
      std::ranges::copy(read.axes, sample->axes.begin());
    }
    gamepad.read(sample, events);
  }

  void add_cursor(double x, double y) {
    std::array<int, 2> size{}, pixels{};
    glfwGetWindowSize(window, &size[0], &size[1]);
    glfwGetFramebufferSize(window, &pixels[0], &pixels[1]);
    CursorEvent event;
    event.x = x * pixels[0] / std::max(size[0], 1);
    event.y = y * pixels[1] / std::max(size[1], 1);
    if (have_cursor) {
      event.dx = x - cursor_x;
      event.dy = y - cursor_y;
    }
    have_cursor = true;
    cursor_x = x;
    cursor_y = y;
    events.emplace_back(event);
  }
};

namespace {

std::string glfw_error_text() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "unknown GLFW error";
}

struct NamedKey {
  int glfw;
  Key key;
};
constexpr NamedKey kNamedKeys[] = {
    {GLFW_KEY_ESCAPE, Key::escape},
    {GLFW_KEY_ENTER, Key::enter},
    {GLFW_KEY_TAB, Key::tab},
    {GLFW_KEY_BACKSPACE, Key::backspace},
    {GLFW_KEY_INSERT, Key::insert},
    {GLFW_KEY_DELETE, Key::delete_forward},
    {GLFW_KEY_LEFT, Key::left},
    {GLFW_KEY_RIGHT, Key::right},
    {GLFW_KEY_UP, Key::up},
    {GLFW_KEY_DOWN, Key::down},
    {GLFW_KEY_PAGE_UP, Key::page_up},
    {GLFW_KEY_PAGE_DOWN, Key::page_down},
    {GLFW_KEY_HOME, Key::home},
    {GLFW_KEY_END, Key::end},
    {GLFW_KEY_SPACE, Key::space},
    {GLFW_KEY_LEFT_SHIFT, Key::left_shift},
    {GLFW_KEY_RIGHT_SHIFT, Key::right_shift},
    {GLFW_KEY_LEFT_CONTROL, Key::left_control},
    {GLFW_KEY_RIGHT_CONTROL, Key::right_control},
    {GLFW_KEY_LEFT_ALT, Key::left_alt},
    {GLFW_KEY_RIGHT_ALT, Key::right_alt},
    {GLFW_KEY_MINUS, Key::minus},
    {GLFW_KEY_EQUAL, Key::equal},
    {GLFW_KEY_LEFT_BRACKET, Key::left_bracket},
    {GLFW_KEY_RIGHT_BRACKET, Key::right_bracket},
    {GLFW_KEY_COMMA, Key::comma},
    {GLFW_KEY_PERIOD, Key::period},
    {GLFW_KEY_SLASH, Key::slash},
    {GLFW_KEY_KP_DIVIDE, Key::slash},
    {GLFW_KEY_KP_ENTER, Key::keypad_enter},
};

Key key_after(Key first, int steps) { return static_cast<Key>(static_cast<int>(first) + steps); }

/// Returns the key by its place on an American keyboard, which is how GLFW names keys.
Key key_of(int glfw) {
  if (glfw >= GLFW_KEY_A && glfw <= GLFW_KEY_Z) return key_after(Key::a, glfw - GLFW_KEY_A);
  if (glfw >= GLFW_KEY_0 && glfw <= GLFW_KEY_9) return key_after(Key::digit_0, glfw - GLFW_KEY_0);
  if (glfw >= GLFW_KEY_F1 && glfw <= GLFW_KEY_F12) return key_after(Key::f1, glfw - GLFW_KEY_F1);
  const auto* const found =
      std::find_if(std::begin(kNamedKeys), std::end(kNamedKeys),
                   [glfw](const NamedKey& named) { return named.glfw == glfw; });
  return found == std::end(kNamedKeys) ? Key::unknown : found->key;
}

/// Returns the key by its letter in the user's keyboard layout: a German keyboard has Y and Z the
/// other way round. A key without such a letter, or of a layout without them, keeps its place.
Key lettered_key(int glfw, int code) {
  const char* const name = glfwGetKeyName(glfw, code);
  const Key place = key_of(glfw);
  if (name == nullptr || name[0] == 0 || name[1] != 0) return place;
  if (name[0] >= 'a' && name[0] <= 'z') return key_after(Key::a, name[0] - 'a');
  if (name[0] == '/') return Key::slash;
  return place;
}

std::optional<MouseButton> button_of(int glfw) {
  if (glfw == GLFW_MOUSE_BUTTON_LEFT) return MouseButton::left;
  if (glfw == GLFW_MOUSE_BUTTON_RIGHT) return MouseButton::right;
  if (glfw == GLFW_MOUSE_BUTTON_MIDDLE) return MouseButton::middle;
  return std::nullopt;
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
  const char* name() const override {
    const bool is_es = glfwGetWindowAttrib(window_, GLFW_CLIENT_API) == GLFW_OPENGL_ES_API;
    return is_es ? "GLFW, OpenGL ES" : "GLFW";
  }
  bool is_window() const override { return true; }
  void swap() override { glfwSwapBuffers(window_); }

 private:
  GLFWwindow* const window_;
};

}  // namespace

Window::Window(int width, int height, const std::string& title)
    : state_(std::make_unique<State>()) {
  if (glfwInit() != GLFW_TRUE)
    throw std::runtime_error("no window: no display is reached (" + glfw_error_text() +
                             "); --headless needs none");
  struct Version {
    int api, profile, major, minor;
  };
  constexpr std::array<Version, 3> kVersions = {{
      {GLFW_OPENGL_API, GLFW_OPENGL_CORE_PROFILE, 4, 5},
      {GLFW_OPENGL_API, GLFW_OPENGL_CORE_PROFILE, 3, 3},
      {GLFW_OPENGL_ES_API, GLFW_OPENGL_ANY_PROFILE, 3, 0},
  }};
  for (const auto& [client_api, profile, major, minor] : kVersions) {
    glfwWindowHint(GLFW_CLIENT_API, client_api);
    glfwWindowHint(GLFW_OPENGL_PROFILE, profile);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
    state_->window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (state_->window != nullptr) break;
  }
  if (state_->window == nullptr) {
    const std::string text = glfw_error_text();
    glfwTerminate();
    throw std::runtime_error(
        "no window: OpenGL 3.3 or OpenGL ES 3.0 is needed, and this display has neither (" + text +
        ")");
  }
  glfwSetWindowUserPointer(state_->window, state_.get());
  glfwSetMouseButtonCallback(state_->window, [](GLFWwindow* w, int button, int action, int) {
    State& state = *static_cast<State*>(glfwGetWindowUserPointer(w));
    if (const auto known = button_of(button))
      state.events.emplace_back(ButtonEvent{*known, action == GLFW_PRESS});
  });
  glfwSetCursorPosCallback(state_->window, [](GLFWwindow* w, double x, double y) {
    static_cast<State*>(glfwGetWindowUserPointer(w))->add_cursor(x, y);
  });
  glfwSetScrollCallback(state_->window, [](GLFWwindow* w, double, double dy) {
    static_cast<State*>(glfwGetWindowUserPointer(w))->events.emplace_back(WheelEvent{dy});
  });
  glfwSetKeyCallback(state_->window, [](GLFWwindow* w, int key, int code, int action, int mods) {
    KeyEvent event;
    event.place = key_of(key);
    event.key = lettered_key(key, code);
    event.is_pressed = action != GLFW_RELEASE;
    event.is_repeat = action == GLFW_REPEAT;
    event.control = (mods & GLFW_MOD_CONTROL) != 0;
    event.shift = (mods & GLFW_MOD_SHIFT) != 0;
    event.alt = (mods & GLFW_MOD_ALT) != 0;
    static_cast<State*>(glfwGetWindowUserPointer(w))->events.emplace_back(event);
  });
  glfwSetCharCallback(state_->window, [](GLFWwindow* w, unsigned character) {
    static_cast<State*>(glfwGetWindowUserPointer(w))
        ->events.emplace_back(CharacterEvent{static_cast<char32_t>(character)});
  });
  glfwSetDropCallback(state_->window, [](GLFWwindow* w, int count, const char** paths) {
    auto& dropped = static_cast<State*>(glfwGetWindowUserPointer(w))->dropped;
    for (int i = 0; i < count; ++i) dropped.emplace_back(paths[i]);
  });
  glfwSetWindowFocusCallback(state_->window, [](GLFWwindow* w, int has_focus) {
    static_cast<State*>(glfwGetWindowUserPointer(w))
        ->events.emplace_back(FocusEvent{has_focus == GLFW_TRUE});
  });
}

Window::~Window() {
  glfwDestroyWindow(state_->window);
  glfwTerminate();
}

WindowEvents Window::poll() {
  glfwPollEvents();
  WindowEvents out;
  state_->read_gamepad();
  out.events = std::exchange(state_->events, {});
  out.dropped = std::exchange(state_->dropped, {});
  out.close = glfwWindowShouldClose(state_->window) == GLFW_TRUE;
  return out;
}

void Window::set_captured(bool is_captured) {
  if (std::exchange(state_->captured, is_captured) == is_captured) return;
  state_->have_cursor = false;
  glfwSetInputMode(state_->window, GLFW_CURSOR,
                   is_captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(state_->window, title.c_str());
}
std::array<int, 2> Window::framebuffer_size() const {
  std::array<int, 2> size{};
  glfwGetFramebufferSize(state_->window, &size[0], &size[1]);
  return {std::max(size[0], 1), std::max(size[1], 1)};
}
bool Window::has_focus() const {
  return glfwGetWindowAttrib(state_->window, GLFW_FOCUSED) == GLFW_TRUE;
}

std::unique_ptr<GlContext> make_window_context(Window& window) {
  return std::make_unique<WindowContext>(window.state_->window);
}

}  // namespace runstone
