#include "client/ui/ui_context.hpp"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <set>
#include <utility>

namespace runstone {
namespace {

constexpr const char* kFontFile = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr double kFontPixels = 15;
/// Latin with its extensions, Greek, Cyrillic, punctuation, currency and arrows. Pairs of the first
/// and the last character; 0 ends the list.
constexpr std::array<ImWchar, 11> kGlyphRanges = {0x20,   0x24F,  0x370,  0x52F,  0x2010, 0x205E,
                                                  0x20A0, 0x20BF, 0x2190, 0x21FF, 0};
/// ImGui measures speeds with the time of a frame, which must not be 0.
constexpr double kSecondsMin = 1e-4;

struct KeyPair {
  int imgui;
  Key key;
};
constexpr KeyPair kKeyPairs[] = {
    {ImGuiKey_Tab, Key::tab},
    {ImGuiKey_LeftArrow, Key::left},
    {ImGuiKey_RightArrow, Key::right},
    {ImGuiKey_UpArrow, Key::up},
    {ImGuiKey_DownArrow, Key::down},
    {ImGuiKey_PageUp, Key::page_up},
    {ImGuiKey_PageDown, Key::page_down},
    {ImGuiKey_Home, Key::home},
    {ImGuiKey_End, Key::end},
    {ImGuiKey_Insert, Key::insert},
    {ImGuiKey_Delete, Key::delete_forward},
    {ImGuiKey_Backspace, Key::backspace},
    {ImGuiKey_Space, Key::space},
    {ImGuiKey_Enter, Key::enter},
    {ImGuiKey_Escape, Key::escape},
    {ImGuiKey_KeyPadEnter, Key::keypad_enter},
    {ImGuiKey_A, Key::a},
    {ImGuiKey_C, Key::c},
    {ImGuiKey_V, Key::v},
    {ImGuiKey_X, Key::x},
    {ImGuiKey_Y, Key::y},
    {ImGuiKey_Z, Key::z},
};

void set_style(double scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 6;
  style.FrameRounding = 4;
  style.GrabRounding = 4;
  style.WindowBorderSize = 0;
  style.WindowPadding = {10, 10};
  style.Colors[ImGuiCol_WindowBg] = {0.07F, 0.08F, 0.10F, 0.93F};
  style.ScaleAllSizes(static_cast<float>(scale));
}

void load_font(double scale, const std::optional<ByteView>& font) {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  const auto pixels = static_cast<float>(kFontPixels * scale);
  std::size_t bytes = 0;
  void* file = nullptr;  // the atlas frees it
  if (!font) {
    file = ImFileLoadToMemory(kFontFile, "rb", &bytes);
  } else if (!font->empty()) {
    bytes = font->size();
    file = ImGui::MemAlloc(bytes);
    std::memcpy(file, font->data(), bytes);
  }
  if (file != nullptr) {
    fonts.AddFontFromMemoryTTF(file, static_cast<int>(bytes), pixels, nullptr, kGlyphRanges.data());
  } else {
    ImFontConfig config;
    config.SizePixels = pixels;
    fonts.AddFontDefault(&config);
  }
}

std::shared_ptr<const OverlayAtlas> take_atlas() {
  unsigned char* pixels = nullptr;
  OverlayAtlas atlas;
  ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &atlas.width, &atlas.height);
  atlas.coverage.assign(pixels, pixels + static_cast<std::ptrdiff_t>(atlas.width) * atlas.height);
  ImGui::GetIO().Fonts->ClearTexData();
  return std::make_shared<const OverlayAtlas>(std::move(atlas));
}

void add_list(const ImDrawList& list, OverlayFrame& out) {
  const auto first_vertex = static_cast<std::uint32_t>(out.vertices.size());
  const auto first_index = static_cast<std::uint32_t>(out.indices.size());
  for (const ImDrawVert& v : list.VtxBuffer)
    out.vertices.push_back({v.pos.x, v.pos.y, v.uv.x, v.uv.y, v.col});
  out.indices.insert(out.indices.end(), list.IdxBuffer.begin(), list.IdxBuffer.end());
  for (const ImDrawCmd& command : list.CmdBuffer) {
    if (command.UserCallback != nullptr || command.ElemCount == 0) continue;
    OverlayCommand added;
    added.clip = {command.ClipRect.x, command.ClipRect.y, command.ClipRect.z, command.ClipRect.w};
    added.first_index = first_index + command.IdxOffset;
    added.index_count = command.ElemCount;
    added.first_vertex = first_vertex + command.VtxOffset;
    added.image = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(command.TextureId));
    out.commands.push_back(added);
  }
}

