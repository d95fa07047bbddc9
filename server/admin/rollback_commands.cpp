#include "server/admin/rollback_commands.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <variant>

#include "common/core/utc_text.hpp"
#include "server/admin/build_file.hpp"
#include "server/admin/command_call.hpp"
#include "server/admin/log_selection.hpp"
#include "server/admin/material_file.hpp"
#include "server/admin/rights_change_text.hpp"
#include "server/draw/preview_pictures.hpp"
#include "server/history/edit_text.hpp"
#include "server/names/name_reference.hpp"
#include "server/rollback/count_text.hpp"
#include "server/rollback/newest_actions.hpp"
#include "server/rollback/preview_edits.hpp"

namespace runstone {
namespace {

struct CauseName {
  std::string_view name;
  Cause cause;
};
constexpr std::array<CauseName, 12> kCauses = {{{"player", Cause::player},
                                                {"console", Cause::console},
                                                {"rollback", Cause::rollback},
                                                {"undo", Cause::undo},
                                                {"redo", Cause::redo},
                                                {"import", Cause::import},
                                                {"rights", Cause::rights},
                                                {"materials", Cause::materials},
                                                {"library", Cause::library},
                                                {"clock", Cause::clock},
                                                {"textures", Cause::textures},
                                                {"gap", Cause::gap}}};
constexpr const char* kFilterWords =
    "author, not author, address-of, joined-after, since, until, box, in, cause";
constexpr const char* kCauseNames =
    "player, console, rollback, undo, redo, import, rights, materials, library, clock, textures or "
    "gap";

CommandFilter::Author author_of(const std::string& word, WordReader& reader) {
  if (word.starts_with('#')) {
    const auto number = number_of<AuthorId>(std::string_view(word).substr(1));
    if (!number) reader.wrong("author \"" + word + "\": a number after #, or a name");
    return {"", number};
  }
  return {word, std::nullopt};
}

/// Records an error if the last word for authors is one pattern too many.
void check_patterns(WordReader& reader, const CommandFilter& filter, const std::string& word) {
  const auto is_pattern = [](const CommandFilter::Author& author) {
    return is_name_pattern(author.name);
  };
  const auto patterns = std::ranges::count_if(filter.authors, is_pattern) +
                        std::ranges::count_if(filter.not_authors, is_pattern);
  if (is_name_pattern(word) && patterns > static_cast<std::ptrdiff_t>(kPatternsMax)) {
    reader.wrong("author \"" + word + "\": a line has at most " + std::to_string(kPatternsMax) +
                 " patterns of names");
  }
}

/// Reads one filter with its values. Returns false if the next word is no filter.
bool take_filter(WordReader& reader, CommandFilter& filter) {
  const std::string word = reader.peek();
  if (word == "author") {
    reader.take("", "");
    filter.authors.push_back(author_of(reader.take(word, std::string(kPlayerWord) + ","), reader));
    check_patterns(reader, filter, filter.authors.back().name);
  } else if (word == "not") {
    reader.take("", "");
    if (!reader.take_word("author")) {
      reader.wrong(reader.at_end() ? "not: author PLAYER is missing"
                                   : "not \"" + reader.peek() + "\": author PLAYER");
      return true;
    }
    filter.not_authors.push_back(
        author_of(reader.take("not author", std::string(kPlayerWord) + ","), reader));
    check_patterns(reader, filter, filter.not_authors.back().name);
  } else if (word == "address-of") {
    reader.take("", "");
    filter.address_of.push_back(reader.player(word));
  } else if (word == "joined-after") {
    reader.take("", "");
    filter.joined_after_us = reader.moment(word);
  } else if (word == "since" || word == "until") {
    reader.take("", "");
    (word == "since" ? filter.from_us : filter.until_us) = reader.moment(word);
  } else if (word == "box") {
    reader.take("", "");
    filter.box = reader.box(word);
    if (!filter.in.empty()) reader.wrong("box: a place is a box, or in NAME, and not both");
  } else if (word == "in") {
    reader.take("", "");
    filter.in = reader.rights_name(word);
    if (filter.box) reader.wrong("in: a place is a box, or in NAME, and not both");
  } else if (word == "cause") {
    reader.take("", "");
    const std::string name = reader.take(word, kCauseNames);
    const auto found =
        std::find_if(kCauses.begin(), kCauses.end(), [&](const auto& c) { return c.name == name; });
    if (found != kCauses.end()) filter.cause = found->cause;
    if (found == kCauses.end()) reader.wrong("cause \"" + name + "\": " + kCauseNames);
  } else {
    return false;
  }
  return true;
}

/// Sets the box of the filter to the protected box that the filter names. Returns the reason if
/// there is no such box, or nullopt.
std::optional<std::string> place_filter(const CommandCall& call, CommandFilter& filter) {
  if (filter.in.empty()) return std::nullopt;
  const Decided<ProtectedBox>* box = call.rights().find_box(filter.in);
  if (box == nullptr)
    return "in \"" + filter.in + "\": there is no such protected box (protected lists them)";
  filter.box = box->value.box;
  return std::nullopt;
}

/// Returns the players who have built, for the lines of the log. Blocks on the disk.
StoreResult<KnownPlayers> read_builders(WorldReader& reader) {
  KnownPlayers::Sources sources;
  auto rows = reader.players();
  if (!rows) return failure(rows.error());
  auto used = reader.player_names();
  if (!used) return failure(used.error());
  sources.stored = *std::move(rows);
  sources.used = *std::move(used);
  return KnownPlayers(sources);
}

Result<LogCommand, std::string> parse_log(WordReader& reader) {
  LogCommand log;
  while (!reader.at_end()) {
    if (take_filter(reader, log.filter)) continue;
    const std::string word = reader.take("", "");
    if (word != "limit") return failure("log \"" + word + "\": " + kFilterWords + " or limit");
    const std::string text = reader.take(word, "how many edits");
    const auto number = number_of<std::uint64_t>(text);
    if (!number || *number == 0 || *number > kLogLinesMax) {
      reader.wrong("limit \"" + text + "\": a number from 1 to " + std::to_string(kLogLinesMax));
    } else {
      log.limit = *number;
    }
  }
  return reader.result(log, "log ");
}

/// Returns what follows the line of an action of several edits: their number, and the box around them.
std::string action_tail(const LogAction& action) {
  if (action.edits < 2) return {};
  const VoxelBox& box = action.box;
  const auto place = [](std::int32_t x, std::int32_t y, std::int32_t z) {
    return std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z);
  };
  return " (the newest of " + counted(action.edits, "edit") + " of one action, from " +
         std::to_string(action.first) + " on, in box " + place(box.min.x, box.min.y, box.min.z) +
         " to " + place(box.max.x - 1, box.max.y - 1, box.max.z - 1) + ")";
}

/// Returns a line for each of the newest actions that the filter selects. Blocks on the disk.
Result<std::string, std::string> read_log_lines(WorldReader& reader, const SelectionFilter& filter,
                                                std::uint64_t limit) {
  const auto names = read_builders(reader);
  const auto newest = newest_actions(reader, filter, limit);
  const auto materials = reader.materials();
  if (!materials) return failure(materials.error().message());
  if (!newest) return failure(newest.error().message());
  if (!names) return failure(names.error().message());
  std::string text;
  for (const LogAction& action : *newest) {
    const EditRecord& record = action.newest;
    text += (text.empty() ? "" : "\n") +
            log_line(record, names->text_of(record.op.author), *materials) + action_tail(action);
  }
  return text.empty() ? std::string("no edit matches") : text;
}

void list_log(const CommandCall& call, const LogCommand& command) {
  call.world().commit(call.now);
  CommandFilter wanted = command.filter;
  if (auto why = place_filter(call, wanted)) return call.refuse("log " + *why);
  with_selection(call, wanted, "log", false, [call, limit = command.limit](SelectionFilter filter) {
    filter.last = call.world().order().durable();
    call.on_worker(
        "log: ",
        [filter, limit](WorldReader& reader) { return read_log_lines(reader, filter, limit); },
        [call](const std::string& text) { call.answer(text); });
  });
}

Result<RollbackPreviewCommand, std::string> parse_preview(WordReader& reader) {
  RollbackPreviewCommand preview;
  while (!reader.at_end()) {
    if (reader.take_word("picture")) {
      preview.picture = true;
      continue;
    }
    if (take_filter(reader, preview.filter)) continue;
    return failure("rollback preview \"" + reader.peek() + "\": " + kFilterWords + " or picture");
  }
  if (!reader.error().empty()) return failure("rollback preview " + reader.error());
  if (preview.filter.cause == Cause::rights)
    return failure("rollback preview cause \"rights\": rights undo SEQ takes these records back");
  if (preview.filter.cause == Cause::materials)
    return failure("rollback preview cause \"materials\": added materials and shapes stay");
  if (preview.filter.cause == Cause::library)
    return failure("rollback preview cause \"library\": builds remove takes a build away");
  if (preview.filter.cause == Cause::textures)
    return failure("rollback preview cause \"textures\": textures stay");
  if (preview.filter.cause == Cause::clock)
    return failure("rollback preview cause \"clock\": `time` sets the time of the world");
  if (preview.filter.cause == Cause::gap)
    return failure("rollback preview cause \"gap\": these records are lost and have no voxels");
  // A preview without filters would select the whole world, most likely by mistake.
  if (preview.filter == CommandFilter{}) {
    return failure("rollback preview: say whose edits, when, where or why: " +
                   std::string(kFilterWords));
  }
  return preview;
}

constexpr CommandRule kRollback = needs(Right::roll_back);
// Owners of protected ground may give these commands without the right roll_back.
constexpr CommandRule kOwnRollback = needs(Right::roll_back, Right::claim, Right::build);

RollbackService::Scope scope_of(const CommandCall& call) {
  const bool has_all = has_right(call.caller, call.rights(), Right::roll_back, call.rights_time());
  return has_all ? RollbackService::Scope::all : RollbackService::Scope::own;
}

std::string box_names(const std::vector<const Decided<ProtectedBox>*>& boxes) {
  std::string text;
  for (const auto* box : boxes) text += (text.empty() ? "" : ", ") + box->value.name;
  return text;
}

/// Chooses the ground on which a caller without the right roll_back takes edits back, and sets it
/// as the box of the filter. Fails with the reason if there is no such ground.
Result<OwnGround, std::string> choose_own_ground(const CommandCall& call,
                                                 const RollbackPreviewCommand& command,
                                                 CommandFilter& filter) {
  const PublicKey& key = *call.caller.actor.key;
  const auto boxes = call.rights().boxes_of(key);
  if (boxes.empty()) {
    const auto lacks = why_not(call.caller, call.rights(), kRollback, call.rights_time());
    return failure(lacks.value_or("you own no protected ground") +
                   " (who owns protected ground takes edits back there without it)");
  }
  if (auto frozen = call.world().rights().freeze_text(key)) return failure(*frozen);
  if (!filter.address_of.empty())
    return failure("rollback preview: address-of needs the right roll_back");
  if (command.picture) return failure("rollback preview: picture needs the right roll_back");
  const Decided<ProtectedBox>* chosen = nullptr;
  for (const auto* box : boxes) {
    const bool is_named = !filter.in.empty() && box->value.name == filter.in;
    const bool has_place =
        filter.in.empty() && filter.box && intersect(box->value.box, *filter.box) == *filter.box;
    const bool is_only = filter.in.empty() && !filter.box && boxes.size() == 1;
    if (is_named || has_place || is_only) chosen = box;
  }
  if (chosen == nullptr && filter.in.empty() && !filter.box)
    return failure("rollback preview: say in which of your boxes, with in NAME: " +
                   box_names(boxes));
  if (chosen == nullptr)
    return failure("rollback preview: that is not wholly in ground of yours: your boxes are " +
                   box_names(boxes));
  if (!filter.box) filter.box = chosen->value.box;
  return OwnGround{call.caller.author, chosen->value.name, *filter.box};
}

void preview_rollback(const CommandCall& call, const RollbackPreviewCommand& command) {
  CommandFilter filter = command.filter;
  std::optional<OwnGround> own;
  if (scope_of(call) == RollbackService::Scope::own) {
    auto chosen = choose_own_ground(call, command, filter);
    if (!chosen) return call.refuse(chosen.error());
    own = *std::move(chosen);
  } else if (auto why = place_filter(call, filter)) {
    return call.refuse("rollback preview " + *why);
  }
  const auto edits = call.caller.preview_view
                         ? std::make_shared<PreviewEdits>(*call.caller.preview_view)
                         : std::shared_ptr<PreviewEdits>();
  const auto pictures = command.picture
                            ? std::make_shared<PreviewPictures>(call.services.world_folder)
                            : std::shared_ptr<PreviewPictures>();
  RollbackPreview::PlanViewer viewer;
  if (edits || pictures) {
    viewer.choose = [edits, pictures](const std::vector<ChunkKey>& changing) {
      const auto seen = edits ? edits->choose(changing) : std::vector<ChunkKey>();
      const auto drawn = pictures ? pictures->choose(changing) : std::vector<ChunkKey>();
      std::vector<ChunkKey> both;
      std::set_union(seen.begin(), seen.end(), drawn.begin(), drawn.end(),
                     std::back_inserter(both));
      return both;
    };
    viewer.add = [edits, pictures](const RestorePlan& plan) {
      if (edits) edits->add(plan);
      if (pictures) pictures->add(plan);
    };
  }
  RollbackPreview::Summary summarise;
  if (pictures) {
    summarise = [pictures](WorldReader& reader, const Generator& generator, const std::string& id,
                           const ShouldContinue& wanted) {
      return pictures->draw(reader, generator, id, wanted);
    };
  }
  const auto answer = [edits, reply = call.reply](CommandAnswer given) {
    if (edits && given.restore) {
      RestorePreview shown = *given.restore;
      edits->take(shown);
      given.restore = std::make_shared<const RestorePreview>(std::move(shown));
    }
    reply(given);
  };
  with_selection(call, filter, "rollback preview", true,
                 [call, answer, viewer, summarise, own](const SelectionFilter& selected) {
                   call.services.rollback.preview(selected, call.now, answer, viewer, summarise,
                                                  own);
                 });
}

Result<std::string, std::string> parse_rollback_id(WordReader& reader) {
  return reader.result(reader.take_only("one id comes after it (rollback list names them)"));
}

/// Returns the reason why an owner of ground may not apply a preview, or nullopt: the ground has
/// another owner or another place than before.
std::optional<std::string> why_not_own(const CommandCall& call, const OwnGround& ground) {
  const PublicKey& key = *call.caller.actor.key;
  if (auto frozen = call.world().rights().freeze_text(key)) return frozen;
  const Decided<ProtectedBox>* box = call.rights().find_box(ground.name);
  const bool is_owned = box != nullptr && box->value.owner == key &&
                        intersect(box->value.box, ground.box) == ground.box;
  if (is_owned) return std::nullopt;
  return "rollback apply: the ground of the preview is not wholly yours any more (" + ground.name +
         ")";
}

void apply_rollback(const CommandCall& call, const std::string& id) {
  RollbackService& rollback = call.services.rollback;
  const RollbackService::Scope scope = scope_of(call);
  const OwnGround* const ground =
      scope == RollbackService::Scope::own ? rollback.own_ground(id, call.caller.author) : nullptr;
  if (ground != nullptr) {
    if (auto why = why_not_own(call, *ground)) return call.refuse(*std::move(why));
  }
  rollback.apply(id, call.caller.author, call.reply, scope);
}
void cancel_rollback(const CommandCall& call, const std::string& id) {
  call.services.rollback.cancel(id, call.reply, call.caller.author, scope_of(call));
}
void undo_rollback(const CommandCall& call, const std::string& id) {
  call.services.rollback.undo_rollback(id, call.caller.author, call.now, call.reply,
                                       scope_of(call));
}
void list_rollbacks(const CommandCall& call) {
  call.services.rollback.list(call.reply, call.caller.author, scope_of(call));
}

constexpr std::array<CommandRow, 6> kRollbackRows = {{
    {"log", kRollback, "log FILTERS [limit N]     the newest actions, the last one at the bottom",
     parsed_by<parse_log, list_log>()},
    {.words = "rollback preview",
     .rule = kOwnRollback,
     .help = "rollback preview FILTERS [picture]\n"
             "                          what a rollback of these edits would do; "
             "`picture` draws the area before and after.\n"
             "                          Owners of protected ground: of edits there, in NAME",
     .functions = parsed_by<parse_preview, preview_rollback>(),
     .may_be_confirmed = true},
    {"rollback apply", kOwnRollback,
     "rollback apply ID         do it, while people go on playing; "
     "what others built since stays",
     parsed_by<parse_rollback_id, apply_rollback>()},
    {"rollback cancel", kOwnRollback, "rollback cancel ID        stop it, or forget a preview",
     parsed_by<parse_rollback_id, cancel_rollback>()},
    {"rollback undo", kOwnRollback, "rollback undo ID          take a rollback back",
     parsed_by<parse_rollback_id, undo_rollback>()},
    {"rollback list", kOwnRollback, "rollback list             previews, and the rollbacks so far",
     alone<list_rollbacks>()},
}};

}  // namespace

