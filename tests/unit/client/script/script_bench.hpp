// ScriptBench: a script runner, and a host that plays its client.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/script/script_runner.hpp"
#include "common/builds/paste_source.hpp"
#include "common/edits/clipboard/clipboard_builder.hpp"

namespace runstone::test {

/// A host with a world of single voxels. It answers at once.
struct FakeScriptHost final : ScriptHost {
  struct Submitted {
    EditDescriptor edit;
    TimeUs due_us, now_us;
    ActionPart part;
  };
  bool open = true, is_loaded = true, is_horizon_seen = true, is_durable = true, draws = true,
       takes = true;
  std::optional<Result<void, std::string>> picture{std::in_place};
  std::uint64_t pongs = 0;
  WorldPos at{10, 20, 30};
  double yaw = 0, pitch = 0, time_of_day = 0;
  Antialiasing antialiasing = Antialiasing::automatic;
  std::map<VoxelPos, Material> voxels;
  std::optional<RayHit> hit;
  std::vector<Submitted> edits;
  mutable std::vector<VoxelBox> copied;
  std::vector<std::string> files;
  std::vector<HistoryRequest> travels;
  std::vector<std::string> said, heard;  // lines of chat
  bool is_travelling = false;
  std::string refusal;

  bool ready() const override { return open; }
  bool is_connected = true, is_answer_lost = false;
  std::uint64_t connection_count = 1;
  bool connected() const override { return is_connected; }
  std::uint64_t connections() const override { return connection_count; }
  bool answer_lost() const override { return is_answer_lost; }
  WorldPos eye() const override { return at; }
  void move_to(const WorldPos& eye) override { at = eye; }
  void look(double y, double p) override { yaw = y, pitch = p; }
  void set_time_of_day(double share) override { time_of_day = share; }
  void set_antialiasing(Antialiasing choice) override { antialiasing = choice; }
  Result<Material, std::string> material(std::string_view name) const override {
    if (name == "air" || name == "0") return kEmpty;
    if (name == "stone") return Material{5};
    if (name == "sand") return Material{2};
    return failure("the world has no material \"" + std::string(name) + "\"");
  }
  std::optional<Material> shown_at(VoxelPos pos) const override {
    if (pos.x > 1000) return std::nullopt;
    const auto it = voxels.find(pos);
    return it == voxels.end() ? kEmpty : it->second;
  }
  Result<BuildPtr> copy(const VoxelBox& box) const override {
    copied.push_back(box);
    if (box.min.x > 1000) return runstone::fail(ErrorCode::not_found, "it is far");
    const auto side = [](std::int32_t low, std::int32_t high) {
      return static_cast<std::uint8_t>(high - low);
    };
    ClipboardBuilder cells(
        {side(box.min.x, box.max.x), side(box.min.y, box.max.y), side(box.min.z, box.max.z)});
    cells.append(1, Material{5});
    while (cells.filled() < static_cast<std::uint32_t>(box.max.x - box.min.x) *
                                static_cast<std::uint32_t>(box.max.y - box.min.y) *
                                static_cast<std::uint32_t>(box.max.z - box.min.z)) {
      cells.append(1, kEmpty);
    }
    return build_of(**cells.finish());
  }
  std::optional<RayHit> pick() const override { return hit; }
  ToolBox tools;
  Replica world;
  std::optional<FixedAim> fixed_aim;
  Material held = kEmpty;
  int previews = 0;
  ToolBox& tool_box() override { return tools; }
  const Replica& replica() const override { return world; }
  Aim aim() const override {
    Aim out{at, {}, std::nullopt, held};
    if (fixed_aim) {
      out.hit = RayHit{fixed_aim->voxel, world.shown_at(fixed_aim->voxel).value_or(kEmpty),
                       fixed_aim->face, 5};
    }
    return out;
  }
  void fix_aim(std::optional<FixedAim> aim) override { fixed_aim = aim; }
  void hold(Material material) override { held = material; }
  std::vector<std::string> hotbars;
  Result<void, std::string> use_hotbar(const script::NamedHotbar& order) override {
    if (order.what == script::NamedHotbar::What::forget) return failure("there is none");
    hotbars.push_back((order.what == script::NamedHotbar::What::keep ? "keep " : "take ") +
                      order.name);
    return {};
  }
  void finish_preview() override { ++previews; }
  std::optional<std::int32_t> surface(std::int32_t x, std::int32_t) const override {
    if (x > 1000) return std::nullopt;
    return 7;
  }
  TimeUs budget_from_us = 0;  // edits must wait until then
  TimeUs edit_wait_us(const EditDescriptor& /*edit*/, TimeUs now_us) override {
    return std::max<TimeUs>(0, budget_from_us - now_us);
  }
  Result<void, std::string> propose(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us,
                                    ActionPart part) override {
    edits.push_back({edit, due_us, now_us, part});
    if (!takes) return failure("the past cannot be edited");
    return {};
  }
  std::uint64_t build_from_voxels = 1'000'000;  // edits of more voxels are actions
  std::vector<ToolAction> actions;
  std::optional<Result<void, std::string>> ended_action;
  bool needs_build(const ToolAction& action) const override {
    return !action.pastes.empty() ||
           std::any_of(action.edits.begin(), action.edits.end(), [&](const EditDescriptor& edit) {
             return counted_voxels(edit) > build_from_voxels;
           });
  }
  Result<void, std::string> build(const ToolAction& action) override {
    actions.push_back(action);
    if (!takes) return failure("another action is under way");
    return {};
  }
  std::optional<Result<void, std::string>> built() const override { return ended_action; }
  bool loaded() const override { return is_loaded; }
  bool sees_horizon() const override { return is_horizon_seen; }
  bool durable() const override { return is_durable; }
  std::uint64_t sync_mark() const override { return pongs; }
  bool synced(std::uint64_t mark) const override { return pongs >= mark + 2; }
  void travel(const HistoryRequest& travel) override { travels.push_back(travel); }
  bool travelling() const override { return is_travelling; }
  std::vector<std::string> commands;
  bool is_commanding = false, is_command_ok = true;
  std::string say(const std::string& text) override {
    said.push_back(text);
    return refusal;
  }
  bool take_chat(const std::string& text) override {
    const auto found = std::find(heard.begin(), heard.end(), text);
    if (found == heard.end()) return false;
    heard.erase(heard.begin(), found + 1);
    return true;
  }
  std::string command(const std::string& text) override {
    commands.push_back(text);
    return {};
  }
  bool commanding() const override { return is_commanding; }
  bool show_answer() override { return is_command_ok; }
  std::string travel_refusal() const override { return refusal; }
  TimeUs utc_now_us() const override { return 5'000'000; }
  std::vector<std::string> input;  // what was pressed, typed and clicked
  bool is_handling = false;
  void press(const KeyChord& chord) override { input.push_back("press " + text_of(chord)); }
  void type(const std::string& text) override { input.push_back("type " + text); }
  void click(double x, double y) override {
    input.push_back("click " + std::to_string(std::lround(x)) + " " +
                    std::to_string(std::lround(y)));
  }
  bool handling_input() const override { return is_handling; }
  void show_interface(bool is_shown) override { input.push_back(is_shown ? "on" : "off"); }
  void inspect(InspectionMode mode, bool is_on) override {
    input.push_back(std::string(to_string(mode)) + (is_on ? " on" : " off"));
  }
  bool is_loading_panels = false, is_rolling_back = false, is_rollback_ok = true;
  std::string rollback_refusal;
  void show_map(bool is_shown, bool is_full) override {
    input.push_back(!is_shown ? "map off" : is_full ? "map full" : "map on");
  }
  void zoom_map(double pixels) override {
    input.push_back("zoom " + std::to_string(std::lround(pixels)));
  }
  void show_timeline(bool is_shown) override {
    input.push_back(is_shown ? "timeline on" : "timeline off");
  }
  bool loading_panels() const override { return is_loading_panels; }
  bool is_using_library = false;
  std::string library_refusal;
  void show_library(bool is_shown) override {
    input.push_back(is_shown ? "library on" : "library off");
  }
  void list_library(const std::string& name) override { input.push_back("list " + name); }
  void take_build(Sequence number) override { input.push_back("take " + std::to_string(number)); }
  void add_build(const std::string& name) override { input.push_back("add " + name); }
  bool using_library() const override { return is_using_library; }
  std::string show_library_answer() override { return library_refusal; }
  std::string preview_rollback(const std::string& filters) override {
    input.push_back("preview " + filters);
    return rollback_refusal;
  }
  std::string apply_rollback() override { return input.push_back("apply"), rollback_refusal; }
  std::string undo_rollback() override { return input.push_back("undo"), rollback_refusal; }
  std::string forget_rollback() override { return input.push_back("forget"), rollback_refusal; }
  bool rolling_back() const override { return is_rolling_back; }
  bool show_rollback_answer() override { return is_rollback_ok; }
  bool screenshot(const std::string& file) override {
    files.push_back(file);
    return draws;
  }
  std::optional<Result<void, std::string>> screenshot_written() const override { return picture; }
  Result<void, std::string> digests(const std::string& file) override {
    files.push_back(file);
    if (file == "bad") return failure(file + ": cannot be written: No space left on device");
    return {};
  }
};

struct ScriptBench {
  void load(std::string_view text) {
    auto parsed = parse_script(text, "s.txt");
    INFO((parsed ? "" : parsed.error().message()));
    REQUIRE(parsed.has_value());
    script = *parsed;
    runner.emplace(script, host);
  }
  void run(std::string_view text) {
    load(text);
    runner->step(0);
    REQUIRE(runner->finished());
  }
  FakeScriptHost host;
  Script script;
  std::optional<ScriptRunner> runner;
};

}  // namespace runstone::test