/// The parts of an event batch that one frame of ImGui can take.
class FrameRoom {
 public:
  /// Returns true if the event fits the frame, and counts it.
  bool take(const InputEvent& event) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
      has_press_ = has_press_ || key->is_pressed;
      return !has_character_ && changed_keys_.insert(key->key).second;
    }
    if (std::holds_alternative<CharacterEvent>(event)) {
      has_character_ = true;
      return !has_press_;
    }
    if (const auto* button = std::get_if<ButtonEvent>(&event))
      return changed_buttons_.insert(button->button).second;
    if (std::holds_alternative<CursorEvent>(event)) return changed_buttons_.empty();
    return true;
  }

 private:
  std::set<Key> changed_keys_;
  std::set<MouseButton> changed_buttons_;
  bool has_press_ = false, has_character_ = false;
};

void apply(const InputEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    io.KeysDown[static_cast<std::size_t>(key->key)] = key->is_pressed;
    // An event of a modifier key has the modifiers from before it.
    const auto is_held = [&](Key left, Key right, bool of_event) {
      const bool is_down = io.KeysDown[static_cast<std::size_t>(left)] ||
                           io.KeysDown[static_cast<std::size_t>(right)];
      return is_down || (of_event && key->key != left && key->key != right);
    };
    io.KeyCtrl = is_held(Key::left_control, Key::right_control, key->control);
    io.KeyShift = is_held(Key::left_shift, Key::right_shift, key->shift);
    io.KeyAlt = is_held(Key::left_alt, Key::right_alt, key->alt);
  } else if (const auto* typed = std::get_if<CharacterEvent>(&event)) {
    io.AddInputCharacter(typed->character);
  } else if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
    io.MousePos = {static_cast<float>(cursor->x), static_cast<float>(cursor->y)};
  } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
    io.MouseDown[static_cast<std::size_t>(button->button)] = button->is_pressed;
  } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
    io.MouseWheel += static_cast<float>(wheel->steps);
  } else if (std::holds_alternative<FocusEvent>(event)) {
    io.ClearInputKeys();
  }
}

}  // namespace

void UiContext::Deleter::operator()(ImGuiContext* context) const { ImGui::DestroyContext(context); }

UiContext::UiContext(double scale, std::optional<ByteView> font)
    : scale_(scale), context_(ImGui::CreateContext()) {
  ImGui::SetCurrentContext(context_.get());
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  for (const KeyPair& pair : kKeyPairs) io.KeyMap[pair.imgui] = static_cast<int>(pair.key);
  set_style(scale);
  load_font(scale, font);
  atlas_ = take_atlas();
}

UiContext::~UiContext() = default;

void UiContext::set_keyboard(bool is_on) {
  ImGui::SetCurrentContext(context_.get());
  ImGuiConfigFlags& flags = ImGui::GetIO().ConfigFlags;
  flags = is_on ? flags | ImGuiConfigFlags_NavEnableKeyboard
                : flags & ~ImGuiConfigFlags_NavEnableKeyboard;
}

void UiContext::focus_window() {
  ImGui::SetCurrentContext(context_.get());
  constexpr ImGuiWindowFlags kOther = ImGuiWindowFlags_NoNavFocus | ImGuiWindowFlags_ChildWindow |
                                      ImGuiWindowFlags_Tooltip | ImGuiWindowFlags_NoNavInputs;
  // The windows are in the order in which they are drawn.
  for (int i = context_->Windows.Size - 1; i >= 0; --i) {
    ImGuiWindow* const window = context_->Windows[i];
    if (!window->Active || window->IsFallbackWindow || (window->Flags & kOther) != 0) continue;
    ImGui::FocusWindow(window);
    ImGui::NavInitWindow(window, true);
    context_->NavDisableHighlight = false;
    return;
  }
}

