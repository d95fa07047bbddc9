#include "client/ui/map_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "client/ui/ui_draw.hpp"
#include "common/materials/readable_name.hpp"

namespace runstone {
namespace {

constexpr double kZoomStep = 1.25;  // of a step of the wheel
constexpr float kDragPixels = 4;    // a press that moves less far is a click
constexpr double kArrowPixels = 8;  // at scale 1
constexpr ImU32 kUnknown = IM_COL32(22, 26, 32, 255);
constexpr ImU32 kMe = IM_COL32(255, 240, 90, 255), kOther = IM_COL32(255, 255, 255, 255);
constexpr ImU32 kSpawn = IM_COL32(255, 120, 90, 255);

}  // namespace

/// The part of the window that shows the map.
struct MapWindow::Canvas {
  ImVec2 from, to;  // pixels
  double zoom = 1;  // pixels for each voxel
  double centre_x = 0, centre_z = 0;
  double scale = 1;  // of the interface

  ImVec2 middle() const { return {(from.x + to.x) / 2, (from.y + to.y) / 2}; }
  /// Returns the pixel of a place, on a whole number so that tiles join without a gap.
  ImVec2 pixel(double x, double z) const {
    return {std::round(middle().x + static_cast<float>((x - centre_x) * zoom)),
            std::round(middle().y + static_cast<float>((z - centre_z) * zoom))};
  }
  double x_at(float pixel_x) const { return centre_x + (pixel_x - middle().x) / zoom; }
  double z_at(float pixel_y) const { return centre_z + (pixel_y - middle().y) / zoom; }
  bool shows(ImVec2 a, ImVec2 b) const {
    return b.x > from.x && a.x < to.x && b.y > from.y && a.y < to.y;
  }
};

namespace {

void draw_arrow(ImDrawList& list, ImVec2 at, double yaw, double size, ImU32 colour) {
  const auto corner = [&](double turn, double length) {
    return ImVec2{at.x + static_cast<float>(std::sin(yaw + turn) * length),
                  at.y + static_cast<float>(std::cos(yaw + turn) * length)};
  };
  const ImVec2 tip = corner(0, size), left = corner(2.5, size), right = corner(-2.5, size);
  const ImVec2 back = corner(0, -0.35 * size);
  list.AddTriangleFilled(tip, left, back, colour);
  list.AddTriangleFilled(tip, back, right, colour);
  const ImVec2 outline[] = {tip, left, back, right};
  list.AddPolyline(outline, 4, IM_COL32(0, 0, 0, 220), ImDrawFlags_Closed, 1.5F);
}

}  // namespace

void MapWindow::set_zoom(double zoom) { zoom_ = std::clamp(zoom, kZoomMin, kZoomMax); }

void MapWindow::build_buttons(const MapState& state) {
  if (ImGui::Checkbox("follow me", &follows_) && follows_) {
    centre_x_ = state.me.x;
    centre_z_ = state.me.z;
  }
  ImGui::SameLine();
  if (ImGui::Button("-")) set_zoom(zoom_ / kZoomStep);
  ImGui::SameLine();
  if (ImGui::Button("+")) set_zoom(zoom_ * kZoomStep);
  ImGui::SameLine();
  if (ImGui::Button("spawn")) {
    follows_ = false;
    centre_x_ = state.spawn_x;
    centre_z_ = state.spawn_z;
  }
  ImGui::SameLine();
  if (ImGui::Button(is_full_ ? "small" : "full size")) is_full_ = !is_full_;
  ImGui::SameLine();
  ImGui::TextDisabled("%s", zoom_ >= 1 ? fmt::format("{:.1f} pixels a voxel", zoom_).c_str()
                                       : fmt::format("{:.1f} voxels a pixel", 1 / zoom_).c_str());
}

void MapWindow::take_mouse(const Canvas& canvas) {
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    // The place under the cursor stays there.
    const double x = canvas.x_at(io.MousePos.x), z = canvas.z_at(io.MousePos.y);
    const double before = zoom_;
    set_zoom(zoom_ * std::pow(kZoomStep, io.MouseWheel));
    if (!follows_) {
      centre_x_ = x + (centre_x_ - x) * before / zoom_;
      centre_z_ = z + (centre_z_ - z) * before / zoom_;
    }
  }
  if (ImGui::IsItemActive() && ImGui::IsMouseDragging(ImGuiMouseButton_Left, kDragPixels)) {
    is_dragged_ = true;
    follows_ = false;
    centre_x_ -= io.MouseDelta.x / canvas.zoom;
    centre_z_ -= io.MouseDelta.y / canvas.zoom;
  }
  if (!ImGui::IsItemDeactivated()) return;
  if (!std::exchange(is_dragged_, false) && ImGui::IsItemHovered()) {
    follows_ = false;
    centre_x_ = canvas.x_at(io.MousePos.x);
    centre_z_ = canvas.z_at(io.MousePos.y);
  }
}

