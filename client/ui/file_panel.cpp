#include "client/ui/file_panel.hpp"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <array>

#include "common/models/model_format.hpp"

namespace runstone {
namespace {

constexpr std::array<const char*, 4> kTurns = {"0", "90", "180", "270"};
/// The words are those of the converter. The first of each leaves the choice to the file.
constexpr std::array<const char*, 3> kUps = {"as usual", "y", "z"};
constexpr std::array<const char*, 5> kSurfaces = {"as usual", "none", "thin", "thick", "all"};
constexpr std::array<SurfaceMode, 4> kSurfaceModes = {SurfaceMode::none, SurfaceMode::separating_6,
                                                      SurfaceMode::separating_26,
                                                      SurfaceMode::conservative};
const ImVec4 kFileWarning = {1, 0.82F, 0.47F, 1};

template <std::size_t kCount>
void model_choice(const char* label, int& value, const std::array<const char*, kCount>& names,
                  const char* help) {
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6);
  ImGui::Combo(label, &value, names.data(), static_cast<int>(kCount));
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
}

}  // namespace

bool FilePanel::build(const HudState& state) {
  ImGui::Separator();
  if (!state.file.text.empty()) return build_progress(state.file), false;
  ImGui::SetNextItemWidth(-1);
  ImGui::InputTextWithHint("##file", "path, such as ~/castle.schem", &file_);
  if (file_.empty() && ImGui::IsItemHovered()) {
    ImGui::SetTooltip(
        "The ending names the format: .schem, .litematic, .vox, .mts, .rsb and others; .obj, "
        ".stl, .ply, .gltf and .glb are models, which become voxels.\n"
        "A file that is dropped on the window is loaded, too.");
  }
  std::string why;
  if (model_format_of(file_)) {
    build_choices();
    why = refusal();
    if (!why.empty()) ImGui::TextColored(kFileWarning, "%s", why.c_str());
  }
  bool copies = false;
  ImGui::BeginDisabled(file_.empty());
  ImGui::BeginDisabled(!why.empty());
  if (ImGui::Button("Load into the clipboard")) wanted_ = ClipboardOfFile{file_, false, choices()};
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(!state.tools->clipboard().build);
  if (ImGui::Button("Save the clipboard")) wanted_ = ClipboardOfFile{file_, true};
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(!state.tools->selection());
  if (ImGui::Button("Save the selection")) {
    copies = true;
    wanted_ = ClipboardOfFile{file_, true};
  }
  ImGui::EndDisabled();
  ImGui::EndDisabled();
  return copies;
}

ClipboardOfFile FilePanel::drop(std::string file) {
  file_ = std::move(file);
  return {file_, false, refusal().empty() ? choices() : ModelChoices{}};
}

void FilePanel::build_progress(const FileState& file) {
  ImGui::TextUnformatted(file.text.c_str());
  if (file.share) ImGui::ProgressBar(static_cast<float>(*file.share), {-1, 0});
  if (file.can_stop && ImGui::Button("Stop")) wanted_ = FileStop{};
}

void FilePanel::build_choices() {
  ImGui::PushID("model");
  int size = is_by_metres_ ? 1 : 0;
  ImGui::RadioButton("longest side", &size, 0);
  ImGui::SameLine();
  ImGui::RadioButton("metres", &size, 1);
  ImGui::SameLine();
  is_by_metres_ = size == 1;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6);
  if (is_by_metres_) {
    ImGui::InputDouble("voxels per metre", &voxels_per_metre_, 0, 0, "%.6g");
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("If the file has no units, a unit of it is a metre.");
  } else {
    ImGui::InputInt("voxels", &voxels_, 0);
  }
  int is_hollow = model_.is_solid ? 0 : 1;
  ImGui::RadioButton("solid", &is_hollow, 0);
  ImGui::SameLine();
  ImGui::RadioButton("hollow", &is_hollow, 1);
  model_.is_solid = is_hollow == 0;
  ImGui::SameLine();
  ImGui::BeginDisabled(!model_.is_solid);
  ImGui::Checkbox("fill overlaps", &model_.fills_overlaps);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("The inside is filled also where closed parts overlap.");
  ImGui::EndDisabled();
  int surface = 0;
  for (std::size_t i = 0; i < kSurfaceModes.size(); ++i) {
    if (model_.surface == kSurfaceModes[i]) surface = static_cast<int>(i) + 1;
  }
  model_choice(
      "surface", surface, kSurfaces,
      "What the surface sets besides the inside: none; thin, which keeps walls without the "
      "centre of a voxel; thick; or all voxels that it touches.\n"
      "As usual: none, and thin if the model is hollow or nothing lies inside.");
  model_.surface.reset();
  if (surface != 0) model_.surface = kSurfaceModes[static_cast<std::size_t>(surface) - 1];
  ImGui::SameLine();
  int up = model_.up ? (*model_.up == ModelUp::y ? 1 : 2) : 0;
  model_choice("up", up, kUps,
               "The axis of the file that points up.\n"
               "As usual: z for .stl and .ply, otherwise y.");
  model_.up.reset();
  if (up != 0) model_.up = up == 1 ? ModelUp::y : ModelUp::z;
  ImGui::SameLine();
  model_choice("turn", model_.quarters, kTurns, "Degrees to the left, as seen from above");
  ImGui::PopID();
}

std::string FilePanel::refusal() const {
  std::string why;
  if (is_by_metres_) {
    if (why = voxels_per_metre_refusal(voxels_per_metre_); !why.empty())
      return "voxels per metre: " + why;
  } else if (why = voxels_refusal(voxels_); !why.empty()) {
    return "voxels: " + why;
  }
  return choices_refusal(model_);
}

ModelChoices FilePanel::choices() const {
  ModelChoices out = model_;
  if (is_by_metres_) {
    out.voxels_per_metre = voxels_per_metre_;
  } else {
    out.voxels = static_cast<std::uint32_t>(voxels_);
  }
  return out;
}

}  // namespace runstone
