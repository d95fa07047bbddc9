#include "client/play/play.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "client/play/player_actions.hpp"
#include "client/play/time_travel.hpp"
#include "client/ui/log_words.hpp"
#include "common/core/text.hpp"
#include "common/core/utc_text.hpp"
#include "common/core/world_time.hpp"
#include "common/mesh_materials/mesh_materials_of.hpp"

namespace runstone {
namespace {

/// A longer time between two turns moves the player as if it were this long, in seconds.
constexpr double kSecondsMax = 0.1;
/// The sun moves in steps of this share of a day, a tenth of a degree: each step draws a frame and
/// all shadows again.
constexpr double kTimeStep = 1.0 / 3600;
/// The voxel at the crosshair is looked up this often for its author.
constexpr TimeUs kAuthorEveryUs = 50'000;

}  // namespace

Play::Play(ClientSession& session, ToolBox& tools, DrawQueue* draw_queue, PlayLog& log,
           const PlayConfig& config, std::function<void()> wake)
    : session_(session),
      log_(log),
      driver_(config.driver),
      walks_(config.walks),
      started_us_(config.started_us),
      pipeline_(session.replica(), draw_queue, config.is_watched, config.workers, std::move(wake)),
      tool_(session, player_, pipeline_.recorder(), tools,
            [this](const std::string& why) { log_.on_edit_refused(why); }),
      motion_(session.replica(), player_),
      clicks_(tool_),
      hotbar_(player_),
      hotbars_(config.hotbars),
      chat_(session, [this] { tool_.box().forget_pasted(); }),  // an undo may take it back
      view_(session, player_, config.wishes.radii, config.wishes.far_levels),
      limits_(config.wishes, session.replica(), pipeline_, view_),
      panels_(session, tools, config.workers != 0),
      scene_(session, player_, tool_, view_, panels_, others_),
      server_notices_(session),
      kit_of_(config.kit_of),
      own_time_(config.time_of_day),
      input_us_(config.started_us) {
  input_.set_keys(config.keys);
}

void Play::begin_turn(bool is_opened, const ShownPanels& shown, TimeUs now_us) {
  if (is_opened) open_world(now_us);
  take_new_materials();
  show_time(now_us);
  take_changes(now_us);
  if (const auto ended = tool_.step_build(now_us)) {
    const bool is_whole =
        tool_.last_build().stop_reason.empty() && tool_.last_build().edits_refused == 0;
    notify(*ended, is_whole ? NoticeKind::information : NoticeKind::warning);
  }
  view_.update_completeness(now_us);
  if (panels_.step(shown, now_us)) pipeline_.moved();
  for (std::string& text : panels_.library().take_notices()) notify(std::move(text));
  limit_memory(now_us);
}

void Play::open_world(TimeUs now_us) {
  if (!opened_us_) {
    opened_us_ = now_us;
    if (walks_) player_.set_walking(true);
  }
  const Welcome& welcome = *session_.welcome();
  player_.enter(welcome.world_id, welcome.spawn, session_.place());
  // The hotbar has the kit of the world that was left until it is filled.
  note_kit();
  const bool is_another = std::exchange(world_, welcome.world_id) != welcome.world_id;
  if (is_another) {
    hotbar_.fill(welcome.materials);
    recent_.clear();
  }
  set_materials(welcome.materials);
  if (is_another) take_up_kit();
  limits_.open_world(welcome.view_radius_max);
}

void Play::take_up_kit() {
  if (const auto kept = kit_of_ ? kit_of_(*world_) : std::nullopt) {
    hotbar_.take(kept->slots, kept->slot, session_.welcome()->materials);
    // A tool that this version of the client does not have is ignored.
    static_cast<void>(tool_.box().choose(kept->tool));
  }
  kept_kit_ = kit();
}

WorldKit Play::kit() const {
  return {hotbar_.slots(), hotbar_.slot(), std::string(tool_.box().tool().name())};
}

void Play::note_kit() {
  if (!world_) return;
  WorldKit now = kit();
  if (now == kept_kit_) return;
  kept_kit_ = now;
  changed_kits_.push_back({*world_, std::move(now)});
}

std::vector<KeptKit> Play::take_kits() {
  note_kit();
  return std::exchange(changed_kits_, {});
}

std::optional<HotbarLists> Play::take_hotbars() {
  return hotbars_.take_changed() ? std::optional(hotbars_.lists()) : std::nullopt;
}

void Play::hold(Material material, bool is_picked, TimeUs now_us) {
  if (is_picked) {
    hotbar_.pick(material, now_us);
  } else {
    hotbar_.hold(material, now_us);
  }
  recent_.note(material);
}

Result<std::string, std::string> Play::carry_out(const HotbarOrder& order) {
  const MaterialTable& materials = pipeline_.materials();
  if (order.what == HotbarOrder::What::take) {
    const auto slots = hotbars_.take(order.name, materials);
    if (!slots) return failure(slots.error());
    hotbar_.take(*slots, hotbar_.slot(), materials);
    return "the hotbar \"" + order.name + "\" is taken";
  }
  const bool is_kept = order.what == HotbarOrder::What::keep;
  const auto done =
      is_kept ? hotbars_.keep(order.name, hotbar_.slots(), materials) : hotbars_.forget(order.name);
  if (!done) return failure(done.error());
  return "the hotbar \"" + order.name + (is_kept ? "\" is kept" : "\" is forgotten");
}

void Play::set_own_time(std::optional<double> share) { own_time_ = share; }

void Play::show_time(TimeUs now_us) {
  LookControl& look = pipeline_.look();
  const auto time = session_.world_time(now_us);
  double share = own_time_.value_or(time ? day_share(*time) : FrameLook{}.time_of_day);
  if (!own_time_ && time && time->rate != 0) share = std::floor(share / kTimeStep) * kTimeStep;
  if (share == look.time_of_day()) return;
  look.set_time_of_day(share);
  pipeline_.moved();
}

void Play::take_new_materials() {
  if (!session_.is_open()) return;
  const MaterialTable& materials = session_.welcome()->materials;
  const std::size_t known = pipeline_.materials().size();
  const bool has_new = materials.size() > known;
  if (!has_new && shapes_number_ == session_.shapes_number()) return;
  set_materials(materials);
  if (has_new) log_.on_new_materials(materials.size() - known);
}

void Play::set_materials(const MaterialTable& materials) {
  shapes_number_ = session_.shapes_number();
  const MeshMaterialsPtr meshed = mesh_materials_of(materials);
  pipeline_.set_materials(materials, meshed);
  motion_.set_materials(materials, shapes_in(meshed));
  tool_.set_shapes(shapes_in(meshed));
  panels_.set_materials(materials, meshed);
  others_.set_materials(materials, meshed);
  const std::string lost = tool_.box().set_materials(materials, meshed);
  if (!lost.empty()) notify(with_unseen_replaced(lost), NoticeKind::warning);
}

void Play::limit_memory(TimeUs now_us) {
  if (const auto change = limits_.limit_view(now_us)) {
    log_.on_view_limited(*change);
    take_changes(now_us);
  }
  limits_.limit_meshes();
  if (const auto change = limits_.limit_far(now_us)) {
    log_.on_view_limited(*change);
    take_changes(now_us);
  }
}

void Play::take_changes(TimeUs now_us) {
  const ReplicaChanges changes = session_.replica().drain_changes();
  pipeline_.take(changes, session_.clock(), now_us);
  panels_.take(changes);
  tool_.take(changes, now_us);
  const std::vector<PlayerNotice> state = server_notices_.take_state();
  log_.on_changes(changes, state);
  notices_.insert(notices_.end(), state.begin(), state.end());
  // The progress of an action counts its own refusals.
  if (tool_.is_building()) return;
  for (const RejectedEdit& reject : changes.rejects) notices_.push_back(notice_of(reject));
}

RoutedInput Play::handle_input(const UiFocus& focus, const PlaySettings& settings, TimeUs now_us) {
  const double seconds = static_cast<double>(now_us - std::exchange(input_us_, now_us)) / 1e6;
  RoutedInput routed = input_.route(focus);
  const WindowInput& input = routed.player;
  if (driver_ == Driver::person) move(input, std::min(seconds, kSecondsMax), settings.look);
  for (const std::string& why : clicks_.step(input, driver_ != Driver::script, now_us))
    notify(why, NoticeKind::warning);
  if (input.place_clicks != 0) recent_.note(player_.held());
  if (input.pick_clicks != 0) {
    if (const auto hit = tool_.pick()) hold(hit->material, true, now_us);
  }
  if (const auto line = act_on_wheel(input, tool_, player_, hotbar_)) notify(*line);
  if (!input.actions.empty() || input.scroll != 0) pipeline_.moved();
  return routed;
}

void Play::move(const WindowInput& input, double seconds, const LookSettings& look) {
  const bool was_waiting = player_.is_waiting_for_ground();
  motion_.step(input, seconds, look);
  if (player_.take_fallen_out())
    notify("you fell out of the world: you are at its spawn, and fly", NoticeKind::warning);
  if (was_waiting != player_.is_waiting_for_ground()) pipeline_.moved();
}

bool Play::act(Action action, TimeUs now_us) {
  if (hotbar_.act(action)) return true;
  if (const auto done = act_on_tool(tool_, action, now_us)) {
    notify(*done ? **done : done->error(), *done ? NoticeKind::information : NoticeKind::warning);
    return true;
  }
  switch (action) {
    case Action::walk_or_fly:
      player_.set_walking(!player_.is_walking());
      return true;
    case Action::stop_building:
      notify(tool_.stop_building() ? "it stops when the server has answered what was sent"
                                   : "no fill, paste, move or mix is under way");
      return true;
    case Action::undo: {
      // An action of which nothing was sent yet is only stopped: an undo would take back the one
      // before it.
      tool_.box().forget_pasted();  // it may be taken back
      const bool is_unsent = tool_.is_building() && !tool_.has_built();
      tool_.stop_building();
      if (!is_unsent) chat_.send("/undo");  // the answer is shown
      return true;
    }
    case Action::redo:
      chat_.send("/redo");
      return true;
    case Action::earlier:
      step_in_time(session_, -1);
      return true;
    case Action::later:
      step_in_time(session_, 1);
      return true;
    case Action::live:
      show_after(session_, kSequenceShownMax);
      return true;
    default:
      return false;
  }
}

void Play::carry_out(const UiAction& action, TimeUs now_us) {
  if (const auto* line = std::get_if<SendLine>(&action)) chat_.send(line->text);
  if (const auto* held = std::get_if<HoldMaterial>(&action)) hold(held->material, false, now_us);
  if (const auto* order = std::get_if<HotbarOrder>(&action)) {
    const auto done = carry_out(*order);
    notify(done ? *done : done.error(), done ? NoticeKind::information : NoticeKind::warning);
  }
  if (const auto* chosen = std::get_if<SetInspection>(&action)) pipeline_.inspect(chosen->modes);
  if (const auto* time = std::get_if<SetTime>(&action)) set_own_time(time->share);
  if (const auto* moment = std::get_if<ShowMoment>(&action))
    show_after(session_, moment->is_live ? kSequenceShownMax : moment->seq);
  // If a rollback cannot be ordered, its window says why.
  if (const auto* order = std::get_if<RollbackOrder>(&action)) static_cast<void>(carry_out(*order));
  if (const auto* order = std::get_if<LibraryOrder>(&action)) panels_.library().carry_out(*order);
  if (const auto* command = std::get_if<ToolCommand>(&action)) {
    const auto done = tool_.carry_out(*command, now_us);
    const std::string& notice = tool_.box().turn_notice();
    if (!done) {
      notify(done.error(), NoticeKind::warning);
    } else if (std::holds_alternative<ClipboardTurn>(*command) && !notice.empty()) {
      notify(notice, NoticeKind::warning);
    }
  }
}

void Play::follow(TimeUs now_us) {
  if (view_.follow(now_us)) {
    pipeline_.view_changed();
    take_changes(now_us);
  }
  if (!session_.replica().opened()) return;
  pipeline_.joined(session_.view(), started_us_);
  pipeline_.set_eye(player_.chunk(session_.replica().chunk_edge()));
}

void Play::step_previews(const PlaySettings& settings, TimeUs now_us) {
  static const std::vector<EditDescriptor> kNothing;
  if (tool_.step_preview()) pipeline_.moved();
  const bool is_on = tool_.box().is_preview_shown();
  const bool is_shared = is_on && settings.shares_previews && tool_.has_preview();
  const auto stroke = is_shared ? tool_.drawn_stroke() : std::nullopt;
  if (stroke) {
    session_.share_preview({stroke->line}, now_us, stroke->stroke);
  } else {
    session_.share_preview(is_shared ? tool_.box().preview().edits() : kNothing, now_us);
  }
  const Replica& replica = session_.replica();
  const bool is_shown = is_on && settings.shows_previews && replica.opened() && !replica.past();
  const bool has_changed =
      is_shown ? others_.step(replica, session_.others_previews()) : others_.clear();
  if (has_changed) pipeline_.moved();
}

void Play::step_textures(const PlaySettings& settings, TimeUs now_us) {
  const bool is_on = settings.shows_textures && pipeline_.draws();
  TextureExchange& textures = session_.textures();
  textures.set_wanted(is_on);
  if (auto drawn = textures_.step(textures, is_on, now_us))
    pipeline_.set_textures(*std::move(drawn));
  const auto& frames = pipeline_.recent_frames();
  const RenderStats stats = frames.empty() ? RenderStats() : frames.back().stats;
  limits_.set_texture_bytes(textures.picture_bytes() + textures_.bytes() + stats.texture_bytes);
  if (auto notice = textures_.take_notice(textures, stats.textures_left_out))
    notify(*std::move(notice), NoticeKind::warning);
}

void Play::step_author(const PlaySettings& settings, TimeUs now_us) {
  if (now_us < author_due_us_) return;
  author_due_us_ = now_us + kAuthorEveryUs;
  const auto hit = settings.shows_authors ? tool_.pick() : std::nullopt;
  session_.step_voxel_author(hit ? std::optional(hit->voxel) : std::nullopt, now_us);
  if (!session_.take_voxel_author_changed()) return;
  const VoxelAuthor::Found* const found = session_.voxel_author().found();
  std::string text;
  if (found != nullptr) {
    text = with_unseen_replaced(found->author) + ", " + utc_text(found->mark.utc_us);
    if (found->mark.cause != Cause::player)
      text += ", " + record_words(found->mark.kind, found->mark.cause);
  }
  if (std::exchange(author_text_, std::move(text)) != author_text_) pipeline_.moved();
}

void Play::keep_pace(bool has_focus, bool is_fading, TimeUs now_us) {
  const bool is_moving = panels_.take_moved(now_us) || is_fading;
  pace_.step(pipeline_, has_focus, player_.pose(), is_moving, now_us);
}

FrameOrder Play::frame(const FrameChoice& choice, TimeUs now_us) {
  pace_.drew(now_us);
  FrameOrder out;
  out.camera = scene_.camera(choice.field_of_view);
  out.width = choice.size[0];
  out.height = choice.size[1];
  out.contents = scene_.contents(choice.outlines_aim, choice.shows_ground);
  return out;
}

std::string Play::state_text() const {
  if (const auto& past = session_.replica().past()) return moment_text(past);
  if (player_.is_waiting_for_ground()) return "the ground here has not arrived yet";
  if (std::string building = tool_.build_text(); !building.empty()) return building;
  return limits_.text();
}

void Play::fill(HudState& state, const ShownPanels& shown) const {
  state.materials = &pipeline_.materials();
  state.slots = hotbar_.slots();
  state.slot = hotbar_.slot();
  state.recent = recent_.all();
  for (const auto& [name, materials] : hotbars_.lists()) state.hotbars.push_back(name);
  state.is_captured = input_.is_captured();
  if (session_.clock().known())
    state.ping_ms = static_cast<double>(session_.clock().round_trip_us()) / 1e3;
  if (const auto sight = tool_.pick()) {
    state.aimed_at = sight->material;
    state.sight = sight->voxel;
    state.author = author_text_;
  }
  state.measure = tool_.measure_text();
  state.tools = &tool_.box();
  state.has_preview = tool_.has_preview();
  state.time_of_day = pipeline_.look().time_of_day();
  state.has_own_time = own_time_.has_value();
  panels_.fill(state, shown, player_.pose());
}

bool Play::has_ground(TimeUs wait_us, TimeUs now_us) const {
  if (!opened_us_) return false;
  return (session_.is_open() && pipeline_.meshed_count() >= kGroundChunks) || view_.is_complete() ||
         now_us - *opened_us_ > wait_us;
}

void Play::add_to(ClientReport& report, TimeUs now_us) const {
  report.seconds = static_cast<double>(now_us - started_us_) / 1e6;
  report.edits_refused = tool_.refused();
  limits_.add_to(report, session_.view(), scene_.reach());
  pipeline_.add_to(report);
}

}  // namespace runstone
