#include "server/admin/place_words.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/build_files/model_words.hpp"
#include "common/builds/build_transforms.hpp"
#include "common/core/assert.hpp"
#include "common/edits/descriptor/added_materials.hpp"
#include "common/formats/file_build_turn.hpp"
#include "common/formats/material_family.hpp"
#include "common/formats/material_match.hpp"
#include "common/formats/turned_names.hpp"
#include "common/materials/nearest_material.hpp"
#include "server/rollback/count_text.hpp"

namespace runstone {
namespace {

constexpr std::size_t kMissingListed = 8;

std::string missing_text(std::span<const BuildMaterial> materials, const MaterialMatch& match) {
  std::string text = "this world lacks " + counted(match.missing.size(), "material") + " of it: ";
  const std::size_t listed = std::min(match.missing.size(), kMissingListed);
  for (std::size_t i = 0; i < listed; ++i)
    text += (i == 0 ? "" : ", ") + world_name_of(materials[match.missing[i]]);
  if (listed < match.missing.size())
    text += " and " + std::to_string(match.missing.size() - listed) + " more";
  return text;
}

/// A build as it will lie in the world, and the materials of the world for those of the file.
struct MatchedBuild {
  BuildPtr build;  // turned; its materials are those of the file
  std::vector<BuildMaterial> materials;
  std::size_t stuck = 0;  // materials that no state turns
  MaterialMatch match;
};

/// Gives each missing material the nearest one of its family, or the nearest colour of the table if
/// the table lacks the family. Cost: O(looks that differ * table + members of the families).
void match_nearest(std::span<const BuildMaterial> materials, const MaterialTable& table,
                   MaterialMatch& match) {
  std::map<std::pair<MaterialColour, Visibility>, Material> found;
  for (const std::size_t i : match.missing) {
    const MaterialRow& row = materials[i].row;
    if (const auto member =
            nearest_member(table, states_of_material(world_name_of(materials[i])))) {
      match.ids[i] = *member;
      continue;
    }
    const auto [known, is_new] = found.try_emplace({row.colour, row.visibility}, kEmpty);
    if (is_new) known->second = nearest_material(row, table);
    match.ids[i] = known->second;
  }
  match.missing.clear();
}

/// Turns the build and matches its materials. Thread: a worker.
Result<std::shared_ptr<MatchedBuild>, std::string> match_build(WorldReader& reader,
                                                               const FileBuild& build,
                                                               const PlaceWords& words) {
  const auto table = reader.materials();
  if (!table) return failure(table.error().message());
  auto turned_build = turned_file_build(build, words.orientation);
  if (!turned_build) return failure(std::string(turned_build.error().what));
  auto out = std::make_shared<MatchedBuild>();
  out->build = std::move(turned_build->build.build);
  out->materials = std::move(turned_build->build.materials);
  out->stuck = turned_build->stuck;
  out->match = match_by_name(out->materials, *table);
  if (words.missing == MissingMaterials::nearest) match_nearest(out->materials, *table, out->match);
  if (words.missing == MissingMaterials::refused && !out->match.missing.empty()) {
    return failure(missing_text(out->materials, out->match) +
                   "; repeat the line with `materials add` (rows of the table stay for ever) or "
                   "`materials nearest` (other states, and the nearest colours of this world)");
  }
  if (out->match.missing.size() > kPlacedMaterialsMax) {
    return failure(missing_text(out->materials, out->match) + "; one command adds at most " +
                   std::to_string(kPlacedMaterialsMax) + ": `materials nearest` adds none");
  }
  return out;
}

/// Orders the rows that the world lacks, and gives them their ids.
Result<void, std::string> add_missing(const CommandCall& call, MatchedBuild& made) {
  const MaterialTable& table = call.world().order().materials();
  std::map<std::string, std::size_t> index;  // in rows, by name
  std::vector<MaterialRow> rows;
  for (const std::size_t i : made.match.missing) {
    MaterialRow row = world_row_of(made.materials[i]);
    // `materials shapes` gives what the name says once the old follower has ended.
    if (call.world().cluster().shapes_refusal()) row.shape = {};
    // Somebody may have added it meanwhile, and two materials may have one name.
    if (table.find(row.name) || !index.try_emplace(row.name, rows.size()).second) continue;
    rows.push_back(std::move(row));
  }
  if (const auto fits = table.check_rows(rows); !fits)
    return failure("the materials cannot be added: " + std::string(fits.error().what));
  for (std::size_t begin = 0; begin < rows.size(); begin += kAddedMaterialsMax) {
    const std::size_t end = std::min(begin + kAddedMaterialsMax, rows.size());
    const std::vector<MaterialRow> some(rows.begin() + static_cast<std::ptrdiff_t>(begin),
                                        rows.begin() + static_cast<std::ptrdiff_t>(end));
    const auto added = call.world().changes().add_materials(some, call.now);
    if (!added) return failure("the materials cannot be added: " + std::string(added.error().what));
  }
  for (const std::size_t i : made.match.missing)
    made.match.ids[i] = call.world().order().materials().find(world_name_of(made.materials[i]));
  return {};
}

/// Takes a word that says how a model becomes a build. Returns false if there is none.
bool take_model_word(WordReader& reader, ModelChoices& model) {
  const ModelWord* const word = model_word(reader.peek());
  if (word == nullptr) return false;
  const std::string name(word->name);
  reader.take_word(name);
  const std::string value =
      word->has_value() ? reader.take(name, std::string(word->values)) : std::string();
  if (const auto chosen = choose_by_word(*word, value, model); !chosen)
    reader.wrong(name + " \"" + value + "\": " + chosen.error());
  return true;
}

}  // namespace

PlaceWords take_place_words(WordReader& reader, PlacedFileWords* file) {
  PlaceWords out;
  if (!reader.take_word("at")) {
    reader.wrong(reader.command() + ": at X Y Z is missing: the place of its lowest corner");
    return out;
  }
  out.at = reader.position("at");
  while (!reader.at_end()) {
    if (reader.take_word("turn")) {
      const std::int64_t degrees = reader.number("turn", 0, 270);
      if (degrees % 90 != 0) reader.wrong("turn " + std::to_string(degrees) + ": 90, 180 or 270");
      out.orientation = out.orientation.rotated_about_y(static_cast<int>(degrees / 90));
    } else if (reader.take_word("mirror")) {
      const std::string axis = reader.take("mirror", "x or z");
      if (axis != "x" && axis != "z") reader.wrong("mirror \"" + axis + "\": x or z");
      out.orientation = out.orientation.mirrored(axis == "x" ? Axis::x : Axis::z);
    } else if (reader.take_word("only-into")) {
      if (!reader.take_word("empty")) reader.wrong("only-into: empty is the only choice");
      out.mask.kind = MaskKind::only_empty;
    } else if (reader.take_word("without")) {
      if (!reader.take_word("air")) reader.wrong("without: air is the only choice");
      out.empty = EmptyCells::skipped;
    } else if (reader.take_word("materials")) {
      const bool is_add = reader.take_word("add");
      if (!is_add && !reader.take_word("nearest")) reader.wrong("materials: add or nearest");
      out.missing = is_add ? MissingMaterials::added : MissingMaterials::nearest;
    } else if (file != nullptr && reader.take_word(kMapWord)) {
      file->map = reader.take(std::string(kMapWord), "a TOML file that chooses materials");
    } else if (file != nullptr && reader.take_word(kColoursWord)) {
      file->colours =
          reader.take(std::string(kColoursWord), "a PNG with the colours of a height map");
    } else if (file == nullptr || !take_model_word(reader, file->model)) {
      reader.wrong(reader.command() + " \"" + reader.peek() +
                   "\": turn, mirror, only-into, without" +
                   (file != nullptr
                        ? ", materials, map, colours, voxels, voxels-per-metre, surface, hollow, "
                          "fill-overlaps or up"
                        : " or materials"));
    }
  }
  return out;
}

void place_build(const CommandCall& call, const std::string& command, const std::string& name,
                 std::shared_ptr<const FileBuild> build, const PlaceWords& words) {
  const bool is_host = call.caller.author == 0 || call.caller.actor.is_operator;
  if (words.missing == MissingMaterials::added && !is_host) {
    return call.refuse(command +
                       ": materials add is for the console and operators, because rows of "
                       "the table stay for ever: materials nearest adds none");
  }
  call.on_worker(
      command + ": ",
      [build = std::move(build), words](WorldReader& reader) {
        return match_build(reader, *build, words);
      },
      [call, command, name, words](const std::shared_ptr<MatchedBuild>& made) {
        PlaceOrder order;
        order.author = order.payer = call.caller.author;
        order.build = made->build;
        order.at = words.at;
        order.mask = words.mask;
        order.empty = words.empty;
        if (const auto why = call.services.placing.refusal(order))
          return call.refuse(command + ": " + *why);
        if (const auto notice = stuck_notice(made->stuck); !notice.empty()) call.report(notice);
        if (const auto done = add_missing(call, *made); !done)
          return call.refuse(command + ": " + done.error());
        call.on_worker(
            command + ": ",
            [made](WorldReader&) -> Result<BuildPtr, std::string> {
              auto known = with_materials(*made->build, made->match.ids);
              if (!known) return failure(std::string(known.error().what));
              return *std::move(known);
            },
            [call, name, order](const BuildPtr& known) {
              PlaceOrder ready = order;
              ready.build = known;
              call.services.placing.place(std::move(ready), name, call.now, call.reply);
            });
      });
}

}  // namespace runstone
