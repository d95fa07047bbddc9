#include "client/ui/menu.hpp"

#include <imgui.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "client/ui/text_field.hpp"

namespace runstone {
namespace {

constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
constexpr std::array<const char*, 4> kGenerators = {"landscape", "terrain", "flat", "empty"};
constexpr std::array<const char*, 4> kGeneratorTexts = {"landscape", "hills and sea", "flat ground",
                                                        "nothing"};
const ImVec4 kWarning{1.0F, 0.62F, 0.45F, 1.0F};
const ImVec4 kQuiet{0.65F, 0.68F, 0.72F, 1.0F};

/// Begins a window in the middle of the frame.
void begin_centred(const char* name, std::array<int, 2> size, double width, double height,
                   ImGuiWindowFlags flags) {
  const ImVec2 frame{static_cast<float>(size[0]), static_cast<float>(size[1])};
  const float w = std::min(static_cast<float>(width), frame.x);
  const float h = std::min(static_cast<float>(height), frame.y);
  ImGui::SetNextWindowPos({frame.x / 2, frame.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
  if (height > 0) {
    ImGui::SetNextWindowSize({w, h});
  } else {
    ImGui::SetNextWindowSizeConstraints({w, 0}, {w, frame.y});
    flags |= ImGuiWindowFlags_AlwaysAutoResize;
  }
  ImGui::Begin(name, nullptr, flags);
}

/// Draws a headline that is larger than the text.
void headline(const char* text, double times) {
  ImGui::SetWindowFontScale(static_cast<float>(times));
  ImGui::TextUnformatted(text);
  ImGui::SetWindowFontScale(1);
}

void wrapped(const std::string& text, ImVec4 colour) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

bool wide_button(const char* label) { return ImGui::Button(label, {-1, 0}); }

bool is_pressed(ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key), false); }

/// Makes the button that space and enter press while no other one is chosen by the arrows. ImGui
/// itself lets keys press a button only after an arrow key.
bool first_button(const char* label) {
  const bool is_clicked = wide_button(label);
  ImGui::SetItemDefaultFocus();
  const ImGuiIO& io = ImGui::GetIO();
  return is_clicked || (!io.NavVisible && !io.WantTextInput &&
                        (is_pressed(ImGuiKey_Space) || is_pressed(ImGuiKey_Enter)));
}

std::optional<std::uint64_t> number_in(const std::string& text) {
  std::uint64_t out = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() ? std::optional(out) : std::nullopt;
}

}  // namespace

Menu::Menu(const ClientSettings& settings)
    : context_(settings.interface_scale), settings_(settings) {
  context_.set_keyboard(true);
}

void Menu::reset() {
  shown_ = Screen::none;
  shows_settings_ = false;
  password_.clear();
  context_.release_all();
}

std::shared_ptr<const OverlayFrame> Menu::title(const TitleState& state, std::array<int, 2> size,
                                                double seconds) {
  const Screen screen = state.asks_password_of.empty() ? Screen::title : Screen::password;
  return make_frame(screen, size, seconds, [&] {
    if (shows_settings_) return build_settings(size);
    if (screen == Screen::password) return build_password(state.asks_password_of, size);
    build_title(state, size);
  });
}

std::shared_ptr<const OverlayFrame> Menu::connecting(const ConnectingState& state,
                                                     std::array<int, 2> size, double seconds) {
  return make_frame(Screen::connecting, size, seconds, [&] { build_connecting(state, size); });
}

std::shared_ptr<const OverlayFrame> Menu::pause(const PauseState& state, std::array<int, 2> size,
                                                double seconds) {
  return make_frame(Screen::pause, size, seconds, [&] {
    if (shows_settings_) return build_settings(size);
    build_pause(state, size);
  });
}

std::shared_ptr<const OverlayFrame> Menu::make_frame(Screen screen, std::array<int, 2> size,
                                                     double seconds,
                                                     const std::function<void()>& build) {
  if (screen != Screen::connecting && shows_settings_) screen = Screen::settings;
  if (std::exchange(shown_, screen) != screen) {
    for (int i = 0; i < UiContext::kFocusFrames; ++i) context_.make_hidden_frame(size, build);
  }
  return context_.make_frame(size, seconds, build);
}

void Menu::join(std::string address) {
  if (!address.empty()) actions_.emplace_back(JoinAddress{std::move(address), name_});
}

void Menu::build_title(const TitleState& state, std::array<int, 2> size) {
  if (!std::exchange(has_name_, true)) name_ = state.name;
  const double scale = context_.scale();
  begin_centred("title", size, 860 * scale, 560 * scale, kFixed);
  headline("Runstone", 2.4);
  ImGui::TextColored(kQuiet, "A world of runs, built together.");
  ImGui::Dummy({0, static_cast<float>(6 * scale)});
  if (!state.failure.headline.empty()) build_failure(state.failure);
  if (!state.notice.empty()) wrapped(state.notice, kQuiet);
  const float below = static_cast<float>(58 * scale);
  const float half = ImGui::GetContentRegionAvail().x / 2 - static_cast<float>(4 * scale);
  ImGui::BeginChild("worlds", {half, -below}, true, ImGuiWindowFlags_NavFlattened);
  build_worlds(state);
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("servers", {0, -below}, true, ImGuiWindowFlags_NavFlattened);
  build_servers(state);
  ImGui::EndChild();
  ImGui::SetNextItemWidth(static_cast<float>(200 * scale));
  text_field("your name", "builder", name_);
  ImGui::SameLine();
  ImGui::TextColored(kQuiet, "identity %s", state.identity.c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", state.key_file.c_str());
  if (ImGui::Button("Settings")) {
    form_.begin(settings_);
    shows_settings_ = true;
  }
  ImGui::SameLine();
  if (ImGui::Button("Quit")) actions_.emplace_back(QuitProgram{});
  ImGui::End();
}

void Menu::build_failure(const ShownFailure& failure) {
  ImGui::PushStyleColor(ImGuiCol_Text, kWarning);
  headline(failure.headline.c_str(), 1.15);
  ImGui::PopStyleColor();
  if (!failure.detail.empty()) wrapped(failure.detail, kQuiet);
  ImGui::Separator();
}

void Menu::build_worlds(const TitleState& state) {
  headline("On this computer", 1.3);
  if (state.worlds.empty()) {
    wrapped("One click makes a world with mountains, rivers and forests, for you alone.", kQuiet);
    if (first_button("Build here"))
      actions_.emplace_back(MakeLocalWorld{state.first_world, name_, kGenerators[0], {}});
  }
  for (std::size_t i = 0; i < state.worlds.size(); ++i) {
    const ListedWorld& world = state.worlds[i];
    const std::string label = world.name + "    " + world.changed + "##world";
    if (i == 0 ? first_button(label.c_str()) : wide_button(label.c_str()))
      actions_.emplace_back(JoinLocalWorld{world.name, name_});
  }
  ImGui::Separator();
  ImGui::TextUnformatted("A new world");
  text_field("its name", "castle", world_);
  ImGui::Combo("ground", &generator_, kGeneratorTexts.data(), kGeneratorTexts.size());
  // The landscape and the terrain depend on a seed.
  if (generator_ <= 1) text_field("seed", "random", seed_, ImGuiInputTextFlags_CharsDecimal);
  if (ImGui::Button("Make it")) {
    actions_.emplace_back(MakeLocalWorld{
        world_, name_, kGenerators.at(static_cast<std::size_t>(generator_)), number_in(seed_)});
  }
}

void Menu::build_servers(const TitleState& state) {
  headline("With others", 1.3);
  ImGui::SetNextItemWidth(-static_cast<float>(70 * context_.scale()));
  const bool is_entered = text_field("##address", "HOST, HOST:PORT or runstone://…", address_,
                                     ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  if (ImGui::Button("Join") || is_entered) join(address_);
  ImGui::Separator();
  if (state.servers.empty()) wrapped("Servers that you joined are listed here.", kQuiet);
  for (const ListedServer& server : state.servers) {
    if (wide_button((server.address + "##server").c_str())) join(server.address);
    if (ImGui::IsItemHovered()) {
      ImGui::SetTooltip("as %s, %s", server.name.c_str(), server.joined.c_str());
    }
  }
}

void Menu::build_password(const std::string& address, std::array<int, 2> size) {
  begin_centred("password", size, 460 * context_.scale(), 0, kFixed);
  headline("This world has a password", 1.3);
  wrapped(address + " lets in who knows it. Your key is enough afterwards.", kQuiet);
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const bool is_entered =
      text_field("##password", "password", password_,
                 ImGuiInputTextFlags_Password | ImGuiInputTextFlags_EnterReturnsTrue);
  if ((ImGui::Button("Join") || is_entered) && !password_.empty())
    actions_.emplace_back(GivePassword{std::exchange(password_, {})});
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) actions_.emplace_back(CancelJoin{});
  ImGui::End();
}

void Menu::build_connecting(const ConnectingState& state, std::array<int, 2> size) {
  const double scale = context_.scale();
  begin_centred("connecting", size, 520 * scale, 0, kFixed);
  headline(state.to.c_str(), 1.3);
  ImGui::TextUnformatted(state.step.c_str());
  if (state.progress >= 0) ImGui::ProgressBar(static_cast<float>(state.progress), {-1, 0});
  if (!state.detail.empty()) wrapped(state.detail, kWarning);
  ImGui::Dummy({0, static_cast<float>(4 * scale)});
  if (ImGui::Button("Cancel")) actions_.emplace_back(CancelJoin{});
  ImGui::End();
}

void Menu::build_pause(const PauseState& state, std::array<int, 2> size) {
  begin_centred("pause", size, 340 * context_.scale(), 0, kFixed);
  headline(state.where.c_str(), 1.3);
  if (!state.players.empty()) ImGui::TextColored(kQuiet, "%s", state.players.c_str());
  if (first_button("Go on")) actions_.emplace_back(ResumePlay{});
  if (wide_button("Settings")) {
    form_.begin(settings_);
    shows_settings_ = true;
  }
  if (wide_button(state.is_local ? "Save and leave" : "Leave"))
    actions_.emplace_back(LeaveServer{});
  if (wide_button("Quit")) actions_.emplace_back(QuitProgram{});
  ImGui::End();
}

void Menu::build_settings(std::array<int, 2> size) {
  begin_centred("settings", size, 480 * context_.scale(), 0, kFixed);
  headline("Settings", 1.3);
  const SettingsForm::Result result = form_.build(context_.scale());
  if (result == SettingsForm::Result::kept) {
    if (form_.edited().name != settings_.name) name_ = form_.edited().name;
    settings_ = form_.edited();
    actions_.emplace_back(ChangeSettings{settings_});
  }
  if (result != SettingsForm::Result::open) shows_settings_ = false;
  ImGui::End();
}

}  // namespace runstone
