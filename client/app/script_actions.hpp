// ScriptActions: carries out the commands of a script in this client. One thread.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "client/app/client_hud.hpp"
#include "client/app/clipboard_file.hpp"
#include "client/app/terminal_chat.hpp"
#include "client/play/play.hpp"
#include "client/replica/copy_box.hpp"
#include "client/report/report.hpp"
#include "client/script/script_host.hpp"

namespace runstone {

class ScriptActions final : public ScriptHost {
 public:
  /// All but `screenshot_folder` must outlive this object.
  ScriptActions(Play& play, TerminalChat& chat, ClientHud& hud, std::string screenshot_folder);

  bool ready() const override { return session_.connect_count() != 0; }
  bool connected() const override { return session_.is_open(); }
  std::uint64_t connections() const override { return session_.connect_count(); }
  WorldPos eye() const override { return play_.player().eye(); }
  void move_to(const WorldPos& eye) override;
  void look(double yaw, double pitch) override;
  void set_time_of_day(double share) override;
  void set_antialiasing(Antialiasing antialiasing) override;
  Result<Material, std::string> material(std::string_view name) const override;
  std::optional<Material> shown_at(VoxelPos at) const override {
    return session_.replica().shown_at(at);
  }
  Result<BuildPtr> copy(const VoxelBox& box) const override {
    return copy_box(session_.replica(), box);
  }
  std::optional<RayHit> pick() const override { return play_.tool().pick(); }
  ToolBox& tool_box() override { return play_.tool().box(); }
  const Replica& replica() const override { return session_.replica(); }
  Aim aim() const override { return play_.tool().aim(); }
  void fix_aim(std::optional<FixedAim> aim) override { play_.tool().fix_aim(aim); }
  void hold(Material material) override;
  Result<void, std::string> use_hotbar(const script::NamedHotbar& order) override;
  void finish_preview() override;
  std::optional<std::int32_t> surface(std::int32_t x, std::int32_t z) const override;
  TimeUs edit_wait_us(const EditDescriptor& edit, TimeUs now_us) override {
    return session_.edit_wait_us(edit, now_us);
  }
  bool needs_build(const ToolAction& action) const override {
    return replica().opened() && play_.tool().needs_build(action);
  }
  Result<void, std::string> build(const ToolAction& action) override {
    return play_.tool().build(action);
  }
  std::optional<Result<void, std::string>> built() const override;
  Result<void, std::string> propose(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us,
                                    ActionPart part) override {
    return play_.tool().propose(edit, due_us, now_us, part);
  }
  Result<void, std::string> load_clipboard(const std::string& file,
                                           const ModelChoices& model) override;
  Result<void, std::string> save_clipboard(const std::string& file) override {
    return write_clipboard(file, play_.tool().box());
  }
  bool loaded() const override;
  bool sees_horizon() const override;
  bool durable() const override { return session_.replica().local_edits().all().empty(); }
  std::uint64_t sync_mark() const override { return session_.pongs(); }
  bool synced(std::uint64_t mark) const override;
  void travel(const HistoryRequest& request) override;
  bool travelling() const override { return session_.loading_history(); }
  std::string travel_refusal() const override { return session_.history_refusal(); }
  std::string say(const std::string& text) override;
  bool take_chat(const std::string& text) override { return chat_.take_heard(text); }
  std::string command(const std::string& text) override;
  bool commanding() const override { return session_.commanding(); }
  bool show_answer() override;
  bool answer_lost() const override { return session_.is_answer_lost(); }
  TimeUs utc_now_us() const override;
  void press(const KeyChord& chord) override;
  void type(const std::string& text) override;
  void click(double x, double y) override;
  bool handling_input() const override { return play_.input().has_events(); }
  void show_interface(bool is_shown) override { hud_.set_shown(is_shown); }
  void inspect(InspectionMode mode, bool is_on) override;
  void show_map(bool is_shown, bool is_full) override;
  void zoom_map(double pixels) override { hud_.map().set_zoom(pixels); }
  void show_timeline(bool is_shown) override { hud_.show_timeline(is_shown); }
  void show_library(bool is_shown) override { hud_.show_library(is_shown); }
  void list_library(const std::string& name) override { play_.panels().library().list(name); }
  void take_build(Sequence number) override { play_.panels().library().take(number); }
  void add_build(const std::string& name) override { play_.panels().library().add(name); }
  bool using_library() const override { return play_.panels().library().is_busy(); }
  std::string show_library_answer() override;
  bool loading_panels() const override { return play_.panels().is_loading(hud_.shown_panels()); }
  std::string preview_rollback(const std::string& filters) override {
    return play_.panels().rollback().preview(filters);
  }
  std::string apply_rollback() override { return play_.carry_out(ApplyRollback{}); }
  std::string undo_rollback() override { return play_.carry_out(UndoRollback{}); }
  std::string forget_rollback() override { return play_.carry_out(ForgetRollback{}); }
  bool rolling_back() const override { return play_.panels().rollback().is_busy(); }
  bool show_rollback_answer() override;
  bool screenshot(const std::string& file) override;
  /// Returns where the screenshot of this name goes.
  std::string screenshot_path(const std::string& file) const;
  std::optional<Result<void, std::string>> screenshot_written() const override;
  Result<void, std::string> digests(const std::string& file) override {
    return write_digests(file, session_);
  }

  /// The longest time for which loaded() waits for a moment without unfinished meshes after all
  /// chunks in view have arrived. While others edit all the time there may be no such moment.
  static constexpr TimeUs kMeshWaitUsMax = 10'000'000;

 private:
  Play& play_;
  ClientSession& session_;  // of play_
  TerminalChat& chat_;
  ClientHud& hud_;
  const std::string screenshot_folder_;
};

}  // namespace runstone
