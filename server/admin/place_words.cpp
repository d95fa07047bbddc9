#include "server/admin/place_words.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/builds/build_transforms.hpp"
#include "common/edits/descriptor/added_materials.hpp"
#include "common/formats/material_match.hpp"
#include "common/materials/nearest_material.hpp"
#include "server/rollback/count_text.hpp"

namespace runstone {
namespace {

constexpr std::size_t kMissingListed = 8;

std::string missing_text(const FileBuild& build, const MaterialMatch& match) {
  std::string text = "this world lacks " + counted(match.missing.size(), "material") + " of it: ";
  const std::size_t listed = std::min(match.missing.size(), kMissingListed);
  for (std::size_t i = 0; i < listed; ++i)
    text += (i == 0 ? "" : ", ") + world_name_of(build.materials[match.missing[i]]);
  if (listed < match.missing.size())
    text += " and " + std::to_string(match.missing.size() - listed) + " more";
  return text;
}

/// Orders the rows that the world lacks, and gives them their ids.
Result<void, std::string> add_missing(const CommandCall& call, const FileBuild& build,
                                      MaterialMatch& match) {
  if (match.missing.size() > kPlacedMaterialsMax) {
    return failure(missing_text(build, match) + "; one command adds at most " +
                   std::to_string(kPlacedMaterialsMax) + ": `materials nearest` adds none");
  }
  const std::size_t known = call.world().order().materials().size();
  if (match.missing.size() > kMaterialCountMax - known) {
    return failure(missing_text(build, match) + "; the world has " + std::to_string(known) +
                   " of at most " + std::to_string(kMaterialCountMax) +
                   ": `materials nearest` adds none");
  }
  for (std::size_t begin = 0; begin < match.missing.size(); begin += kAddedMaterialsMax) {
    const std::size_t end = std::min(begin + kAddedMaterialsMax, match.missing.size());
    std::vector<MaterialRow> rows;
    for (std::size_t i = begin; i < end; ++i)
      rows.push_back(world_row_of(build.materials[match.missing[i]]));
    const auto added = call.world().changes().add_materials(rows, call.now);
    if (!added) return failure("the materials cannot be added: " + std::string(added.error().what));
    for (std::size_t i = begin; i < end; ++i) {
      match.ids[match.missing[i]] =
          static_cast<Material>(added->first + static_cast<Material>(i - begin));
    }
  }
  return {};
}

Result<void, std::string> resolve_missing(const CommandCall& call, const FileBuild& build,
                                          MissingMaterials how, MaterialMatch& match) {
  if (match.missing.empty()) return {};
  switch (how) {
    case MissingMaterials::added:
      return add_missing(call, build, match);
    case MissingMaterials::nearest:
      for (const std::size_t i : match.missing)
        match.ids[i] = nearest_material(build.materials[i].row, call.world().order().materials());
      return {};
    default:
      return failure(missing_text(build, match) +
                     "; repeat the line with `materials add` (rows of the table stay for ever) or "
                     "`materials nearest` (the nearest colours of this world)");
  }
}

}  // namespace

PlaceWords take_place_words(WordReader& reader) {
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
    } else {
      reader.wrong(reader.command() + " \"" + reader.peek() +
                   "\": turn, mirror, only-into, without or materials");
    }
  }
  return out;
}

void place_build(const CommandCall& call, const std::string& command, const std::string& name,
                 const FileBuild& build, const PlaceWords& words) {
  MaterialMatch match = match_by_name(build.materials, call.world().order().materials());
  if (const auto done = resolve_missing(call, build, words.missing, match); !done)
    return call.refuse(command + ": " + done.error());
  call.on_worker(
      command + ": ",
      [built = build.build, ids = std::move(match.ids),
       words](WorldReader&) -> Result<BuildPtr, std::string> {
        auto known = with_materials(*built, ids);
        if (known) known = turned(**known, words.orientation);
        if (!known) return failure(std::string(known.error().what));
        return *std::move(known);
      },
      [call, name, words](const BuildPtr& made) {
        PlaceOrder order;
        order.author = order.payer = call.caller.author;
        order.build = made;
        order.at = words.at;
        order.mask = words.mask;
        order.empty = words.empty;
        call.services.placing.place(std::move(order), name, call.now, call.reply);
      });
}

}  // namespace runstone
