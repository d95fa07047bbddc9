#include "client/ui/library_window.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "client/ui/text_field.hpp"
#include "client/ui/ui_draw.hpp"
#include "common/core/text.hpp"

namespace runstone {
namespace {

constexpr double kWindowWidth = 600, kListHeight = 190, kPictureSide = 168;  // at scale 1
constexpr ImU32 kRefusedColour = IM_COL32(255, 153, 128, 255);

void show_text(const std::string& text) {
  ImGui::TextUnformatted(text.c_str(), text.c_str() + text.size());
}

void show_wrapped(const std::string& text) {
  ImGui::PushTextWrapPos(0);
  show_text(text);
  ImGui::PopTextWrapPos();
}

void show_refusal(const std::string& text) {
  if (text.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, kRefusedColour);
  show_wrapped(text);
  ImGui::PopStyleColor();
}

std::string file_size_text(std::uint64_t bytes) {
  if (bytes < 1024) return fmt::format("{} B", bytes);
  if (bytes < 1024 * 1024) return fmt::format("{:.1f} KiB", static_cast<double>(bytes) / 1024);
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024 * 1024));
}

std::string tags_text(const std::vector<std::string>& tags) {
  std::string out;
  for (const std::string& tag : tags) out += (out.empty() ? "" : ", ") + tag;
  return out;
}

std::string sides_text(const BuildSides& sides) {
  return fmt::format("{} x {} x {}", sides.x, sides.y, sides.z);
}

std::string adder_text(const ListedBuild& build) {
  if (build.added_by == 0) return "the server";
  if (build.added_by_name.empty()) return "#" + std::to_string(build.added_by);
  return with_unseen_replaced(build.added_by_name);
}

void show_progress(const char* what, std::uint64_t done, std::uint64_t all) {
  const std::string text =
      all == 0 ? std::string(what)
               : fmt::format("{} {} of {}", what, file_size_text(done), file_size_text(all));
  const float share =
      all == 0 ? 0 : static_cast<float>(static_cast<double>(done) / static_cast<double>(all));
  ImGui::ProgressBar(share, {-1, 0}, text.c_str());
}

}  // namespace

void LibraryWindow::set_open(bool is_open) {
  is_new_ = is_open && !is_open_;
  is_open_ = is_open;
}

void LibraryWindow::build_search(const LibraryState& state, double scale) {
  bool is_entered = false;
  for (const auto& [label, hint, text] : {std::tuple{"##name", "part of the name", &name_},
                                          std::tuple{"##author", "part of the author", &author_},
                                          std::tuple{"##tag", "tag", &tag_}}) {
    ImGui::SetNextItemWidth(static_cast<float>(150 * scale));
    is_entered = text_field(label, hint, *text, ImGuiInputTextFlags_EnterReturnsTrue) || is_entered;
    ImGui::SameLine();
  }
  const bool is_pressed = ImGui::Button("Search");
  // The list may be old when the window is opened again.
  const bool is_old = is_new_ && state.builds != nullptr && !state.is_listing;
  if (is_pressed || is_entered || is_old) order_ = FindBuilds{name_, author_, tag_};
  is_new_ = false;
  show_refusal(state.list_refusal);
}

void LibraryWindow::build_list(const LibraryState& state, double scale) {
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
                                     ImGuiTableFlags_BordersOuter | ImGuiTableFlags_Resizable |
                                     ImGuiTableFlags_NoSavedSettings;
  if (ImGui::BeginTable("builds", 6, kFlags, {0, static_cast<float>(kListHeight * scale)})) {
    ImGui::TableSetupScrollFreeze(0, 1);
    constexpr std::array<std::pair<const char*, float>, 6> kColumns = {{{"Number", 1},
                                                                        {"Name", 2.4F},
                                                                        {"Author", 1.5F},
                                                                        {"Size", 1.7F},
                                                                        {"File", 1.1F},
                                                                        {"Tags", 2}}};
    for (const auto& [title, weight] : kColumns)
      ImGui::TableSetupColumn(title, ImGuiTableColumnFlags_WidthStretch, weight);
    ImGui::TableHeadersRow();
    ImGuiListClipper clipper;
    clipper.Begin(state.builds == nullptr ? 0 : static_cast<int>(state.builds->size()));
    while (clipper.Step()) {
      for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
        const ListedBuild& build = (*state.builds)[static_cast<std::size_t>(row)];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const std::string label = fmt::format("{}##build{}", build.number, build.number);
        if (ImGui::Selectable(label.c_str(), build.number == selected_,
                              ImGuiSelectableFlags_SpanAllColumns)) {
          selected_ = build.number;
          drop_ = 0;
          if (build.file_bytes <= kShownBytesMax && state.pictured != selected_)
            order_ = ShowBuild{selected_};
        }
        for (const std::string& text :
             {build.info.name, build.info.author, sides_text(build.info.sides),
              file_size_text(build.file_bytes), tags_text(build.info.tags)}) {
          ImGui::TableNextColumn();
          show_text(text);
        }
      }
    }
    ImGui::EndTable();
  }
  if (enabled_button("More", state.has_more && !state.is_listing)) order_ = FindMoreBuilds{};
  ImGui::SameLine();
  if (state.is_listing) {
    ImGui::TextDisabled("the server searches ...");
  } else if (state.builds != nullptr) {
    ImGui::TextDisabled("%s",
                        fmt::format("{}{} shown; the library has {}", state.builds->size(),
                                    state.builds->size() == 1 ? " build" : " builds", state.total)
                            .c_str());
  }
}