void UiContext::release_all() {
  ImGui::SetCurrentContext(context_.get());
  events_.clear();
  ImGuiIO& io = ImGui::GetIO();
  io.ClearInputKeys();
  io.ClearInputCharacters();
  std::fill(std::begin(io.MouseDown), std::end(io.MouseDown), false);
}

void UiContext::feed(const std::vector<InputEvent>& events) {
  events_.insert(events_.end(), events.begin(), events.end());
}

void UiContext::apply_events() {
  FrameRoom room;
  while (!events_.empty() && room.take(events_.front())) {
    apply(events_.front());
    events_.pop_front();
  }
}

std::shared_ptr<const OverlayFrame> UiContext::make_frame(std::array<int, 2> size, double seconds,
                                                          const std::function<void()>& build) {
  ImGui::SetCurrentContext(context_.get());
  do {
    apply_events();
    run_frame(size, std::exchange(seconds, 0), build);
  } while (!events_.empty());
  return overlay_frame();
}

void UiContext::make_hidden_frame(std::array<int, 2> size, const std::function<void()>& build) {
  ImGui::SetCurrentContext(context_.get());
  run_frame(size, 0, build);
}

void UiContext::run_frame(std::array<int, 2> size, double seconds,
                          const std::function<void()>& build) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(size[0]), static_cast<float>(size[1])};
  io.DeltaTime = static_cast<float>(std::max(seconds, kSecondsMin));
  images_.clear();
  ImGui::NewFrame();
  build();
  ImGui::Render();
}

std::shared_ptr<const OverlayFrame> UiContext::overlay_frame() const {
  const ImDrawData& data = *ImGui::GetDrawData();
  OverlayFrame out;
  out.width = static_cast<int>(data.DisplaySize.x);
  out.height = static_cast<int>(data.DisplaySize.y);
  out.vertices.reserve(static_cast<std::size_t>(data.TotalVtxCount));
  out.indices.reserve(static_cast<std::size_t>(data.TotalIdxCount));
  for (int i = 0; i < data.CmdListsCount; ++i) add_list(*data.CmdLists[i], out);
  out.atlas = atlas_;
  out.images = images_;
  return std::make_shared<const OverlayFrame>(std::move(out));
}

void* UiContext::add_image(std::shared_ptr<const OverlayImage> image) {
  images_.push_back(std::move(image));
  return reinterpret_cast<void*>(static_cast<std::uintptr_t>(images_.size()));
}

bool UiContext::types() const {
  ImGui::SetCurrentContext(context_.get());
  return ImGui::GetIO().WantTextInput;
}

std::string UiContext::field_text() const {
  ImGui::SetCurrentContext(context_.get());
  const ImGuiInputTextState* const state = ImGui::GetInputTextState(ImGui::GetActiveID());
  if (state == nullptr || state->ID == 0) return {};
  const ImWchar* const begin = state->TextW.Data;
  std::string out(
      static_cast<std::size_t>(ImTextCountUtf8BytesFromStr(begin, begin + state->CurLenW)), '\0');
  // The function writes a terminating zero, for which a string has room.
  ImTextStrToUtf8(out.data(), static_cast<int>(out.size()) + 1, begin, begin + state->CurLenW);
  return out;
}

bool UiContext::over_window() const {
  ImGui::SetCurrentContext(context_.get());
  return ImGui::GetIO().WantCaptureMouse;
}

bool UiContext::has_window_at(double x, double y) const {
  const ImVec2 at(static_cast<float>(x), static_cast<float>(y));
  for (const ImGuiWindow* window : context_->Windows) {
    const bool takes_mouse =
        window->Active && !window->Hidden && (window->Flags & ImGuiWindowFlags_NoMouseInputs) == 0;
    if (takes_mouse && window->Rect().Contains(at)) return true;
  }
  return false;
}

}  // namespace runstone