std::span<const CommandRow> rollback_commands() { return kRollbackRows; }

std::string_view name_of(Cause cause) {
  const auto found =
      std::find_if(kCauses.begin(), kCauses.end(), [&](const auto& c) { return c.cause == cause; });
  return found == kCauses.end() ? "?" : found->name;
}

std::string log_line(const EditRecord& record, const std::string& author,
                     const MaterialTable& materials) {
  std::string line =
      std::to_string(record.version.seq) + " " + utc_text(record.time_us) + " " + author + " ";
  line += name_of(record.cause);
  if (record.subject != 0)
    line += (restores(record.cause) ? " of " : " with ") + std::to_string(record.subject);
  if (const RightsChange* change = rights_change_of(record.edit))
    return line + " " + rights_change_text(*change);
  if (const AddedMaterials* added = added_materials_of(record.edit))
    return line + " " + added_materials_text(*added);
  if (const GivenShapes* given = given_shapes_of(record.edit))
    return line + " shapes of " + given_names_text(given->rows, materials);
  if (const GivenTexture* given = given_texture_of(record.edit))
    return line + " texture of " + given_names_text(given->uses, materials);
  if (const LibraryChange* change = library_change_of(record.edit))
    return line + " " + library_change_text(*change);
  if (const WorldTime* time = world_time_of(record.edit))
    return line + " time " + day_time_text(time->day_ms) + " rate " + std::to_string(time->rate);
  if (const GapEdit* gap = gap_of(record.edit)) {
    const std::string whose = gap->author == 0 ? "" : " of #" + std::to_string(gap->author);
    return line + " lost record" + whose;
  }
  return line + " " + edit_text(record, materials);
}

}  // namespace runstone