void LibraryWindow::build_buttons(const LibraryState& state, const ListedBuild& build) {
  const bool is_fetching = state.fetching != 0;
  if (enabled_button("Take", !state.is_taking)) order_ = TakeBuild{build.number};
  ImGui::SameLine();
  if (enabled_button("Show picture", !is_fetching && state.pictured != build.number))
    order_ = ShowBuild{build.number};
  ImGui::SameLine();
  if (enabled_button("Stop", is_fetching)) order_ = StopFetch{};
  ImGui::SameLine();
  const bool may_remove = state.removes_all || (state.me != 0 && build.added_by == state.me);
  if (drop_ != build.number) {
    if (enabled_button("Remove", may_remove && !state.is_removing)) drop_ = build.number;
    return;
  }
  if (enabled_button("Remove for ever", may_remove && !state.is_removing)) {
    order_ = DropBuild{build.number};
    drop_ = 0;
  }
  ImGui::SameLine();
  if (ImGui::Button("Keep")) drop_ = 0;
}

void LibraryWindow::build_selected(const LibraryState& state, UiContext& context) {
  const ListedBuild* build = nullptr;
  if (state.builds != nullptr) {
    const auto found = std::find_if(state.builds->begin(), state.builds->end(),
                                    [&](const ListedBuild& b) { return b.number == selected_; });
    if (found != state.builds->end()) build = &*found;
  }
  ImGui::Separator();
  const auto side = static_cast<float>(kPictureSide * context.scale());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + side, at.y + side},
                                            IM_COL32(22, 26, 32, 255));
  if (build != nullptr && state.picture != nullptr && state.pictured == build->number) {
    const OverlayImage& image = *state.picture;
    const float factor = side / static_cast<float>(std::max(image.width, image.height));
    const ImVec2 size{static_cast<float>(image.width) * factor,
                      static_cast<float>(image.height) * factor};
    const ImVec2 from{at.x + (side - size.x) / 2, at.y + (side - size.y) / 2};
    ImGui::GetWindowDrawList()->AddImage(context.add_image(state.picture), from,
                                         {from.x + size.x, from.y + size.y});
  }
  ImGui::Dummy({side, side});
  ImGui::SameLine();
  ImGui::BeginGroup();
  if (build == nullptr) {
    ImGui::TextDisabled("Select a build in the list.");
  } else {
    show_wrapped(build->info.name);
    show_text(fmt::format("{} voxels, {} of them in the build", sides_text(build->info.sides),
                          build->touched));
    show_text("file: " + file_size_text(build->file_bytes));
    if (!build->info.author.empty()) show_text("author: " + build->info.author);
    show_text("added by: " + adder_text(*build));
    if (!build->info.tags.empty()) show_wrapped("tags: " + tags_text(build->info.tags));
    build_buttons(state, *build);
  }
  if (state.fetching != 0) {
    show_progress(fmt::format("build {}:", state.fetching).c_str(), state.fetched_bytes,
                  state.fetch_bytes);
  } else if (!state.fetch_text.empty()) {
    show_wrapped(state.fetch_text);
  }
  if (!state.remove_text.empty()) show_wrapped(state.remove_text);
  ImGui::EndGroup();
}

void LibraryWindow::build_adding(const LibraryState& state, double scale) {
  ImGui::Separator();
  if (state.clipboard.empty()) {
    ImGui::TextDisabled("To add a build, copy a selection first.");
  } else {
    show_text("Add the clipboard (" + state.clipboard + ") to the library:");
    ImGui::SetNextItemWidth(static_cast<float>(200 * scale));
    static_cast<void>(text_field("##add_name", "name of the build", add_name_));
    ImGui::SameLine();
    ImGui::SetNextItemWidth(static_cast<float>(200 * scale));
    static_cast<void>(text_field("##add_tags", "tags, with commas between", add_tags_));
    ImGui::SameLine();
    if (state.is_adding) {
      if (ImGui::Button("Stop##adding")) order_ = StopAdding{};
    } else if (ImGui::Button("Add")) {
      order_ = AddClipboard{add_name_, add_tags_};
    }
  }
  if (state.is_adding) {
    show_progress(state.add_bytes == 0 ? "the file is made ..." : "sent:", state.added_bytes,
                  state.add_bytes);
  } else if (!state.add_text.empty()) {
    show_wrapped(state.add_text);
  }
}

std::optional<LibraryOrder> LibraryWindow::build(const LibraryState& state, UiContext& context) {
  if (!is_open_) return std::nullopt;
  const bool has_taken = std::exchange(taken_, state.taken) != state.taken && !is_new_;
  if (has_taken) {
    is_open_ = false;
    return std::nullopt;
  }
  order_.reset();
  const double scale = context.scale();
  const auto margin = static_cast<float>(10 * scale);
  ImGui::SetNextWindowPos({margin, static_cast<float>(90 * scale)}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({static_cast<float>(kWindowWidth * scale), 0});
  ImGui::Begin("Builds", &is_open_,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  if (!state.unavailable.empty()) {
    show_wrapped(state.unavailable);
    is_new_ = false;
  } else {
    build_search(state, scale);
    build_list(state, scale);
    build_selected(state, context);
    build_adding(state, scale);
  }
  ImGui::End();
  return std::exchange(order_, std::nullopt);
}

}  // namespace runstone
