#include "client/ui/rollback_window.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "client/ui/log_words.hpp"
#include "client/ui/ui_draw.hpp"

namespace runstone {
namespace {

const char* phase_text(RollbackPhase phase) {
  switch (phase) {
    case RollbackPhase::idle:
      return "";
    case RollbackPhase::previewing:
      return "the server computes what would change ...";
    case RollbackPhase::previewed:
      return "nothing has changed yet";
    case RollbackPhase::applying:
      return "the rollback is applied ...";
    case RollbackPhase::applied:
      return "the rollback is done";
    case RollbackPhase::undoing:
      return "the rollback is taken back ...";
  }
  return "";
}

}  // namespace

void RollbackWindow::build_choice(const RollbackState& state) {
  const auto name_of = [&](const std::optional<AuthorId>& author) -> std::string {
    if (!author) return "everybody";
    for (const auto& [id, name] : state.authors) {
      if (id == *author) return name;
    }
    return "#" + std::to_string(*author);
  };
  if (ImGui::BeginCombo("edits of", name_of(choice_.author).c_str())) {
    if (ImGui::Selectable("everybody", !choice_.author)) choice_.author.reset();
    for (const auto& [author, name] : state.authors) {
      const std::string label = fmt::format("{}##{}", name, author);
      ImGui::PushStyleColor(ImGuiCol_Text, author_colour(author));
      if (ImGui::Selectable(label.c_str(), choice_.author == author)) choice_.author = author;
      ImGui::PopStyleColor();
    }
    ImGui::EndCombo();
  }
  ImGui::InputInt("of the last minutes", &choice_.minutes, 5, 60);
  choice_.minutes = std::clamp(choice_.minutes, 1, kRollbackMinutesMax);
  for (const auto& [label, minutes] : {std::pair{"10 minutes", 10}, std::pair{"1 hour", 60},
                                       std::pair{"1 day", 1440}, std::pair{"1 week", 10'080}}) {
    if (ImGui::SmallButton(label)) choice_.minutes = minutes;
    ImGui::SameLine();
  }
  ImGui::NewLine();
  const auto area = [this](const char* label, RollbackArea which, bool is_enabled) {
    ImGui::BeginDisabled(!is_enabled);
    if (ImGui::RadioButton(label, choice_.area == which)) choice_.area = which;
    ImGui::EndDisabled();
    ImGui::SameLine();
  };
  if (!state.has_selection && choice_.area == RollbackArea::selection)
    choice_.area = RollbackArea::everywhere;
  area("everywhere", RollbackArea::everywhere, true);
  area("in the selection", RollbackArea::selection, state.has_selection);
  area("around me", RollbackArea::around_me, true);
  ImGui::NewLine();
  if (choice_.area != RollbackArea::around_me) return;
  ImGui::InputInt("voxels around me", &choice_.radius, 8, 64);
  choice_.radius = std::clamp(choice_.radius, 1, kRollbackRadiusMax);
}

std::optional<RollbackOrder> RollbackWindow::build_buttons(const RollbackState& state) {
  std::optional<RollbackOrder> out;
  const RollbackPhase phase = state.phase;
  const bool is_busy = phase == RollbackPhase::previewing || phase == RollbackPhase::applying ||
                       phase == RollbackPhase::undoing;
  if (enabled_button("preview", !is_busy)) out = PreviewRollback{choice_};
  ImGui::SameLine();
  if (enabled_button("apply", phase == RollbackPhase::previewed)) out = ApplyRollback{};
  ImGui::SameLine();
  if (enabled_button("undo rollback", phase == RollbackPhase::applied)) out = UndoRollback{};
  ImGui::SameLine();
  if (enabled_button("forget", phase == RollbackPhase::previewed)) out = ForgetRollback{};
  return out;
}

std::optional<RollbackOrder> RollbackWindow::build(const RollbackState& state, double scale) {
  if (!is_open_) return std::nullopt;
  const auto margin = static_cast<float>(10 * scale);
  ImGui::SetNextWindowPos({margin, static_cast<float>(120 * scale)}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({static_cast<float>(430 * scale), 0});
  ImGui::Begin("Rollback", &is_open_,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  std::optional<RollbackOrder> out;
  if (!state.is_allowed) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(
        "Your role does not allow to take back the edits of others. Whoever runs the server can "
        "give you a role with the right roll_back.");
    ImGui::PopTextWrapPos();
  } else {
    ImGui::PushItemWidth(static_cast<float>(190 * scale));
    build_choice(state);
    ImGui::PopItemWidth();
    out = build_buttons(state);
    ImGui::TextDisabled("%s", phase_text(state.phase));
    if (state.phase == RollbackPhase::previewed) {
      ImGui::Text(
          "%s",
          fmt::format("{} voxels in {} chunks would change", state.voxels, state.chunks).c_str());
      ImGui::TextColored(
          {0.55F, 0.85F, 1, 1}, "%s",
          fmt::format("in view: {} would come back or change", state.placed).c_str());
      ImGui::TextColored({1, 0.5F, 0.45F, 1}, "%s",
                         fmt::format("in view: {} would go", state.removed).c_str());
      if (state.is_cut)
        ImGui::TextDisabled("only the nearest changes are shown as ghosts: there are too many");
    }
    ImGui::PushTextWrapPos(0);
    for (const std::string& line : state.answer) ImGui::TextUnformatted(line.c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
  return out;
}

}  // namespace runstone