void MapWindow::draw(const Canvas& canvas, const MapState& state, UiContext& context) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(canvas.from, canvas.to, true);
  list.AddRectFilled(canvas.from, canvas.to, kUnknown);
  const std::int32_t edge = state.map->edge();
  for (const auto& [key, tile] : state.map->tiles()) {
    const ImVec2 a = canvas.pixel(1.0 * key.x * edge, 1.0 * key.z * edge);
    const ImVec2 b = canvas.pixel((key.x + 1.0) * edge, (key.z + 1.0) * edge);
    if (tile.image != nullptr && canvas.shows(a, b))
      list.AddImage(context.add_image(tile.image), a, b);
  }
  const ImVec2 spawn = canvas.pixel(state.spawn_x, state.spawn_z);
  const auto mark = static_cast<float>(5 * canvas.scale);
  list.AddQuadFilled({spawn.x, spawn.y - mark}, {spawn.x + mark, spawn.y},
                     {spawn.x, spawn.y + mark}, {spawn.x - mark, spawn.y}, kSpawn);
  shadowed_text(list, {spawn.x + mark + 2, spawn.y - mark - 4}, kSpawn, "spawn");
  const auto put = [&](const MapPlayer& player, ImU32 colour) {
    const ImVec2 at = canvas.pixel(player.x, player.z);
    draw_arrow(list, at, player.yaw, kArrowPixels * canvas.scale, colour);
    if (!player.name.empty())
      shadowed_text(list, {at.x + static_cast<float>(kArrowPixels * canvas.scale) + 2, at.y - 8},
                    colour, player.name);
  };
  for (const MapPlayer& other : state.others) put(other, kOther);
  put(state.me, kMe);
  list.PopClipRect();
}

std::string MapWindow::text_at(const Canvas& canvas, const MapState& state,
                               const MaterialTable& materials) {
  const ImVec2 at = ImGui::GetIO().MousePos;
  const auto x = static_cast<std::int32_t>(
      std::floor(std::clamp(canvas.x_at(at.x), -1.0 * kWorldLimit, kWorldLimit - 1.0)));
  const auto z = static_cast<std::int32_t>(
      std::floor(std::clamp(canvas.z_at(at.y), -1.0 * kWorldLimit, kWorldLimit - 1.0)));
  const auto top = state.map->top(x, z);
  if (!top) return fmt::format("{} ? {}", x, z);
  const std::string name =
      materials.knows(top->material) ? readable_name(materials[top->material].name) : "unknown";
  return fmt::format("{} {} {}  {}", x, top->y, z, name);
}

void MapWindow::build(const MapState& state, const MaterialTable& materials, UiContext& context) {
  if (!is_open_ || state.map == nullptr) return;
  const double scale = context.scale();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const auto margin = static_cast<float>(10 * scale);
  if (is_full_) {
    ImGui::SetNextWindowPos({margin, margin});
    ImGui::SetNextWindowSize({size.x - 2 * margin, size.y - 2 * margin});
  } else {
    const ImVec2 small{std::min(size.x * 0.45F, static_cast<float>(520 * scale)),
                       std::min(size.y * 0.6F, static_cast<float>(440 * scale))};
    ImGui::SetNextWindowPos({size.x - margin, margin * 4}, ImGuiCond_Appearing, {1, 0});
    ImGui::SetNextWindowSize(small, ImGuiCond_Appearing);
  }
  // A window of its own for each size: ImGui keeps the place of the small one.
  ImGui::Begin(is_full_ ? "Map###map full" : "Map###map", &is_open_,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  build_buttons(state);
  if (follows_) {
    centre_x_ = state.me.x;
    centre_z_ = state.me.z;
  }
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const ImVec2 canvas_size{std::max(room.x, 32.0F), std::max(room.y - line, 32.0F)};
  ImGui::InvisibleButton("canvas", canvas_size);
  const bool is_hovered = ImGui::IsItemHovered();
  const auto canvas = [&] {
    return Canvas{from,          {from.x + canvas_size.x, from.y + canvas_size.y},
                  zoom_ * scale, centre_x_,
                  centre_z_,     scale};
  };
  take_mouse(canvas());
  draw(canvas(), state, context);
  ImGui::TextUnformatted(is_hovered ? text_at(canvas(), state, materials).c_str()
                                    : "wheel: zoom   drag: move   click: centre");
  ImGui::End();
}

}  // namespace runstone
